"""The smallest ε₀ that an explicit state refutes: sampled, optimised, then confirmed in balls.

References: ``reyes2019family`` (12), (15).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import islice

import numpy as np

from lyapcheck._types import SEED, Array, Progress, part, silent
from lyapcheck.check.loop.states import State, confirms_positive, rate
from lyapcheck.check.numbers.balls import precision
from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.files.decimals import significant_up
from lyapcheck.robots.plant import RobotModel
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.search.worst_states import (
    States,
    fast_states,
    fastest_directions,
    finite_states,
    quadratic,
    require_one_rate,
    sample,
    slow_sample,
    slow_states,
    spread,
    worst_rates,
)

SAMPLES = 20_000
STARTS = 30
DIGITS = 9
"""Significant digits of a state; the optimum is flat, so that more would not sharpen ε₀."""
_EPS_DIGITS = 7
_STEPS, _QUICK = 9, 3
"""Kinds of candidates: all, and those up to the fast states."""
_WIDE, _NEAR = 30.0, 1e-5
"""Largest |e_i| of slow states, rad: anywhere, and at the origin."""
_SHOWN_BITS = 256
_SCALES = tuple(sign * 10.0 ** (k / 2) for k in range(-2, 17) for sign in (1, -1))
"""Factors tried on the rates of a candidate: fast states need ‖w‖ large enough for K_v h(w) not to matter."""
_SLACKS = (Fraction(0), Fraction(1, 10**6), Fraction(1, 10**5), Fraction(1, 10**4), Fraction(1, 10**3))


@dataclass(frozen=True)
class RisingState:
    """An exact state at which dV/dt > 0 was proved for ``eps0``; ``rate`` encloses it, W."""

    eps0: Fraction
    state: State
    rate: Enclosure
    kind: str


def falsify(
    controlled: ControlledArm,
    starts: int = STARTS,
    samples: int = SAMPLES,
    seed: int = SEED,
    on_progress: Progress | None = None,
    quick: bool = False,
) -> RisingState | None:
    """The smallest ε₀ for which a state with dV/dt > 0 was found and confirmed, with that state.

    Args:
        starts: how many starts for each of the optimised programs.
        samples: how many random states they are chosen from.
        quick: look at fast states alone, from a third of the starts; what slow states refute is then missed.

    Returns:
        the witness; ``None`` when no state was confirmed, which proves nothing.

    Soundness: the witness is proved by `lyapcheck.check.loop.states` from exact data; nothing says that no
        smaller ε₀ fails.
    """
    candidates = _candidates(controlled, math.ceil(starts / 3) if quick else starts, samples, seed)
    steps, progress = _QUICK if quick else _STEPS, on_progress or silent
    result: list[tuple[float, str, State]] = []
    for share, (kind, states) in enumerate(islice(candidates, steps), start=1):
        progress(min(share / steps, 1.0), f"{kind} states")
        result += _best(controlled, kind, states)
    for reciprocal, kind, state in sorted(result, key=lambda entry: -entry[0]):
        # a short ε₀ just above 1/reciprocal at which balls prove dV/dt > 0
        for slack in _SLACKS:
            eps0 = significant_up(Fraction(1 / reciprocal) * (1 + slack), _EPS_DIGITS)
            if (witness := confirmed(controlled, eps0, kind, state)) is not None:
                return witness
    return None


def _candidates(
    controlled: ControlledArm, starts: int, samples: int, seed: int
) -> Iterator[tuple[str, States]]:
    """States that refute a small ε₀, from plain sampling to the optimised programs."""
    states = sample(controlled, samples, seed)
    chosen = promising(controlled, states, starts)
    require_one_rate(controlled, chosen)
    yield "sampled", chosen
    speed, directions = fastest_directions(controlled, states.q, states.e)
    picked = spread(states, speed, starts)
    begin = States(states.q[picked], states.e[picked], directions[picked])
    fast = fast_states(controlled, begin)
    yield "fast", fast
    yield "level", fast_states(controlled, begin, level=True)
    yield "finite", finite_states(controlled, chosen)
    # from fast states at moderate rates, both ways
    speed, _ = fastest_directions(controlled, fast.q, fast.e)
    best = fast.take(spread(fast, speed, max(1, starts // 6)))
    leaving = best.scaled([sign * t for t in (3.0, 30.0, 300.0) for sign in (1, -1)])
    yield "finite", finite_states(controlled, leaving)
    # near the origin, and for weak gains, the linear terms in w decide
    states = slow_sample(controlled, samples, seed)
    chosen = promising(controlled, states, starts)
    yield "slow", chosen
    yield "slow", slow_states(controlled, chosen, _WIDE)
    if controlled.family.dh(0.0) > 0:
        near = States(states.q, states.e * _NEAR / 10, states.w * _NEAR / 10)
        chosen = promising(controlled, worst_rates(controlled, near), starts)
        yield "slow", chosen
        yield "slow", slow_states(controlled, chosen, _NEAR)


def promising(controlled: ControlledArm, states: States, count: int) -> States:
    """So many of the states, from different corners, those first that refute the smallest ε₀."""
    return states.take(spread(states, quadratic(controlled, states).reciprocal(), count))


def _best(controlled: ControlledArm, kind: str, states: States) -> list[tuple[float, str, State]]:
    """The three best of the states, each with the smallest rates that are as good as any."""
    moved = states.scaled(_SCALES)
    reciprocals = quadratic(controlled, moved).reciprocal().reshape(len(_SCALES), -1)
    best = reciprocals.max(axis=0)
    result = []
    for i in np.argsort(-best, kind="stable")[:3]:
        if best[i] > 0:
            enough = int(np.argmax(reciprocals[:, i] >= best[i] * (1 - 1e-6)))
            place = enough * len(best) + i
            q, e, w = (_exact(getattr(moved, part)[place]) for part in "qew")
            result.append((float(reciprocals[enough, i]), kind, State(q, e, w)))
    return result


def _exact(row: Array) -> tuple[Fraction, ...]:
    """Short decimals close to the doubles; what is rounding noise beside the others becomes 0."""
    noise = max(1e-12, 1e-8 * float(np.max(np.abs(row))))
    return tuple(Fraction(0) if abs(x) <= noise else Fraction(f"{x:.{DIGITS - 1}e}") for x in row)


def confirmed(controlled: ControlledArm, eps0: Fraction, kind: str, state: State) -> RisingState | None:
    """The witness that a state is against an ε₀; ``None`` where balls do not prove dV/dt > 0 there."""
    if not confirms_positive(controlled.arm, controlled.controller, eps0, state):
        return None
    with precision(_SHOWN_BITS):
        shown = rate(controlled.arm, controlled.controller, eps0, state, _SHOWN_BITS)
        return RisingState(eps0, state, Enclosure.from_arb(shown), kind)


# --- The arm, within what is uncertain about it, for which a gain set is worst.


ROUNDS = 4
"""How often the worst corner is looked for at a new witness."""
Corner = dict[str, Fraction]
"""Values by name: parameters of M, and ``viscous 0`` … for the friction of each joint."""


def falsify_corners(
    controlled: ControlledArm,
    look: Callable[[ControlledArm, Progress], RisingState | None],
    on_progress: Progress | None = None,
) -> tuple[ControlledArm, RisingState | None]:
    """The smallest ε₀ that a state refutes at some corner of the arm's ranges, and the arm at that corner.

    From the nominal arm: find a witness, move every uncertain number to the end at which that state refutes
    a smaller ε₀, look again there, until nothing gets smaller; ``look`` looks at one arm.

    Soundness: the witness is proved for the arm that is handed back, which is one of those meant.
    """
    progress = on_progress or silent
    best, witness = replace(controlled, ranges=False), None
    trial = best
    for turn in range(ROUNDS):
        result = look(trial, part(progress, turn / ROUNDS, (turn + 1) / ROUNDS, f"corner {turn + 1}: "))
        if result is None or (witness is not None and result.eps0 >= witness.eps0):
            break
        best, witness = trial, result
        trial = replace(controlled, model=worst_corner(controlled.model, best, witness), ranges=False)
    return best, witness


def worst_corner(model: RobotModel, at: ControlledArm, witness: RisingState) -> RobotModel:
    """The arm with each uncertain number at the end that is worse for a witness, one after the other."""
    state = witness.state
    states = States(*(np.array([[float(x) for x in part]]) for part in (state.q, state.e, state.w)))
    chosen, merit = at.model, _merit(at, states)
    numbers = model.parameters | {f"viscous {i}": number for i, number in enumerate(model.viscous)}
    for name, number in numbers.items():
        for end in number.bounds if number.ranged else ():
            trial = at_corner(model, chosen, {name: end})
            result = _merit(replace(at, model=trial), states)
            if result > merit:
                chosen, merit = trial, result
    return chosen


def at_corner(model: RobotModel, near: RobotModel, moved: Corner) -> RobotModel:
    """``near`` with some numbers moved; nominal values of ``near`` are those of its numbers."""
    parameters = {
        name: replace(number, value=moved.get(name, near.parameters[name].value))
        for name, number in model.parameters.items()
    }
    viscous = tuple(
        replace(number, value=moved.get(f"viscous {i}", number.value))
        for i, number in enumerate(near.viscous)
    )
    return replace(near, parameters=parameters, viscous=viscous)


def _merit(controlled: ControlledArm, states: States) -> float:
    """The 1/ε₀ that the state refutes."""
    return float(quadratic(controlled, states).reciprocal()[0])
