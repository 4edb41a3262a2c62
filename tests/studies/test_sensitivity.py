"""The sensitivity study: the bench it runs, what it samples, and whether its answers can be replayed."""

from __future__ import annotations

import runpy
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lyapcheck.control.gains import GainSet, paper_gain_file, read_gain_file
from lyapcheck.robots import RobotModel, load
from lyapcheck.simulate.bench import Bench
from lyapcheck.simulate.printed import printed_entry
from lyapcheck.simulate.task import PAPER_TASK, gains_for
from lyapcheck.simulate.trial import experiment
from studies.printed_experiment.approach import approach, between
from studies.printed_experiment.assumptions import Assumption, assumptions
from studies.printed_experiment.bench_compiled import compiled_bench
from studies.printed_experiment.bench_graph import graph_bench
from studies.printed_experiment.bench_runs import PERIOD, BenchRuns, enough_sweeps
from studies.printed_experiment.design import LEVELS, design, values
from studies.printed_experiment.json import study_json
from studies.printed_experiment.numbers import number_study
from studies.printed_experiment.printed_numbers import START_TORQUES, PrintedNumber
from studies.printed_experiment.results import Answer, Study
from studies.printed_experiment.shares import shares
from studies.printed_experiment.study import study
from studies.printed_experiment.trials import first_trials

ARM = load("buap3")
ASSUMED = assumptions(ARM)
NOMINAL = np.array([[one.nominal for one in ASSUMED]])
SETS = {
    one.name: one for name in ("table2", "table2_pd") for one in read_gain_file(paper_gain_file(name)).gains
}
SHORT = replace(PAPER_TASK, T=1.0)


def runs(name: str, task: Any = SHORT, model: RobotModel = ARM, **more: Any) -> BenchRuns:
    return BenchRuns(SETS[name], model, task, assumptions(model), **more)


def without_dry_friction(model: RobotModel) -> RobotModel:
    return replace(model, coulomb=(None,) * model.n)


@pytest.mark.parametrize("name", ["tau_m1", "tau_m3", "tau_pd"])
def test_without_dry_friction_the_bench_is_that_of_the_experiment(name: str) -> None:
    arm = without_dry_friction(ARM)
    bench = runs(name, model=arm, substeps=8)
    ours = bench.paths(np.array([[one.nominal for one in bench.assumed]]))[0]
    other = experiment(SETS[name], arm, PAPER_TASK.q_d, T=SHORT.T)
    assert np.max(np.abs(ours[:, :3] - other.q)) < 2e-5
    assert np.max(np.abs(ours[:, 6:] - other.tau)) < 0.2  # one line of an encoder under the gains of PD


@pytest.mark.slow
@pytest.mark.parametrize("name", ["tau_m1", "tau_pd"])
def test_creeping_joints_tend_to_sticking_ones(name: str) -> None:
    ours = runs(name, substeps=16).paths(NOMINAL)[0, :, :3]
    creeping = [
        experiment(SETS[name], ARM, PAPER_TASK.q_d, T=SHORT.T, bench=Bench(creep=creep)).q
        for creep in (4e-3, 5e-4)
    ]
    far, near = (np.max(np.abs(ours - q)) for q in creeping)
    assert near < 6e-4
    assert near < far / 4


def test_a_spring_below_the_dry_friction_moves_nothing_at_all() -> None:
    weak = replace(SETS["tau_m1"], kp=(Fraction(1),) * 3)
    bench = BenchRuns(weak, ARM, SHORT, ASSUMED)
    assert not np.any(bench.paths(NOMINAL)[0, :, :6])
    loose = NOMINAL.copy()
    loose[0, [one.name.endswith("coulomb") for one in ASSUMED]] = 0.0
    assert np.all(bench.paths(loose)[0, -1, :3] > 0.03)


def test_graphs_do_what_compiled_code_does() -> None:
    points = np.random.default_rng(3).uniform(size=(5, len(ASSUMED)))
    bench, gains = runs("tau_m2", replace(PAPER_TASK, T=0.3)), gains_for(SETS["tau_m2"], 3)
    numbers = values(ASSUMED, points)
    plain = graph_bench(ARM, gains.family, PERIOD, bench.substeps, enough_sweeps(ARM))
    by_graph = plain(np.zeros((5, 6)), bench._parameters(gains, numbers), bench.periods)
    assert np.max(np.abs(by_graph - bench.paths(numbers))) < 1e-9


@pytest.mark.slow
def test_without_a_compiler_a_small_study_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LYAPCHECK_NO_COMPILER", "1")
    compiled_bench.cache_clear()
    result = study([SETS["tau_pd"]], ARM, spread=9, corners=2, search=False, seed=2)
    compiled_bench.cache_clear()
    assert result is not None
    assert not result.search
    assert result.runs == result.sets[0].at_once.arms + 1 == 1 + LEVELS * len(ASSUMED) + 11 + 1


def test_smaller_steps_change_the_index_by_less_than_is_shown() -> None:
    numbers = values(ASSUMED, np.random.default_rng(5).uniform(size=(16, len(ASSUMED))))
    coarse, fine = (runs("tau_m1", PAPER_TASK, substeps=k)(numbers).L2 for k in (2, 16))
    assert np.max(np.abs(coarse - fine)) < 0.02


def test_what_is_assumed_is_what_the_arm_says() -> None:
    ranged = [name for name, number in ARM.numbers.items() if number.assumed]
    assert sorted(ranged) == sorted(one.name for one in ASSUMED[:-1])
    assert ASSUMED[-1].name == "settling_band"
    assert all(one.low <= one.nominal <= one.high and one.low < one.high for one in ASSUMED)


def test_the_design_covers_the_ranges() -> None:
    plan = design(ASSUMED, 40, 10, 1)
    assert np.all(np.arange(40) == np.sort((plan.spread * 40).astype(int), axis=0).T)
    assert set(np.unique(plan.corners)) == {0.0, 1.0}
    moved = plan.alone != plan.nominal
    assert all(not np.delete(moved[i], i, axis=1).any() for i in range(len(ASSUMED)))
    assert plan.points.shape == (1 + LEVELS * len(ASSUMED) + 50, len(ASSUMED))
    assert np.allclose(values(ASSUMED, plan.nominal[None]), NOMINAL)
    assert np.array_equal(plan.points, design(ASSUMED, 40, 10, 1).points)
    assert not np.array_equal(plan.points, design(ASSUMED, 40, 10, 2).points)


UNIT = tuple(Assumption(name, "", 0.0, 0.5, 1.0) for name in "abc")


@pytest.mark.parametrize(
    ("function", "expected"),
    [
        (lambda x: 3 * x[:, 0] + x[:, 1], (0.9, 0.1, 0.0)),
        (lambda x: (x[:, 2] - 0.5) ** 2, (0.0, 0.0, 1.0)),  # no correlation at all, and yet everything
        (lambda x: (x[:, 0] - 0.5) * (x[:, 1] - 0.5), (0.0, 0.0, 0.0)),  # only together
    ],
)
def test_shares_of_the_variance_are_those_of_sobol(
    function: Callable[[np.ndarray], np.ndarray], expected: tuple[float, ...]
) -> None:
    points = design(UNIT, 4096, 0, 7).spread
    result = shares(points, function(points))
    assert result is not None
    assert np.allclose(result, expected, atol=0.08)


def test_a_constant_has_no_shares() -> None:
    points = design(UNIT, 64, 0, 7).spread
    assert shares(points, np.full(64, 5.0)) is None


def test_the_search_finds_a_corner_that_no_sample_holds() -> None:
    points = design(UNIT, 32, 0, 7).spread

    def missing(x: np.ndarray) -> np.ndarray:
        return (3.0 - x.sum(axis=1))[:, None]

    result = approach(points, missing(points), missing, lambda seen: np.array([False]), seed=1)
    assert missing(points).min() > 0.1
    assert missing(result).min() < 1e-3


def test_halving_closes_in_on_a_root_and_on_a_jump() -> None:
    def apart(x: np.ndarray) -> np.ndarray:
        return np.column_stack([x[:, 0] ** 2 - 0.3, np.where(x[:, 1] < 0.7, -1.0, 2.0)])

    points = np.array([[0.0, 0.0, 0.0], [1.0, 1.0, 1.0]])
    middles = between(points, apart(points), lambda x: np.diagonal(apart(x)))
    assert abs(middles[-2, 0] - np.sqrt(0.3)) < 1e-3
    assert abs(middles[-1, 1] - 0.7) < 1e-3


def test_figures_print_the_torques_that_the_proof_holds_against_table_2() -> None:
    proof = runpy.run_path(str(Path(__file__).parents[2] / "proofs" / "published.py"))
    joints = proof["JOINTS"]
    ours = {
        (figure.removeprefix("Fig. "), f"m{m}" if m else "pd", joints[i], value)
        for m, (figure, torques) in START_TORQUES.items()
        for i, value in enumerate(torques)
        if value is not None
    }
    assert ours == {(figure, m, joint, float(torque)) for figure, m, joint, torque in proof["FIGURES"]}


@pytest.fixture(scope="module")
def small() -> Study:
    result = study([SETS["tau_m1"], SETS["tau_pd"]], ARM, spread=32, corners=64, seed=4)
    assert result is not None
    return result


def arm_at(at: tuple[float, ...]) -> RobotModel:
    """The paper's arm with other numbers, made without the study's own code."""
    numbers = {one.name: Fraction(x) for one, x in zip(ASSUMED, at, strict=True)}
    fixed = ARM.fixed(**{name: numbers[name] for name in ARM.parameters})
    friction = {
        kind: tuple(
            replace(number, value=numbers.get(f"{joint}_{kind}", number.value))
            for joint, number in zip(ARM.joints, getattr(ARM, kind), strict=True)
        )
        for kind in ("viscous", "coulomb")
    }
    return replace(fixed, **friction)


@pytest.mark.slow
def test_an_arm_that_explains_a_print_does_so_in_the_other_simulator(small: Study) -> None:
    for result in small.sets:
        index = result.numbers[0]
        assert index.answer is Answer.YES
        assert index.at is not None
        other = experiment(SETS[result.name], arm_at(index.at), PAPER_TASK.q_d)
        assert pytest.approx(index.printed.value, abs=0.1) == other.L2


def test_spreads_hold_the_nominal_value_and_single_changes(small: Study) -> None:
    for number in (number for result in small.sets for number in result.numbers):
        ends = [x for pair in number.alone for x in pair if x is not None]
        if number.low is not None and number.high is not None:
            assert all(number.low <= x <= number.high for x in ends)
        assert number.nominal is None or number.low <= number.nominal <= number.high  # type: ignore[operator]


def test_no_arm_has_a_part_in_the_torque_at_the_start(small: Study) -> None:
    torques = [n for result in small.sets for n in result.numbers if n.printed.quantity == "start_torque"]
    assert len(torques) == 6
    for number in torques:
        assert number.answer is Answer.NO_PART
        assert number.shares is None
        assert number.low == number.high == number.nominal


def test_gains_read_off_a_figure_start_with_its_torques(small: Study) -> None:
    pd = small.sets[1].figure_gains
    assert pd.kp == pytest.approx((40 / 45, 120 / 45, 12 / 90))
    assert pytest.approx(small.sets[1].numbers[0].nominal) != pd.L2


def test_no_arm_gives_all_indices_at_once_though_each_is_explained(small: Study) -> None:
    assert small.together is not None
    assert small.together.nearest.worst > 0.02
    assert small.together.ordered == 0.0  # the paper has PD last, the model first


@pytest.mark.parametrize(
    ("value", "at_most", "answer"),
    [
        (5.0, False, Answer.NO),
        (200.0, True, Answer.YES),
        (5.0, True, Answer.NO),
        (29.4122, False, Answer.YES),
    ],
)
def test_answers_follow_from_what_was_seen(value: float, at_most: bool, answer: Answer) -> None:
    plan = design(ASSUMED, 8, 8, 1)
    number = PrintedNumber("L2", None, value, "°", at_most, "made up")
    trials = first_trials(runs("tau_m1", PAPER_TASK), (number,), plan.points)
    assert number_study(number, trials.searched(1), plan).answer is answer


def test_only_what_the_paper_ran_is_held_against_it() -> None:
    entry = printed_entry(SETS["tau_m1"], ARM)
    assert entry is not None
    assert entry.m == 1
    other: GainSet = replace(SETS["tau_m1"], kp=(Fraction(28), Fraction(61), Fraction(5)))
    assert printed_entry(other, ARM) is None
    assert study([other], ARM) is None
    assert study([SETS["tau_m1"]], load("buap3-small")) is None


@pytest.mark.slow
def test_the_same_seed_gives_the_same_study() -> None:
    first, second = (study([SETS["tau_m3"]], ARM, spread=16, corners=8, seed=2) for _ in range(2))
    assert first is not None
    assert second is not None
    assert study_json(first) == study_json(second)
    assert first.together is None
