"""Statements that are false or undefined somewhere and were once proved, with the proof that did it."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from lyapcheck.check.certificates.proofs import (
    Boxes,
    ChosenMajorants,
    ExactNumbers,
    LeadingTerm,
    NormalForm,
    Pieces,
    PrintedInputs,
    Proof,
    SeparateBalls,
    SignIdentity,
    Sturm,
    Supremum,
)
from lyapcheck.claims import (
    Constant,
    ForSmall,
    Statement,
    agrees,
    any_matrix,
    any_vector,
    dh,
    every_n,
    expr,
    for_all,
    identity,
    implies,
    log,
    majorant,
    nonnegative,
    norm_bound,
    norm_chain,
    positive,
    reals,
    sqrt,
    var,
    zero_vector,
)


@dataclass(frozen=True)
class KnownFault:
    """A statement that must not be proved, and a proof of it that the checker must refuse."""

    name: str
    statement: Statement
    proof: Proof
    grade: str = "exact"


def near_zero(*cuts: int) -> Pieces:
    """Taylor boxes from 0 on."""
    return Pieces((Boxes(tuple(map(Fraction, cuts)), True, False, 160),))


x, v, y, b, s, eps = map(var, ("x", "v", "y", "b", "s", "eps"))
a, M = any_vector("a"), any_matrix("M")
hidden = sqrt(2) ** 2 - 2
deeper = sqrt(2) * sqrt(3) - sqrt(6)
nowhere = sqrt(-3)

FAULTS: tuple[KnownFault, ...] = (
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
        every_n(
            (a + M @ a).dot(a + M @ a),
            a.dot(a) + a.dot(M @ a) + a.dot(M @ (M @ a)),
            symmetric=[M],
        ),
        NormalForm(),
    ),
    KnownFault("aa/aa", every_n(a.dot(a) / a.dot(a), 1), NormalForm()),
    KnownFault("a number over itself", every_n(s * a.dot(a) / s, a.dot(a)), NormalForm()),
    KnownFault("log s times 0", every_n(zero_vector().dot(a.times(log(s))), 0), NormalForm()),
    # the other kinds
    KnownFault("a norm below 0/0", norm_bound(dh(1, x), 1, deeper / deeper), Supremum(ExactNumbers())),
    KnownFault(
        "a majorant that is no number",
        norm_chain([(majorant(log(-1), w=1), majorant(0))], majorant(1)),
        ChosenMajorants((1,), ExactNumbers()),
    ),
    KnownFault(
        "small eps beside 0 log 0",
        ForSmall("eps", (), (), expr(0) < log(0) * 0 + eps),
        LeadingTerm(SignIdentity((), ())),
    ),
    KnownFault(
        "a printed number beside log(-1)",
        agrees(b * log(-1) ** 0, "1.0", b="1.0"),
        PrintedInputs(128),
        "enclosure",
    ),
)
"""Each with the proof that was accepted; more are welcome, none goes."""
