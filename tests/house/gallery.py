"""The notebooks of the documents, executed: ``python -m tests.house.gallery`` writes their outputs anew."""

from __future__ import annotations

import ast
import io
import json
import os
import sys
from contextlib import chdir, redirect_stdout
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

GALLERY = Path(__file__).parents[2] / "docs" / "gallery"
NOTEBOOKS = sorted(GALLERY.glob("*.ipynb"))


def outputs(notebook: dict[str, Any], folder: Path) -> list[str]:
    """What each cell of code prints, its last value included, all in one namespace and a folder."""
    names: dict[str, Any] = {"__name__": "__main__"}
    result = []
    with chdir(folder):
        for cell in notebook["cells"]:
            if cell["cell_type"] == "code":
                printed = io.StringIO()
                with redirect_stdout(printed):
                    _run("".join(cell["source"]), names)
                result.append(printed.getvalue())
    return result


def _run(source: str, names: dict[str, Any]) -> None:
    """A cell as a notebook runs it: the value of a last expression is shown."""
    *first, last = ast.parse(source).body
    ends = isinstance(last, ast.Expr)
    exec(compile(ast.Module([*first] if ends else [*first, last], []), "cell", "exec"), names)
    value = eval(compile(ast.Expression(last.value), "cell", "eval"), names) if ends else None
    if value is not None:
        print(repr(value))


def shown(notebook: dict[str, Any]) -> list[str]:
    """What the file says that each cell of code prints."""
    cells = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
    return ["".join("".join(output["text"]) for output in cell["outputs"]) for cell in cells]


def main() -> int:
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
