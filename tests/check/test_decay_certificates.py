"""Bounds of motions as statements: accepted from their files, refused when what matters is changed."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from lyapcheck.answers.bounds.certificates import certificates
from lyapcheck.answers.bounds.compare import compare
from lyapcheck.certificate import Certificate
from lyapcheck.check.certificate import digest_of, judge, parse, read
from lyapcheck.check.kinds.decreasing import BoxTree
from lyapcheck.check.kinds.inertia import Bisection
from lyapcheck.check.kinds.resting import AtBounds, Resting, RestWitness
from lyapcheck.check.kinds.settling import FallingLevels, Settling
from lyapcheck.check.kinds.stopping import ComesToRest, EnergyFalls
from lyapcheck.check.refusal import Refused
from lyapcheck.check.verify import verify
from lyapcheck.claims.procedures import propose
from lyapcheck.control.gains import read_gain_file
from lyapcheck.control.paper import paper_gain_file
from lyapcheck.rechecking.trusted import modules
from lyapcheck.robots import load
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.search.decay.bounds import settling_bound
from lyapcheck.simulate.task import Task
from lyapcheck.verdicts import Verdict
from tests.helpers.command import invoke
from tests.helpers.shares import but, one_in

pytestmark = pytest.mark.usefixtures("in_this_process")

F = Fraction
Document = dict[str, Any]


@pytest.fixture(scope="module")
def made() -> dict[str, Certificate]:
    """All certificates of one gain set on the two-joint arm, a settling time in phases and at one ε₀."""
    gains = read_gain_file(paper_gain_file("table2_shoulder_elbow")).gains[0]
    task = Task((math.pi / 4, math.pi / 2), (0.0, 0.0), (0.0, 0.0), 0.5)
    arm, delta = load("reyes-kelly2"), math.radians(10)
    found = compare(gains, arm, task, delta, (0.1, 0.05), max_boxes=4_000)
    at_one = settling_bound(
        ControlledArm(gains, arm), task.step, task.w0, delta, in_phases=False, max_boxes=4_000
    )
    kinds = {
        name.split(".")[1]: certificate
        for name, certificate in certificates(replace(found, settling=at_one)).items()
    }
    return kinds | {"phases": certificates(found)["tau_m1.settling.json"]}


def reread(certificate: Certificate, change: Callable[[Document], None] = lambda data: None) -> Certificate:
    """The certificate from its text, changed by somebody who knows how to make a digest."""
    data = json.loads(certificate.text())
    change(data)
    data["digest"] = digest_of({key: value for key, value in data.items() if key != "digest"})
    return read(parse(json.dumps(data)))


def put(value: Any, *path: Any) -> Callable[[Document], None]:
    """Put a value at a place."""

    def change(data: Document) -> None:
        for step in path[:-1]:
            data = data[step]
        data[path[-1]] = value

    return change


def test_all_are_accepted_from_their_text(made: dict[str, Certificate]) -> None:
    assert set(made) == {"settling", "disturbed", "resting", "phases"}
    for certificate in made.values():
        accepted = judge(reread(certificate))
        assert (accepted.verdict, accepted.grade) == ("proved", "enclosure")


def drop_a_level(data: Document) -> None:
    """One level fewer, and the λ of the band above it."""
    del data["statement"]["envelope"][3]
    del data["proof"]["slopes"][2]


def hasten(data: Document) -> None:
    """A last time that is a per mille smaller."""
    last = data["statement"]["envelope"][-1]
    last[0] = str(F(last[0]) * 999 / 1000)


def start_lower(data: Document) -> None:
    """A first level that is half of what it was."""
    first = data["statement"]["envelope"][0]
    first[1] = str(F(first[1]) - F(1, 1000))


def end_nearer(data: Document) -> None:
    """Errors that are a per mille smaller."""
    data["statement"]["errors"] = [str(F(x) * 999 / 1000) for x in data["statement"]["errors"]]


FAULTS: list[tuple[str, Callable[[Document], None], str]] = [
    ("a smaller time", hasten, "too short"),
    ("fewer levels", drop_a_level, "too short|is not shown to fall"),
    ("a lower first level", start_lower, "where V may start"),
    ("smaller errors", end_nearer, "allows at most"),
    ("smaller errors on the way", put(["1/2", "1"], "statement", "largest_errors"), "allows at most"),
    ("a farther start", put(["1", "8/5"], "statement", "errors_at_start"), "where V may start"),
    ("a faster start", put(["1", "0"], "statement", "rates_at_start"), "where V may start"),
    ("far more friction", put([["300", "300"], ["7/40", "7/40"]], "statement", "viscous"), "."),
    ("less friction", put([["2", "2"], ["7/40", "7/40"]], "statement", "viscous"), "."),
    ("another stiffness", put(["59", "6"], "statement", "kp"), "."),
    ("another member", put(2, "statement", "m"), "."),
    ("a larger ε₀", put("7/10", "statement", "eps0"), "."),
    ("a steeper λ", put("1000", "proof", "slopes", 0), "must be from 0 to"),
    ("λ = 0", put("0", "proof", "slopes", -1), "too short|is not shown to fall"),
    ("one λ fewer", put([], "proof", "slopes"), "one a band"),
    ("a larger share of friction", put("9/10", "proof", "friction"), "."),
    ("a smaller u", put(["1/10", "1/10"], "proof", "heaviest"), "."),
    ("one box", put(".", "proof", "decreasing", "rate", "tree"), "dV/dt|tree"),
    ("no level", put([], "statement", "envelope"), "must have a level"),
    ("a torque below 0", put(["-1", "0"], "statement", "torque"), "from 0 to"),
]
LONG = ("another member", "a larger ε₀")
"""Refused by some late box, as another stiffness is by an early one."""


@pytest.mark.parametrize("kind", one_in(2, ["settling", "disturbed"]))
@pytest.mark.parametrize(
    ("name", "change", "says"),
    but([fault for fault in FAULTS if fault[0] not in LONG], FAULTS),
    ids=[name for name, *_ in FAULTS],
)
def test_altered_bounds_are_refused(
    made: dict[str, Certificate], kind: str, name: str, change: Callable[[Document], None], says: str
) -> None:
    with pytest.raises(Refused, match=says):
        judge(reread(made[kind], change))


PHASE_FAULTS: list[tuple[str, Callable[[Document], None], str]] = [
    ("an earlier time", put("1", "statement", "within", -1, 0), "allows at most|after"),
    ("smaller errors", put(["1/10", "1/10"], "statement", "within", -1, 1), "allows at most"),
    (
        "a farther start",
        put(["1", "8/5"], "statement", "errors_at_start"),
        "at least|floor|kept by the energy",
    ),
    ("a faster start", put(["1", "1"], "statement", "rates_at_start"), "at least|floor|kept by the energy"),
    ("less damping", put(["1/1000", "1/1000"], "statement", "kv"), "."),
    ("a stiffer loop", put(["90", "9"], "statement", "kp"), "."),
    ("errors that die out sooner", put("1/10", "statement", "after", "scale"), "shorter"),
    ("smaller errors that die out", put(["1/100"] * 2, "statement", "after", "sizes"), "allows at most"),
    ("a higher floor", put(["9/10", "9/10"], "proof", "phases", 0, "floors"), "floor"),
    ("no bound of the errors", put([], "proof", "phases", 0, "within"), "must bound|is not shown"),
    ("tighter errors", put(["1/2", "1/2"], "proof", "phases", 0, "within"), "kept by the energy"),
    ("a heavier least inertia", put(["100", "100"], "proof", "lightest"), "must be proved|M −|bound"),
    ("a larger ε₀", put("50", "proof", "phases", 0, "eps0"), "."),
]


@pytest.mark.parametrize(
    ("name", "change", "says"), one_in(3, PHASE_FAULTS), ids=[name for name, *_ in PHASE_FAULTS]
)
def test_altered_phases_are_refused(
    made: dict[str, Certificate], name: str, change: Callable[[Document], None], says: str
) -> None:
    with pytest.raises(Refused, match=says):
        judge(reread(made["phases"], change))


def test_coming_to_rest_is_decided() -> None:
    """Whatever the gains, on an arm that is one; (19) is not asked."""
    one = (((0, 0), F(1)),)
    friction, gains = ((F(1), F(1)),), ("hyperbolic", 1, (F(2),), (F(50),))
    statement = ComesToRest(((one,),), friction, (), *gains, (F(1),), (F(11, 20),))
    assert propose(statement).verdict is Verdict.PROVED
    assert "w → 0" in statement.text()
    near = replace(statement, errors=(F(1, 2),))
    assert propose(near).verdict is Verdict.REFUTED
    assert propose(replace(statement, dry=(F(3),), errors=(None,))).verdict is Verdict.PROVED
    assert propose(replace(statement, dry=(F(2),))).verdict is Verdict.REFUTED
    with pytest.raises(Refused):
        verify(replace(statement, mass=(((((0, 0), F(-1)),),),)), EnergyFalls(Bisection()))
    with pytest.raises(Refused, match="must be positive"):
        verify(replace(statement, viscous=((F(0), F(1)),)), EnergyFalls(Bisection()))


def test_another_arm_is_refused(made: dict[str, Certificate]) -> None:
    certificate = made["settling"]
    assert isinstance(certificate.statement, Settling)
    M = certificate.statement.mass
    heavier = tuple(tuple(tuple((powers, 2 * c) for powers, c in entry) for entry in row) for row in M)
    with pytest.raises(Refused):
        verify(replace(certificate.statement, mass=heavier), certificate.proof)


def test_more_torque_than_was_reckoned_with_is_refused(made: dict[str, Certificate]) -> None:
    calm, pushed = made["settling"], made["disturbed"]
    assert isinstance(calm.statement, Settling)
    assert isinstance(pushed.statement, Settling)
    with pytest.raises(Refused, match="share of the damping"):
        verify(replace(calm.statement, torque=(F(1), F(0))), calm.proof)
    with pytest.raises(Refused):
        verify(replace(calm.statement, dry=(F(1), F(0))), calm.proof)
    with pytest.raises(Refused):
        verify(replace(pushed.statement, torque=(F(1), F(1))), pushed.proof)


def test_one_level_is_kept_only_where_nothing_acts(made: dict[str, Certificate]) -> None:
    """At the goal V = 0 is below any level, but a torque moves the arm away from there."""
    for kind, holds in (("settling", True), ("disturbed", False)):
        statement, proof = made[kind].statement, made[kind].proof
        assert isinstance(statement, Settling)
        assert isinstance(proof, FallingLevels)
        errors = (F(1, 1000),) * 2
        zero = (F(0),) * 2
        at_goal = replace(
            statement,
            errors_at_start=zero,
            rates_at_start=zero,
            envelope=((F(0), F(1, 10**8)),),
            largest_errors=errors,
            errors=errors,
        )
        if holds:
            assert verify(at_goal, replace(proof, slopes=())).verdict == "proved"
        else:
            with pytest.raises(Refused, match="need not be kept"):
                verify(at_goal, replace(proof, slopes=()))


def test_the_text_says_all_of_it(made: dict[str, Certificate]) -> None:
    text = made["disturbed"].statement.text()
    for part in (
        "|d_i| ≤ (0.1, 0.05) N·m",
        "dry friction",
        "0.785399",
        "about 45°",
        "M11 = ",
        "K_p = diag(60, ",
    ):
        assert part in text
    granted = " ".join(made["disturbed"].statement.granted)
    assert "dry friction" in granted
    assert "dry friction" not in " ".join(made["settling"].statement.granted)


RESTING = Resting("hyperbolic", 2, (F(10), F(5)), (F(2), F(5)), (F(3, 5), None))


def test_states_of_rest_are_decided() -> None:
    assert verify(RESTING, AtBounds()).verdict == "proved"
    assert propose(RESTING).verdict is Verdict.PROVED
    tight = replace(RESTING, errors=(F(1, 2), None))
    with pytest.raises(Refused, match="as large as"):
        verify(tight, AtBounds())
    assert propose(tight).verdict is Verdict.REFUTED
    with pytest.raises(Refused, match="beyond the bound"):
        verify(tight, RestWitness(0, F(1, 2)))
    with pytest.raises(Refused, match="held"):
        verify(tight, RestWitness(0, F(2, 3)))
    with pytest.raises(Refused):
        verify(replace(RESTING, errors=(F(3, 5), F(100))), AtBounds())
    still = replace(RESTING, torque=(F(0), F(0)), errors=(F(0), F(0)))
    assert verify(still, AtBounds()).verdict == "proved"


def test_a_settling_time_by_itself_is_open_with_advice(made: dict[str, Certificate]) -> None:
    result = propose(made["settling"].statement)
    assert result.verdict is Verdict.UNDECIDED
    assert "lyapcheck bounds" in result.reason


def test_what_the_verdict_rests_on_is_listed() -> None:
    kinds = "lyapcheck.check.kinds"
    used = modules([("", f"{kinds}.settling:Settling {kinds}.settling:FallingLevels")])
    for part in ("estimate", "margin", "least"):
        assert f"lyapcheck.check.loop.decay.{part}" in used
    used = modules([("", f"{kinds}.resting:Resting {kinds}.resting:AtBounds")])
    assert "lyapcheck.check.kinds.resting" in used


GAINS = 'robot = "{robot}"\n[[gains]]\nname = "one"\nm = 1\nkp = [60, 5]\nkv = [0.2, 0.2]\n'
HOLLOW = """
title = "An arm whose M is not positive definite"
[model]
M11 = [[1, ""], [1.05, "c2"]]
M12 = []
M22 = [[0.1, ""]]
potential = []
[[joints]]
name = "shoulder"
viscous = 2
[[joints]]
name = "elbow"
viscous = 0.5
"""


@pytest.mark.slow
def test_the_command_writes_what_recheck_accepts(tmp_path: Path) -> None:
    gains, made = tmp_path / "gains.toml", tmp_path / "made"
    gains.write_text(GAINS.format(robot="reyes-kelly2"))
    asked = ["bounds", str(gains), "--target", "45,90", "--delta", "10", "--time", "0.5"]
    outcome = invoke(*asked, "--certificates", str(made), "--format", "json")
    assert outcome.exit_code == 0
    assert {path.name for path in made.iterdir()} == {
        f"one.{kind}.json" for kind in ("settling", "disturbed", "resting")
    }
    rechecked = invoke("recheck", str(made), "--trusted")
    assert rechecked.exit_code == 0
    assert "3 accepted (3 proved" in rechecked.stdout
    assert "loop.decay.estimate" in rechecked.stdout
    (result,) = json.loads(outcome.stdout)["results"]
    statement = read(parse((made / "one.settling.json").read_text(encoding="utf-8"))).statement
    assert result["settling"]["statement"] == statement.text()


@pytest.mark.slow
def test_an_arm_that_is_none_has_no_bounds(tmp_path: Path) -> None:
    """With M11 = 1 + 1.05 cos q2 a run leaves any bound that V would give."""
    gains, made = tmp_path / "gains.toml", tmp_path / "made"
    (tmp_path / "hollow.toml").write_text(HOLLOW)
    gains.write_text(GAINS.format(robot="hollow.toml"))
    asked = ["bounds", str(gains), "--target", "5,0", "--delta", "10", "--time", "0.1"]
    result = invoke(*asked, "--disturbance", "0.1,0.1", "--certificates", str(made))
    assert result.exit_code == 3
    assert "M(q) is not positive definite at q = (" in result.stdout
    assert "certified: within" not in result.stdout
    assert "certified: |e|" not in result.stdout
    assert list(made.iterdir()) == []


@pytest.mark.slow
def test_a_proof_cannot_do_without_its_mass(made: dict[str, Certificate]) -> None:
    """A statement about an arm that is none is refused, whatever the rest of its proof says."""
    statement, proof = made["settling"].statement, made["settling"].proof
    assert isinstance(statement, Settling)
    assert isinstance(proof, FallingLevels)
    one, cosine = (0, 0, 0, 0), (0, 0, 0, 1)
    mass = (((one, F(1)), (cosine, F(21, 20))), ()), ((), ((one, F(1, 10)),))
    with pytest.raises(Refused):
        verify(replace(statement, mass=mass), proof)
    free = replace(proof, decreasing=replace(proof.decreasing, rate=BoxTree(".")))
    with pytest.raises(Refused):
        verify(replace(statement, mass=mass), free)
