"""The notebooks of the documents, executed: ``python -m tests.house.gallery`` writes their outputs anew."""

import ast
import io
import json
import os
import sys
from contextlib import chdir, redirect_stdout
from pathlib import Path
from tempfile import TemporaryDirectory

GALLERY = Path(__file__).parents[2] / "docs" / "gallery"
NOTEBOOKS = sorted(GALLERY.glob("*.ipynb"))


def outputs(notebook, folder):
    """What each cell of code prints, its last value included, all in one namespace and a folder."""
    names = {"__name__": "__main__"}
    result = []
    with chdir(folder):
        for cell in notebook["cells"]:
            if cell["cell_type"] == "code":
                printed = io.StringIO()
                with redirect_stdout(printed):
                    _run("".join(cell["source"]), names)
                result.append(printed.getvalue())
    return result


def _run(source, names):
    """A cell as a notebook runs it: the value of a last expression is shown."""
    *first, last = ast.parse(source).body
    ends = isinstance(last, ast.Expr)
    exec(compile(ast.Module([*first] if ends else [*first, last], []), "cell", "exec"), names)
    value = eval(compile(ast.Expression(last.value), "cell", "eval"), names) if ends else None
    if value is not None:
        print(repr(value))


def shown(notebook):
    """What the file says that each cell of code prints."""
    cells = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
    return ["".join("".join(output["text"]) for output in cell["outputs"]) for cell in cells]


def main():
    """Execute all notebooks and write what they print into them."""
    os.environ["LYAPCHECK_NO_STORE"] = "1"
    for path in NOTEBOOKS:
        notebook = json.loads(path.read_text(encoding="utf-8"))
        with TemporaryDirectory() as folder:
            texts = iter(outputs(notebook, Path(folder)))
        for number, cell in enumerate((c for c in notebook["cells"] if c["cell_type"] == "code"), start=1):
            text = next(texts).splitlines(keepends=True)
            stream = {"name": "stdout", "output_type": "stream", "text": text}
            cell |= {"execution_count": number, "outputs": [stream] if text else []}
        path.write_text(json.dumps(notebook, ensure_ascii=False, indent=1) + "\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
