"""Accepted certificates before Coq's kernel, and what becomes of each."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

from lyapcheck.check.certificate import Certificate, certificate_of
from lyapcheck.check.recheck import Checked, Outcome, content
from lyapcheck.check.refusal import plain, require
from lyapcheck.kernel.coq import (
    GRADE,
    LIBRARY,
    Coq,
    CoqRefused,
    CoqUndecided,
    Kernel,
    axioms_of,
    golden,
    seconds_in,
)
from lyapcheck.kernel.scripts import script
from lyapcheck.kernel.statements import shown
from lyapcheck.kernel.terms import NotPrinted

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
        within = _within(modules, coq, name)
        for k in modules:
            said = f"its axioms go beyond the golden list {name}"
            if k not in within:
                result[k] = (
                    replace(result[k], axioms="float")
                    if name == "real"
                    else Kernel(result[k].file, False, said)
                )
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
    return Kernel(one.file, True, theorem=theorem, axioms=axioms, seconds=seconds_in(printed))


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
