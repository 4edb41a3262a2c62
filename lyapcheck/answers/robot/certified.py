"""Ends of the constants of an arm that certificates show, beside those of floating point.

The end that a state shows is a bound refuted at a posture; the other is shown for all angles: for few joints
by boxes, or by storage forms along the links where these show more; for more joints by such forms, and else
by the sizes of harmonics, which are coarse.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np

from lyapcheck._types import SEED
from lyapcheck.answers.robot.properties import PropertyQuestion, PropertyResult
from lyapcheck.asked import bound_of_constant
from lyapcheck.check.kinds.chain import (
    ChainAbove,
    ChainBelow,
    ChainCoriolisBelow,
    ChainGravityBelow,
    NoTorque,
    OfLinks,
)
from lyapcheck.check.kinds.coriolis import CoriolisBelow
from lyapcheck.check.kinds.gravity import GravityBelow
from lyapcheck.check.kinds.inertia import Bisection, HarmonicSizes, MassAbove, MassBelow, PostureWitness
from lyapcheck.check.loop.field import size_of
from lyapcheck.check.numbers.balls import precision, to_arb
from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.check.statement import Proof, Statement
from lyapcheck.claims.bounds import ArmBounds
from lyapcheck.claims.search_result import SearchResult, broken, entries, failing, shown
from lyapcheck.constants import ConstantResult
from lyapcheck.constants.spectrum import ArmHarmonics
from lyapcheck.constants.storage import BoundWithProof, storage_proof
from lyapcheck.files.decimals import decimal_text
from lyapcheck.output.digits import decimals
from lyapcheck.robots import RobotModel
from lyapcheck.robots.dynamics import FEW_JOINTS, Chain, TooManyTerms
from lyapcheck.robots.trig import to_terms
from lyapcheck.verdicts import Grade

BOXES = 2000
"""How many boxes the search may take for one bound."""
DIGITS = 6
MARGINS = (Fraction(1, 10**5), Fraction(1, 10**3), Fraction(1, 50))
"""How far from the floating-point end a bound may be, relative to it; the smallest that is shown counts."""
MARGINS_OF_CORIOLIS = (Fraction(1, 200), Fraction(1, 20))
"""The same for k_c, from the norms that boxes can show, as its boxes cost more."""
SAMPLES = 4096
"""Postures at which these norms are taken."""
NEAR = Fraction(1, 10**4)
"""Where a bound is so near what is reached, relative to it, forms along the links are not asked."""
BITS = 64
_ABOVE = (MassBelow, CoriolisBelow, GravityBelow, ChainBelow, ChainGravityBelow, ChainCoriolisBelow)
SYMBOLS = {"lambda_min": "λmin(M)", "lambda_max": "λmax(M)"}


@dataclass(frozen=True)
class CertifiedBounds:
    """Both ends as certificates show them; none where there is none."""

    lower: Fraction | None = None
    upper: Fraction | None = None


_Outer = tuple[Statement, Fraction, SearchResult]
"""A bound for all angles: the statement, its number, and by what it is shown."""


@dataclass(frozen=True)
class _Bound:
    """How one constant is bounded.

    Args:
        state: a bound of it as a statement.
        proof: of a bound, if one is found.
        start: about the best that can be shown.
        sizes: what the sizes of harmonics show; none for λmin(M).
        witness: the posture that shows the other end.
        seen: the constant there.
        margins: those that are tried.
    """

    state: Callable[[Fraction], Statement]
    proof: Callable[[Fraction], Proof | None]
    start: Fraction
    sizes: Fraction | None
    witness: PostureWitness
    seen: Fraction
    margins: tuple[Fraction, ...] = MARGINS


def bound_questions(model: RobotModel, constants: Sequence[ConstantResult]) -> Iterator[PropertyQuestion]:
    """Bounds of the constants of an arm at nominal parameters, two a constant at most."""
    arm, nominal = ArmBounds(model), model.fixed()
    chain = nominal.chain if model.n <= FEW_JOINTS else None
    for constant in constants:
        if constant.shown is not None:
            yield from _along_links(constant, constant.shown, nominal)
            continue
        try:
            with precision(BITS):
                bound = _bound(arm, constant)
        except TooManyTerms:
            continue
        sign = _sign(constant.name)
        outer = _outer(arm.robot.n, constant.name, bound, sign, chain)
        if outer is not None:
            yield _question(nominal, constant.name, *outer)
        yield from _inside(nominal, constant.name, bound.state, bound.witness, bound.seen)


def _along_links(
    constant: ConstantResult, outside: BoundWithProof, nominal: RobotModel
) -> Iterator[PropertyQuestion]:
    """Both ends of a constant of a chain: its storage forms, and the posture."""
    result = shown(outside.proof, outside.proof.rule)
    yield _question(nominal, constant.name, outside.statement, outside.bound, result)
    ends, n = constant.enclosure, len(outside.statement.links)
    seen = ends.lower if _sign(constant.name) > 0 else ends.upper
    state = [Fraction(x).limit_denominator(10**7) for x in constant.state]
    witness = PostureWitness(tuple(state[:n]), (), tuple(state[n:]))
    yield from _inside(nominal, constant.name, outside.at_end, witness, seen)


def _sign(name: str) -> int:
    """1 where the bound for all angles is from above."""
    return -1 if name == "lambda_min" else 1


def _inside(
    nominal: RobotModel,
    name: str,
    state: Callable[[Fraction], Statement],
    witness: PostureWitness,
    seen: Fraction,
) -> Iterator[PropertyQuestion]:
    """The end that a posture shows: a little to the safe side of it."""
    sign = _sign(name)
    inner = max(_rounded(seen * (1 - sign * Fraction(1, 10**6)), -sign), Fraction(0))
    if inner > 0 or sign < 0:
        where = entries(q=witness.q, x=witness.x)
        result = broken(witness, "a posture", failing(where, seen, "≤" if sign > 0 else ">", inner))
        yield _question(nominal, name, state(inner), inner, result, inside=True)


def certified(answers: Sequence[PropertyResult], positive: bool) -> dict[str, CertifiedBounds]:
    """The ends that the checker has accepted, by the name of the constant.

    Args:
        answers: to ``bound_questions``.
        positive: whether M ≻ 0 is proved: only then ‖M‖ > b, which the refutation of ‖M‖ ≤ b comes to, is a
            statement about λmax(M).
    """
    result: dict[str, CertifiedBounds] = {}
    for answer in answers:
        name, _, side = answer.id.rpartition(".")
        if answer.certificate is None or (name == "lambda_max" and side == "lower" and not positive):
            continue
        value = _value(answer.certificate.statement)
        known = result.get(name, CertifiedBounds())
        result[name] = replace(known, lower=value) if side == "lower" else replace(known, upper=value)
    return result


def _value(statement: Statement) -> Fraction:
    if isinstance(statement, (MassAbove, ChainAbove)):
        return statement.low
    if isinstance(statement, _ABOVE):
        return statement.high
    raise TypeError(f"{type(statement).__name__} is no bound of a constant")


def _question(
    nominal: RobotModel,
    name: str,
    statement: Statement,
    value: Fraction,
    finding: SearchResult,
    inside: bool = False,
) -> PropertyQuestion:
    """A bound; what is asked is about the arm and the number as it is printed."""
    grade = Grade.EXACT if isinstance(finding.proof, (HarmonicSizes, NoTorque)) else Grade.ENCLOSURE
    printed, above = decimal_text(value), _sign(name) > 0
    words = f"{SYMBOLS.get(name, name)} {'<=' if above else '>'} {printed}"
    asked = bound_of_constant(name, nominal, Fraction(printed), isinstance(statement, OfLinks))
    side = "upper" if above != inside else "lower"
    return PropertyQuestion(f"{name}.{side}", words, statement, replace(finding, grade=grade), asked)


def _outer(n: int, name: str, bound: _Bound, sign: int, chain: Chain | None) -> _Outer | None:
    """The best bound for all angles that is shown, and by what."""
    best: _Outer | None = None
    if bound.sizes is not None:
        coarse = _rounded(bound.sizes, sign)
        best = bound.state(coarse), coarse, shown(HarmonicSizes(), HarmonicSizes.rule)
    if n > FEW_JOINTS:
        return best
    # forms along the links take less time than the boxes that they spare
    return _by_search(bound, sign, _by_links(bound, name, sign, chain, best))


def _by_search(bound: _Bound, sign: int, best: _Outer | None) -> _Outer | None:
    """What boxes show, if that is better than what is known."""
    for margin in bound.margins:
        value = _rounded(bound.start * (1 + sign * margin), sign)
        if best is not None and sign * best[1] <= sign * value:
            break
        proof = bound.proof(value) if value > 0 else None
        if proof is not None:
            return bound.state(value), value, shown(proof, proof.rule)
    return best


def _by_links(bound: _Bound, name: str, sign: int, chain: Chain | None, best: _Outer | None) -> _Outer | None:
    """What forms along the links show, if that is better than what is known, unless that is near enough."""
    enough = sign * bound.seen + abs(bound.seen) * NEAR
    if chain is None or (best is not None and sign * best[1] <= enough):
        return best
    outside = storage_proof(chain, name)
    if outside is None or (best is not None and sign * best[1] <= sign * outside.bound):
        return best
    return outside.statement, outside.bound, shown(outside.proof, outside.proof.rule)


def _bound(arm: ArmBounds, constant: ConstantResult) -> _Bound:
    q = tuple(Fraction(x).limit_denominator(10**6) for x in constant.state[: arm.robot.n])
    if constant.name in ("lambda_min", "lambda_max"):
        return _of_mass(arm, constant, q)
    return _of_coriolis(arm, constant, q) if constant.name == "k_c" else _of_gravity(arm, constant, q)


def _of_mass(arm: ArmBounds, constant: ConstantResult, q: tuple[Fraction, ...]) -> _Bound:
    low, mass, inertia = constant.name == "lambda_min", arm.mass, arm.inertia
    rows = np.array([[float(entry) for entry in row] for row in inertia.at(q, ())])
    vector = np.linalg.eigh(rows)[1][:, 0 if low else -1]
    x = tuple(Fraction(float(entry)).limit_denominator(10**6) for entry in vector)
    v = np.array([float(entry) for entry in x])
    seen = float(v @ rows @ v / (v @ v)) if low else float(np.linalg.norm(rows @ v) / np.linalg.norm(v))
    witness = PostureWitness(q, (), x)
    if low:
        return _Bound(
            lambda value: MassAbove(mass, (), value),
            lambda value: _boxes(inertia.above([value] * inertia.n, BOXES)),
            constant.enclosure.lower,
            None,
            witness,
            Fraction(seen),
        )
    return _Bound(
        lambda value: MassBelow(mass, (), value),
        lambda value: _boxes(inertia.below(value, BOXES)),
        constant.enclosure.upper,
        inertia.largest_row,
        witness,
        Fraction(seen),
    )


def _of_coriolis(arm: ArmBounds, constant: ConstantResult, q: tuple[Fraction, ...]) -> _Bound:
    mass, inertia = arm.mass, arm.inertia
    x = tuple(Fraction(entry).limit_denominator(10**6) for entry in constant.state[arm.robot.n :])
    balls = [to_arb(entry) for entry in x]
    turned = [float(entry) for entry in inertia.coriolis(q, (), balls, balls)]
    size = float(sum(entry * entry for entry in x))
    return _Bound(
        lambda value: CoriolisBelow(mass, (), value),
        lambda value: _boxes(inertia.coriolis_below(value, BOXES)),
        _unfolded(arm.robot) if arm.robot.n <= FEW_JOINTS else Fraction(0),
        arm.kc,
        PostureWitness(q, (), x, x),
        Fraction(float(np.linalg.norm(turned)) / size),
        MARGINS_OF_CORIOLIS,
    )


def _of_gravity(arm: ArmBounds, constant: ConstantResult, q: tuple[Fraction, ...]) -> _Bound:
    robot = arm.robot
    joints = range(robot.n) if constant.name == "k_g" else [int(constant.name.removeprefix("k_g")) - 1]
    gravity = tuple(tuple(to_terms(robot.gravity[i])) for i in joints)

    def state(value: Fraction) -> GravityBelow:
        return GravityBelow(robot.n, gravity, (), value)

    entries = state(Fraction(0)).entries
    square = sum((size_of(entry, ()) ** 2 for entry in entries), Fraction(0))
    seen = np.linalg.norm([float(value) for value in state(Fraction(0)).at(q, ())])
    return _Bound(
        state,
        lambda value: _boxes(state(value).shown_by_boxes(BOXES)),
        constant.enclosure.upper,
        size_of(entries[0], ()) if len(entries) == 1 else _root(square),
        PostureWitness(q, (), ()),
        Fraction(float(seen)),
    )


def _unfolded(robot: RobotModel) -> Fraction:
    """About the least bound of ‖C(q, x)y‖ that boxes can show: that of the better unfolding of the c_ijk."""
    arm = ArmHarmonics(robot)
    states = np.random.default_rng(SEED).uniform(-np.pi, np.pi, (SAMPLES, robot.n))
    c = arm.tensor(arm.symbols.at(states))
    both = (np.einsum("bijk,bijl->bkl", c, c), np.einsum("bijk,bljk->bil", c, c))
    tops = [np.linalg.eigvalsh(square)[:, -1] for square in both]
    return _root(Fraction(float(max(np.max(np.minimum(*tops)), 0.0))))


def _boxes(show: bool) -> Bisection | None:
    return Bisection() if show else None


def _root(square: Fraction) -> Fraction:
    """√, rounded up."""
    with precision(BITS):
        return Enclosure.from_arb(to_arb(square).sqrt()).upper


def _rounded(value: Fraction, sign: int) -> Fraction:
    """The nearest decimal number of a few digits that is not below (sign > 0), or not above."""
    return Fraction(decimals(Enclosure.exact(value), DIGITS)[1 if sign > 0 else 0])
