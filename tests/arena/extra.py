"""Write certificates of the kinds and rules that no shipped script gives: python -m tests.arena.extra FOLDER.

Statements of one and two joints and of few letters, small enough to be judged by hand. Where no proof stands
beside a statement, the search proposes one.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction as F
from importlib.metadata import version
from pathlib import Path
from typing import Any

from lyapcheck.certificate import Certificate
from lyapcheck.check.certificate import About
from lyapcheck.check.expressions.expression import Tree
from lyapcheck.check.kinds.bound_every_n import BoundEveryN
from lyapcheck.check.kinds.chain import (
    IDENTITIES,
    ByDefinition,
    ChainAbove,
    ChainBelow,
    ChainCoriolisBelow,
    ChainGravityBelow,
    ChainIdentity,
    NoTorque,
    OwnMoments,
)
from lyapcheck.check.kinds.constant import Agrees, Corners
from lyapcheck.check.kinds.coriolis import (
    CoriolisAtRest,
    CoriolisBelow,
    CoriolisTorque,
    MassSymmetric,
    Matrices,
    RateLessTwiceCoriolis,
    RateOfMass,
)
from lyapcheck.check.kinds.decreasing import (
    BoxTree,
    Decreasing,
    LargerKv,
    PositiveAndDecreasing,
    StateWitness,
)
from lyapcheck.check.kinds.every_n import EveryN
from lyapcheck.check.kinds.for_all import ForAll
from lyapcheck.check.kinds.for_small import ForSmall
from lyapcheck.check.kinds.gravity import GravityBelow, GravityOfPotential
from lyapcheck.check.kinds.identity import MovingPosture
from lyapcheck.check.kinds.inertia import (
    Bisection,
    HarmonicSizes,
    Links,
    MassAbove,
    MassAtCorners,
    MassBelow,
    PostureWitness,
)
from lyapcheck.check.kinds.link_bounds import LinkBounds
from lyapcheck.check.kinds.norm_bound import NormBound
from lyapcheck.check.kinds.resting import Resting
from lyapcheck.check.kinds.stability import PROPERTIES
from lyapcheck.check.kinds.trigonometric import TrigonometricBound, TrigonometricPositive
from lyapcheck.check.loop.chain import RigidLink
from lyapcheck.check.loop.closed_loop import ClosedLoop
from lyapcheck.check.statement import Monomials, Proof, Relation, Statement, Variable
from lyapcheck.check.verify import verify
from lyapcheck.claims.procedures import propose
from lyapcheck.constants.storage import storage_proof
from lyapcheck.robots.dynamics import Chain
from lyapcheck.search.error_boxes import ErrorBoxes
from lyapcheck.search.link_bounds import bounds_along
from tests.statement_fuzz.generators.loops import property_of

Row = tuple[str, Statement, Proof | None]


def num(value: F | int) -> Tree:
    return ("num", str(F(value)))


def vector(*values: int) -> tuple[F, ...]:
    return tuple(map(F, values))


X: Tree = ("var", "x")
EPS, S, T = (("var", name) for name in ("eps", "s", "t"))
A, Y, Z = ("mat", "A"), ("vec", "y"), ("vec", "z")

# One joint: M = 1, and −1, which no arm has.
UNIT: Monomials = (((0, 0), F(1)),)
SINE: Monomials = (((1, 0), F(1)),)
COSINE: Monomials = (((0, 1), F(1)),)
MINUS: Monomials = (((0, 0), F(-1)),)
# Two links of length 1 with mass 1 at each end: exponents of sin q1, sin q2, cos q1, cos q2.
ONE: Monomials = (((0, 0, 0, 0), F(1)),)
ELBOW: Monomials = (((0, 1, 0, 0), F(1)),)
BACK: Monomials = (((0, 1, 0, 0), F(-1)),)
TWICE: Monomials = (((0, 1, 0, 0), F(-2)),)
MIXED: Monomials = (((0, 0, 0, 0), F(1)), ((0, 0, 0, 1), F(1)))
MASS = (((((0, 0, 0, 0), F(3)), ((0, 0, 0, 1), F(2))), MIXED), (MIXED, ONE))
SKEWED = ((ONE, ELBOW), ((), ONE))
SYMBOLS: Matrices = ((((), BACK, ()), (BACK, BACK, ())), ((ELBOW, (), ()), ((), (), ())))
SPLIT: Matrices = ((((), TWICE, ()), ((), BACK, ())), ((ELBOW, (), ()), ((), (), ())))
"""C(q, w)w is right, the halves of C are not those of the Christoffel symbols."""
STILL: Matrices = ((((), BACK, ONE), (BACK, BACK, ())), ((ELBOW, (), ()), ((), (), ())))
"""With friction in C11."""
TURN = (vector(1, 0, 0), vector(0, 1, 0), vector(0, 0, 1))
NOTHING = (vector(0, 0, 0),) * 3
AXIS, ALONG = vector(0, 0, 1), vector(1, 0, 0)
LINKS = (
    RigidLink(AXIS, vector(0, 0, 0), F(1), ALONG, NOTHING, TURN),
    RigidLink(AXIS, ALONG, F(1), ALONG, NOTHING, TURN),
)
HEAVIER = tuple(replace(link, mass=F(2)) for link in LINKS)
PAYLOAD = ((F(1), F(2)),)
LOADED = tuple(tuple(tuple(((*powers, 1), c) for powers, c in entry) for entry in row) for row in MASS)
"""The same for a mass at each end that ranges."""
AT = (F(0), F(1))
RATES = (F(1), F(1, 2))


def of_the_arm() -> Iterator[Row]:
    """Bounds and identities of M, C and g."""
    yield "links", MassAbove(MASS, (), F(0)), Links(LINKS)
    yield "links-at-corners", MassAbove(LOADED, PAYLOAD, F(0)), MassAtCorners((Links(LINKS), Links(HEAVIER)))
    yield "mass-boxes", MassBelow(MASS, (), F(6)), Bisection()
    ranged = (((((0, 0, 1), F(1)), ((0, 1, 0), F(1))),),)
    yield "mass-range", MassBelow(ranged, ((F(1), F(2)),), F(7, 2)), Bisection()
    yield (
        "mass-range-large",
        MassBelow(ranged, ((F(1), F(2)),), F(5, 2)),
        PostureWitness((F(0),), (F(2),), (F(1),)),
    )
    yield "coriolis-range", CoriolisBelow(ranged, ((F(1), F(2)),), F(1)), HarmonicSizes()
    yield "gravity-boxes", GravityBelow(1, ((*SINE, *COSINE),), (), F(3, 2)), Bisection()
    yield (
        "gravity-large",
        GravityBelow(1, ((*SINE, *COSINE),), (), F(7, 5)),
        PostureWitness((F(4, 5),), (), ()),
    )
    yield "potential", GravityOfPotential((SINE,), (((0, 1), F(-1)),), ()), None
    yield "no-potential", GravityOfPotential((SINE,), COSINE, ()), MovingPosture((F(1),), (), (F(0),))
    yield "symmetric", MassSymmetric(MASS, ()), None
    yield "skewed", MassSymmetric(SKEWED, ()), MovingPosture(AT, (), RATES)
    yield "symbols", CoriolisTorque(MASS, (), SYMBOLS), None
    yield "split", CoriolisTorque(MASS, (), SPLIT), None
    yield "friction", CoriolisTorque(MASS, (), STILL), MovingPosture(AT, (), RATES)
    for kind in (CoriolisAtRest, RateOfMass, RateLessTwiceCoriolis):
        yield f"{kind.__name__}.printed", kind(MASS, (), SYMBOLS), None
        yield f"{kind.__name__}.friction", kind(MASS, (), STILL), MovingPosture(AT, (), RATES)
    yield "halves", RateOfMass(MASS, (), SPLIT), MovingPosture(AT, (), RATES)
    yield "halves-less", RateLessTwiceCoriolis(MASS, (), SPLIT), MovingPosture(AT, (), RATES)


def of_chains() -> Iterator[Row]:
    """Bounds of M and g along the two links: λmax = 3 + 2√2, g1 = 2 sin q1 + sin(q1 + q2)."""
    fall = vector(1, 0, 0)
    chain = Chain(LINKS, fall)
    for name in ("lambda_max", "k_g", "k_g2"):
        shown = storage_proof(chain, name)
        assert shown is not None
        yield f"chain-{name}", shown.statement, shown.proof
    yield "chain-moments", ChainAbove(LINKS, F(0)), OwnMoments()
    rods = tuple(replace(link, inertia=TURN) for link in LINKS)
    shown = storage_proof(Chain(rods, fall), "lambda_min")
    assert shown is not None
    yield "chain-lambda_min", shown.statement, shown.proof
    yield "chain-no-torque", ChainGravityBelow(LINKS, AXIS, (1, 2), F(0)), NoTorque()
    for identity in IDENTITIES:
        yield f"chain-{identity.replace(' ', '-')}", ChainIdentity(LINKS, identity), ByDefinition()
    yield "chain-small", ChainAbove(LINKS, F(1)), PostureWitness(AT, (), (F(-2), F(5)))
    yield "chain-large", ChainBelow(LINKS, F(5)), PostureWitness((F(0), F(0)), (), (F(5), F(2)))
    shown = storage_proof(chain, "k_c")
    assert shown is not None
    yield "chain-k_c", shown.statement, shown.proof
    yield "chain-coriolis", ChainCoriolisBelow(LINKS, F(1, 10)), PostureWitness(AT, (), (F(1), F(1)))
    yield (
        "chain-torque",
        ChainGravityBelow(LINKS, fall, (1,), F(29, 10)),
        PostureWitness((F(8, 5), F(0)), (), ()),
    )


def decreasing(mass: Monomials, eps0: F, kp: F = F(1), viscous: F = F(1)) -> Decreasing:
    """One joint under tanh."""
    return Decreasing(((mass,),), ((viscous, viscous),), (), "tanh", None, (kp,), (F(1),), eps0, ())


RANGING: dict[str, Any] = {
    "mass": (((((0, 0, 1), F(1)),),),),
    "viscous": ((F(1), F(6, 5)),),
    "parameters": ((F(9, 10), F(1)),),
}
"""One joint with ranges for inertia and friction."""
RESTING = Resting("hyperbolic", 2, (F(10), F(5)), (F(2), F(5)), (F(3, 5), None))


LINKED = Decreasing(
    mass=LOADED,
    viscous=((F(5), F(6)), (F(3), F(4))),
    parameters=PAYLOAD,
    family="tanh",
    m=None,
    kp=(F(20), F(10)),
    kv=(F(1), F(1)),
    eps0=F(1, 5),
    coupling=(),
)


def along_links() -> LinkBounds:
    """Bounds of two links with ranges for mass and friction."""
    chains = tuple(Chain(links, vector(1, 0, 0)) for links in (LINKS, HEAVIER))
    bounds = bounds_along(chains, tuple(low for low, _ in LINKED.viscous))
    assert bounds is not None
    return bounds


def linked(loop: ClosedLoop) -> PositiveAndDecreasing:
    """By boxes beside these bounds."""
    bounds = along_links()
    boxes = ErrorBoxes(loop, bounds).covered(5_000)
    assert boxes.proved
    rate = replace(bounds, tree=boxes.tree, scales=boxes.scales)
    return PositiveAndDecreasing(MassAtCorners((Links(LINKS), Links(HEAVIER))), rate)


NO_ARM = (F(0),), (), (F(1),)


def of_the_loop() -> Iterator[Row]:
    """Statements of (11), of V and of what is left of the errors."""
    h: tuple[Tree, Tree, Tree] = ("h", 1, X), ("dh", 1, X), ("potential", 1, X)
    for name in PROPERTIES:
        yield name.replace(" ", "-"), property_of(name, h), None
    yield "boxes", decreasing(UNIT, F(1, 10)), PositiveAndDecreasing(Bisection(), BoxTree("."))
    damped = PositiveAndDecreasing(Bisection(), BoxTree("."))
    yield "larger-kv", replace(decreasing(UNIT, F(1, 10)), kv=(F(1, 2),)), LargerKv((F(1),), damped)
    yield "linked", LINKED, linked(LINKED.closed_loop)
    yield "no-arm", decreasing(MINUS, F(1, 10)), PostureWitness(*NO_ARM)
    at = StateWitness((F(1),), (), (F(0),), (F(0),), (F(1),))
    yield "eps0-too-large", decreasing(UNIT, F(10)), at
    mass_range = MassAbove(RANGING["mass"], RANGING["parameters"], F(1, 2))
    yield "mass-at-corners", mass_range, MassAtCorners((Bisection(),) * 2)
    yield "resting", RESTING, None
    yield "not-resting", Resting("tanh", None, (F(2),), (F(1),), (F(1, 2),)), None


def of_letters_and_numbers() -> Iterator[Row]:
    """Statements for every n, for small values, of angles, and about what is printed."""
    AY: Tree = ("apply", A, Y)
    yield "not-symmetric", EveryN(("dot", Z, AY), ("dot", Y, ("apply", A, Z))), None
    norms = (((A,), S), ((Y,), T), ((Z,), T))
    yield "norms", BoundEveryN(("dot", Z, AY), ("mul", S, ("pow", T, 2)), (), (), (), norms, ()), None
    yield "no-norms", BoundEveryN(("dot", Z, AY), ("mul", S, T), (), (), (), norms, ()), None
    positive = (Variable("x", F(0)),)
    yield "small", ForSmall("eps", positive, (), Relation(EPS, "<", X)), None
    shared = Relation(("mul", EPS, T), "<", ("mul", num(2), T))
    yield "small-shared", ForSmall("eps", (), (), shared, ("t",)), None
    yield "not-small", ForSmall("eps", positive, (), Relation(X, "<", EPS)), None
    yield "equal-entries", NormBound(("div", X, ("add", num(1), ("pow", X, 2))), 2, num(F(3, 4))), None
    yield "supremum", NormBound(("h", 2, X), 4, num(3)), None
    yield "square", ForAll(Relation(("mul", num(2), X), "<=", ("add", num(1), ("pow", X, 2)))), None
    yield "sine", TrigonometricBound(((("sin", X), F(1, 2)),)), None
    yield "positive", TrigonometricPositive((("add", num(2), ("sin", X)),)), None
    yield "not-positive", TrigonometricPositive((("add", num(F(1, 2)), ("sin", X)),)), None
    product: Tree = ("mul", X, ("var", "y"))
    yield "corners", Agrees(product, (("x", "1.5"), ("y", "1.5")), "2.4"), Corners((0, 0), (1, 1), 128)


def certificate(name: str, statement: Statement, proof: Proof | None) -> Certificate:
    """The certificate of a statement by its proof, or by the one that the search finds."""
    result = proof or propose(statement).proof
    if result is None:
        raise ValueError(f"{name}: no proof was found")
    accepted = verify(statement, result)
    about = About(name, statement.text()[:200], None, None, "extra")
    used = {name: version(name) for name in ("lyapcheck", "python-flint")}
    return Certificate(about, statement, accepted.verdict, accepted.grade, result, {}, used)


def main(folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    for rows in (of_the_arm(), of_chains(), of_the_loop(), of_letters_and_numbers()):
        for name, statement, proof in rows:
            text = certificate(name, statement, proof).text()
            (folder / f"{name}.json").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
