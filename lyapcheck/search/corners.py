"""The arm, within what is uncertain about it, for which a gain set is worst."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from fractions import Fraction

import numpy as np

from lyapcheck._types import Progress, part, silent
from lyapcheck.robots.plant import Plant
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.search.falsify import RisingState
from lyapcheck.search.sample import States, quadratic

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


def worst_corner(model: Plant, at: ControlledArm, witness: RisingState) -> Plant:
    """The arm with each uncertain number at the end that is worse for a witness, one after the other."""
    states = _states(witness)
    corner: Corner = {name: number.value for name, number in at.model.parameters.items()}
    chosen, merit = at.model, _merit(at, states)
    for moved in _moves(model, corner):
        trial = at_corner(model, chosen, moved)
        result = _merit(replace(at, model=trial), states)
        if result > merit:
            chosen, merit = trial, result
            corner.update(moved)
    return chosen


def at_corner(model: Plant, near: Plant, moved: Corner) -> Plant:
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


def _moves(model: Plant, corner: Corner) -> Iterator[Corner]:
    """Each end of each range, on its own."""
    for name, number in model.parameters.items():
        for end in number.bounds:
            if number.ranged:
                yield {name: end}
    for i, number in enumerate(model.viscous):
        for end in number.bounds:
            if number.ranged:
                yield {f"viscous {i}": end}


def _states(witness: RisingState) -> States:
    parts = (witness.state.q, witness.state.e, witness.state.w)
    return States(*(np.array([[float(x) for x in part]]) for part in parts))


def _merit(controlled: ControlledArm, states: States) -> float:
    """The 1/ε₀ that the state refutes."""
    return float(quadratic(controlled, states).reciprocal()[0])
