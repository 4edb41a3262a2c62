"""Statements that are false or undefined somewhere and were once proved, with the proof that did it."""

from dataclasses import dataclass
from fractions import Fraction

from lyapcheck.check.kinds.constant import (
    Constant,
    ExactNumbers,
    OutsideRounding,
    PrintedInputs,
    SeparateBalls,
)
from lyapcheck.check.kinds.for_all import Boxes, Pieces, Sturm
from lyapcheck.check.kinds.for_small import LeadingTerm
from lyapcheck.check.kinds.identity import NormalForm
from lyapcheck.check.kinds.implies import SignIdentity
from lyapcheck.check.kinds.norm_bound import Supremum
from lyapcheck.check.statement import Proof, Witness
from lyapcheck.claims import (
    ForSmall,
    Statement,
    agrees,
    always_positive,
    any_matrix,
    any_vector,
    bounded,
    cos,
    dh,
    every_n,
    exp,
    expr,
    for_all,
    identity,
    implies,
    log,
    nonnegative,
    norm_bound,
    positive,
    reals,
    sin,
    sinh,
    sqrt,
    var,
    zero_vector,
)


@dataclass(frozen=True)
class KnownFault:
    """A statement that must not get a verdict, and a proof to that effect that the checker must refuse."""

    name: str
    statement: Statement
    proof: Proof
    grade: str = "exact"
    verdict: str = "proved"


def near_zero(*cuts):
    """Taylor boxes from 0 on."""
    return Pieces((Boxes(tuple(map(Fraction, cuts)), True, False, 160),))


x, v, y, b, s, eps = map(var, ("x", "v", "y", "b", "s", "eps"))
a, M = any_vector("a"), any_matrix("M")
t = var("t")
LEADING = LeadingTerm(SignIdentity((), ()))


def small(claim, *bounded):
    """A claim for small eps."""
    return ForSmall("eps", (), (), claim, bounded)


hidden = sqrt(2) ** 2 - 2
deeper = sqrt(2) * sqrt(3) - sqrt(6)
nowhere = sqrt(-3)

FAULTS = (
    # 0/0 behind a square root
    KnownFault("0/0 is at most -1", Constant(hidden / hidden <= -1), ExactNumbers()),
    KnownFault("0/0 is at least 10^9", Constant(expr(10**9) <= hidden / hidden), ExactNumbers()),
    KnownFault("0/0 by a product of roots", Constant(deeper / deeper < 2), ExactNumbers()),
    # roots and powers of what is negative
    KnownFault("root of -3 times itself", Constant(nowhere * nowhere < 0), ExactNumbers()),
    KnownFault("root of -2 to the power 0", Constant(sqrt(-2) ** 0 < 2), SeparateBalls(128), "enclosure"),
    KnownFault("1/0 to the power 0", Constant((expr(1) / 0) ** 0 < 2), SeparateBalls(128), "enclosure"),
    KnownFault("log -3 less itself", Constant(log(-3) - log(-3) < 1), ExactNumbers()),
    KnownFault("root squared, an identity", identity(sqrt(v) ** 2, v), NormalForm()),
    KnownFault(
        "root squared, an implication", implies(reals("v"), (), sqrt(v) ** 2 <= v), SignIdentity((), ())
    ),
    KnownFault("x/x, an identity", identity(x / x, 1), NormalForm()),
    KnownFault("log x less itself", identity(log(x) - log(x), 0), NormalForm()),
    # one variable: what does not matter is not looked at
    KnownFault("0 log(x - 5)", for_all(1 + 0 * log(x - 5) > 0, 0, 1), near_zero(1), "enclosure"),
    KnownFault("0/x", for_all(1 + expr(0) / x > 0, 0, 1), near_zero(1), "enclosure"),
    KnownFault(
        "a removable pole",
        for_all((x - 5) / (x - 5) > 0, 1),
        Pieces((Boxes((Fraction(1), Fraction(2)), False, True, 160),)),
        "enclosure",
    ),
    KnownFault("root to the power 0", for_all(sqrt(x - 5) ** 0 > 0, 0, 1), near_zero(1), "enclosure"),
    KnownFault("root of -3 squared", for_all(x**2 + 4 + nowhere**2 > 0, 1), Pieces((Sturm(),))),
    KnownFault("the same on the line", for_all(x**2 + 4 + nowhere**2 >= 0), Pieces((Sturm(), Sturm()))),
    # implications
    KnownFault("1/(1/y) at 0", implies(nonnegative("y"), (), expr(0) <= 1 / (1 / y)), SignIdentity((), ())),
    KnownFault(
        "a hypothesis with 1/(1/y)",
        implies(nonnegative("y", "b"), (1 / (1 / y) <= b,), expr(0) <= b),
        SignIdentity((), ()),
    ),
    KnownFault(
        "root of -y less itself",
        implies(positive("y"), (), y <= y + sqrt(-y) - sqrt(-y)),
        SignIdentity((), ()),
    ),
    # vectors and matrices
    KnownFault(
        "a word twice",
        every_n((a + M @ a).dot(a + M @ a), a.dot(a) + a.dot(M @ a) + a.dot(M @ (M @ a)), symmetric=[M]),
        NormalForm(),
    ),
    KnownFault("aa/aa", every_n(a.dot(a) / a.dot(a), 1), NormalForm()),
    KnownFault("a number over itself", every_n(s * a.dot(a) / s, a.dot(a)), NormalForm()),
    KnownFault("log s times 0", every_n(zero_vector().dot(a.times(log(s))), 0), NormalForm()),
    # the other kinds
    KnownFault("a norm below 0/0", norm_bound(dh(1, x), 1, deeper / deeper), Supremum(ExactNumbers())),
    KnownFault("small eps beside 0 log 0", small(expr(0) < log(0) * 0 + eps), LEADING),
    KnownFault(
        "a printed number beside log(-1)",
        agrees(b * log(-1) ** 0, "1.0", b="1.0"),
        PrintedInputs(128),
        "enclosure",
    ),
    # functions of ε and t are not their own leading terms
    KnownFault("eps exp(1/eps)", small(eps * exp(1 / eps) < 1), LEADING),
    KnownFault("eps root of 1/eps^4", small(eps * sqrt(1 / eps**4) < 1), LEADING),
    KnownFault("eps |1/t|", small(eps * abs(1 / t) < 1, "t"), LEADING),
    # points of the domain at which a term is undefined, next to those where all is well
    KnownFault("sin x / x at 0", for_all(sin(x) / x <= 2, 0, 1), near_zero(1), "enclosure"),
    KnownFault("x/x at 0", for_all(x / x > 0, 0, 1), near_zero(1), "enclosure"),
    # refuted, at a point where a term is undefined
    KnownFault(
        "6 below a root to the power 0",
        Constant(sqrt(-2) ** 0 > 6),
        SeparateBalls(128),
        "enclosure",
        "refuted",
    ),
    KnownFault(
        "log to the power 0 at 0",
        for_all(log(x) ** 0 < x, 0, 0),
        Witness((("x", Fraction(0)),)),
        "enclosure",
        "refuted",
    ),
    KnownFault(
        "root to the power 0 of what is negative",
        implies(reals("v"), (sqrt(v) ** 0 <= 1,), expr(0) <= v),
        Witness((("v", Fraction(-1)),)),
        "enclosure",
        "refuted",
    ),
    KnownFault(
        "log to the power 0, an identity",
        identity(log(-1 - x**2) ** 0, 2),
        Witness((("x", Fraction(-1)),)),
        "enclosure",
        "refuted",
    ),
    KnownFault(
        "a norm below a root to the power 0",
        norm_bound(x, 1, sqrt(-2) ** 0),
        Witness((("x1", Fraction(2)),)),
        "enclosure",
        "refuted",
    ),
    KnownFault(
        "a printed number that is none",
        agrees(log(b) ** 0, "2.0", b="-1.0"),
        OutsideRounding(128),
        "enclosure",
        "refuted",
    ),
)
"""Each with the proof that was accepted; more are welcome, none goes."""

RAISING = {
    "the root of a negative number": Constant(sqrt(-1) <= 1),
    "0 times the root of a negative number": Constant(0 * sqrt(-1) <= -2),
    "a number over 0": implies(positive("y"), (), expr(1) / 0 <= y),
    "a number over 0, one variable": for_all(expr(1) / 0 < 1, 0),
    "over a hidden 0": Constant(expr(1) / hidden <= 1),
    "over a hidden 0, inside": Constant(abs(expr(1) / hidden) <= 1),
    "over another hidden 0": for_all(1 / (sin(x) ** 2 + cos(x) ** 2 - 1) <= 1, 1),
    "the root of a negative number, an implication": implies(positive("y"), (), sqrt(-1) <= y),
    "the root of a negative number, small eps": small(sqrt(-1) < eps),
    "a point": for_all(x >= 0, 0, 0, open_low=True),
    "a point that is a root": for_all(x - 1 >= 0, 1, 1),
    "a printed number that is none": agrees(log(b), "1.0", b="-1.0"),
    "a printed number, a divisor that may be 0": agrees(1 / b, "1.0", b="0"),
    "a norm that is none": norm_bound(log(-4), 2, 2),
    "a norm over 0": norm_bound(x, 4, expr(3) / 0),
    "an angle by itself": bounded([1 + var("q")], [1]),
    "over an angle": always_positive([1 / var("q")]),
    "e to the e to the 30": Constant(exp(exp(30)) <= 1),
    "sinh of 10^12": Constant(sinh(expr(10**12)) <= 1),
}
"""Statements on which a decision must be made, if only that there is none."""
