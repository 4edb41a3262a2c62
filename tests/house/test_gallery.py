"""The notebooks of the documents print what they say they print."""

import json
from pathlib import Path

import pytest

from tests.house.gallery import NOTEBOOKS, outputs, shown


@pytest.mark.slow
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_prints_what_it_says(path, tmp_path):
    notebook = json.loads(path.read_text(encoding="utf-8"))
    assert any(shown(notebook))
    assert outputs(notebook, tmp_path) == shown(notebook)


def test_every_notebook_is_a_page_of_the_site():
    assert len(NOTEBOOKS) >= 4
    text = (Path(__file__).parents[2] / "docs" / "conf.py").read_text(encoding="utf-8")
    assert '".ipynb": "notebook"' in text
    assert '"gallery/": "Gallery"' in text
