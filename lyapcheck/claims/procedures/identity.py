"""What computing decides: identities, by normal forms over ℚ or a point against them; relations of numbers.

References: ``geddes1992algorithms``, chapter 3; ``reyes2019family``, Section 4.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from itertools import islice, product
from random import Random

from flint import ctx

from lyapcheck.check.expressions.domain import holds
from lyapcheck.check.expressions.expression import Unsupported, ball, variables
from lyapcheck.check.expressions.normal_form import is_zero
from lyapcheck.check.kinds.constant import (
    Agrees,
    Constant,
    Corners,
    ExactNumbers,
    OutsideRounding,
    PrintedInputs,
    SeparateBalls,
    at_corner,
    at_printed,
    exact_truth,
    over_all,
    printed_range,
)
from lyapcheck.check.kinds.every_n import (
    EntriesWitness,
    EveryN,
    at_size,
    in_words,
    moved_at,
    names_of,
    rates_fit,
)
from lyapcheck.check.kinds.identity import (
    Compared,
    Gap,
    Identity,
    MovingPosture,
    NormalForm,
    SameHarmonics,
    differences,
    gap_of,
)
from lyapcheck.check.letters.entries import exact
from lyapcheck.check.numbers.balls import precision
from lyapcheck.check.numbers.polynomials import Enclosure, ball_of
from lyapcheck.check.refusal import Refused
from lyapcheck.check.statement import Proof, Relation
from lyapcheck.claims.procedures.search import (
    BITS,
    Point,
    Sides,
    first_refutation,
    point_of,
    witness_data,
    witness_of,
)
from lyapcheck.claims.search_result import (
    SearchResult,
    between,
    broken,
    entries,
    failing,
    procedure,
    shown,
    still_open,
)
from lyapcheck.rechecking.drawn_entries import doubt_identity, drawn, solved_at

METHOD = "identity"
TRIES, FIRST = 12, 2


@procedure(Identity)
def find_identity(statement: Identity) -> SearchResult:
    """Try a few points where both sides may differ, then the normal forms, then more points."""
    places = points(statement)
    refuted = _refuted(statement, islice(places, FIRST))
    if refuted is not None:
        return refuted
    try:
        if is_zero(gap_of(statement)):
            return shown(NormalForm(), f"{METHOD}: equal normal forms over the rationals")
        advice = (
            "the normal forms differ but no point tells the sides apart; apply laws of log or atan by hand"
        )
    except Unsupported as problem:
        advice = f"{problem}; rewrite both sides in polynomials, exp, sinh, cosh, sin, cos"
    return _refuted(statement, places) or still_open(advice, METHOD)


def _refuted(statement: Identity, places: Iterator[Point]) -> SearchResult | None:
    result = first_refutation((statement.left, "=", statement.right), places)
    if result is None:
        return None
    return broken(witness_of(result), f"{METHOD}: a point where the sides differ", witness_data(result))


def points(statement: Identity) -> Iterator[Point]:
    """Rational points without symmetry: variables get different values, of both signs where they may."""
    lows = {variable.name: variable.low for variable in statement.variables}
    for k in range(TRIES):
        spread = {name: _spread(k, i) for i, name in enumerate(sorted(statement.names))}
        yield {
            name: value if (low := lows.get(name)) is None else low + abs(value)
            for name, value in spread.items()
        }


def _spread(k: int, i: int) -> Fraction:
    """A fixed low-discrepancy rational in (-2, 2), never 0, positive for k = 0."""
    value = Fraction((37 * (i + 1) + 101 * k) % 997 + 1, 499)
    return value if k == 0 else value * (-1) ** (i * k)


# --- Polynomials of an arm that should be the same: by their harmonics, else a posture that tells them apart.


COMPARISON = "comparison of polynomials in normal form"
POSTURES = 40


@procedure(Compared)
def find_compared(statement: Compared) -> SearchResult:
    """The harmonics of all differences, else a posture at which the first that is left is not 0."""
    gap = next((gap for gap in statement.gaps() if gap[2]), None)
    if gap is None:
        return shown(SameHarmonics(), COMPARISON)
    for posture in _postures(statement, gap):
        with precision(BITS):
            value = next(value for place, value in differences(statement, posture) if place == gap[0])
            if value.contains(0):
                continue
            left = Enclosure.from_arb(value)
        rates = posture.x if any(rates for _, rates, _ in statement.gaps()) else ()
        witness = failing(entries(q=posture.q, p=posture.parameters, w=rates), left, "=", 0)
        return replace(broken(posture, COMPARISON, witness), reason=f"they differ in {_words(gap)}")
    return still_open(f"they differ in {_words(gap)}, and no posture shows it; compare by hand", COMPARISON)


def _words(gap: Gap) -> str:
    place, rates, _ = gap
    factor = " ".join(f"w{k + 1}" for k in rates)
    return f"{place} (the factor of {factor})" if rates else place


def _postures(statement: Compared, gap: Gap) -> Iterator[MovingPosture]:
    """Angles without symmetry, ends of the ranges of parameters, and rates: those of the gap first."""
    joints = range(statement.joints)
    chosen = tuple(Fraction(int(k in gap[1] or not gap[1])) for k in joints)
    for step in range(1, POSTURES):
        q = tuple(Fraction(step * (2 * i + 1), 2 * i + 2) for i in joints)
        parameters = tuple(ends[step % 2] for ends in statement.parameters)
        yield MovingPosture(q, parameters, chosen)
        yield MovingPosture(q, parameters, tuple(Fraction(i + 1) for i in joints))


# --- Identities for every n, proved by normal forms of words xᵀ A B … y and refuted by entries for some n.
#
# References: ``geddes1992algorithms``, chapter 3.

EVERY_N = "identity for every n"
SIZES = (1, 2, 3)
TRIES_EVERY_N = 4
SEED = 1


@procedure(EveryN)
def find_every_n(statement: EveryN) -> SearchResult:
    """Try the normal forms in words, then entries for n = 1, 2, 3."""
    try:
        statement.require_well_formed()
        if not rates_fit(statement):
            return still_open("a symmetric matrix has a derivative that is not; correct it", EVERY_N)
        if is_zero(in_words(statement)):
            return _proved(statement)
    except Refused as refusal:
        return still_open(f"{refusal}; correct the statement", EVERY_N)
    except Unsupported as problem:
        return still_open(f"{problem}; write both sides in sums, products and quotients", EVERY_N)
    seen = "no entries for n = 1, 2, 3 tell the sides apart"
    for n, point in _attempts(statement):
        try:
            result = _difference(statement, n, point)
            moved_at(statement, n, point)
        except Refused as refusal:
            seen = str(refusal)
            continue
        except (Unsupported, ZeroDivisionError):
            continue
        if result is not None:
            return result
    return still_open(f"the normal forms differ, but {seen}; compare by hand", EVERY_N)


def _proved(statement: EveryN) -> SearchResult:
    """Equal words, unless entries that are drawn say otherwise, or none are found."""
    try:
        doubt_identity(statement)
    except Refused as doubt:
        return still_open(str(doubt), EVERY_N)
    return shown(NormalForm(), f"{EVERY_N}: equal normal forms in words of vectors and matrices")


def _attempts(statement: EveryN) -> Iterator[tuple[int, Point]]:
    """Entries that meet what is given: small rational numbers, then one linear system for each vector."""
    random = Random(SEED)
    for n in SIZES:
        for _ in range(TRIES_EVERY_N):
            names = names_of(statement, n)
            try:
                yield n, solved_at(statement, n, drawn(names, statement.positive, random))
            except (Unsupported, ZeroDivisionError):
                continue


def _difference(statement: EveryN, n: int, point: Point) -> SearchResult | None:
    """The finding that both sides differ at a point, if they do."""
    sides, _ = at_size(statement, n)
    left, right = (exact(side, point) for side in sides)
    if left == right:
        return None
    data = failing({"n": n, **dict(sorted(point.items()))}, [str(left)] * 2, "=", [str(right)] * 2)
    return broken(EntriesWitness(n, point_of(point)), f"{EVERY_N}: entries at which the sides differ", data)


# --- Relations between numbers, in balls of growing precision or exactly; numbers as texts print them.


NUMBERS = "relation between numbers"
PRECISIONS = (128, 512, 2048)


@procedure(Constant)
def find_constant(statement: Constant) -> SearchResult:
    """Decide a relation between numbers."""
    return find_relation(statement.relation, NUMBERS)


def find_relation(relation: Relation, method: str) -> SearchResult:
    """Compare both sides exactly, or in balls of growing precision."""
    exact = exact_truth(relation)
    if exact is not None:
        return _found(relation, exact, ExactNumbers(), f"{method}: exact arithmetic", PRECISIONS[0])
    for bits in PRECISIONS:
        with ctx.workprec(bits):
            truth = holds(relation.comparison, {})
        if truth is not None:
            return _found(relation, truth, SeparateBalls(bits), f"{method}: balls of {bits} bits", bits)
    return still_open(
        f"both sides agree to {PRECISIONS[-1]} bits; if they are equal, state it as an identity", method
    )


def _found(relation: Relation, truth: bool, proof: Proof, method: str, bits: int) -> SearchResult:
    if truth:
        return shown(proof, method)
    with ctx.workprec(bits):
        left, right = (Enclosure.from_arb(ball(side)) for side in (relation.left, relation.right))
    return broken(proof, method, witness_data((relation.comparison, {}, Sides(left, right))))


# --- Printed numbers: whether a result that a text prints agrees with the numbers it prints beside it.
#
# A number printed as 0.5934 stands for some real in [0.59335, 0.59345]. The printed result agrees if some
# choice of inputs within their half units gives a result within its half unit; it disagrees if none does.


PRINTED = "arithmetic on printed numbers"
PRINTED_BITS = 128


@procedure(Agrees)
def find_agrees(statement: Agrees) -> SearchResult:
    """Compare the formula at the printed inputs, over all their roundings and at the corners of these."""
    target, exact = printed_range(statement.printed), at_printed(statement, PRINTED_BITS)
    computed = {"computed": between(exact, 8), "printed": statement.printed}
    if target.lower <= exact.lower and exact.upper <= target.upper:
        return shown(PrintedInputs(PRINTED_BITS), f"{PRINTED}: the printed inputs give it", **computed)
    whole = over_all(statement, PRINTED_BITS)
    if whole.upper < target.lower or whole.lower > target.upper:
        method = f"{PRINTED}: no inputs within their rounding give it"
        sides = failing(dict(statement.inputs), exact, "=", target) | {"printed": statement.printed}
        return broken(OutsideRounding(PRINTED_BITS), method, sides | _needed(statement, target))
    # A corner of the roundings with a result below the printed one, and one above
    all_ends = list(product((0, 1), repeat=len(statement.inputs)))
    values = [(ends, at_corner(statement, ends, PRINTED_BITS)) for ends in all_ends]
    below = next((ends for ends, value in values if value.upper <= target.upper), None)
    above = next((ends for ends, value in values if value.lower >= target.lower), None)
    if below is not None and above is not None:
        corners = Corners(below, above, PRINTED_BITS)
        return shown(corners, f"{PRINTED}: within the rounding of the inputs", **computed)
    return still_open(
        "the rounding of the inputs leaves it open; use more digits of the inputs", PRINTED, **computed
    )


def _needed(statement: Agrees, target: Enclosure) -> dict[str, object]:
    """The value of one input that would give the printed result, when the result is proportional to it."""
    name = statement.solve_for
    if name is None:
        return {}
    kind, *factors = statement.formula
    rest = [factor for factor in factors if factor != ("var", name)]
    if kind != "mul" or len(rest) != len(factors) - 1 or any(name in variables(factor) for factor in rest):
        return {}
    at_one = ("mul", ("num", "1"), *rest)
    others = {key: ball_of(Fraction(text)) for key, text in statement.inputs if key != name}
    with ctx.workprec(PRINTED_BITS):
        value = Enclosure.from_arb(target.to_arb() / ball(at_one, others))
    return {f"{name} that gives it": between(value, 6)}
