"""What SymPy derives beside what the checker proves of it."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from fractions import Fraction
from functools import reduce
from operator import add, mul
from typing import Any, cast

import sympy as sp
from flint import arb
from sympy.printing.latex import latex
from sympy.printing.pretty.pretty import PrettyPrinter
from sympy.printing.pretty.stringpict import prettyForm
from sympy.printing.str import sstr

from lyapcheck.check.expressions.expression import Tree, ball
from lyapcheck.check.kinds.norm_bound import NormBound
from lyapcheck.check.numbers.balls import hyperbolic_constants, precision
from lyapcheck.check.numbers.polynomials import Enclosure, ball_of
from lyapcheck.check.statement import Statement
from lyapcheck.claims import loops
from lyapcheck.claims.bounds import rate_of_mass
from lyapcheck.claims.expressions import Expr, diff, expr, var
from lyapcheck.claims.letters import diagonal, every_n
from lyapcheck.claims.procedures import propose
from lyapcheck.claims.statements import Missing, identity
from lyapcheck.control.judgement import judged_statement
from lyapcheck.derive import (
    DEGREES,
    EPS,
    EPS0,
    Letters,
    R,
    WrittenArm,
    derivation,
    matrices,
    terms_15,
    value_12,
    value_13,
)
from lyapcheck.derive.family import Member, positive_roots
from lyapcheck.output.digits import correct_digits, decimals
from lyapcheck.output.document import Block, Equation, Paragraph
from lyapcheck.promise import Promise, promised, told
from lyapcheck.robots import RobotModel

# --- What SymPy has derived, written as statements that the checker can judge.

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


def number(expression: Any) -> Expr:
    """A (1, 1) matrix of SymPy in the letters of every n."""
    if isinstance(expression, sp.MatAdd):
        return reduce(add, map(number, expression.args))
    scalar, parts = _factors(expression)
    result = _written(scalar)
    while parts:
        if parts[0].shape == (1, 1):
            result *= number(parts.pop(0))
            continue
        last = next(k for k, part in enumerate(parts) if part.shape[1] == 1)
        row, column = _written(parts[0].T.doit()), _written(sp.MatMul(*parts[1 : last + 1]).doit())
        result, parts = result * (row @ column), parts[last + 1 :]
    return cast("Expr", result)


def _factors(expression: Any) -> tuple[Any, list[Any]]:
    """The number in front, and the matrices of a product."""
    if not isinstance(expression, sp.MatMul):
        return sp.Integer(1), [expression]
    matrices = [part for part in expression.args if part.is_Matrix]
    return sp.Mul(*(part for part in expression.args if not part.is_Matrix)), matrices


def _written(expression: Any) -> Any:
    """A number, a vector or a matrix in the letters of every n."""
    if expression.is_Rational:
        return expr(str(expression))
    if isinstance(expression, sp.Symbol | sp.MatrixSymbol):
        return LETTERS[expression.name]
    if isinstance(expression, sp.Transpose):
        return _written(expression.arg).T
    if isinstance(expression, sp.MatMul):
        scalar, parts = _factors(expression)
        product = reduce(lambda right, left: left @ right, map(_written, reversed(parts)))
        return product if scalar == 1 else product.times(_written(scalar))
    if expression.is_Pow:
        return _written(expression.base) ** int(expression.exp)
    return reduce(mul if expression.is_Mul else add, map(_written, expression.args))


def _letters(x: Letters) -> dict[str, Any]:
    """The letters of SymPy by name as those of the checker."""
    same = {getattr(x, name): getattr(LOOP, name) for name in ("w", "e", "h", "hw", "U", "kp", "M", "C")}
    diagonals = {x.slope: LOOP.dh, x.Kp: LOOP.kp, x.Kv: LOOP.kv, x.B: LOOP.b}
    numbers = {EPS: LOOP.eps, R: LOOP.r}
    named = same | {letter: diagonal(one) for letter, one in diagonals.items()} | numbers
    return {letter.name: value for letter, value in named.items()}


LETTERS = _letters(matrices())


# --- Formulas that SymPy has derived, as text of several lines and in LaTeX.


COLUMNS = 74
"""Of a formula in a terminal, beside its indent."""


@dataclass(frozen=True)
class Formula:
    """One formula ``name = value``.

    Args:
        id: its number in the paper, or a word.
        says: what it is.
        name: the left side in letters.
        head: the left side in LaTeX.
        value: the right side, a SymPy expression.
    """

    id: str
    says: str
    name: str
    head: str
    value: Any

    def blocks(self) -> tuple[Block, ...]:
        """What it is, and the formula."""
        shown = PrettyPrinter({"use_unicode": True})._print(self.value)
        whole = prettyForm(*prettyForm(f"{self.name} = ").right(shown))
        text = whole.render(num_columns=COLUMNS, wrap_line=True, use_unicode=True)
        lines = "\n".join(line.rstrip() for line in text.splitlines())
        equation = Equation(lines, f"{self.head} = {latex(self.value)}")
        return (Paragraph(self.says), equation) if self.says else (equation,)

    def data(self) -> dict[str, Any]:
        """The formula as SymPy reads it, and in LaTeX."""
        return {"id": self.id, "name": self.name, "sympy": sstr(self.value), "latex": latex(self.value)}


# --- The formulas of a derivation under their headings.


SHOWN = 10
Part = tuple[str, tuple[Formula, ...]]


def family(member: Member) -> Part:
    """U, h, h' and the polynomials of γ and ρ."""
    m = member.m
    known = hyperbolic_constants(m)
    gamma, rho = (
        f"{correct_digits(one, SHOWN)} (enclosed by the checker)" for one in (known.gamma, known.rho)
    )
    rising = f"0 at the place of γ = {gamma}, u = sinh²x:"
    steepest = f"0 where h′ is least or largest, ρ = {rho}:"
    if m == 1:
        rising = f"No zero at u = sinh²x > 0: h rises to its limit γ = {gamma}."
        steepest = f"No zero at u > 0: h′ falls from h′(0) = ρ = {rho}."
    rows = (
        Formula("U", "All comes from the potential:", f"U_{m}(x)", f"U_{{{m}}}(x)", member.potential),
        Formula("6", "h = U′:", f"h_{m}(x)", f"h_{{{m}}}(x)", member.h),
        Formula("8", "Its derivative:", f"h_{m}′(x)", f"h_{{{m}}}'(x)", member.dh),
        Formula("gamma", rising, "g(u)", "g(u)", member.gamma_polynomial.as_expr()),
        Formula("rho", steepest, "p(u)", "p(u)", member.rho_polynomial.as_expr()),
    )
    return f"The family, m = {m}", rows


def value() -> Part:
    """V of (12) and (13)."""
    x = matrices()
    rows = (
        Formula("eps", "With r = ‖q̃‖ and", "ε", r"\epsilon", EPS0 * x.near),
        Formula("12", "As (12) prints it:", "V", "V", value_12(x)),
        Formula("13", "As (13) writes it:", "V", "V", value_13(x)),
    )
    return "The Lyapunov function, n joints", rows


def rate() -> Part:
    """The eleven terms of (15)."""
    said = {
        1: "dV/dt = t₁ + … + t₁₁ = −a₀ + a₁ε₀ + a₂ε₀²; −a₀ is the sum of",
        3: "a₁ε₀ is the sum of",
        9: "a₂ε₀² is the sum of",
    }
    terms = enumerate(terms_15(matrices()), start=1)
    rows = tuple(Formula(f"15.{k}", said.get(k, ""), f"t{_low(k)}", f"t_{{{k}}}", term) for k, term in terms)
    assert [DEGREES[k - 1] for k in said] == [0, 1, 2]
    return "dV/dt along (11), term by term of (15)", rows


def arm(model: RobotModel, written: WrittenArm) -> Part:
    """M, C and g of an arm, entry by entry; what is 0 is left out."""
    rows: list[Formula] = []
    for name, matrix, says in (
        ("M", written.M, "kg·m²; symmetric, other entries are 0:"),
        ("C", written.C, "C(q, w) of the Christoffel symbols, kg·m²/s; other entries are 0:"),
        ("g", written.g, "N·m; other entries are 0:"),
    ):
        places = [
            (i, j)
            for i in range(matrix.rows)
            for j in range(matrix.cols)
            if matrix[i, j] != 0 and not (name == "M" and j < i)
        ]
        for count, (i, j) in enumerate(places):
            place = (i + 1,) if matrix.cols == 1 else (i + 1, j + 1)
            low = "".join(map(str, place))
            head = f"{name}_{{{low}}}"
            entry: Any = sp.expand(written.at_angles(matrix)[i, j])
            rows.append(Formula(f"{name}{low}", "" if count else says, f"{name}{_low(*place)}", head, entry))
    return f"The arm {model.name}", tuple(rows)


def _low(*numbers: int) -> str:
    return "".join(str(k) for k in numbers).translate(str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉"))


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
        promise: what lets its words be said; ``None`` where the statement is not proved.
    """

    what: str
    derived: str
    holds: bool
    claim: str
    statement: str
    verdict: str
    grade: str
    certified: str = ""
    promise: Promise | None = None

    def data(self) -> dict[str, Any]:
        """The row as plain data; the checker's words as its promise has them."""
        own = {one.name: getattr(self, one.name) for one in fields(self) if one.name != "promise"}
        said = {name: told(self.promise, own[name]) for name in ("statement", "verdict")}
        return {**own, **said, "agree": self.agree}

    @property
    def agree(self) -> bool:
        """Whether both say yes."""
        return self.holds and self.verdict == "proved"


def of_member(member: Member) -> list[Agreement]:
    """h, h', γ and ρ of one m: U' is the h that was derived, and h' of the checker's h the derived one."""
    m, h, dh = member.m, Expr(tree(member.h)), Expr(tree(member.dh))
    slope = identity(diff(Expr(("potential", m, X.tree)), "x"), h)
    rate = identity(diff(Expr(("h", m, X.tree)), "x"), dh)
    return [
        agreement(f"h_{m} = U_{m}′ is (6)", "same normal form", True, "14", slope),
        agreement(f"h_{m}′ is (8)", "same normal form", True, "8", rate),
        largest(member, "gamma", "h", member.h, member.gamma_polynomial),
        largest(member, "rho", "dh", member.dh, member.rho_polynomial),
    ]


def of_loop(n: int) -> list[Agreement]:
    """V and dV/dt: SymPy for n joints, the checker for all n.

    (12) equals (13), with Σ k_pi U_i in place of uᵀK_p u/(2m). V of (13) has the sum of the terms of (15) as
    its derivative along (11).
    """
    x, found, words = matrices(), derivation(n), f"same polynomial, n = {n}"
    squares = {x.share * x.root.T * x.Kp * x.root: x.kp.T * x.U}
    first, second = number(value_12(x).subs(squares)), number(value_13(x))
    equal = every_n(first, second, (LOOP.M,), positive=(LOOP.r,))
    rate = loops.along(LOOP, second, reduce(add, map(number, terms_15(x))))
    return [
        agreement("V: (12) is (13)", words, found.value_is_one(), "12", equal),
        agreement("dV/dt: the terms of (15) add up", words, found.sum_is_rate(), "15", rate),
    ]


def of_arm(model: RobotModel, arm: WrittenArm) -> list[Agreement]:
    """dV/dt on one arm, whose Ṁ the chain rule gives; the checker has Ṁ = C + Cᵀ."""
    found = arm.derivation()
    words = f"same polynomial, sin² + cos² = 1, n = {arm.n}"
    return [agreement(f"dV/dt on {model.name}", words, found.sum_is_rate(), "2.4", rate_of_mass(model))]


def agreement(what: str, derived: str, holds: bool, claim: str, statement: Statement | Missing) -> Agreement:
    """The row of a statement, judged here and now."""
    proof = propose(statement).proof
    if isinstance(statement, Missing):
        return Agreement(what, derived, holds, claim, statement.reason, "undecided", "numeric")
    judged = judged_statement(statement, [] if proof is None else [proof])
    promise, _ = promised(statement, judged)
    grade = judged.grade or "numeric"
    return Agreement(what, derived, holds, claim, statement.text(), judged.shown, grade, promise=promise)


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
    digits = correct_digits(Enclosure.from_arb(reached), SHOWN)
    words = f"{len(roots)} positive root{'s' * (len(roots) != 1)}, {letter} = {digits}"
    _, upper = decimals(known, DIGITS)
    stated = NormBound((function, member.m, ("var", "x")), 1, ("num", str(Fraction(upper))))
    row = agreement(f"{letter}_{member.m}", words, bool(inside), "", stated)
    return replace(row, certified=f"{letter} = {correct_digits(known, SHOWN)}")


def _place(ends: tuple[Fraction, Fraction]) -> arb:
    """asinh √u for the u between two ends."""
    return ball_of(ends[0]).union(ball_of(ends[1])).sqrt().asinh()
