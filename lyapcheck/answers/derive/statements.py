"""What SymPy has derived, written as statements, beside what the checker proves of it."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import reduce
from operator import add, mul
from typing import Any, cast

import sympy as sp
from flint import arb

from lyapcheck.check.expressions.expression import Tree, ball
from lyapcheck.check.kinds.norm_bound import NormBound
from lyapcheck.check.numbers.balls import precision
from lyapcheck.check.numbers.constants import hyperbolic_constants
from lyapcheck.check.numbers.enclosure import Enclosure, ball_of
from lyapcheck.check.refusal import Refused
from lyapcheck.check.statement import Statement
from lyapcheck.check.verify import verify
from lyapcheck.claims import loops
from lyapcheck.claims.expressions import Expr, diff, expr, var
from lyapcheck.claims.letters import AnyMatrix, AnyVector, diagonal, every_n
from lyapcheck.claims.moving_arm import rate_of_mass
from lyapcheck.claims.procedures import propose
from lyapcheck.claims.statements import Missing, identity
from lyapcheck.derive.arm import WrittenArm
from lyapcheck.derive.family import Member, positive_roots
from lyapcheck.derive.lyapunov import EPS, Letters, R, derivation, matrices, terms_15, value_12, value_13
from lyapcheck.output.digits import correct_digits, decimals
from lyapcheck.robots import RobotModel

X = var("x")
LOOP = loops.letters()


def tree(expression: Any) -> Tree:
    """An expression in numbers, x, sinh, cosh and log as the checker writes it."""
    if expression.is_Rational:
        return "num", str(expression)
    if expression.is_Symbol:
        return "var", expression.name
    if expression.is_Pow:
        base, power = tree(expression.base), int(expression.exp)
        return ("pow", base, power) if power > 0 else ("div", ("num", "1"), ("pow", base, -power))
    parts = tuple(map(tree, expression.args))
    if expression.is_Add or expression.is_Mul:
        return ("add" if expression.is_Add else "mul", *parts)
    return expression.func.__name__, *parts


def of_family(member: Member) -> dict[str, Statement]:
    """By the id of the claim: U' is the h that was derived, and h' of the checker's h is the derived one."""
    h, dh = Expr(tree(member.h)), Expr(tree(member.dh))
    return {
        "14": identity(diff(Expr(("potential", member.m, X.tree)), "x"), h),
        "8": identity(diff(Expr(("h", member.m, X.tree)), "x"), dh),
    }


def equal_values() -> Statement:
    """(12), as SymPy has it, equals (13) for every n; Σ k_pi U_i in place of uᵀK_p u/(2m)."""
    x = matrices()
    squares = {x.share * x.root.T * x.Kp * x.root: x.kp.T * x.U}
    return every_n(number(value_12(x).subs(squares)), number(value_13(x)), (LOOP.M,), positive=(LOOP.r,))


def rate_of_value() -> Statement:
    """V of (13) has the sum of the derived terms as its derivative along (11), for every n."""
    x = matrices()
    return loops.along(LOOP, number(value_13(x)), reduce(add, map(number, terms_15(x))))


def number(expression: Any) -> Expr:
    """A (1, 1) matrix of SymPy in the letters of every n."""
    if isinstance(expression, sp.MatAdd):
        return reduce(add, map(number, expression.args))
    scalar, parts = _factors(expression)
    result = _scalar(scalar)
    while parts:
        if parts[0].shape == (1, 1):
            result *= number(parts.pop(0))
            continue
        last = next(k for k, part in enumerate(parts) if part.shape[1] == 1)
        row, column = _vector(parts[0].T.doit()), _vector(sp.MatMul(*parts[1 : last + 1]).doit())
        result, parts = result * (row @ column), parts[last + 1 :]
    return result


def _factors(expression: Any) -> tuple[Any, list[Any]]:
    """The number in front, and the matrices of a product."""
    if not isinstance(expression, sp.MatMul):
        return sp.Integer(1), [expression]
    matrices = [part for part in expression.args if part.is_Matrix]
    return sp.Mul(*(part for part in expression.args if not part.is_Matrix)), matrices


def _vector(expression: Any) -> AnyVector:
    if isinstance(expression, sp.MatrixSymbol):
        return cast("AnyVector", LETTERS[expression.name])
    if isinstance(expression, sp.MatAdd):
        return reduce(add, map(_vector, expression.args))
    scalar, parts = _factors(expression)
    result = _vector(parts[-1])
    for part in reversed(parts[:-1]):
        result = _matrix(part) @ result
    return result if scalar == 1 else result.times(_scalar(scalar))


def _matrix(expression: Any) -> AnyMatrix:
    if isinstance(expression, sp.MatAdd):
        return reduce(add, map(_matrix, expression.args))
    if isinstance(expression, sp.Transpose):
        return _matrix(expression.arg).T
    return cast("AnyMatrix", LETTERS[expression.name])


def _scalar(expression: Any) -> Expr:
    """Sums, products and powers of numbers."""
    if expression.is_Rational:
        return expr(str(expression))
    if expression.is_Symbol:
        return cast("Expr", LETTERS[expression.name])
    if expression.is_Pow:
        return _scalar(expression.base) ** int(expression.exp)
    return reduce(add if expression.is_Add else mul, map(_scalar, expression.args))


def _letters(x: Letters) -> dict[str, Any]:
    """The letters of SymPy by name as those of the checker."""
    s = LOOP
    named = {
        x.w: s.w,
        x.e: s.e,
        x.h: s.h,
        x.hw: s.hw,
        x.U: s.U,
        x.kp: s.kp,
        x.M: s.M,
        x.C: s.C,
        x.slope: diagonal(s.dh),
        x.Kp: diagonal(s.kp),
        x.Kv: diagonal(s.kv),
        x.B: diagonal(s.b),
        EPS: s.eps,
        R: s.r,
    }
    return {letter.name: value for letter, value in named.items()}


LETTERS = _letters(matrices())


DIGITS, BITS = 30, 160
SHOWN = 10


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
    """

    what: str
    derived: str
    holds: bool
    claim: str
    statement: str
    verdict: str
    grade: str

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
    return agreement(f"{letter}_{member.m}", words, bool(inside), "", stated)


def _place(ends: tuple[Fraction, Fraction]) -> arb:
    """asinh √u for the u between two ends."""
    return ball_of(ends[0]).union(ball_of(ends[1])).sqrt().asinh()


def _digits(value: arb) -> str:
    return correct_digits(Enclosure.from_arb(value), SHOWN)
