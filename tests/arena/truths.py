"""True statements with proofs against what is left of them without one hypothesis; parts about other arms.

    python -m tests.arena.truths

adds them to the arena as it stands, and some certificates that must be accepted. ``CASES`` has for each rule
that refutes statements of which each hypothesis in turn is necessary: a rule that forgets the hypothesis
would refute what is true.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction as F
from importlib.metadata import version

from lyapcheck.certificate import Certificate
from lyapcheck.check.certificate import About
from lyapcheck.check.codec import from_json
from lyapcheck.check.expressions.expression import Tree
from lyapcheck.check.kinds.all_of import AllOf, EveryPart, OnePart
from lyapcheck.check.kinds.bound_every_n import BoundEveryN
from lyapcheck.check.kinds.chain import (
    ByDefinition,
    ChainAbove,
    ChainBelow,
    ChainCoriolisBelow,
    ChainGravityBelow,
    ChainIdentity,
    NoTorque,
    OwnLevers,
    OwnMoments,
)
from lyapcheck.check.kinds.constant import Agrees, Constant, ExactNumbers, OutsideRounding, SeparateBalls
from lyapcheck.check.kinds.coriolis import CoriolisAtRest, CoriolisBelow, CoriolisTorque, MassSymmetric
from lyapcheck.check.kinds.decreasing import (
    BoxTree,
    DampingAbove,
    DampingBelow,
    PositiveAndDecreasing,
    StateWitness,
)
from lyapcheck.check.kinds.every_n import EntriesWitness, EveryN, Given
from lyapcheck.check.kinds.for_all import ForAll
from lyapcheck.check.kinds.for_small import ForSmall, SmallWitness
from lyapcheck.check.kinds.gate_accepted import BrokenCondition, GateAccepted, GateParts, SaturatingState
from lyapcheck.check.kinds.gravity import GravityBelow, GravityOfPotential, Levers
from lyapcheck.check.kinds.identity import Identity, MovingPosture, SameHarmonics
from lyapcheck.check.kinds.implies import Implies
from lyapcheck.check.kinds.inertia import (
    Bisection,
    HarmonicSizes,
    Links,
    MassAbove,
    MassAtCorners,
    MassBelow,
    PostureWitness,
)
from lyapcheck.check.kinds.norm_bound import NormBound
from lyapcheck.check.kinds.resting import Resting, RestWitness
from lyapcheck.check.kinds.sampled import SampledStable
from lyapcheck.check.kinds.trigonometric import EntryWitness, TrigonometricBound, TrigonometricPositive
from lyapcheck.check.statement import Proof, Relation, Statement, Variable, Witness
from lyapcheck.check.verify import verify, weakest
from tests.arena.extra import (
    AT,
    COSINE,
    EPS,
    LINKS,
    MASS,
    MINUS,
    RANGING,
    RATES,
    RESTING,
    SINE,
    SPLIT,
    STILL,
    SYMBOLS,
    UNIT,
    A,
    S,
    T,
    X,
    Y,
    Z,
    decreasing,
    num,
    vector,
)
from tests.arena.library import Added
from tests.arena.plant import ARENA

Case = tuple[Statement, Statement, Proof]
"""True; without one hypothesis; and what refutes only the latter."""


def at(**point: F | int) -> tuple[tuple[str, F], ...]:
    return tuple((name, F(value)) for name, value in point.items())


def entries(n: int = 1, **point: F | int) -> EntriesWitness:
    """Entries for one n; ``x`` for n = 1 stands for x[1], ``A`` for A[1,1], numbers are in ``NUMBERS``."""
    if n > 1:
        return EntriesWitness(n, tuple((name.replace("_", ","), F(x)) for name, x in point.items()))
    ends = {name: "" if name in NUMBERS else "[1,1]" if name.isupper() else "[1]" for name in point}
    return EntriesWitness(1, tuple((name + ends[name], F(x)) for name, x in point.items()))


NUMBERS = ("s", "t")
ZERO = num(0)
NO_VALUE: Tree = ("pow", ("sqrt", num(-1)), 0)
"""A power without a value, as its base has none."""
B, P, Q, W = ("mat", "B"), *(("vec", name) for name in "pqw")
C, V = ("mat", "C"), ("vec", "x")
NOWHERE: Tree = ("sum",)


def form(x: Tree, matrix: Tree, y: Tree) -> Tree:
    return ("dot", x, ("apply", matrix, y))


def less(left: Tree, operator: str, right: Tree) -> Relation:
    return Relation(left, operator, right)


def bound(left: Tree, right: Tree, **known: object) -> BoundEveryN:
    """With nothing known beside what is said."""
    nothing = {"symmetric": (), "rates": (), "given": (), "norms": (), "least": ()}
    return BoundEveryN(left, right, **(nothing | known))  # type: ignore[arg-type]


def on_points() -> dict[str, Case]:
    """Relations, at points."""
    square, real, above = ("mul", X, X), Variable("x"), Variable("x", F(0))
    positive, y_too = less(ZERO, "<=", X), less(ZERO, "<=", ("var", "y"))
    product, both = ("mul", X, ("var", "y")), (Variable("x"), Variable("y"))
    either = Implies(both, (positive, y_too), less(ZERO, "<=", product))
    inside = ForAll(less(X, "<=", num(1)), F(-1), F(1))
    half = ("div", X, ("add", num(1), square))
    zero_inside = ForAll(less(ZERO, "<", X), F(0), F(1))
    one_inside = ForAll(less(X, "<", num(1)), F(0), F(1))
    root = ("sqrt", square)
    return {
        "low": (ForAll(positive, F(0)), ForAll(positive), Witness(at(x=-1))),
        "high": (inside, replace(inside, high=F(2)), Witness(at(x=2))),
        "open low": (replace(zero_inside, open_low=True), zero_inside, Witness(at(x=0))),
        "open high": (replace(one_inside, open_high=True), one_inside, Witness(at(x=1))),
        "equality": (ForAll(less(ZERO, "<=", square)), ForAll(less(ZERO, "<", square)), Witness(at(x=0))),
        "a value": (
            ForAll(less(("pow", ("sqrt", X), 0), "<=", num("1/2")), F(-2), F(-1)),
            ForAll(less(("pow", ("abs", X), 0), "<=", num("1/2")), F(-2), F(-1)),
            Witness(at(x=-1)),
        ),
        "a positive variable": (Identity(root, X, (above,)), Identity(root, X), Witness(at(x=-1))),
        "a variable that is not 0": (
            Implies((above,), (), less(ZERO, "<", X)),
            Implies((replace(above, strict=False),), (), less(ZERO, "<", X)),
            Witness(at(x=0)),
        ),
        "a hypothesis": (
            Implies((real,), (less(num(1), "<=", X),), less(num(1), "<=", square)),
            Implies((real,), (), less(num(1), "<=", square)),
            Witness(at(x=0)),
        ),
        "a strict hypothesis": (
            Implies((real,), (less(ZERO, "<", X),), less(ZERO, "<", square)),
            Implies((real,), (positive,), less(ZERO, "<", square)),
            Witness(at(x=0)),
        ),
        "one hypothesis": (either, replace(either, hypotheses=(y_too,)), Witness(at(x=-1, y=1))),
        "the other hypothesis": (either, replace(either, hypotheses=(positive,)), Witness(at(x=1, y=-1))),
        "the size of x": (NormBound(X, 1, num(1), 1), NormBound(X, 1, num(1), 0), Witness(at(x1=2))),
        "the number of entries": (
            NormBound(half, 1, num("1/2")),
            NormBound(half, 2, num("1/2")),
            Witness(at(x1=1, x2=1)),
        ),
        "equal numbers": (
            Constant(less(num(1), "<=", num(1))),
            Constant(less(num(1), "<", num(1))),
            ExactNumbers(),
        ),
        "a number that has a value": (
            Constant(less(("mul", ZERO, NO_VALUE), "<", ZERO)),
            Constant(less(("mul", ZERO, ("sqrt", num(2))), "<", ZERO)),
            ExactNumbers(),
        ),
        "a value in balls": (
            Constant(less(NO_VALUE, "<", num("1/2"))),
            Constant(less(("pow", ("sqrt", num(2)), 0), "<", num("1/2"))),
            SeparateBalls(128),
        ),
        "nearly equal numbers": (
            Constant(less(("sqrt", num(2)), "<", ("add", ("sqrt", num(2)), num(F(1, 10**30))))),
            Constant(less(("sqrt", num(2)), "<", ("add", ("sqrt", num(2)), num(F(-1, 10))))),
            SeparateBalls(32),
        ),
    }


def on_entries() -> dict[str, Case]:
    """Identities and bounds for every n, at entries."""
    turned = EveryN(form(Z, A, Y), form(Y, A, Z))
    loose = entries(2, **{"A[1_1]": 1, "A[1_2]": 2, "A[2_1]": 3, "A[2_2]": 1})
    loose = replace(loose, point=(*loose.point, *at(**{"y[1]": 1, "y[2]": 2, "z[1]": 3, "z[2]": 1})))
    solved = EveryN(form(Y, A, V), ("dot", Y, Z), given=(Given("A", "x", Z),))
    still = EveryN(form(Z, A, Y), ZERO, rates=((V, Y), (A, NOWHERE)), given=(Given("A", "x", NOWHERE),))
    one = entries(A=0, x=1, y=1, z=1)
    one = replace(one, point=tuple((k, F(0) if k == "x[1]" else F(1)) for k, _ in one.point))
    rated = EveryN(("rate", ("mul", S, S)), ("mul", num(2), S, T), rates=((S, T),))
    twice = EveryN(
        ("dot", Q, W),
        ZERO,
        ("A", "B"),
        ((A, NOWHERE), (B, NOWHERE), (Y, W), (Z, NOWHERE)),
        (Given("A", "x", Y), Given("B", "x", Z), Given("A", "q", ("apply", B, P))),
    )
    ones = entries(A=1, B=1, p=1, q=1, w=1, x=1, y=1, z=1)
    singular = replace(
        twice,
        symmetric=("A",),
        rates=((A, NOWHERE), (Y, W)),
        given=(Given("A", "x", Y), Given("A", "q", NOWHERE)),
    )
    bent = EveryN(form(Z, C, Y), form(Y, C, Z), ("A",), ((A, B), (B, C)))
    skew = {f"B[{i},{j}]": F(1) for i in (1, 2) for j in (1, 2)}
    skew |= {"C[1,1]": F(1), "C[1,2]": F(2), "C[2,1]": F(3), "C[2,2]": F(1)}
    skew |= {"y[1]": F(1), "y[2]": F(2), "z[1]": F(3), "z[2]": F(1)}
    yy, known = ("dot", Y, Y), bound(("dot", Y, Y), ("pow", S, 2), norms=(((Y,), S),))
    least = bound(("neg", yy), ("neg", S), least=((yy, S),))
    at_zero = bound(yy, ZERO, rates=((V, Y),), norms=(((V,), ZERO),))
    sided = bound(("add", turned.right, ("neg", turned.left)), ZERO)
    moved = bound(still.left, ZERO, rates=still.rates, given=still.given)
    squared = bound(("rate", ("mul", S, S)), ("mul", num(2), S, T), rates=((S, T),))
    faster = ((S, ("mul", num(2), T)),)
    put = bound(("add", solved.left, ("neg", solved.right)), ZERO, given=solved.given)
    return {
        "symmetry": (replace(turned, symmetric=("A",)), turned, loose),
        "what is given": (solved, replace(solved, given=()), entries(A=1, x=1, y=1, z=2)),
        "a derivative": (rated, replace(rated, rates=faster), entries(s=1, t=1)),
        "x of what is given moves": (still, replace(still, rates=((A, NOWHERE),)), one),
        "all of what is given moves": (still, replace(still, rates=()), one),
        "what is given twice": (twice, replace(twice, rates=()), ones),
        "what is given by a singular matrix": (
            singular,
            replace(singular, rates=()),
            entries(A=0, q=1, w=1, x=1, y=0),
        ),
        "a symmetric matrix that moves": (
            bent,
            replace(bent, symmetric=()),
            EntriesWitness(2, tuple(skew.items())),
        ),
        "a bound of a norm": (known, replace(known, norms=()), entries(s=1, y=2)),
        "a lower bound": (least, replace(least, least=()), entries(s=1, y=0)),
        "a bound that is reached": (at_zero, replace(at_zero, rates=()), entries(x=0, y=1)),
        "symmetry in a bound": (replace(sided, symmetric=("A",)), sided, loose),
        "what is given moves, in a bound": (moved, replace(moved, rates=()), one),
        "what is given, in a bound": (put, replace(put, given=()), entries(A=1, x=2, y=1, z=1)),
        "a derivative in a bound": (squared, replace(squared, rates=faster), entries(s=1, t=1)),
    }


def on_small_values() -> dict[str, Case]:
    """Relations for small values, of angles and between printed numbers."""
    one, x = Variable("x"), Variable("x", F(0))
    shown, small = less(EPS, "<", X), less(T, "<=", num(1))
    nothing = SmallWitness((), F(1))
    sine, twice = ("sin", X), ("mul", num(2), ("sin", X))
    both = TrigonometricBound(((sine, F(1)), (twice, F(2))))
    printed = Agrees(("mul", X, ("var", "y")), (("x", "1.5"), ("y", "1.500000")), "2.31")
    as_read = Agrees(X, (("x", "1.54000"),), "1.5")
    return {
        "a range beside small values": (
            ForSmall("eps", (x,), (), shown),
            ForSmall("eps", (one,), (), shown),
            SmallWitness(at(x=0), F(1)),
        ),
        "a bounded variable": (
            ForSmall("eps", (), (), small, ("t",)),
            ForSmall("eps", (Variable("t"),), (), small),
            SmallWitness(at(t=2), F(1)),
        ),
        "a bounded variable above 0": (
            ForSmall("eps", (), (), less(ZERO, "<", T), ("t",)),
            ForSmall("eps", (Variable("t"),), (), less(ZERO, "<", T)),
            SmallWitness(at(t=0), F(1)),
        ),
        "a hypothesis on small values": (
            ForSmall("eps", (one,), (less(ZERO, "<", X),), shown),
            ForSmall("eps", (one,), (), shown),
            SmallWitness(at(x=-1), F(1)),
        ),
        "a strict hypothesis on small values": (
            ForSmall("eps", (one,), (less(ZERO, "<", X),), shown),
            ForSmall("eps", (one,), (less(ZERO, "<=", X),), shown),
            SmallWitness(at(x=0), F(1)),
        ),
        "small values alone": (
            ForSmall("eps", (), (), less(EPS, "<", num("1/2"))),
            ForSmall("eps", (), (), less(EPS, "<", num("-1/2"))),
            nothing,
        ),
        "equality for small values": (
            ForSmall("eps", (), (), less(EPS, "<=", EPS)),
            ForSmall("eps", (), (), less(EPS, "<", EPS)),
            nothing,
        ),
        "a value for small values": (
            ForSmall("eps", (), (), less(("add", EPS, NO_VALUE), "<", num("1/2"))),
            ForSmall("eps", (), (), less(("add", EPS, ("pow", EPS, 0)), "<", num("1/2"))),
            nothing,
        ),
        "the bound of an entry": (
            TrigonometricBound(((sine, F(1)),)),
            TrigonometricBound(((sine, F(1, 10)),)),
            EntryWitness(0, False, at(x=1)),
        ),
        "from below": (
            TrigonometricBound(((sine, F(1)),)),
            TrigonometricBound(((sine, F(1, 10)),)),
            EntryWitness(0, True, at(x=-1)),
        ),
        "an entry without a bound": (
            TrigonometricBound(((sine, None),)),
            TrigonometricBound(((sine, F(1, 10)),)),
            EntryWitness(0, False, at(x=1)),
        ),
        "the bound of this entry": (
            both,
            replace(both, entries=((sine, F(1)), (twice, F(1)))),
            EntryWitness(1, False, at(x=1)),
        ),
        "what is added": (
            TrigonometricPositive((("add", num(2), sine),)),
            TrigonometricPositive((sine,)),
            EntryWitness(0, True, at(x=-1)),
        ),
        "a bound from below": (
            TrigonometricPositive((("add", num(2), sine),)),
            TrigonometricPositive((("add", num(-2), sine),)),
            EntryWitness(0, True, at(x=1)),
        ),
        "how one number is rounded": (
            printed,
            replace(printed, inputs=(("x", "1.500000"), ("y", "1.500000"))),
            OutsideRounding(128),
        ),
        "how the other number is rounded": (
            replace(printed, inputs=(("x", "1.500000"), ("y", "1.5"))),
            replace(printed, inputs=(("x", "1.500000"), ("y", "1.500000"))),
            OutsideRounding(128),
        ),
        "how the result is rounded": (as_read, replace(as_read, printed="1.50"), OutsideRounding(128)),
    }


def on_postures() -> dict[str, Case]:
    """Bounds and identities of an arm, at postures."""
    mean = (((0, 0, 1), F(1)),)  # p
    share = (((0, 0, 0, 0, 1), F(1)),)
    plain = (((0, 0, 0, 0, 0), F(1)),)
    uneven = MassSymmetric(((plain, share), (plain, plain)), ((F(1), F(1)),))
    moving = MovingPosture(AT, (), RATES)
    pull = (((1, 0, 1), F(1)),)  # p sin q
    swing = (((0, 0, 0), F(3)), ((0, 1, 1), F(1)))  # 3 + p cos q
    ranged, wider = ((F(1), F(2)),), ((F(1), F(3)),)
    mass = (((((0, 0, 1), F(1)), ((0, 1, 0), F(1))),),)  # p + cos q
    top, side = (F(0),), (F(11, 7),)
    straight, fall = (F(0), F(0)), vector(1, 0, 0)
    alone = PostureWitness(AT, (), (F(1), F(1)), (F(100), F(0)))
    return {
        "a parameter of M": (uneven, replace(uneven, parameters=wider), MovingPosture(AT, (F(3),), RATES)),
        "what has no rate": (CoriolisAtRest(MASS, (), SYMBOLS), CoriolisAtRest(MASS, (), STILL), moving),
        "both halves of C": (CoriolisTorque(MASS, (), SPLIT), CoriolisTorque(MASS, (), STILL), moving),
        "the sign of U": (
            GravityOfPotential((SINE,), (((0, 1), F(-1)),), ()),
            GravityOfPotential((SINE,), COSINE, ()),
            MovingPosture((F(1),), (), (F(0),)),
        ),
        "the range of M from above": (
            MassBelow(mass, ranged, F(7, 2)),
            MassBelow(mass, wider, F(7, 2)),
            PostureWitness(top, (F(3),), (F(1),)),
        ),
        "the range of M from below": (
            MassAbove(((mean,),), ranged, F(1, 2)),
            MassAbove(((mean,),), ((F(0), F(2)),), F(1, 2)),
            PostureWitness(top, (F(0),), (F(1),)),
        ),
        "the range of g": (
            GravityBelow(1, (pull,), ranged, F(5, 2)),
            GravityBelow(1, (pull,), wider, F(5, 2)),
            PostureWitness(side, (F(3),), ()),
        ),
        "the range of C": (
            CoriolisBelow(((swing,),), ranged, F(5, 4)),
            CoriolisBelow(((swing,),), wider, F(5, 4)),
            PostureWitness(side, (F(3),), (F(1),), (F(1),)),
        ),
        "the size of x beside M": (
            MassBelow(MASS, (), F(6)),
            MassBelow(MASS, (), F(1)),
            PostureWitness(straight, (), (F(5), F(2))),
        ),
        "the sizes of x and y beside C": (
            CoriolisBelow(MASS, (), F(5, 3)),
            CoriolisBelow(MASS, (), F(1, 10)),
            alone,
        ),
        "the least energy of links": (
            ChainAbove(LINKS, F(0)),
            ChainAbove(LINKS, F(1)),
            PostureWitness(AT, (), (F(-2), F(5))),
        ),
        "the size of x beside links": (
            ChainBelow(LINKS, F(6)),
            ChainBelow(LINKS, F(5)),
            PostureWitness(straight, (), (F(5), F(2))),
        ),
        "the sizes beside C of links": (
            ChainCoriolisBelow(LINKS, F(5, 3)),
            ChainCoriolisBelow(LINKS, F(1, 10)),
            PostureWitness(AT, (), (F(1), F(1))),
        ),
        "the torque of links": (
            ChainGravityBelow(LINKS, fall, (1,), F(3)),
            ChainGravityBelow(LINKS, fall, (1,), F(29, 10)),
            PostureWitness((F(8, 5), F(0)), (), ()),
        ),
        "the way down": (
            ChainGravityBelow(LINKS, vector(0, 0, 1), (1,), F(0)),
            ChainGravityBelow(LINKS, fall, (1,), F(0)),
            PostureWitness((F(8, 5), F(0)), (), ()),
        ),
        "a joint that is not meant": (
            ChainGravityBelow(LINKS, fall, (2,), F(1)),
            ChainGravityBelow(LINKS, fall, (1, 2), F(1)),
            PostureWitness((F(8, 5), F(0)), (), ()),
        ),
    }


def on_states() -> dict[str, Case]:
    """Statements about the closed loop, at states, and what is built of others."""
    slow, quick = decreasing(UNIT, F(1, 10)), decreasing(UNIT, F(10))
    moving = StateWitness((F(1),), (), (F(0),), (F(0),), (F(1),))
    driven = replace(slow, viscous=((F(-5), F(1)),))
    weighed = replace(slow, mass=RANGING["mass"], parameters=((F(9, 10), F(1)),))
    heavy = replace(moving, parameters=(F(1000),), e=(F(-1),), w=(F(-3),))
    light = PostureWitness((F(0),), (F(-1),), (F(1),))
    lighter = ((F(-1), F(1)),)
    everywhere = replace(weighed, parameters=lighter)
    one = Resting(RESTING.family, RESTING.m, RESTING.kp[:1], RESTING.torque[:1], RESTING.errors[:1])
    damped = PositiveAndDecreasing(Bisection(), BoxTree("."))
    needed = DampingBelow(((UNIT,),), ((F(1), F(1)),), (), "tanh", None, (F(1),), (F(1),), num(1))
    above = DampingAbove(F(1), F(1, 10), ExactNumbers(), damped)
    true, false = (Constant(less(num(k), "<", num(1))) for k in (0, 2))
    return {
        "a small ε₀": (slow, quick, moving),
        "the weights of h": (replace(quick, coupling=(F(1, 100),)), quick, moving),
        "the friction": (slow, driven, replace(moving, viscous=(F(-5),), w=(F(3),))),
        "a parameter of the loop": (weighed, replace(weighed, parameters=((F(9, 10), F(1000)),)), heavy),
        "an arm with mass": (weighed, everywhere, light),
        "the torque at rest": (one, replace(one, torque=(F(10),)), RestWitness(0, F(1))),
        "the error at rest": (one, replace(one, errors=(F(2, 5),)), RestWitness(0, F(1, 2))),
        "the stiffness at rest": (one, replace(one, kp=(F(2),)), RestWitness(0, F(1))),
        "the function at rest": (one, replace(one, m=9), RestWitness(0, F(4, 5))),
        "an error that nothing bounds": (
            RESTING,
            replace(RESTING, errors=(F(3, 5), F(1, 2))),
            RestWitness(1, F(1)),
        ),
        "another joint at rest": (
            RESTING,
            replace(RESTING, torque=(F(10), F(5))),
            RestWitness(0, F(1)),
        ),
        "V that falls": (replace(needed, viscous=((F(-5), F(1)),)), needed, above),
        "M ≻ 0 where V falls": (replace(needed, mass=((MINUS,),)), needed, above),
        "the bound of the damping": (replace(needed, bound=num(3)), needed, above),
        "the part that is false": (
            AllOf((("a", true), ("b", true))),
            AllOf((("a", true), ("b", false))),
            OnePart(1, ExactNumbers()),
        ),
    }


GATE = GateAccepted(
    joints=1,
    gravity=((((1, 0, 1), F(1)),),),
    potential=(((0, 1, 1), F(-1)),),
    parameters=((F(1), F(2)),),
    k_g=(F(2),),
    viscous=((F(2), F(3)),),
    limits=(F(10),),
    family="hyperbolic",
    m=1,
    kp=(F(5),),
    kv=(F(1),),
    conditions=("10", "10p", "10i", "19"),
    stability=(MassAbove((((((0, 0, 0), F(1)),),),), ((F(1), F(2)),), F(0)),),
)
"""g = p sin q, p in [1, 2]."""
PASSED = GateParts((HarmonicSizes(),), 30, (Bisection(),))


def on_gates() -> dict[str, Case]:
    """Gains on one joint with a motor."""
    side, heavy = SaturatingState(0, (F(1),), (F(2),), F(20)), SaturatingState(0, (F(1),), (F(9),), F(20))
    broken = BrokenCondition("19", 0, 30)
    rubbed = replace(GATE, viscous=((F(1, 2), F(3)),))
    tight = replace(GATE, kv=(F(19, 10),))
    return {
        "the limit of a motor": (GATE, replace(GATE, limits=(F(7),)), side),
        "the range of gravity": (GATE, replace(GATE, parameters=((F(1), F(9)),)), heavy),
        "the stiffness of the gate": (GATE, replace(GATE, kp=(F(9),)), side),
        "the other side": (
            GATE,
            replace(GATE, limits=(F(7),)),
            replace(side, turns=(F(3),), x=F(-20)),
        ),
        "what is asked of a motor": (
            replace(GATE, limits=(F(7),), conditions=("19",)),
            replace(GATE, limits=(F(7),), conditions=("10i", "19")),
            side,
        ),
        "the friction of the gate": (GATE, rubbed, broken),
        "a condition that is asked": (replace(rubbed, conditions=("10i",)), rubbed, broken),
        "the function of the gate": (tight, replace(tight, m=3), broken),
        "k_g in a condition": (GATE, replace(GATE, k_g=(F(5),)), BrokenCondition("10p", 0, 30)),
        "the norm of a limit": (GATE, replace(GATE, limits=(F(15, 2),)), BrokenCondition("10", 0, 30)),
    }


def broken_gates() -> Iterator[tuple[str, Statement, Proof]]:
    """False verdicts of the gate, each with the proof of the true one."""
    yield "k_g", replace(GATE, k_g=(F(3, 2),)), PASSED
    yield "equality", replace(GATE, limits=(F(8),)), PASSED
    yield "potential", replace(GATE, potential=(((0, 1, 1), F(1)),)), PASSED
    yield "no-proof", GATE, replace(PASSED, gravity=())
    yield "no-stability", GATE, replace(PASSED, stability=())


FALL = vector(1, 0, 0)
SWING = (
    *(((1, 0, 0, 0, k), F(1)) for k in (0, 1)),
    *((powers, F(1)) for powers in ((1, 0, 0, 1, 1), (0, 1, 1, 0, 1))),
)
"""g1 = (1 + p) sin q1 + p sin(q1 + q2) of two links, p the mass of the second; at most 1 + 2p."""
SWUNG = GravityBelow(2, (SWING,), ((F(1), F(2)),), F(5))
EMPTY = (LINKS[0], replace(LINKS[1], mass=F(0)))
BY_LEVERS = Levers(EMPTY, (vector(0, 1),), FALL, 0, (1,))
HANGING = ChainGravityBelow(LINKS, FALL, (1,), F(3))
NEAR = F(1, 10**9)


def broken_levers() -> Iterator[tuple[str, Statement, Proof]]:
    """Bounds of gravity that are false, or are not shown by these links."""
    yield "near", replace(SWUNG, high=5 - NEAR), BY_LEVERS
    yield "range", replace(SWUNG, parameters=((F(1), F(2) + NEAR),)), BY_LEVERS
    yield "below-zero", replace(SWUNG, parameters=((F(-9), F(2)),)), BY_LEVERS
    yield "lighter", replace(SWUNG, high=F(4)), replace(BY_LEVERS, shares=((F(0), F(1, 2)),))
    yield "weightless", replace(SWUNG, high=F(0)), replace(BY_LEVERS, fall=vector(0, 0, 0))
    yield "no-share", SWUNG, replace(BY_LEVERS, shares=())
    yield "no-link", SWUNG, replace(BY_LEVERS, links=EMPTY[:1], shares=(vector(1),))
    yield "flat-fall", SWUNG, replace(BY_LEVERS, fall=vector(1, 0))
    yield "other-joint", replace(SWUNG, high=F(2)), replace(BY_LEVERS, joint=1)
    yield "no-joint", SWUNG, replace(BY_LEVERS, joint=-1)
    yield (
        "short-axis",
        SWUNG,
        replace(BY_LEVERS, links=(replace(EMPTY[0], axis=(F(0), F(0), F(1, 2))), EMPTY[1])),
    )
    yield "square", replace(SWUNG, gravity=((*SWING, ((1, 0, 0, 0, 2), F(1))),), high=F(9)), BY_LEVERS
    yield "two", replace(SWUNG, gravity=(SWING, SWING)), BY_LEVERS
    yield "own-near", replace(HANGING, high=3 - NEAR), OwnLevers((1,))
    yield "own-both", replace(HANGING, joints=(1, 2)), OwnLevers((1,))


def on_computers() -> dict[str, Case]:
    """One joint whose k_v = 5 is above its friction, from the file that ``tests.arena.unstable`` writes."""
    data = json.loads((ARENA / "good" / "one.uns.json").read_text(encoding="utf-8"))
    left = from_json(Statement, data["statement"], "statement")
    grown = from_json(Proof, data["proof"], "proof")
    assert isinstance(left, SampledStable)
    return {
        "the friction on a computer": (replace(left, viscous_min=(F(1000),)), left, grown),
        "the damping on a computer": (replace(left, kp=(F(1, 10),), kv=(F(1, 10),)), left, grown),
        "what is said of motions on a computer": (
            replace(left, conclusion="rest", viscous_min=(F(1000),)),
            left,
            grown,
        ),
    }


CASES = on_points() | on_entries() | on_small_values() | on_postures() | on_states() | on_gates()
CASES |= on_computers()


Part = tuple[Statement, Proof]


def arms() -> dict[str, tuple[Part, Part]]:
    """Two statements about two arms, each with its proof, by what tells the arms apart."""
    one, other = (decreasing(UNIT, F(1, 10), viscous=F(b)) for b in (1, 2))
    damped, corners = PositiveAndDecreasing(Bisection(), BoxTree(".")), MassAtCorners((Bisection(),) * 2)
    heavy = tuple(replace(link, mass=F(2)) for link in LINKS)
    double = tuple(tuple(tuple((p, 2 * c) for p, c in entry) for entry in row) for row in MASS)
    mean = ((((0, 0, 1), F(1)),),)
    ranged = [MassAbove((mean,), ((F(1), F(high)),), F(1, 2)) for high in (2, 3)]
    still = tuple(ChainGravityBelow(LINKS, vector(0, 0, z), (1, 2), F(0)) for z in (1, 2))
    mass = MassAbove(MASS, (), F(0)), Links(LINKS)
    half = (((1, 0), F(1, 2)),)
    pulled = GravityOfPotential((SINE,), (((0, 1), F(-1)),), ()), SameHarmonics()
    both = GravityBelow(2, (ACROSS, ()), (), F(1)), HarmonicSizes()
    return {
        "M": (mass, (MassBelow(double, (), F(12)), Bisection())),
        "number of joints": (mass, (GravityBelow(1, (SINE,), (), F(1)), HarmonicSizes())),
        "range of parameters": ((ranged[0], corners), (ranged[1], corners)),
        "B": ((one, damped), (other, damped)),
        "M of links": ((ChainAbove(LINKS, F(0)), OwnMoments()), (ChainAbove(heavy, F(0)), OwnMoments())),
        "M or links": (mass, (ChainIdentity(heavy, "rate"), ByDefinition())),
        "free fall": ((still[0], NoTorque()), (still[1], NoTorque())),
        "g": (
            pulled,
            (GravityOfPotential((half,), (((0, 1), F(-1, 2)),), ()), SameHarmonics()),
        ),
        "potential": (
            pulled,
            (GravityOfPotential((SINE,), (((0, 1), F(-1)), ((0, 0), F(1))), ()), SameHarmonics()),
        ),
        "g of a bound": (both, (GravityBelow(2, (ACROSS, ACROSS), (), F(2)), HarmonicSizes())),
        "M inside": (
            (AllOf((("inner", mass[0]),)), EveryPart((mass[1],))),
            (MassBelow(double, (), F(12)), Bisection()),
        ),
    }


ACROSS = (((1, 0, 0, 0), F(1)),)
"""sin q1 of two joints."""


def together(*parts: Part) -> Part:
    """All of some statements."""
    named = tuple((f"part {k}", statement) for k, (statement, _) in enumerate(parts, 1))
    return AllOf(named), EveryPart(tuple(proof for _, proof in parts))


def good() -> Iterator[tuple[str, Statement, Proof]]:
    """Refutations by what functions of time may be, and statements about one arm."""
    motion = Given("A", "w", ("sum", Y, ("scale", num(-1), ("apply", C, Q))))
    rates = ((A, ("sum", C, ("transpose", C))), (Q, W))
    fall = EveryN(("rate", form(Q, A, Q)), ZERO, ("A",), rates, (motion,))
    yield "solved", fall, entries(A=2, C=1, q=1, w=0, y=1)
    still = EveryN(("dot", Y, V), ZERO, rates=((Q, W),), given=(Given("B", "x", NOWHERE),))
    yield "still", still, entries(B=0, w=1, x=1, y=1)
    inside = bound(("dot", Y, Y), ZERO, rates=((V, Y),), norms=(((V,), num(1)),))
    yield "inside", inside, entries(x=0, y=1)
    identity = ChainIdentity(LINKS, "rate"), ByDefinition()
    for name, parts in {
        "written": ((MassAbove(MASS, (), F(0)), Links(LINKS)), (MassBelow(MASS, (), F(6)), Bisection())),
        "linked": ((ChainAbove(LINKS, F(0)), OwnMoments()), identity),
    }.items():
        yield f"arm-{name}", *together(*parts)
    yield "levers", SWUNG, BY_LEVERS
    yield "own-levers", HANGING, OwnLevers((1,))
    yield "gate", GATE, PASSED
    yield "gate-premise", replace(GATE, gravity=(), potential=()), replace(PASSED, gravity=())
    for name in ("the limit of a motor", "the friction of the gate"):
        _, false, proof = on_gates()[name]
        yield f"gate-{plain(name)}", false, proof


def certified(name: str, statement: Statement, proof: Proof, verdict: str, grade: str) -> bytes:
    about = About(name, statement.text()[:200], None, None, "truths")
    used = {package: version(package) for package in ("lyapcheck", "python-flint")}
    return Certificate(about, statement, verdict, grade, proof, {}, used).text().encode()


def main() -> None:
    """Write the files, and what is expected of them."""
    arena = Added("tru")
    for name, statement, proof in good():
        accepted = verify(statement, proof)
        content = certified(name, statement, proof, accepted.verdict, accepted.grade)
        arena.add(f"good/{name}.tru.json", content, ["accepted"], "")
    for name, (true, false, proof) in CASES.items():
        content = certified(name, true, proof, "refuted", verify(false, proof).grade)
        arena.add(f"bad/true.tru.{plain(name)}.json", content, ["refused"], f"true because of {name}")
    for name, statement, proof in broken_gates():
        content = certified(name, statement, proof, "proved", "exact")
        arena.add(
            f"bad/false.tru.gate-{name}.json", content, ["refused"], f"a false verdict of the gate: {name}"
        )
    for name, statement, proof in broken_levers():
        content = certified(name, statement, proof, "proved", "exact")
        arena.add(
            f"bad/false.tru.levers-{name}.json", content, ["refused"], f"no bound by these levers: {name}"
        )
    for name, parts in arms().items():
        grade = weakest(verify(*part).grade for part in parts)
        content = certified(name, *together(*parts), "proved", grade)
        arena.add(f"bad/arms.tru.{plain(name)}.json", content, ["refused"], f"parts about two arms: {name}")
    arena.entries.sort(key=lambda entry: entry["path"])
    (ARENA / "expected.json").write_text(json.dumps(arena.entries, indent=1, ensure_ascii=False) + "\n")


def plain(name: str) -> str:
    """A name as part of that of a file."""
    return "-".join(word for word in name.replace("≻ 0 ", "").replace("ε₀", "eps0").replace(",", "").split())


if __name__ == "__main__":
    main()
