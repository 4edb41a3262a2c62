"""ε₀ where speeds or errors are limited: a state within the limits against it, a proof for all of them.

The proof relies on h(w_i)/w_i ≥ δ_i at the speeds allowed (``lyapcheck.check.loop.decay.speeds``), and on
boxes that end at the errors allowed. For m ≥ 2 h(w)/w is 0 at w = 0: a limit of speed alone then adds nothing
to the proof, and only moves the state against it.

References: ``reyes2019family`` (11), (12), (15).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from lyapcheck._types import SEED, Array, Progress
from lyapcheck.check.kinds.decreasing import statement_of
from lyapcheck.check.kinds.nearby import DecreasingNearby, SlowerAndNearer
from lyapcheck.check.loop.closed_loop import ClosedLoop
from lyapcheck.check.numbers.balls import precision, to_arb
from lyapcheck.check.numbers.enclosure import Enclosure
from lyapcheck.search.closed_loop import closed_loop_of
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.search.decay.digits import short_below
from lyapcheck.search.decay.phases import floor_below, light_proof, lightest
from lyapcheck.search.falsify import RisingState, promising, smallest_refuted
from lyapcheck.search.proof import DecreaseProof
from lyapcheck.search.sample import States, fastest_directions, sample, slow_sample, spread
from lyapcheck.search.worst_states import finite_states, slow_states

if TYPE_CHECKING:
    from lyapcheck.search.proof import RateData

SAMPLES = 20_000
NEAR_STARTS = 10
SHARES = tuple(Fraction(n, 100) for n in (50, 60, 70, 80, 85, 90, 95))
"""Of the falsified ε₀: those that are tried one after the other where 0.99 of it is not proved."""
INSIDE = 1 - 1e-7
"""Of a limit: states keep within it when they are rounded."""
ORIGIN = 1e-5
"""rad: so near the origin dV/dt is a quadratic form."""
_BITS = 128
_STEPS = 6


@dataclass(frozen=True, eq=False)
class NearbyArm(ControlledArm):
    """A gain set on an arm at states within limits alone.

    Args:
        speeds: of |w_i|, rad/s, one a joint; none where they are not limited.
        errors: of |e_i|, rad, likewise.
    """

    speeds: tuple[Fraction, ...] = ()
    errors: tuple[Fraction, ...] = ()

    @classmethod
    def of(
        cls, controlled: ControlledArm, speeds: tuple[Fraction, ...], errors: tuple[Fraction, ...]
    ) -> NearbyArm:
        """With the least h(w_i)/w_i at these speeds."""
        floors = tuple(floor_below(controlled, float(speed)) for speed in speeds)
        return cls(
            controlled.gains,
            controlled.model,
            controlled.ranges,
            floors if any(floors) else (),
            speeds=speeds,
            errors=errors,
        )

    def loop(self, eps0: Fraction, coupling: tuple[Fraction, ...] = ()) -> ClosedLoop:
        """What has to be proved: with the damping that slow joints have, and at errors within the limits."""
        return replace(super().loop(eps0, coupling), nearby=self.errors)

    def proof(self, loop: ClosedLoop, by: RateData) -> DecreaseProof:
        """What is to be judged; nothing is said of motions yet."""
        return NearbyProof(loop, by, self.inertia_proof, self.statement(loop.eps0), self.floors)

    def statement(self, eps0: Fraction) -> DecreasingNearby:
        """dV/dt < 0 within the limits."""
        whole = closed_loop_of(self.gains, self.ranged, eps0, ranges=self.ranges)
        return DecreasingNearby(statement_of(whole), self.speeds, self.errors, None)

    def held(self, states: States) -> States:
        """States with e and w shortened to within the limits."""
        return States(states.q, _shortened(states.e, self.errors), _shortened(states.w, self.speeds))


@dataclass(frozen=True)
class NearbyProof(DecreaseProof):
    """The same for states within limits, ``stated`` with or without motions that keep there."""

    stated: DecreasingNearby
    floors: tuple[Fraction, ...]
    lightest: tuple[Fraction, ...] = ()

    @property
    def statement(self) -> DecreasingNearby:
        """What is proved."""
        return self.stated

    @property
    def certificate(self) -> SlowerAndNearer:
        """The proof as certificates bring it forward."""
        floors = self.floors or (Fraction(0),) * self.loop.n
        by = light_proof(self.loop.arm.mass, self.loop.parameters)
        lightness = (by,) * len(self.lightest)
        return SlowerAndNearer(self.inertia, floors, self.by, self.lightest, lightness)


def with_motions(near: NearbyArm, proof: NearbyProof, jobs: int = 1) -> NearbyProof:
    """The proof with the largest energy that is shown to keep within the limits; as it was where none is."""
    inertia = lightest(near) if near.speeds else ()
    if not all(x > 0 for x in inertia):
        return proof
    known = near.loop(Fraction(1)).member
    energies = [x * speed * speed / 2 for x, speed in zip(inertia, near.speeds, strict=True)]
    with precision(_BITS):
        energies += [
            Enclosure.from_arb(to_arb(k) * known.potential(to_arb(error))).lower
            for k, error in zip(near.gains.kp, near.errors, strict=bool(near.errors))
        ]
    energy = short_below(min(energies))
    if energy <= 0:
        return proof
    more = replace(proof, stated=replace(proof.stated, energy=energy), lightest=inertia)
    return more if more.accepted(jobs) else proof


def falsify_nearby(
    near: NearbyArm, starts: int = NEAR_STARTS, seed: int = SEED, on_progress: Progress | None = None
) -> RisingState | None:
    """The smallest ε₀ that a state within the limits refutes, with that state.

    Args:
        near: gains, nominal arm and limits.
        starts: how many starts for each of the optimised programs.
        seed: of the random states.
        on_progress: receives how far the search is.

    Soundness: as for `lyapcheck.search.falsify`: the witness is proved, and nothing says that no smaller ε₀
        fails.
    """
    return smallest_refuted(near, _candidates(near, starts, seed), _STEPS, on_progress, near.held)


def _candidates(near: NearbyArm, starts: int, seed: int) -> Iterator[tuple[str, States]]:
    """States within the limits, or nearly, that refute a small ε₀."""
    rates = [float(x) * INSIDE for x in near.speeds]
    errors = [float(x) * INSIDE for x in near.errors]
    states = near.held(sample(near, SAMPLES, seed))
    chosen = promising(near, states, starts)
    yield "sampled", chosen
    yield "finite", finite_states(near, chosen, errors, rates)
    level = near.held(_level(near, states))
    yield "level", finite_states(near, promising(near, level, starts), [0.0] * near.n, rates)
    slow = near.held(slow_sample(near, SAMPLES, seed))
    chosen = promising(near, slow, starts)
    yield "slow", finite_states(near, chosen, errors, rates)
    if near.family.dh(0.0) > 0:
        tiny = States(slow.q, slow.e * ORIGIN / 10, slow.w * ORIGIN / 10)
        yield "slow", slow_states(near, promising(near, tiny, starts), ORIGIN)


def _level(near: NearbyArm, states: States) -> States:
    """At e = 0, in the direction of w that is worst there, at some speed of the sample."""
    still = np.zeros_like(states.e)
    speed, directions = fastest_directions(near, states.q, still)
    picked = spread(States(states.q, still, directions), speed, len(speed) // 4)
    lengths = np.linalg.norm(states.w[picked], axis=1, keepdims=True)
    return States(states.q[picked], still[picked], directions[picked] * lengths)


def _shortened(rows: Array, limits: tuple[Fraction, ...]) -> Array:
    """Rows made shorter until every entry is within its limit."""
    if not limits:
        return rows
    ends = np.array([float(x) for x in limits]) * INSIDE
    return np.asarray(rows / np.maximum(1.0, np.max(np.abs(rows) / ends, axis=1, keepdims=True)))
