"""Where an arm may come to rest beside its goal: proved by h at the bounds, refuted by one state of rest.

At rest (11) is K_p h(e) + d = 0, so |h(e_i)| = |d_i|/k_pi. Each h rises from 0 to its peak, or for ever, and
is at least 1 beyond its peak: for d̄_i < k_pi all solutions lie where h rises.

References: ``reyes2019family`` (7), (11).
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from lyapcheck.check.expressions.text import angles_text, diagonal_text, list_text
from lyapcheck.check.judgement import LARGEST, TORQUE
from lyapcheck.check.kinds.inertia import require_one_a_joint
from lyapcheck.check.numbers.balls import precision, to_arb
from lyapcheck.check.numbers.members import Member, member, member_text
from lyapcheck.check.refusal import require
from lyapcheck.check.statement import Proof, Total
from lyapcheck.check.verify import Accepted, rule

BITS = 64


@dataclass(frozen=True)
class Resting(Total):
    """At every e with K_p h(e) + d = 0 and |d_i| ≤ ``torque``, |e_i| ≤ ``errors``; ``None`` bounds nothing.

    ``family`` and ``m`` name h; ``kp`` and ``torque`` are in N·m, ``errors`` in rad.
    """

    family: str
    m: int | None
    kp: tuple[Fraction, ...]
    torque: tuple[Fraction, ...]
    errors: tuple[Fraction | None, ...]

    def require_well_formed(self) -> None:
        n = len(self.kp)
        require_one_a_joint(self, n, "torque", "errors")
        require(min(self.kp) > 0, "kp", min(self.kp), "must be positive")
        for value in (*self.torque, *self.errors):
            require(value is None or 0 <= value <= LARGEST, "size", value, f"must be from 0 to {LARGEST}")

    @property
    def granted(self) -> tuple[str, ...]:
        return (
            TORQUE,
            "at rest no torque acts beside (6), g(q) and d; dry friction that holds the robot is part of d",
        )

    def text(self) -> str:
        return (
            "at every state of rest of (11) with a torque d on its right, K_p h(e) + d = 0, "
            f"|d_i| ≤ {list_text(self.torque)} N·m: |e_i| ≤ {angles_text(self.errors)}; "
            f"for h = {member_text(self.family, self.m)} and K_p = {diagonal_text(self.kp)}"
        )


@dataclass(frozen=True)
class AtBounds(Proof):
    """The checker takes h at each bound."""

    rule = "h at the bounds"


@dataclass(frozen=True)
class RestWitness(Proof):
    """A joint, from 0, and an error in rad beyond its bound at which a torque within its own holds it."""

    rule = "state of rest"
    joint: int
    error: Fraction


@rule(Resting, AtBounds)
def by_rising(statement: Resting, proof: AtBounds) -> Accepted:
    """Soundness: see :func:`rests_within`."""
    known = member(statement.family, statement.m)
    for k, torque, error in zip(statement.kp, statement.torque, statement.errors, strict=True):
        if error is not None:
            within = rests_within(known, torque / k, error)
            require(
                within, "error", error, f"is not shown to be as large as {torque} N·m beside {k} N·m allow"
            )
    return Accepted("proved", "enclosure")


@rule(Resting, RestWitness)
def by_rest(statement: Resting, proof: RestWitness) -> Accepted:
    """Soundness: the other joints rest at their goal, and d_i = −k_pi h(e_i) is within its bound."""
    known = 0 <= proof.joint < len(statement.kp)
    require(known, "joint", proof.joint, f"must be from 0 to {len(statement.kp) - 1}")
    bound = statement.errors[proof.joint]
    beyond = bound is not None and proof.error > bound
    require(beyond, "error", proof.error, "must be beyond the bound")
    ratio = statement.torque[proof.joint] / statement.kp[proof.joint]
    with precision(BITS):
        held = abs(member(statement.family, statement.m).h(to_arb(proof.error))) <= to_arb(ratio)
    require(bool(held), "error", proof.error, "is not shown to be held by a torque within its bound")
    return Accepted("refuted", "enclosure")


def rests_within(member: Member, ratio: Fraction, error: Fraction) -> bool:
    """Whether |h(x)| ≤ ratio is shown to imply |x| ≤ error, for a ratio d̄/k_p ≥ 0.

    Soundness: h(error) ≥ ratio > 0, and beyond it h rises further or is at least 1 > ratio. For ratio = 0 it
        is h(x) > 0 for x > 0 that matters.
    """
    if ratio >= 1 or error < 0:
        return False
    with precision(BITS):
        return ratio == 0 or bool(member.h(to_arb(error)) >= to_arb(ratio))
