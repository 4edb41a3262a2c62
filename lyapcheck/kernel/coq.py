"""Running Coq: its library of definitions and theorems, and files that use it."""

from __future__ import annotations

import hashlib
import json
import re
import shutil
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from lyapcheck.check.statement import Proof, Statement
from lyapcheck.computing import Spent, run_within
from lyapcheck.errors import argument_error
from lyapcheck.extensions import shipped
from lyapcheck.files.reader import holds
from lyapcheck.kernel.statements import shown
from lyapcheck.kernel.terms import NotPrinted

PACKAGES = "coq libcoq-interval"
QUIET = "-ambiguous-paths,-notation-overridden"
LIBRARY = "Lyapcheck"
NAME = re.compile(r"[A-Za-z_][\w'.]*")
TIMES = re.compile(r"^Chars .* secs \(([\d.]+)u,([\d.]+)s\)$", re.MULTILINE)


@dataclass(frozen=True)
class Kernel:
    """Whether Coq's kernel accepted a certificate.

    ``reason`` is why not; ``theorem`` the statement that was printed, ``axioms`` the golden list within which
    its axioms are, ``seconds`` the computing time that Coq took.
    """

    file: str
    accepted: bool
    reason: str = ""
    theorem: str = ""
    axioms: str = ""
    seconds: float = 0.0


class CoqRefused(Exception):
    """What Coq says against a file."""


class CoqUndecided(Exception):
    """Coq has come to no end."""


class Coq:
    """Coq with the library ``formal/`` compiled in a folder of its own.

    Args:
        folder: where sources and compiled files go; the library there is made anew if its sources differ.
        seconds: of computing time that one file may take; the library takes what it takes.

    Raises:
        InputError: there is no ``coqc``, or no CoqInterval beside it.
    """

    def __init__(self, folder: Path, seconds: int) -> None:
        self.program, self.folder, self.seconds = require_coq(), folder, seconds
        self.library, self.printed = folder / "library", folder / "printed"
        self.printed.mkdir(parents=True, exist_ok=True)
        self._compile_library()

    def accept(self, name: str, text: str, *options: str, limited: bool = True) -> str:
        """Write a file and have it compiled, with options of ``coqc``; what Coq prints.

        ``limited``: whether it may take no longer than was said.

        Raises:
            CoqRefused: Coq does not accept it.
            CoqUndecided: Coq takes too long.
        """
        path = self.printed / f"{name}.v"
        path.write_text(text, encoding="utf-8")
        return self._compile(
            path, ("-Q", str(self.printed), "Printed", *options), self.seconds if limited else None
        )

    def _compile(self, path: Path, more: tuple[str, ...] = (), seconds: int | None = None) -> str:
        command = [self.program, "-q", "-w", QUIET, "-R", str(self.library), LIBRARY, *more, str(path)]
        try:
            done = run_within(command, seconds, self.folder)
        except Spent:
            raise CoqUndecided(f"coqc takes more than {seconds} s of computing time") from None
        if done.returncode != 0:
            raise CoqRefused(_first_error(done.stderr))
        return done.stdout

    def _compile_library(self) -> None:
        self.library.mkdir(parents=True, exist_ok=True)
        fresh = True
        for name in sources():
            text = (shipped("formal") / name).read_bytes()
            path = self.library / name
            same = holds(path, text) and path.with_suffix(".vo").exists()
            fresh = fresh and same  # what comes later rests on what comes before
            if fresh:
                continue
            path.write_bytes(text)
            try:
                self._compile(path)
            except CoqRefused as refusal:
                rule = f"cannot compile {name} of its library: {refusal}"
                raise argument_error(
                    "--kernel", "", rule, f"apt-get install --no-install-recommends {PACKAGES}"
                ) from None


def require_coq() -> str:
    """The path of ``coqc``.

    Raises:
        InputError: there is none.
    """
    program = shutil.which("coqc")
    if program is None:
        rule = "needs Coq and CoqInterval, and there is no coqc on the path"
        raise argument_error("--kernel", "", rule, f"apt-get install --no-install-recommends {PACKAGES}")
    return program


def sources() -> list[str]:
    """The files of the library, in an order in which they can be compiled."""
    lines = (shipped("formal") / "_CoqProject").read_text(encoding="utf-8").split()
    return [line for line in lines if line.endswith(".v")]


def axioms_of(printed: str) -> set[str]:
    """The names below ``Axioms:`` in what ``Print Assumptions`` prints; their types are indented.

    Raises:
        CoqRefused: there is a line that is not understood.
    """
    if printed.strip() == "Closed under the global context":
        return set()
    head, *lines = printed.splitlines()
    result = set()
    for line in lines:
        if line.startswith(" ") or not line:
            continue
        name = NAME.match(line)
        if name is None or line[name.end() :].strip()[:1] not in ("", ":"):
            raise CoqRefused(f"of its axioms: {line}")
        result.add(name.group())
    if head != "Axioms:":
        raise CoqRefused(f"of its axioms: {head}")
    return result


def seconds_in(printed: str) -> float:
    """The computing time of all sentences of a file that was compiled with ``-time``."""
    return sum(float(user) + float(system) for user, system in TIMES.findall(printed))


def golden(name: str) -> frozenset[str]:
    """The axioms of a golden list, ``real`` or ``float``; the second has those of the first as well."""
    own = frozenset((shipped("formal") / f"axioms.{name}").read_text(encoding="utf-8").split())
    return own if name == "real" else own | golden("real")


def _first_error(text: str) -> str:
    """Coq's first error in one line."""
    _, _, said = text.partition("Error:")
    return " ".join((said or text).split())[:300] or "it ends without a word"


# --- What Coq's kernel has accepted before, so that ``check`` and reports can say so without Coq.
#
# The record has digests: of the pages of definitions, and of each printed proposition. Whatever changes a
# claim, the way in which it is printed or what its words mean changes a digest, and the claim has no kernel
# verdict until Coq has accepted it anew. ``recheck --kernel`` never looks here.


GRADE = "kernel"
FILE = Path(__file__).with_name("accepted.json")


def accepted_before(statement: Statement, proof: Proof, verdict: str) -> bool:
    """Whether the record has the proposition that a certificate shows."""
    try:
        proposition = shown(statement, proof, verdict)
    except NotPrinted:
        return False
    return digest(proposition) in _record()


def written(results: Iterable[Kernel]) -> str:
    """The record as text: that of the same definitions so far, and what Coq's kernel has accepted now."""
    known = _record() | {digest(one.theorem): one.axioms for one in results if one.accepted}
    return json.dumps({"definitions": _definitions(), "accepted": known}, indent=1, sort_keys=True) + "\n"


def digest(proposition: str) -> str:
    """SHA-256 of a printed proposition."""
    return hashlib.sha256(proposition.encode()).hexdigest()


@cache
def _record() -> dict[str, str]:
    """The golden list of each accepted proposition by its digest; none if the definitions have changed."""
    data = json.loads(FILE.read_text(encoding="utf-8"))
    accepted: dict[str, str] = data["accepted"]
    return accepted if data["definitions"] == _definitions() else {}


def _definitions() -> str:
    pages = sorted(shipped("formal").glob("*Definitions.v"))
    return hashlib.sha256(b"".join(page.read_bytes() for page in pages)).hexdigest()
