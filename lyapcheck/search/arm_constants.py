"""Certified constants of any arm from both sides, wider where the budget of boxes ends.

    λmin(M), λmax(M) = β_M,     k_g = sup ‖g(q)‖,     k_gi = sup |g_i(q)|,     k_c = sup ‖C(q,x)y‖ / (‖x‖‖y‖).

With the symmetric matrices S_i = (c_ijk)_jk the last one obeys, for ‖x‖ = 1,

    ‖C(q,x)y‖² ≤ λmax(Σ_i S_i²) ‖y‖²     and     ‖C(q,x)y‖ ≤ ‖(c_i,jk)‖ ‖y‖,

the two unfoldings of the Christoffel symbols. It is reached with x = y, for C(q,x)y is symmetric in x and y.

Over a box each of these is bounded at the corners of a linear part, because eigenvalues and norms are convex
functions of the entries (λmin is concave); near an extremum that leaves an error of second order.

References: properties 2.1, 2.2, 2.6 and 2.8 of reyes2019family.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from math import sqrt

import numpy as np
from numpy.typing import NDArray

from lyapcheck.check.enclosure import Enclosure
from lyapcheck.robots import RobotModel
from lyapcheck.search.arm_waves import ArmWaves
from lyapcheck.search.maximise import Bounds, maximise
from lyapcheck.search.spectrum import eigenvalues, largest_eigenvalue, largest_norm, smallest_eigenvalue
from lyapcheck.search.torus import Torus

Array = NDArray[np.float64]
Progress = Callable[[float, str], None]

PI_ABOVE = 3.1415926535897936
GAP = 1e-3
MAX_BOXES = 60_000
SEED = 20190301
_SAMPLES = 1024
_BLOCK = 64
_ROUNDS = 40
_TURNS = 5


@dataclass(frozen=True)
class Constant:
    """One constant of an arm: its enclosure, a state that shows the inside end, and the boxes it took.

    Args:
        name: ``lambda_min``, ``lambda_max``, ``k_c``, ``k_g`` or ``k_g1`` and so on.
        unit: SI unit.
        enclosure: both sides.
        state: angles in rad; for k_c followed by the components of x.
        boxes: looked at.
    """

    name: str
    unit: str
    enclosure: Enclosure
    state: tuple[float, ...]
    boxes: int

    @property
    def gap(self) -> float:
        """Width of the enclosure relative to its larger end."""
        size = max(abs(self.enclosure.lower), abs(self.enclosure.upper))
        return float(self.enclosure.width / size) if size else 0.0


def arm_constants(
    model: RobotModel, max_boxes: int = MAX_BOXES, gap: float = GAP, on_progress: Progress | None = None
) -> tuple[Constant, ...]:
    """λmin(M), λmax(M), k_c, k_g and every k_gi of an arm whose parameters stand at their nominal values.

    Args:
        model: the arm, of any number of joints.
        max_boxes: how many boxes each constant may take.
        gap: relative width of an enclosure that is good enough.
        on_progress: told the share of the work done.

    Returns:
        The constants; where the budget did not suffice their enclosures are wider than ``gap``.

    Soundness: floating point with residuals and bounds of its error beforehand, see `lyapcheck.search.torus`
        and `lyapcheck.search.spectrum`; the inside ends are bounds at the state given.
    """
    arm = ArmWaves(model)
    tasks = [_lambda_min(arm), _lambda_max(arm), _coriolis(arm), _gravity(arm, "k_g", range(arm.n))]
    tasks += [_gravity(arm, f"k_g{i + 1}", [i]) for i in range(arm.n)]
    found = []
    for step, task in enumerate(tasks):

        def tell(fraction: float, note: str, step: int = step, name: str = task.name) -> None:
            if on_progress is not None:
                on_progress((step + fraction) / len(tasks), f"{name}: {note}")

        tell(0.0, "sampling")
        found.append(_solve(task, arm.n, max_boxes, gap, tell))
    return tuple(_with_chain(model, constant) for constant in found)


def _with_chain(model: RobotModel, constant: Constant) -> Constant:
    """The enclosure met with what the links alone say, which wins where the budget is far too small."""
    chain, old = model.chain_bounds, constant.enclosure
    if chain is None:
        return constant
    if constant.name == "lambda_min":
        return replace(constant, enclosure=Enclosure(max(old.lower, chain.lambda_min), old.upper))
    tops = {"lambda_max": chain.lambda_max, "k_g": _length(chain.gravity)}
    tops |= {f"k_g{i + 1}": top for i, top in enumerate(chain.gravity)}
    if chain.k_c is not None:
        tops["k_c"] = chain.k_c
    top = min(old.upper, tops.get(constant.name, old.upper))
    return replace(constant, enclosure=Enclosure(old.lower, top))


def _length(vector: Sequence[Fraction]) -> Fraction:
    """The length of a vector, rounded up."""
    square = sum((x * x for x in vector), Fraction(0))
    return Fraction(sqrt(square)) * (1 + Fraction(1, 10**12))


@dataclass(frozen=True)
class _Task:
    """A constant as the supremum of a function of the coordinates; ``sign`` −1 means that of its negative."""

    name: str
    unit: str
    torus: Torus
    bounds: Bounds
    weight: Array
    sign: int = 1
    direction: Callable[[Array], Array] | None = None


def _solve(task: _Task, n: int, max_boxes: int, gap: float, tell: Progress) -> Constant:
    half = np.zeros(n)
    half[list(task.torus.angles)] = PI_ABOVE

    def influence(middle: Array, width: Array) -> Array:
        return task.torus.influence(width, task.weight)

    start = _climb(lambda q: task.bounds(q, np.zeros_like(q))[0], half)
    found = maximise(half, task.bounds, influence, start[None], max_boxes, gap, tell)
    ends = sorted(Fraction(task.sign * x) for x in (found.inside, found.outside))
    low, high = (max(x, Fraction(0)) for x in ends) if task.name != "lambda_min" else ends
    coordinates = np.array(found.state)
    state = tuple(task.torus.angles_at(coordinates).tolist())
    if task.direction is not None:
        state = (*state, *task.direction(coordinates).tolist())
    return Constant(task.name, task.unit, Enclosure(low, high), state, found.boxes)


def _lambda_max(arm: ArmWaves) -> _Task:
    def bounds(middle: Array, half: Array) -> tuple[Array, Array]:
        reach = arm.mass.on(middle, half)
        centre = arm.matrix(reach.middle)
        values, distance, _ = eigenvalues(centre)
        return values[:, -1] - distance - _lost(arm.mass), largest_eigenvalue(
            centre, arm.matrix(reach.radius)
        )

    return _Task("lambda_max", "kg·m²", arm.mass, bounds, np.ones(len(arm.places)))


def _lambda_min(arm: ArmWaves) -> _Task:
    size = arm.matrix(arm.mass.slack[None])[0].diagonal()
    weight = np.array([1 / sqrt(size[i] * size[j]) if size[i] * size[j] > 0 else 1.0 for i, j in arm.places])

    def bounds(middle: Array, half: Array) -> tuple[Array, Array]:
        reach = arm.mass.on(middle, half)
        values, distance, _ = eigenvalues(arm.matrix(reach.middle))
        low = smallest_eigenvalue(arm.matrix(reach.corners()), arm.matrix(reach.radius)[:, None])
        return -values[:, 0] - distance - _lost(arm.mass), -np.min(low, axis=1)

    return _Task("lambda_min", "kg·m²", arm.mass, bounds, weight, sign=-1)


def _gravity(arm: ArmWaves, name: str, joints: Sequence[int]) -> _Task:
    torus = Torus([arm.gravity[i] for i in joints], arm.n)

    def bounds(middle: Array, half: Array) -> tuple[Array, Array]:
        reach = torus.on(middle, half)
        size = np.sqrt(np.sum(reach.middle**2, axis=1))
        most = np.sqrt(np.sum((np.abs(reach.corners()) + reach.radius[:, None]) ** 2, axis=2))
        return size * (1 - 1e-14) - _lost(torus), np.max(most, axis=1) * (1 + 1e-14)

    return _Task(name, "N·m", torus, bounds, np.ones(len(joints)))


def _coriolis(arm: ArmWaves) -> _Task:
    n, torus = arm.n, arm.symbols

    def bounds(middle: Array, half: Array) -> tuple[Array, Array]:
        reach = torus.on(middle, half)
        centre = arm.tensor(reach.middle)
        x = _whirling(centre)
        low = np.linalg.norm(np.einsum("bijk,bj,bk->bi", centre, x, x), axis=1)
        high = _unfolded(arm.tensor(reach.corners()), arm.tensor(reach.radius)[:, None])
        return low * (1 - 1e-12) - 2 * n * _lost(torus), np.max(high, axis=1)

    def direction(q: Array) -> Array:
        return np.asarray(_whirling(arm.tensor(torus.on(q[None], np.zeros((1, n))).middle))[0])

    return _Task("k_c", "kg·m²", torus, bounds, np.ones(len(arm.triples)), direction=direction)


def _unfolded(tensor: Array, radius: Array) -> Array:
    """An upper bound of ‖C(q,x)y‖ for unit x and y: the smaller norm of the two unfoldings."""
    n = tensor.shape[-1]
    norms = []
    for t, r in ((tensor, radius), (np.moveaxis(tensor, -3, -1), np.moveaxis(radius, -3, -1))):
        norms.append(largest_norm(_tall(t, n), _tall(r, n)))
    return np.minimum(*norms)


def _tall(tensor: Array, n: int) -> Array:
    return tensor.reshape(*tensor.shape[:-3], n * n, n)


def _whirling(tensor: Array) -> Array:
    """For each tensor a unit vector x with a large ‖C(q,x)x‖: the best of alternating between it and x.

    The starts are the singular vectors of the unfolding.
    """
    x = np.swapaxes(np.linalg.eigh(np.einsum("bijk,bijl->bkl", tensor, tensor))[1], -1, -2)
    for _ in range(_TURNS):
        z = np.einsum("bijk,bsj,bsk->bsi", tensor, x, x)
        z /= np.maximum(np.linalg.norm(z, axis=2, keepdims=True), 1e-300)
        values, vectors = np.linalg.eigh(np.einsum("bsi,bijk->bsjk", z, tensor))
        last = np.argmax(np.abs(values), axis=2)
        x = np.take_along_axis(vectors, last[..., None, None], axis=3)[..., 0]
    size = np.linalg.norm(np.einsum("bijk,bsj,bsk->bsi", tensor, x, x), axis=2)
    best = np.take_along_axis(x, np.argmax(size, axis=1)[:, None, None], axis=1)[:, 0]
    return np.asarray(best / np.linalg.norm(best, axis=1, keepdims=True))


def _lost(torus: Torus) -> float:
    """What the rounding of the polynomials can take from the size of all of them together."""
    return float(2 * np.sum(torus.slack))


def _climb(merit: Callable[[Array], Array], half: Array) -> Array:
    """A state of large merit: the best of a sample, improved by random steps that shrink."""
    rng = np.random.default_rng(SEED)
    best, top = np.zeros(len(half)), -np.inf
    for block in range(_SAMPLES // _BLOCK):
        points = rng.uniform(-1, 1, (_BLOCK, len(half))) * half
        if block == 0:
            points[0] = 0.0
        values = merit(points)
        if values.max() > top:
            best, top = points[np.argmax(values)], float(values.max())
    step = 0.5
    for _ in range(_ROUNDS):
        points = best + step * rng.standard_normal((_BLOCK, len(half))) * (half > 0)
        values = merit(points)
        if values.max() > top:
            best, top = points[np.argmax(values)], float(values.max())
        step *= 0.75
    return best
