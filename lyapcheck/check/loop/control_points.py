"""Matrices of trigonometric polynomials that are positive definite at all angles, seen at control points.

Let f be of degree D, f(t) = Σ f_k e^{ikt}, and x_i = (i + ½)h for a step h = 2π/N, N > 2D. The convolution
B of the functions e^{ikt} on |t| ≤ h/2, k = −D, …, D, is real and not negative: that of k and −k is
sin(k(h − |t|))/k on |t| ≤ h. By Poisson's formula Σ_i e^{ik x_i} B(t − x_i) = c_k e^{ikt} for |k| ≤ D, as
the transform of B vanishes at k + Nm, m ≠ 0. So with weights w_i(t) = B(t − x_i)/c_0 ≥ 0, Σ w_i = 1, and
the control points F(x_i) of F, which has the coefficients f_k/ρ_k,

    f(t) = Σ_i w_i(t) F(x_i),     ρ_k = c_k/c_0 = Π_{j=1..k} (D−j+1) sin((D+j)h/2) / ((D+j) sin((D−j+1)h/2)).

As e^{ikt} on |t| ≤ h/2 is the sum of two such functions of half the width, turned by e^{± ikh/4}, B is a
sum of 2D + 2 shifted ones for h/2 with the coefficients of (z + z⁻¹) Π_{k=1..D} (z² + 2 cos(kh/2) + z⁻²),
none negative: each control point for h/2 is a sum, with these weights, of those for h that it comes from.
Of several angles one is taken after the other. What comes from positive definite matrices alone is positive
definite: so only what comes from another one is looked at again.

References: trigonometric splines, ``schoenberg1964trigonometric``.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby, product
from operator import itemgetter

from flint import arb, arb_mat, ctx, fmpq

from lyapcheck.check.refusal import require

BITS = 64
MOST, MOST_AROUND = 200_000, 4096
"""Control points that are looked at, and N."""
MOST_START, MOST_HALVINGS = 32, 24
"""Control points of an angle to begin with, and halvings."""
Point = tuple[int, ...]


def nodes(degree: int, angles: int) -> list[tuple[fmpq, ...]]:
    """The angles, in units of π, at which trigonometric polynomials are given; the last one runs first.

    Args:
        degree: D in each angle.
        angles: how many there are.
    """
    circle = [fmpq(2 * j, 2 * degree + 1) for j in range(2 * degree + 1)]
    return list(product(circle, repeat=angles))


def require_points(start: Sequence[int], halvings: Sequence[int], degree: int, angles: int) -> None:
    """Refuse other numbers of control points than so many angles and such a degree ask for.

    Raises:
        Refused: at the first fault.
    """
    fewest = 2 * degree + 1
    require(len(start) == angles, "start", len(start), f"must be {angles} numbers")
    enough = all(fewest <= count <= MOST_START for count in start)
    require(enough, "start", start, f"must be numbers from {fewest} to {MOST_START}")
    require(len(halvings) <= MOST_HALVINGS, "halvings", len(halvings), f"must be {MOST_HALVINGS} at most")
    require(all(0 <= axis < angles for axis in halvings), "halvings", halvings, "must number those angles")


def definite_at_all_angles(
    values: Iterable[list[arb]], degree: int, start: Sequence[int], halvings: Sequence[int]
) -> bool:
    """Whether a symmetric matrix of trigonometric polynomials is shown positive definite at all angles.

    Args:
        values: the entries on and below the diagonal, by rows, at each of `nodes`.
        degree: D ≥ 1 of the polynomials, in each angle; not above what it is said to be.
        start: N of each angle, above 2D.
        halvings: of which angle, counted from 0, the step is halved next, at what is left.
    """
    counts, seen = list(start), 0
    if min(counts) <= 2 * degree or not set(halvings) <= {*range(len(counts))}:
        return False
    with ctx.workprec(BITS):
        table = [entry for entries in values for entry in entries]
        points = list(product(*map(range, counts)))
        for axis in (*halvings, None):
            seen += len(points)
            if seen > MOST:
                return False
            weights = [control_weights(count, degree) for count in counts]
            left = [point for point, entries in _control(table, weights, points) if not _definite(entries)]
            if not left or axis is None:
                return not left
            counts[axis] *= 2
            # half the step takes at least two points for each one
            if counts[axis] > MOST_AROUND or seen + 2 * len(left) > MOST:
                return False
            points = children(left, axis, degree, counts[axis])
    return False


def children(points: Iterable[Point], axis: int, degree: int, count: int) -> list[Point]:
    """The control points at half the step of an angle that come from some of those at the whole, in order.

    Args:
        points: those.
        axis: the angle.
        degree: D.
        count: N at half the step.
    """
    reach = range(-degree, degree + 2)
    return sorted({(*p[:axis], (2 * p[axis] + i) % count, *p[axis + 1 :]) for p in points for i in reach})


def control_weights(count: int, degree: int) -> list[list[arb]]:
    """What makes of the values at 2D + 1 equally spaced angles the control points, (count, 2D + 1)."""
    size, rho, growth = 2 * degree + 1, arb(1), []
    for j in range(1, degree + 1):
        low, high = degree - j + 1, degree + j
        rho *= low * arb(fmpq(high, count)).sin_pi() / (high * arb(fmpq(low, count)).sin_pi())
        growth.append(2 / rho)
    return [
        [_kernel(fmpq(2 * i + 1, count) - fmpq(2 * j, size), growth) / size for j in range(size)]
        for i in range(count)
    ]


def _kernel(angle: fmpq, growth: Sequence[arb]) -> arb:
    return sum((g * arb(k * angle).cos_pi() for k, g in enumerate(growth, 1)), arb(1))


def _control(
    values: list[arb], weights: Sequence[list[list[arb]]], points: Sequence[Point]
) -> Iterator[tuple[Point, list[arb]]]:
    """Each point, of points in order, with the entries of its matrix."""
    first, *others = weights
    size = len(first[0])
    rest = len(values) // size
    table = arb_mat(size, rest, values)
    if not others:
        entries = (arb_mat([first[point[0]] for point in points]) * table).entries()
        for k, point in enumerate(points):
            yield point, entries[k * rest : (k + 1) * rest]
        return
    for place, group in groupby(points, key=itemgetter(0)):
        line = (arb_mat([first[place]]) * table).entries()
        for point, entries in _control(line, others, [point[1:] for point in group]):
            yield (place, *point), entries


def _definite(entries: list[arb]) -> bool:
    """Whether a symmetric matrix is positive definite, by elimination: all its pivots are positive."""
    rows: list[list[arb]] = []
    start = 0
    while start < len(entries):
        rows.append(entries[start : start + len(rows) + 1])
        start += len(rows)
    for k, row in enumerate(rows):
        pivot = row[k]
        if not pivot > 0:
            return False
        for i in range(k + 1, len(rows)):
            other = rows[i]
            factor = other[k] / pivot
            for j in range(k + 1, i + 1):
                other[j] -= factor * rows[j][k]
    return True
