"""What the gate decided, as certificates that ``lyapcheck recheck`` judges again: one for each check.

A check that is proved uses those of the bounds k_gi that enter it, |g_i(q)| ≤ k_gi for all q, where these are
of an arm and not of the gain file.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import lru_cache
from typing import TYPE_CHECKING

from lyapcheck.answers.gate.friction import held, resting
from lyapcheck.answers.gate.words import RULES, joint_name
from lyapcheck.certificate import Certificate
from lyapcheck.check.certificate import About
from lyapcheck.check.kinds.gravity import GravityBelow
from lyapcheck.check.kinds.inertia import Bisection, HarmonicSizes
from lyapcheck.control.judgement import judged_statement
from lyapcheck.errors import argument_error
from lyapcheck.files.decimals import decimal_text
from lyapcheck.files.names import file_stem
from lyapcheck.robots import load
from lyapcheck.robots.dynamics import FEW_JOINTS
from lyapcheck.robots.trig import to_terms

if TYPE_CHECKING:
    from collections.abc import Sequence
    from fractions import Fraction

    from lyapcheck.answers.gate.judge import GateResult
    from lyapcheck.control.conditions import Check

PROOF = "gate"
HELD = "k_p ≤ f/γ: dry friction f holds the joint wherever it stops"
REST = "how far from the goal dry friction may leave the joints"


@dataclass
class GateCertificates:
    """Certificates by file name, and what of the arm none of them shows, in sentences."""

    certificates: dict[str, Certificate] = field(default_factory=dict)
    granted: list[str] = field(default_factory=list)


def certificates(results: Sequence[GateResult]) -> GateCertificates:
    """The certificates of all checks; one that is undecided has none.

    Raises:
        InputError: gain sets of two files have the same name, and so would their certificates.
    """
    made = GateCertificates()
    for result in results:
        limits = result.limits
        gravity = _gravity_of(result)
        if _of_the_arm(result):
            missing = (f"|g_{i + 1}| ≤ {decimal_text(limits.gravity[i])} N·m" for i in _missing(gravity))
            made.granted += (f"{limits.robot}: no certificate shows {one} for all q" for one in missing)
        for check in (*result.checks, *(() if result.otherwise is None else (result.otherwise,))):
            entering = gravity if check.id == "10" else gravity[check.joint or 0 :][:1]
            used = [one for one in entering if one is not None and check.id in ("10", "10p", "10i")]
            outcome = _certificate(result, check, used)
            if outcome is None:
                continue
            for one in used if outcome.uses else []:
                made.certificates[_file(one)] = one
            if _file(outcome) in made.certificates:
                raise argument_error(
                    "--certificates", result.name, "names gain sets of two files", "judge one file at a time"
                )
            made.certificates[_file(outcome)] = outcome
        made.certificates |= {_file(one): one for one in _of_friction(result)}
    made.granted = list(dict.fromkeys(made.granted))
    return made


def gravity_bounds_of(result: GateResult) -> tuple[Certificate, ...]:
    """The certificates of |g_i| ≤ k_gi for the joints of an arm of which there is one."""
    return tuple(one for one in _gravity_of(result) if one is not None)


def _of_the_arm(result: GateResult) -> bool:
    """Whether the bounds of gravity are those of an arm, and not of the gain file."""
    return bool(result.limits.robot) and result.file.bounds.gravity is None


def _gravity_of(result: GateResult) -> tuple[Certificate | None, ...]:
    limits = result.limits
    return _gravity(limits.robot, limits.gravity) if _of_the_arm(result) else (None,) * limits.n


def _certificate(result: GateResult, check: Check, used: Sequence[Certificate]) -> Certificate | None:
    outcome = check.judgement
    if outcome is None or outcome.proof is None:
        return None
    parts = [result.name, check.id, *([] if check.joint is None else [joint_name(result, check)])]
    says = f"{result.name}, {joint_name(result, check)}: {RULES[check.id]}"
    about = About(".".join(parts), says, result.m, result.limits.n, PROOF)
    uses = {one.claim.id: one.digest for one in used} if outcome.shown == "proved" else {}
    return Certificate(about, outcome.statement, outcome.shown, outcome.grade, outcome.proof, uses)


def _of_friction(result: GateResult) -> Iterator[Certificate]:
    """What is said of dry friction beside the checks."""
    model, gains = result.limits.model, result.gains
    if model is None or not result.explained:
        return
    rows = [(f"held.{model.joints[i]}", HELD, one) for i, one in held(gains, model).items()]
    rest = resting(gains, model)
    for name, says, one in [*rows, *([] if rest is None else [("rest", REST, rest)])]:
        if one.proof is not None:
            about = About(f"{gains.name}.{name}", f"{gains.name}: {says}", gains.m, model.n, PROOF)
            yield Certificate(about, one.statement, one.shown, one.grade, one.proof)


@lru_cache(maxsize=16)
def _gravity(robot: str, bounds: tuple[Fraction, ...]) -> tuple[Certificate | None, ...]:
    """A certificate of |g_i| ≤ k_gi for each joint; ``None`` where the checker is not shown it."""
    model = load(robot)
    ranges = tuple(number.bounds for number in model.parameters.values())
    result: list[Certificate | None] = []
    for i, (torque, bound) in enumerate(zip(model.gravity, bounds, strict=True)):
        statement = GravityBelow(model.n, (tuple(to_terms(torque)),), ranges, bound)
        proofs = (HarmonicSizes(), *([Bisection()] if model.n <= FEW_JOINTS else []))
        its = judged_statement(statement, proofs)
        if its.proof is None or its.shown != "proved":
            result.append(None)
            continue
        says = f"{model.name}: |g_{i + 1}(q)| ≤ k_g{i + 1} = {decimal_text(bound)} N·m"
        about = About(f"{model.name}.k_g{i + 1}", says, None, model.n, PROOF)
        result.append(Certificate(about, statement, its.shown, its.grade, its.proof))
    return tuple(result)


def _missing(gravity: Sequence[Certificate | None]) -> Iterator[int]:
    return (i for i, one in enumerate(gravity) if one is None)


def _file(certificate: Certificate) -> str:
    return f"{file_stem(certificate.claim.id)}.json"
