"""The notebooks of the documents print what they say they print, and draw."""

import base64
import io
import json
from pathlib import Path

import pytest
from PIL import Image

from tests.house.gallery import NOTEBOOKS, outputs, shown, title_of


@pytest.mark.slow
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_prints_what_it_says(path, tmp_path):
    notebook = json.loads(path.read_text(encoding="utf-8"))
    made = outputs(notebook, tmp_path)
    assert [(text, [title_of(figure)] if figure else []) for text, figure in made] == shown(notebook)


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_has_text_and_a_figure(path):
    cells = [cell for cell in json.loads(path.read_text(encoding="utf-8"))["cells"] if "outputs" in cell]
    found = [one for cell in cells for one in cell["outputs"]]
    assert any("text" in one for one in found)
    figures = [one["data"] for one in found if "data" in one]
    assert figures
    for figure in figures:
        assert figure["text/plain"]
        picture = Image.open(io.BytesIO(base64.b64decode(figure["image/png"]))).convert("RGB")
        assert len(picture.getcolors(2**16) or [()] * 2**16) > 10


def test_every_notebook_is_a_page_of_the_site():
    assert len(NOTEBOOKS) >= 4
    text = (Path(__file__).parents[2] / "docs" / "conf.py").read_text(encoding="utf-8")
    assert '".ipynb": "notebook"' in text
    assert '"gallery/": "Gallery"' in text
