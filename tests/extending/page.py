"""The page, section by section: the files that it shows, and the commands with what they print."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import lyapcheck

PAGE = Path(__file__).parents[2] / "docs" / "extend.md"
OWN = ("claims", "cli", "family", "output", "robots")
"""What may lie in a folder of the user's own; what is in ``check`` is for the checker."""
FILE = re.compile(r"^`(?P<path>[\w./-]+)`:\n\n```\w+\n(?P<text>.*?)^```$", re.MULTILINE | re.DOTALL)
CONSOLE = re.compile(r"^```console\n\$ (?P<command>.*?)\n(?P<output>.*?)^```$", re.MULTILINE | re.DOTALL)


@dataclass(frozen=True)
class File:
    """A file that the page shows."""

    path: str
    text: str


@dataclass(frozen=True)
class Call:
    """A command, and lines that it prints; a comment behind it names a verdict other than proved."""

    command: str
    output: str

    @property
    def code(self):
        """The exit code that the comment names."""
        return exit_code(self.command)


def exit_code(line):
    """The exit code of a command line of the documents: 0, or that of the verdict in its comment."""
    words = line.partition(" #")[2].split()
    codes = {"refuted": 1, "rejected": 1, "undecided": 3}
    return next((code for word, code in codes.items() if word in words), 0)


def sections():
    """What each section has, in its order."""
    _, *parts = re.split(r"^## ", PAGE.read_text(encoding="utf-8"), flags=re.MULTILINE)
    return {part.partition("\n")[0]: list(_items(part)) for part in parts}


def _items(part):
    result = [(match.start(), File(match["path"], match["text"])) for match in FILE.finditer(part)]
    calls = [(match.start(), Call(match["command"], match["output"])) for match in CONSOLE.finditer(part)]
    yield from (item for _, item in sorted([*result, *calls], key=lambda pair: pair[0]))


def _copied(source, copy):
    """A package to which files of the checker can be added: the folders that get none are linked."""
    copy.mkdir(parents=True)
    for entry in source.iterdir():
        if entry.is_dir() and entry.name != "check":
            (copy / entry.name).symlink_to(entry)
        elif entry.is_dir():
            shutil.copytree(entry, copy / entry.name)
        else:
            shutil.copy(entry, copy)


class Workshop:
    """A folder with a copy of lyapcheck, whose checker may get files, and a folder of the user's own."""

    def __init__(self, folder):
        self.folder, self.copy, self.mine = folder, folder / "copy", folder / "mine"
        source = Path(lyapcheck.__file__).parent
        _copied(source, self.copy / "lyapcheck")
        if not (source / "proofs").is_dir():
            shutil.copytree(source.parent / "proofs", self.copy / "proofs")
        self.mine.mkdir()

    def put(self, file):
        """Write a file where the page says that it belongs."""
        room = file.path.partition("/")[0]
        root = self.folder
        if room == "check":
            root = self.copy / "lyapcheck"
        elif room in OWN:
            root = self.mine
        path = root / file.path
        assert not path.exists(), "a file is added, none is changed"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(file.text, encoding="utf-8")

    def up_to(self, title):
        """With the files of all sections before one."""
        for name, items in sections().items():
            if name == title:
                return self
            for item in items:
                if isinstance(item, File):
                    self.put(item)
        raise KeyError(title)

    def run(self, command, copied=True):
        """Run a command of the page; with the lyapcheck that is tested here, if not with the copy of it."""
        program, *words = shlex.split(command, comments=True)
        assert program == "lyapcheck"
        return self.python("from lyapcheck.cli.main import main; main()", *words, copied=copied)

    def python(self, code, *words, copied=True):
        """Run some lines of Python likewise."""
        root = self.copy if copied else Path(lyapcheck.__file__).parents[1]
        variables = {
            "PYTHONPATH": str(root),
            "LYAPCHECK_PATH": str(self.mine),
            "COLUMNS": "80",
            "NO_COLOR": "1",
        }
        return subprocess.run(
            [sys.executable, "-c", code, *words],
            cwd=self.folder,
            env=os.environ | variables,
            capture_output=True,
            text=True,
            check=False,
        )
