"""Gains for targets: proposed for one joint, tried on the whole arm, accepted by the gate."""

from __future__ import annotations

import math
import sys
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lyapcheck import robots
from lyapcheck.answers.gate import gate
from lyapcheck.answers.tune import search
from lyapcheck.answers.tune.bench import BenchTuning, Candidate
from lyapcheck.answers.tune.search import Search, accepted, tune_for
from lyapcheck.answers.tune.targets import limits_with
from lyapcheck.answers.tune.trial import BY_19, BY_PROOF, Trial, Trials, Wishes, as_run, tried
from lyapcheck.cli import main as cli
from lyapcheck.control.gains import Bounds, GainSet, paper_gain_file, read_gain_file
from lyapcheck.control.limits import arm_limits
from lyapcheck.control.sampling import LoopRecord
from lyapcheck.errors import InputError
from lyapcheck.files.loop import NOTHING
from lyapcheck.output.answer import FORMATS
from lyapcheck.output.text import Depth, View, render
from lyapcheck.robots.fields import Vary
from lyapcheck.simulate.closed_loop import simulate
from lyapcheck.simulate.many import Starts
from lyapcheck.simulate.task import PAPER_TASK, task_for
from lyapcheck.verdicts import Exit
from tests.helpers.arm_texts import ONE_JOINT
from tests.helpers.command import invoke
from tests.helpers.shares import one_in

WISHES = Wishes(overshoot=8, settle=2.2, rest_error=22)


@pytest.fixture(scope="module")
def tuned() -> BenchTuning:
    """Both ways for m = 1 on the paper's arm."""
    return tune_for("buap3", Trials(WISHES, (PAPER_TASK,)), [1])


@pytest.mark.slow
def test_stability_by_proof_meets_what_19_cannot(tuned: BenchTuning) -> None:
    by_19, by_proof = tuned.sets
    assert (by_19.stable, by_proof.stable) == ("(19)", "proof")
    assert (by_19.gains.condition, by_proof.gains.condition) == (("10i", "19"), ("10i", "scalar"))
    assert tuned.met(by_proof)
    assert not tuned.met(by_19)
    assert tuned.exit == Exit.PROVED
    met = "! simulated: tau_m1_proof meets the targets without the dry friction of the file"
    assert tuned.document().title == met
    assert "simulated: 1 motion of (11) at an infinite rate on buap3" in str(tuned)
    said = " ".join(render(tuned.document(), View(Depth.VERBOSE)).split())
    assert "(19) keeps k_v of base, shoulder, elbow from being larger" in said
    assert "m = 1: worst ratio" in said
    assert "The viscous friction of base, shoulder, elbow is assumed." in said


@pytest.mark.slow
def test_a_motion_is_watched_until_its_energy_keeps_it_in_the_band() -> None:
    """A joint that settles at 3.2 s, after the 3 s that are watched at least."""
    arm, gains = robots.load("pendulum1"), GainSet("slow", 1, (Fraction(3),), (Fraction(1, 10),))
    task = task_for(1, [0.8], None, None, 5.0)
    trial = tried(gains, [arm], Trials(Wishes(overshoot=10, settle=0.1), (task,)), exact=True)
    run = simulate(gains, arm, [0.8], T=3 * trial.T, points=101)
    assert (trial.T, trial.kept) == (6.0, True)
    assert trial.settled[0] == pytest.approx(run.settling[0], rel=1e-5)
    assert trial.overshoot[0] == pytest.approx(run.overshoot[0], rel=1e-5)
    assert not tried(gains, [arm], Trials(Wishes(settle=0.1), (task,))).kept


def test_stability_is_proved_over_the_ranges_that_are_asked_for() -> None:
    """Friction that may vanish leaves LaSalle's theorem, where the nominal one gives a V that falls."""
    arm, varies = "reyes-kelly2", (Vary.parsed("viscous=-100%..+0%"),)
    gains = GainSet("set", 1, (Fraction(10), Fraction(5)), (Fraction(2), Fraction(1)))
    ranges = {arm: arm_limits(arm, varies)}
    assert accepted(gains, BY_PROOF, arm, None, None, NOTHING).deciding == ("10i", "scalar")
    assert accepted(gains, BY_PROOF, arm, None, ranges, NOTHING).deciding == ("10i", "lasalle")
    assert accepted(gains, BY_19, arm, None, ranges, NOTHING).verdict == "rejected"


@pytest.mark.slow
def test_what_is_promised_of_gains_is_what_a_run_shows(tuned: BenchTuning):
    result, arm = tuned.sets[-1], robots.load("buap3")
    run = simulate(result.gains, arm, PAPER_TASK.q_d, T=9.0)
    alone = tried(result.gains, [arm], tuned.bench, exact=True)
    np.testing.assert_allclose(alone.overshoot, run.overshoot, rtol=1e-3, atol=1e-3)
    np.testing.assert_allclose(alone.settled, run.settling, rtol=1e-2)
    limits = [float(most) for most in run.torque_limit if most is not None]
    np.testing.assert_allclose(alone.share, run.peak_torque / limits, rtol=1e-4)
    assert np.all(alone.overshoot <= result.trial.overshoot)
    assert np.all(result.trial.overshoot <= 8)
    assert np.all(result.trial.settled <= 2.2)
    for kp, f, rest in zip(result.gains.kp, (7.17, 7.17, 1.734), result.trial.rest, strict=True):
        assert float(kp) * math.tanh(math.radians(rest)) == pytest.approx(f, rel=1e-5)


@pytest.mark.slow
def test_the_gate_accepts_the_gain_file(tuned: BenchTuning, tmp_path: Path) -> None:
    (tmp_path / "g.toml").write_text(tuned.gain_file(tmp_path))
    (by_proof,) = gate(read_gain_file(tmp_path / "g.toml"))
    assert (by_proof.name, by_proof.verdict) == ("tau_m1_proof", "accepted")
    assert by_proof.deciding == ("10i", "scalar")
    (again,) = gate(read_gain_file(tmp_path / "g.toml"), deciding=("10i", "19"))
    assert again.standing == "breaks (19), stability proved otherwise"


def test_the_worst_of_all_arms_and_motions_counts() -> None:
    model, gains = robots.load("buap3"), read_gain_file(paper_gain_file()).gains[0]
    heavy = model.fixed(base_inertia=2)
    near = replace(PAPER_TASK, q_d=(0.1, 0.1, 0.1))
    alone = [
        tried(gains, [arm], Trials(WISHES, (task,))) for arm in (model, heavy) for task in (PAPER_TASK, near)
    ]
    together = tried(gains, [model, heavy], Trials(WISHES, (PAPER_TASK, near)))
    np.testing.assert_array_equal(together.overshoot, np.max([one.overshoot for one in alone], axis=0))
    np.testing.assert_array_equal(together.share, np.max([one.share for one in alone], axis=0))


@pytest.mark.parametrize("name", one_in(2, ["reyes-kelly2", "buap3"]))
def test_the_search_is_never_worse_than_the_rule_of_thumb(name: str):
    """98 % of (10i) with damping ratio 0.9, of which it starts; every set that is tried keeps (10i)."""
    model = robots.load(name)
    limits = limits_with(model)
    bench = Trials(Wishes(overshoot=5, settle=1.5), (task_for(model.n, [0.8] * model.n, None, None, 5.0),))
    search = Search(bench, [model], limits, 1, BY_PROOF)
    thumb = search.set_of(search.first())
    for kp, kv, torque, pull in zip(thumb.kp, thumb.kv, limits.torque, limits.gravity, strict=True):
        assert float((kp + kv) / (torque - pull)) == pytest.approx(0.98, abs=2e-3)
    found = search.run()
    assert found.trial.worst < tried(thumb, [model], bench, exact=True).worst
    sets = [search.set_of(search.first() + shift) for shift in (-3.0, 0.1, 3.0)]
    for one in (found.gains, *sets):
        rows = zip(one.kp, one.kv, limits.torque, limits.gravity, strict=True)
        assert all(kp + kv < torque - pull for kp, kv, torque, pull in rows)  # γ_1 = 1
        assert min(one.kv) > Fraction(1, 100)  # a joint that friction damps today


def test_a_share_of_the_motions_may_be_what_counts():
    model, gains = (
        robots.load("reyes-kelly2"),
        GainSet("g", 1, (Fraction(30), Fraction(5)), (Fraction(5), Fraction(1))),
    )
    starts, goals = Starts(9, 1.0, 3).motions([0.0, 0.0])
    assert np.all(np.abs(goals) <= 1.0)
    assert np.all((np.abs(goals - starts) >= 0.25) & (np.abs(goals - starts) <= 1.0))
    tasks = tuple(task_for(2, goal, start, None, 5.0) for start, goal in zip(starts, goals, strict=True))
    wishes = Wishes(overshoot=5, settle=1.5)
    alone = np.array([tried(gains, [model], Trials(wishes, (task,))).overshoot for task in tasks])
    for quantile, place in ((1.0, 8), (0.5, 4), (0.1, 0)):
        together = tried(gains, [model], Trials(wishes, tasks, quantile=quantile))
        np.testing.assert_array_equal(together.overshoot, np.sort(alone, axis=0)[place])


@pytest.mark.slow
def test_gains_that_a_computer_cannot_run_are_told_from_those_that_it_can():
    """k_v of 800 on 0.25 kg·m² at 1 kHz; what the search finds there is at most half of J/(T (1 + d))."""
    model, bench = (
        robots.load("pendulum1"),
        Trials(Wishes(overshoot=5, settle=3), (task_for(1, [0.8], None, None, 5.0),)),
    )
    record = LoopRecord(period=Fraction(1, 100))
    wild = GainSet("w", 1, (Fraction(3),), (Fraction(800),))
    seen = as_run(wild, [model], bench, record)
    assert seen.unrest.startswith("limit cycle seen: pivot")
    assert not seen.kept
    found = Search(bench, [model], limits_with(model), 1, BY_PROOF, record).run()
    assert not found.trial.unrest
    assert float(found.gains.kv[0]) <= 0.5 * 0.25 / (0.01 * 2)


@pytest.mark.parametrize(
    ("wishes", "option"), [({"overshoot": 0}, "--overshoot"), ({"peak_share": 2}, "--peak-share")]
)
def test_targets_that_mean_nothing_are_refused(wishes: dict[str, float], option: str) -> None:
    with pytest.raises(InputError, match=option):
        Wishes(**wishes)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--overshoot", "5", "--damping", "1"], "--damping = 1: cannot go with targets"),
        (["--goal", "1,2,3"], "--goal = 1,2,3: has a meaning with targets only"),
        (["--settle", "-1"], "--settle = -1: must be above 0, up to 1e+06"),
        (["--settle", "1", "--goal", "1,2"], "write --goal 45,45,45"),
        (["--settle", "1", "--runs", "0"], "--runs = 0 within 90: must be 1 to 64 motions"),
        (["--settle", "1", "--spread", "5"], "--spread = 5: has a meaning with --runs only"),
        (["--settle", "1", "--quantile", "2"], "--quantile = 2: must be above 0, up to 1"),
        (["--best"], "--best: has a meaning with targets only"),
        (["--within", "5"], "--within: means nothing without a period"),
        (["--quantile", "0.5"], "--quantile = 0.5: has a meaning with targets only"),
        (["--settle", "1", "--goal", "0,0,0"], "--goal = 0,0,0: is where the motion starts"),
        (["--settle", "1", "--start", "45,45,90"], "is where the motion starts"),
    ],
)
def test_options_that_do_not_fit_are_refused(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], words: list[str], said: str
) -> None:
    monkeypatch.setattr(sys, "argv", ["lyapcheck", "tune", "buap3", *words])
    with pytest.raises(SystemExit) as left:
        cli.main()
    assert left.value.code == 2
    assert said in capsys.readouterr().err


@pytest.mark.slow
def test_targets_are_written_only_where_a_set_meets_them(tmp_path: Path) -> None:
    """20 s are met by every set, 10⁻⁹ by none; then ``--best`` writes one, marked."""
    arm, out = tmp_path / "arm.toml", tmp_path / "gains.toml"
    arm.write_text(ONE_JOINT.format(viscous=0.1, torque=10, more="coulomb = 0.1"))
    words = ("tune", str(arm), "--m", "1", "--settle")
    easy = invoke(*words, "20", "--out", str(out))
    assert easy.exit_code == 0
    assert easy.stdout.startswith("! simulated: tau_m1")
    assert {one.condition[0] for one in read_gain_file(out).gains} == {"10i"}
    assert invoke("gate", str(out)).exit_code == 0
    out.unlink()
    hard = invoke(*words, "1e-9", "--stability", "proof", "--out", str(out))
    assert (hard.exit_code, out.exists()) == (3, False)
    assert hard.stdout.startswith("? simulated: no set meets the targets")
    assert "so none is written; --best writes the best one" in hard.stderr
    assert invoke(*words, "1e-9", "--stability", "proof", "--format", "toml").stdout == ""
    best = invoke(*words, "1e-9", "--stability", "proof", "--out", str(out), "--best")
    assert best.exit_code == 3
    assert "# BEST FOUND, MISSES THE TARGETS: misses" in out.read_text()
    assert invoke("gate", str(out)).exit_code == 0


KNOWN = st.one_of(st.just(0.0), st.just(math.inf), st.floats(0, 1e9))


@given(
    rows=st.lists(st.tuples(*[st.tuples(*[KNOWN] * 4)] * 2), min_size=0, max_size=3),
    asked=st.sampled_from(
        [Wishes(overshoot=5), Wishes(settle=1e-9), Wishes(rest_error=1e6), Wishes(5, 1.5, 0.8, 20)]
    ),
    kept=st.booleans(),
)
def test_every_number_of_a_trial_has_words(
    rows: list[tuple[tuple[float, ...], ...]], asked: Wishes, kept: bool
) -> None:
    model, bench = robots.load("reyes-kelly2"), Trials(asked, (task_for(2, [0.8, 0.8], None, None, 5.0),))
    sets = []
    for k, row in enumerate(rows):
        columns = [np.array(column) for column in zip(*row, strict=True)]
        trial = Trial(asked, *columns[:3], np.zeros(2), columns[3], T=3.0, kept=kept)
        way = ("19", "proof", "19")[k]
        gains = GainSet(
            f"s{k}", k + 1, (Fraction(1),) * 2, (Fraction(1),) * 2, condition=("10p", "19")[: 2 * k]
        )
        sets.append(Candidate(gains, trial, way, ("(10p)", "")))
    tuning = BenchTuning("arm", model, bench, tuple(sets))
    for form in FORMATS:
        assert tuning.written(form)
    assert (tuning.exit == Exit.PROVED) == tuning.document().title.startswith(("!", "✓"))
    assert "nan" not in str(tuning)
    assert tuning.gain_file() == "" or tuning.good
    assert bool(replace(tuning, marked=True).gain_file()) == bool(tuning.sets)


def test_a_torque_limit_that_the_user_gives_counts_like_one_of_the_arm_file(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Shares are of the limit that is given, also where the file has another or none."""
    monkeypatch.setattr(search, "MOST_STEPS", 300)
    told, other, bare = (tmp_path / f"{name}.toml" for name in ("told", "other", "bare"))
    text = ONE_JOINT.format(viscous=0.1, torque=10, more="")
    told.write_text(text)
    other.write_text(text.replace("torque_limit = 10", "torque_limit = 40"))
    bare.write_text(text.replace("torque_limit = 10", ""))
    bench = Trials(Wishes(settle=1, peak_share=0.5), (task_for(1, [0.8], None, None, 5.0),), ("proof",))
    shares = []
    for arm, bounds in ((told, None), *((arm, Bounds(torque=(Fraction(10),))) for arm in (other, bare))):
        (one,) = tune_for(str(arm), bench, [1], bounds).sets
        shares.append((one.gains, *one.trial.share))
    assert shares[0] == shares[1] == shares[2]
    assert shares[0][1] > 0


def test_an_error_at_rest_is_not_met_without_a_known_dry_friction() -> None:
    bench = Trials(Wishes(rest_error=5), (task_for(1, [0.8], None, None, 5.0),), ("proof",))
    answer = tune_for("pendulum1", bench, [1])
    assert answer.exit == Exit.UNDECIDED
    assert not answer.good
    assert answer.document().title.startswith("? simulated:")
    assert answer.document().title.endswith("is open; error at rest unknown")
    assert "the arm file gives no dry friction of pivot" in str(answer)
    assert answer.records()[0]["rest_error"] is None


def test_what_a_computer_allows_is_not_said_to_be_what_19_allows() -> None:
    """Where the rate leaves less k_v than (19) does, (19) does not keep it from being larger."""
    model = robots.load("pendulum1")
    bench = Trials(Wishes(settle=3), (task_for(1, [0.8], None, None, 5.0),))
    search = Search(bench, [model], limits_with(model), 1, BY_19)
    top = search.most_kv[0] * search.unit
    assert search._held(GainSet("at", 1, (search.unit,), (top,))) == ("(19)",)
    search.most_kv = [search.most_kv[0] // 2]
    half = search.most_kv[0] * search.unit
    assert search._held(GainSet("below", 1, (search.unit,), (half,))) == ("",)
