"""The notebooks of the documents, executed: ``python -m tests.house.gallery`` writes their outputs anew."""

import ast
import base64
import io
import json
import os
import sys
from contextlib import chdir, redirect_stdout
from pathlib import Path
from tempfile import TemporaryDirectory

from matplotlib.figure import Figure

from lyapcheck.report.plots import png

GALLERY = Path(__file__).parents[2] / "docs" / "gallery"
NOTEBOOKS = sorted(GALLERY.glob("*.ipynb"))


def outputs(notebook, folder):
    """What each cell of code prints, its last value included, and its figure; in one namespace."""
    names = {"__name__": "__main__"}
    result = []
    with chdir(folder):
        for cell in notebook["cells"]:
            if cell["cell_type"] == "code":
                printed = io.StringIO()
                with redirect_stdout(printed):
                    figure = _run("".join(cell["source"]), names)
                result.append((printed.getvalue(), figure))
    return result


def _run(source, names):
    """A cell as a notebook runs it: a last expression is shown, or returned if it is a figure."""
    *first, last = ast.parse(source).body
    ends = isinstance(last, ast.Expr)
    exec(compile(ast.Module([*first] if ends else [*first, last], []), "cell", "exec"), names)
    value = eval(compile(ast.Expression(last.value), "cell", "eval"), names) if ends else None
    if isinstance(value, Figure):
        return value
    if value is not None:
        print(repr(value))
    return None


def title_of(figure):
    """What is read aloud in place of the figure."""
    return "; ".join(axes.get_title(loc) for axes in figure.axes for loc in ("left", "center")).strip("; ")


def shown(notebook):
    """What the file says that each cell of code prints, and the title of its figure."""
    cells = [cell["outputs"] for cell in notebook["cells"] if cell["cell_type"] == "code"]
    texts = ["".join("".join(one.get("text", "")) for one in own) for own in cells]
    figures = [[one["data"]["text/plain"] for one in own if "data" in one] for own in cells]
    return list(zip(texts, figures, strict=True))


def main():
    """Execute all notebooks and write what they print and draw into them."""
    os.environ["LYAPCHECK_NO_STORE"] = "1"
    for path in NOTEBOOKS:
        notebook = json.loads(path.read_text(encoding="utf-8"))
        with TemporaryDirectory() as folder:
            made = iter(outputs(notebook, Path(folder)))
        for number, cell in enumerate((c for c in notebook["cells"] if c["cell_type"] == "code"), start=1):
            text, figure = next(made)
            stream = {"name": "stdout", "output_type": "stream", "text": text.splitlines(keepends=True)}
            cell |= {"execution_count": number, "outputs": [stream] if text else []}
            if figure is not None:
                picture = base64.b64encode(png(figure)).decode()
                data = {"image/png": picture, "text/plain": title_of(figure)}
                cell["outputs"].append({"data": data, "metadata": {}, "output_type": "display_data"})
        path.write_text(json.dumps(notebook, ensure_ascii=False, indent=1) + "\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
