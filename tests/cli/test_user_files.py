"""What users name and is no file that can be read is refused at once, whatever it is and whoever reads it."""

import json
import os
import re
import subprocess
import sys
from itertools import product
from pathlib import Path

import pytest

from lyapcheck.errors import InputError
from lyapcheck.extensions import defining, modules
from lyapcheck.files.reader import Bound, holds, read_bytes, read_text
from tests.cli.user_files import COMMANDS, KINDS

ROOT = Path(__file__).parents[2]
RULES = {
    "missing": r"cannot be read \(No such file or directory\)|no such proof script|no URDF file",
    "device": "is a device",
    "pipe": "is a pipe",
    "folder": "is a folder|the directory has no certificates",
    "huge": r"is larger than \d+ bytes|has 110000000 bytes, above \d+",
    "no text": "is not UTF-8 text|is not Python|is not JSON",
    "unreadable": r"cannot be read \(Input/output error\)",
}
HELD = r"report\.json: file: cannot be read \(No such file or directory\)"
"""A folder may hold an older report."""


@pytest.fixture(scope="module")
def ended(tmp_path_factory):
    """How each command ended on each kind of file: code, output, messages."""
    folder = tmp_path_factory.mktemp("files")
    done = subprocess.run(
        [sys.executable, "-m", "tests.cli.user_files", str(folder)],
        cwd=ROOT,
        env={**os.environ, "MALLOC_ARENA_MAX": "1"},  # a heap of 64 MB a thread would be growth
        capture_output=True,
        text=True,
        check=False,
        timeout=300,  # where something waits for a pipe
    )
    assert done.returncode == 0, done.stderr[-2000:]
    return {(kind, what): (code, out, err) for kind, what, code, out, err in json.loads(done.stdout)}


def test_it_is_refused_in_one_line(ended):
    assert set(ended) == set(product(KINDS, COMMANDS))
    for (kind, what), (code, _, err) in ended.items():
        lines = [line for line in err.splitlines() if line.strip()]
        assert (code, len(lines)) == (2, 1), (kind, what, err)
        assert re.search(r"bad(\.\w+)?", err), (kind, what, err)
        rule = HELD if (kind, what) == ("folder", "older report") else RULES[kind]
        assert re.search(rule, err), (kind, what, err)


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "text.toml"
    path.write_bytes(b"a = 1\r\nb = 2\n")
    return path


def test_a_link_to_a_file_is_read(file, tmp_path):
    link = tmp_path / "link.toml"
    link.symlink_to(file)
    assert read_text(link, Bound(100, "")) == "a = 1\nb = 2\n"
    assert read_text(link, Bound(100, ""), newline="") == "a = 1\r\nb = 2\n"


def test_a_file_of_the_largest_size_is_read_and_one_more_byte_is_not(file):
    size = file.stat().st_size
    assert len(read_bytes(file, Bound(size, ""))) == size
    with pytest.raises(InputError, match=rf"shown: file: is larger than {size - 1} bytes; cut it"):
        read_bytes(file, Bound(size - 1, "cut it"), "shown")


def test_a_mark_of_the_byte_order_is_no_text(file):
    file.write_bytes(b"\xef\xbb\xbfa = 1")
    assert read_text(file, Bound(100, "")) == "a = 1"


@pytest.mark.parametrize("content", [b"a = 1\r\nb = 2\n", b"", b"a = 1\r\nb = 2\n!"])
def test_what_a_file_holds_is_compared_byte_by_byte(file, content):
    assert holds(file, content) == (file.read_bytes() == content)
    assert not holds(file.with_name("other"), content)


def test_a_file_without_end_that_has_no_size_is_not_read_to_it(monkeypatch, tmp_path):
    """Some systems say 0 of files that are written as they are read."""
    file = tmp_path / "endless"
    file.write_bytes(b"x" * 1000)
    empty = os.stat(tmp_path / "endless")
    monkeypatch.setattr(os, "fstat", lambda _: os.stat_result((*empty[:6], 0, *empty[7:])), raising=True)
    with pytest.raises(InputError, match="is larger than 10 bytes"):
        read_bytes(file, Bound(10, ""))


def test_a_pipe_among_modules_of_ones_own_is_none(tmp_path):
    (tmp_path / "good.py").write_text("def create(m):\n    pass\n", encoding="utf-8")
    os.mkfifo(tmp_path / "pipe.py")
    assert modules([str(tmp_path)]) == ("good",)
    assert defining("create", [str(tmp_path)]) == ("good",)
