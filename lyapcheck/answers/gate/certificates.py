"""What the gate decided, as certificates that ``lyapcheck recheck`` judges again: one for each check."""

from __future__ import annotations

from importlib.metadata import version
from typing import TYPE_CHECKING
from urllib.parse import quote

from lyapcheck.answers.gate.words import RULES, joint_name
from lyapcheck.check.certificate import About, Certificate
from lyapcheck.errors import argument_error

if TYPE_CHECKING:
    from collections.abc import Sequence

    from lyapcheck.answers.gate.judge import GateResult
    from lyapcheck.control.conditions import Check

PROOF = "gate"


def certificates(results: Sequence[GateResult]) -> dict[str, Certificate]:
    """Certificates by file name; a check that is undecided has none.

    Raises:
        InputError: gain sets of two files have the same name, and so would their certificates.
    """
    used = {name: version(name) for name in ("lyapcheck", "python-flint")}
    found: dict[str, Certificate] = {}
    for result in results:
        for check in result.checks:
            made = _certificate(result, check, used)
            if made is None:
                continue
            name = f"{quote(made.claim.id, safe='')}.json"
            if name in found:
                raise argument_error(
                    "--certificates", result.name, "names gain sets of two files", "judge one file at a time"
                )
            found[name] = made
    return found


def _certificate(result: GateResult, check: Check, versions: dict[str, str]) -> Certificate | None:
    found = check.judgement
    if found is None or found.proof is None:
        return None
    parts = [result.name, check.id, *([] if check.joint is None else [joint_name(result, check)])]
    says = f"{result.name}, {joint_name(result, check)}: {RULES[check.id]}"
    about = About(".".join(parts), says, result.m, result.limits.n, PROOF)
    return Certificate(about, found.statement, found.shown, found.grade, found.proof, {}, versions)
