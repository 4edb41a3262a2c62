"""What SymPy derives beside what the checker proves of it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

from flint import arb

from lyapcheck.answers.derive.parts import SHOWN
from lyapcheck.answers.derive.statements import equal_values, of_family, rate_of_value, tree
from lyapcheck.check.expressions.expression import ball
from lyapcheck.check.kinds.norm_bound import NormBound
from lyapcheck.check.numbers.balls import precision
from lyapcheck.check.numbers.constants import hyperbolic_constants
from lyapcheck.check.numbers.enclosure import Enclosure, ball_of
from lyapcheck.check.refusal import Refused
from lyapcheck.check.statement import Statement
from lyapcheck.check.verify import verify
from lyapcheck.claims.moving_arm import rate_of_mass
from lyapcheck.claims.procedures import propose
from lyapcheck.claims.statements import Missing
from lyapcheck.derive.arm import WrittenArm
from lyapcheck.derive.family import Member, positive_roots
from lyapcheck.derive.lyapunov import derivation
from lyapcheck.output.digits import correct_digits, decimals
from lyapcheck.robots import RobotModel

DIGITS, BITS = 30, 160


@dataclass(frozen=True)
class Agreement:
    """One thing that SymPy derived and the checker judged.

    Args:
        what: it is.
        derived: what SymPy found, in words.
        holds: whether that is what the paper prints, or what the certified number allows.
        claim: the id of the claim that it belongs to; empty where there is none.
        statement: what the checker judged now.
        verdict: its verdict; ``undecided`` where it has no proof.
        grade: of that verdict.
        certified: the number that the checker encloses, as far as its digits are certain; empty where none.
    """

    what: str
    derived: str
    holds: bool
    claim: str
    statement: str
    verdict: str
    grade: str
    certified: str = ""

    @property
    def agree(self) -> bool:
        """Whether both say yes."""
        return self.holds and self.verdict == "proved"


def of_member(member: Member) -> list[Agreement]:
    """h, h', γ and ρ of one m."""
    stated, m = of_family(member), member.m
    return [
        agreement(f"h_{m} = U_{m}′ is (6)", "normal form", True, "14", stated["14"]),
        agreement(f"h_{m}′ is (8)", "normal form", True, "8", stated["8"]),
        largest(member, "gamma", "h", member.h, member.gamma_polynomial),
        largest(member, "rho", "dh", member.dh, member.rho_polynomial),
    ]


def of_loop(n: int) -> list[Agreement]:
    """V and dV/dt: SymPy for n joints, the checker for all n."""
    found, words = derivation(n), f"one polynomial, n = {n}"
    return [
        agreement("V: (12) is (13)", words, found.value_is_one(), "12", equal_values()),
        agreement("dV/dt: the terms of (15) add up", words, found.sum_is_rate(), "15", rate_of_value()),
    ]


def of_arm(model: RobotModel, arm: WrittenArm) -> list[Agreement]:
    """dV/dt on one arm, whose Ṁ the chain rule gives; the checker has Ṁ = C + Cᵀ."""
    found = arm.derivation()
    words = f"one polynomial, sin² + cos² = 1, n = {arm.n}"
    return [agreement(f"dV/dt on {model.name}", words, found.sum_is_rate(), "2.4", rate_of_mass(model))]


def agreement(what: str, derived: str, holds: bool, claim: str, statement: Statement | Missing) -> Agreement:
    """The row of a statement, judged here and now."""
    proof = propose(statement).proof
    if isinstance(statement, Missing) or proof is None:
        said = statement.reason if isinstance(statement, Missing) else statement.text()
        return Agreement(what, derived, holds, claim, said, "undecided", "numeric")
    try:
        accepted = verify(statement, proof)
    except Refused:
        return Agreement(what, derived, holds, claim, statement.text(), "undecided", "numeric")
    return Agreement(what, derived, holds, claim, statement.text(), accepted.verdict, accepted.grade)


def largest(member: Member, name: str, function: str, form: Any, polynomial: Any) -> Agreement:
    """γ or ρ: the largest |form| at 0, in the limit and at the derived roots, beside the certified number."""
    known: Enclosure = getattr(hyperbolic_constants(member.m, DIGITS), name)
    letter = {"gamma": "γ", "rho": "ρ"}[name]
    roots = positive_roots(polynomial)
    with precision(BITS):
        values = [abs(ball(tree(form), {"x": place})) for place in (arb(0), *map(_place, roots))]
        reached = arb(member.limit_squared).sqrt() if function == "h" else arb(0)
        for value in values:
            reached = reached.max(value)
        inside = reached.overlaps(known.to_arb()) and reached.rad() < arb(10) ** -SHOWN
    words = f"{len(roots)} positive root{'s' * (len(roots) != 1)}, {letter} = {_digits(reached)}"
    _, upper = decimals(known, DIGITS)
    stated = NormBound((function, member.m, ("var", "x")), 1, ("num", str(Fraction(upper))))
    row = agreement(f"{letter}_{member.m}", words, bool(inside), "", stated)
    return replace(row, certified=f"{letter} = {correct_digits(known, SHOWN)}")


def _place(ends: tuple[Fraction, Fraction]) -> arb:
    """asinh √u for the u between two ends."""
    return ball_of(ends[0]).union(ball_of(ends[1])).sqrt().asinh()


def _digits(value: arb) -> str:
    return correct_digits(Enclosure.from_arb(value), SHOWN)
