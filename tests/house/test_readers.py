"""Files that users name are opened by the bounded readers alone."""

import ast
from functools import cache
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[2] / "lyapcheck"
OPENING = ("open", "read_text", "read_bytes")
READERS = {
    ("files/reader.py", "read_bytes"): "the reader",
    ("check/recheck.py", "content"): "the checker's own, of certificates",
    ("store.py", "_content"): "that of the store, which opens no link either",
}
OURS = {
    ("answers/explain.py", "_cited"): "the bibliography of the package",
    ("lyapunov/loop.py", "source"): "source of the package",
    ("export/__init__.py", "texts"): "source of the package",
    ("cli/commands/init.py", "run"): "the first files of the package",
    ("lyapunov/compiler.py", "library"): "what the compiler has just written to a folder of ours",
    ("kernel/__init__.py", "__init__"): "the library of the package",
    ("kernel/__init__.py", "sources"): "the library of the package",
    ("kernel/__init__.py", "golden"): "the library of the package",
    ("kernel/__init__.py", "_record"): "a record of the package",
    ("kernel/__init__.py", "_definitions"): "the library of the package",
    ("rechecking/__init__.py", "_imported"): "source of the package",
    ("report/plots.py", "png"): "a picture in memory",
    ("report/model.py", "published_notes"): "a proof of the package",
    ("report/page/__init__.py", "raw"): "style and script of the package",
    ("lyapunov/numeric.py", "_source_of"): "the file that a family was imported from",
    ("store.py", "source_digest"): "the source of the package",
    ("claims/script.py", "_read"): "an answer in a folder of ours, whose size is looked at first",
    ("answers/sweep/result.py", "_tabulate"): "rows that this run has just written",
}
WRITTEN = {
    ("answers/sweep/result.py", "written"): "rows",
    ("cli/show.py", "_append_summary"): "the summary of a job",
}
OF_THE_SYSTEM = {
    ("check/guard.py", "_most_memory"): "/proc",
    ("claims/script_process.py", "_only_ours"): "the null device",
    ("cli/main.py", "_require_output"): "the null device",
    ("cli/main.py", "_drop"): "the null device",
    ("lyapunov/compiler.py", "_processor"): "/proc",
    ("process_tree.py", "_below"): "/proc",
}
KNOWN = READERS | OURS | WRITTEN | OF_THE_SYSTEM


def opened(tree, function=""):
    """The functions in which something is opened."""
    for node in ast.iter_child_nodes(tree):
        inner = node.name if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) else function
        if isinstance(node, ast.Call):
            called = node.func
            method = isinstance(called, ast.Attribute) and called.attr in OPENING
            if method or (isinstance(called, ast.Name) and called.id == "open"):
                yield inner
        yield from opened(node, inner)


@cache
def places():
    return {
        (path.relative_to(PACKAGE).as_posix(), function)
        for path in PACKAGE.rglob("*.py")
        for function in opened(ast.parse(path.read_text(encoding="utf-8")))
    }


def test_nothing_else_opens_files():
    """What a user names goes through `lyapcheck.files.reader`; what is listed here is named by nobody."""
    assert places() - set(KNOWN) == set()


def test_what_is_listed_is_there():
    assert set(KNOWN) - places() == set()


@pytest.mark.parametrize(
    "text", ["open(p)", "Path(p).read_text()", "p.read_bytes()", "p.open()", "os.open(p, 0)"]
)
def test_every_way_to_open_is_seen(text):
    assert list(opened(ast.parse(f"def read(p):\n    return {text}"))) == ["read"]
