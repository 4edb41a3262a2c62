"""Certificates before Coq's kernel: statements printed as theorems, proved there, their axioms read back.

Nothing here decides: what is accepted is what ``coqc`` accepts, and the statement of each theorem is printed
from the data of the certificate alone. The definitions that such a statement is made of stand on one page,
``formal/Definitions.v``; see ``docs/kernel.md``.
"""

from __future__ import annotations

import hashlib
import json
import re
import shutil
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

from lyapcheck.check.certificate import Certificate, certificate_of
from lyapcheck.check.recheck import Checked, Outcome, content
from lyapcheck.check.refusal import plain, require
from lyapcheck.check.statement import Proof, Statement
from lyapcheck.computing import Spent, run_within
from lyapcheck.errors import argument_error
from lyapcheck.extensions import shipped
from lyapcheck.files.reader import holds
from lyapcheck.kernel.statements import shown
from lyapcheck.kernel.terms import NotPrinted

INSTALL = "apt-get install --no-install-recommends coq libcoq-interval"
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
                raise argument_error("--kernel", "", rule, INSTALL) from None

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
            _, _, first = done.stderr.partition("Error:")
            raise CoqRefused(" ".join((first or done.stderr).split())[:300] or "it ends without a word")
        return done.stdout


def require_coq() -> str:
    """The path of ``coqc``.

    Raises:
        InputError: there is none.
    """
    program = shutil.which("coqc")
    if program is None:
        rule = "needs Coq and CoqInterval, and there is no coqc on the path"
        raise argument_error("--kernel", "", rule, INSTALL)
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


def golden(name: str) -> frozenset[str]:
    """The axioms of a golden list, ``real`` or ``float``; the second has those of the first as well."""
    own = frozenset((shipped("formal") / f"axioms.{name}").read_text(encoding="utf-8").split())
    return own if name == "real" else own | golden("real")


# --- Accepted certificates before the kernel, and what becomes of each.


JOBS = 2
COMPUTES = re.compile(r"\b(numbers|fails|interval|prove_\w+|signs|computed)\b")
HEAD = f"""From Coq Require Import Floats.
Require Import {LIBRARY}.Certificates.
Import {LIBRARY}.GateDefinitions.
Import {LIBRARY}.SampledDefinitions.
Import {LIBRARY}.Definitions.
Import ListNotations.
Open Scope R_scope.
"""
"""The pages of definitions come last: no other file's names stand before its own."""


def theorem_file(certificate: Certificate) -> str:
    """The file of a certificate: its statement, printed, and how Coq is to prove it.

    Raises:
        NotPrinted: its statement has no form in Coq, or no proof there.
    """
    from lyapcheck.kernel.scripts import script

    statement, proof, verdict = certificate.statement, certificate.proof, certificate.verdict
    proposition = shown(statement, proof, verdict)
    return f"{HEAD}Theorem claim : {proposition}.\nProof.\n{script(statement, proof, verdict)}\nQed.\n"


def judged(outcome: Outcome, folder: Path, seconds: int, progress: Callable[[str], None]) -> list[Kernel]:
    """What Coq's kernel says of each certificate that the small checker accepted.

    Args:
        outcome: of the small checker.
        folder: where the files for Coq are written.
        seconds: the most that one of them may take.

    Raises:
        InputError: there is no Coq.
    """
    progress("compiling the library")
    coq = Coq(folder, seconds)
    with ThreadPoolExecutor(JOBS) as pool:
        result = dict(enumerate(pool.map(lambda one: _compiled(one, coq, progress), outcome.checked)))
    progress("reading the axioms")
    for name in ("real", "float"):
        modules = {
            k: _module(outcome.checked[k]) for k, one in result.items() if one.accepted and one.axioms == name
        }
        for k in modules.keys() - _within(modules, coq, name):
            if name == "real":
                result[k] = replace(result[k], axioms="float")
            else:
                result[k] = Kernel(result[k].file, False, "its axioms go beyond the golden list float")
    return list(result.values())


def graded(outcome: Outcome, result: Iterable[Kernel]) -> Outcome:
    """The outcome, with the grade ``kernel`` where Coq's kernel accepted the certificate."""
    pairs = zip(outcome.checked, result, strict=True)
    return replace(
        outcome, checked=tuple(replace(own, grade=GRADE) if one.accepted else own for own, one in pairs)
    )


def _compiled(one: Checked, coq: Coq, progress: Callable[[str], None]) -> Kernel:
    if not one.accepted:
        return Kernel(one.file, False, f"the small checker says {one.status}")
    progress(one.file)
    try:
        certificate, data = certificate_of(content(one.document.path))
        require(data["digest"] == one.finding.digest, "digest", data["digest"], "changed while it was judged")
        text = theorem_file(certificate)
        printed = coq.accept(_module(one), text, "-time")
    except NotPrinted as lack:
        return Kernel(one.file, False, f"there is no theorem of Coq's for {lack}")
    except CoqRefused as refusal:
        return Kernel(one.file, False, plain(f"Coq refuses it: {refusal}"))
    except CoqUndecided as late:
        return Kernel(one.file, False, plain(f"Coq comes to no end: {late}; --seconds allows more"))
    except (OSError, ValueError) as error:
        return Kernel(one.file, False, plain(str(error)))
    theorem = text.split("Theorem claim : ", 1)[1].split(".\nProof.", 1)[0]
    # the shorter golden list, if no tactic of the proof computes with intervals; Coq has the last word
    axioms = "float" if COMPUTES.search(text) else "real"
    taken = sum(float(user) + float(system) for user, system in TIMES.findall(printed))
    return Kernel(one.file, True, theorem=theorem, axioms=axioms, seconds=taken)


def _module(one: Checked) -> str:
    return f"c_{one.finding.digest[:24]}"


def _within(modules: dict[int, str], coq: Coq, name: str) -> set[int]:
    """Those whose axioms are on a golden list: all at once, as reading is slow; one by one if that fails."""
    if not modules:
        return set()
    text = "".join(f"Require Printed.{module}.\n" for module in modules.values())
    claims = ", ".join(f"Printed.{module}.claim" for module in modules.values())
    try:
        asked = f"{text}Definition all := ({claims}).\nPrint Assumptions all.\n"
        printed = coq.accept(f"axioms_{name}", asked, limited=False)
        if axioms_of(printed) <= golden(name):
            return set(modules)
    except CoqRefused:
        pass
    if len(modules) == 1:
        return set()
    return {k for k, module in modules.items() if _within({k: module}, coq, name)}


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
