"""The sensitivity study: how far each printed number is from what any assumed arm can do."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from lyapcheck._types import Progress, silent
from lyapcheck.simulate.printed import printed_entry
from lyapcheck.simulate.task import PAPER_TASK, gains_for
from studies.printed_experiment.assumptions import assumptions
from studies.printed_experiment.bench_runs import BenchRuns
from studies.printed_experiment.design import design, values
from studies.printed_experiment.numbers import number_study
from studies.printed_experiment.printed_numbers import figure_gains, printed_numbers
from studies.printed_experiment.results import FigureGains, SetStudy, Study, Together
from studies.printed_experiment.together import all_sets, one_set
from studies.printed_experiment.trials import Trials, first_trials

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import RobotModel
    from lyapcheck.simulate.printed import PrintedIndices
    from studies.printed_experiment.design import Design


SPREAD, CORNERS = 512, 256
"""Arms spread over all ranges, and arms with every number at an end of its range."""


def study(
    gain_sets: Sequence[GainSet],
    model: RobotModel,
    *,
    spread: int = SPREAD,
    corners: int = CORNERS,
    search: bool = True,
    seed: int = 0,
    on_progress: Progress | None = None,
) -> Study | None:
    """Run the paper's experiment on arms from all over the ranges of what is assumed about the arm.

    Each gain set runs on the same arms: the nominal one, one number changed at a time, a Latin hypercube,
    corners; then on arms that a search picks, for each printed number and for several at once. Nothing is
    fitted: the ranges are those of the arm, and stay as they are.

    Args:
        gain_sets: controllers; those whose experiment the paper does not print are left out.
        model: the arm.
        spread: points of the Latin hypercube.
        corners: points at ends of all ranges.
        search: whether to look for arms that do what is printed beyond the sample.
        seed: of all random choices.
        on_progress: receives the fraction done.

    Returns:
        None if the paper prints nothing of these gains on this arm.

    Soundness: floating point, and a sample: an outcome that was not seen is not proved to be impossible.
    """
    chosen = [(one, entry) for one in gain_sets if (entry := printed_entry(one, model))]
    if not chosen:
        return None
    assumed = assumptions(model)
    plan = design(assumed, spread, corners, seed)
    trials: list[Trials] = []
    sets: list[SetStudy] = []
    for gain_set, entry in chosen:
        runs = BenchRuns(gain_set, model, PAPER_TASK, assumed)
        result = first_trials(runs, printed_numbers(entry), plan.points)
        result = result.searched(seed) if search else result
        sets.append(_set_study(gain_set, entry, result, plan, seed if search else None))
        trials.append(result)
        (on_progress or silent)(len(sets) / (len(chosen) + 1), gain_set.name)
    one_arm = all_sets(trials, len(plan.points), seed if search else None)
    return Study(
        robot=model.name,
        joints=model.joints,
        assumed=assumed,
        spread=spread,
        corners=corners,
        search=search,
        runs=_count(sets, one_arm, len(plan.points)),
        seed=seed,
        sets=tuple(sets),
        together=one_arm,
    )


def _count(sets: Sequence[SetStudy], one_arm: Together | None, common: int) -> int:
    """All bench runs: of each set, of the search for one arm, and one a set under the figure's gains."""
    together = 0 if one_arm is None else (one_arm.nearest.arms - common) * len(sets)
    return sum(one.at_once.arms + 1 for one in sets) + together


def _set_study(
    gain_set: GainSet, entry: PrintedIndices, result: Trials, plan: Design, seed: int | None
) -> SetStudy:
    numbers = tuple(number_study(number, result, plan) for number in result.printed)
    shown = _figure_gains(gain_set, entry, result, plan)
    return SetStudy(gain_set.name, gain_set.m, numbers, one_set(result, seed), shown)


def _figure_gains(gain_set: GainSet, entry: PrintedIndices, result: Trials, plan: Design) -> FigureGains:
    """The nominal arm under the gains with which the paper's figure starts."""
    runs = result.runs
    gains = gains_for(gain_set, runs.model.n)
    kp = figure_gains(entry, gains, runs.task.step)
    outcome = replace(runs, kp=kp)(values(runs.assumed, plan.nominal[None]))
    scale = np.array(gains.written[0]) / np.array(gains.kp)
    return FigureGains(tuple(float(x) for x in np.array(kp) * scale), float(outcome.L2[0]))
