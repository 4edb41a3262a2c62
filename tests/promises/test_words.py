"""No answer says a word of proof but through a promise: with promises turned into *seen*, none is left."""

from dataclasses import replace
from fractions import Fraction as F
from pathlib import Path

import pytest

from lyapcheck.answers.gate.promises import shown_gravity
from lyapcheck.answers.gate.stability import positive
from lyapcheck.check.kinds.gate_accepted import GateAccepted
from lyapcheck.control.judgement import judged_statement
from lyapcheck.robots import load
from lyapcheck.robots.fields import Vary
from lyapcheck.search.certified import certified_epsilon
from lyapcheck.search.controlled_arm import ControlledArm
from tests.helpers.arm_texts import ONE_LINK
from tests.helpers.command import invoke
from tests.helpers.shares import but
from tests.helpers.words_of_proof import left_over, words_of_proof

ROOT = Path(__file__).parents[2]
FRICTION = 'coulomb = {value = 0.1, low = 0.1, high = 0.2, assumed = true, note = "x"}'
ARM = ONE_LINK.format(mass=1, viscous=2, more=FRICTION)
GAINS = """
[[gains]]
name = "passes"
m = 1
kp = [40]
kv = [1]
[[gains]]
name = "saturates"
m = 2
kp = [100]
kv = [3]
"""
FILES = {
    "arm.toml": ARM,
    "gains.toml": f'robot = "arm.toml"{GAINS}',
    "own.toml": f"{GAINS}[bounds]\nviscous_min = 2\ntorque = [60]\ngravity = [4.905]\n",
    "free.toml": 'robot = "ur5"\n[[gains]]\nname = "a"\nm = 1\n'
    f"kp = [{', '.join(['1'] * 6)}]\nkv = [{', '.join(['0.1'] * 6)}]\n",
    "wrong.toml": f'robot = "wrong_arm.toml"{GAINS}',
    "wrong_arm.toml": ARM + "gravity_bound = 1\n",
    "gates.toml": 'robots = ["arm.toml"]\nvariations = [[], ["payload=0..2"]]\nquestions = ["gate"]\n'
    + GAINS,
    "pendulum.toml": 'robot = "pendulum1"\n[[gains]]\nname = "one"\nm = 1\nkp = [5]\nkv = [0.2]\n',
    "two.toml": """
robot = "reyes-kelly2"
[[gains]]
name = "stiff"
m = 1
kp = [60, 9]
kv = [0.1, 0.1]
[[gains]]
name = "weak"
m = 2
kp = [60, 1.7]
kv = [0.1, 0.1]
""",
    "wave.toml": 'kind = "sine"\namplitude = [20, 30]\nfrequency = [0.5, 0.25]\n',
    "plan.toml": """
robots = ["reyes-kelly2"]
variations = [[], ["coulomb=-10%..+20%"]]
questions = ["epsilon", "bounds", "simulate"]
[[gains]]
name = "stiff"
m = 1
kp = [60, 9]
kv = [0.1, 0.1]
[epsilon]
max_boxes = 60
starts = 1
[bounds]
time = 0.1
target = [45, 90]
[simulate]
time = 0.1
target = [45, 90]
""",
}
TABLE2, PANDA = str(ROOT / "proofs/table2.toml"), str(ROOT / "examples/panda_gains.toml")
TARGETS = ("--overshoot", "5", "--settle", "2.5", "--goal", "45")
EPSILON = ("epsilon", "pendulum.toml", "--starts", "2", "--max-boxes", "60")
BOUNDS = ("bounds", "two.toml", "--target", "45,90", "--time", "0.1")
SIMULATE = ("simulate", "two.toml", "--time", "0.2")
TARGET = ("--target", "45,90")
ASKED = {
    "export": ("export", "gains.toml", "--out", "c", "--rate", "1000", "--longest", "3 ms"),
    "gate": ("gate", TABLE2),
    "gate, a proof for the arm": ("gate", TABLE2, "--condition", "10i", "--condition", "scalar"),
    "gate over ranges": ("gate", TABLE2, "--vary", "viscous=-30%..+30%"),
    "gate over ranges, a proof": ("gate", "gains.toml", "--vary", "payload=0..2", "--condition", "scalar"),
    "gate without an arm": ("gate", "own.toml"),
    "gate without friction": ("gate", "free.toml"),
    "gate on a false bound": ("gate", "wrong.toml"),
    "gate on links too many to write out": ("gate", PANDA),
    "tune": ("tune", "buap3", "--m", "1"),
    "tune, all that may be asked": (
        *("tune", "arm.toml", "--m", "1:3", "--damping", "0.2", "--kv-share", "0.5", "--peak-share", "0.9"),
        *("--vary", "payload=0..2"),
    ),
    "tune what cannot be": ("tune", "arm.toml", "--m", "1", "--kv-share", "1", "--viscous-min", "70"),
    "tune to targets": ("tune", "arm.toml", "--m", "1", *TARGETS),
    "tune to targets that are missed": ("tune", "arm.toml", "--m", "1", "--settle", "0.01", "--goal", "45"),
    "sweep": ("sweep", "gates.toml", "--jobs", "1", "--out", "swept"),
    "epsilon": EPSILON,
    "epsilon over ranges": (*EPSILON, "--vary", "viscous=-20%..+20%"),
    "epsilon with weights": (*EPSILON, "--weights"),
    "bounds": BOUNDS,
    "bounds over ranges": (*BOUNDS, "--vary", "coulomb=-10%..+20%"),
    "bounds of nothing": ("bounds", "pendulum.toml", "--target", "45", "--time", "0.1"),
    "simulate": (*SIMULATE, *TARGET),
    "simulate what breaks a promise": (*SIMULATE, *TARGET, "--eps0", "100"),
    "simulate the experiment": (*SIMULATE, *TARGET, "--experiment"),
    "simulate over ranges": (*SIMULATE, *TARGET, "--vary", "viscous=-20%..+20%"),
    "simulate many": (*SIMULATE, *TARGET, "--runs", "3"),
    "simulate along a reference": (*SIMULATE, "--reference", "wave.toml"),
    "sweep all else": ("sweep", "plan.toml", "--jobs", "1", "--out", "sweep"),
    "robot": ("robot", "pendulum1"),
    "robot with ranges": ("robot", "buap3", "--max-boxes", "200"),
    "table": ("table", "--m", "1:3"),
    "check": ("check", "scalar.py", "--m", "1"),
    "check of some": ("check", "scalar.py", "--m", "1", "--only", "arm.theta"),
    "derive": ("derive", "--m", "1,2", "--n", "2"),
}


@pytest.fixture(autouse=True)
def in_a_folder_with_files(tmp_path, monkeypatch):
    for name, text in FILES.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    monkeypatch.chdir(tmp_path)


FAST = {
    *("export", "gate", "gate over ranges", "tune", "sweep", "epsilon over ranges", "bounds over ranges"),
    *("simulate over ranges", "simulate many", "robot", "table", "check of some", "derive"),
}


@pytest.mark.parametrize("name", but(FAST, ASKED))
def test_every_word_of_proof_is_a_promise(name, monkeypatch):
    assert not left_over(ASKED[name], monkeypatch)


def undecided(*words):
    """What an answer says that must be undecided, since what is proved is about something else."""
    done = invoke(*words)
    assert (done.exit_code, done.stdout[:1]) == (3, "?")
    text = " ".join(done.stdout.split())
    assert "accepted" not in text
    return text


def judge_another(monkeypatch, **fields):
    """Have the gate judge its statement about numbers with other fields than were asked about."""

    def judged(asked, proofs):
        return judged_statement(
            replace(asked, **fields) if isinstance(asked, GateAccepted) else asked, proofs
        )

    monkeypatch.setattr("lyapcheck.answers.gate.promises.judged_statement", judged)


def with_less_friction(monkeypatch, share):
    """Have bounds at rest judged for a share of the dry friction that was asked about."""

    def judged(asked, proofs):
        return judged_statement(replace(asked, torque=tuple(share * f for f in asked.torque)), proofs)

    monkeypatch.setattr("lyapcheck.answers.gate.friction.judged_statement", judged)


RANGED = ("gate", "passes.toml", "--vary", "payload=0..2")


@pytest.fixture
def passes():
    """A file of the set that passes alone."""
    Path("passes.toml").write_text(FILES["gains.toml"].partition('[[gains]]\nname = "saturates"')[0])


@pytest.mark.usefixtures("passes")
def test_limits_of_the_nominal_arm_answer_no_question_about_ranges(monkeypatch):
    assert invoke(*RANGED).exit_code == 0
    judge_another(monkeypatch, parameters=((F(1), F(1)),))
    assert "does not answer the question (GateAccepted.parameters" in undecided(*RANGED)


@pytest.mark.usefixtures("passes")
def test_larger_motors_and_more_friction_answer_nothing(monkeypatch):
    for field, stronger in {"limits": (F(61),), "viscous": ((F(3), F(3)),)}.items():
        with monkeypatch.context() as patch:
            judge_another(patch, **{field: stronger})
            assert f"GateAccepted.{field}" in undecided(*RANGED)


@pytest.mark.usefixtures("passes")
def test_gravity_of_the_nominal_arm_answers_no_question_about_ranges(monkeypatch):
    monkeypatch.setattr(
        "lyapcheck.answers.gate.promises.shown_gravity",
        lambda arm, k_g: shown_gravity(load("arm.toml", vary=[Vary.parsed("payload=0..1")]), k_g),
    )
    assert "does not answer the question (GravityOfPotential.parameters" in undecided(*RANGED)


@pytest.mark.usefixtures("passes")
@pytest.mark.parametrize("condition", ["scalar", "lasalle"])
def test_a_proof_about_the_nominal_arm_accepts_nothing_over_ranges(monkeypatch, condition):
    words = (*RANGED, "--condition", condition)
    assert invoke(*words).exit_code == 0
    monkeypatch.setattr(
        "lyapcheck.search.controlled_arm.ControlledArm",
        lambda gains, arm, ranges: ControlledArm(gains, arm.fixed(), False),
    )
    monkeypatch.setattr("lyapcheck.answers.gate.stability.positive", lambda arm: positive(arm.fixed()))
    assert "does not answer the question (" in undecided(*words)


@pytest.mark.usefixtures("passes")
def test_less_dry_friction_than_the_largest_promises_no_angle(monkeypatch):
    assert "leaves at most" in invoke(*RANGED).stdout

    with_less_friction(monkeypatch, F(1, 2))
    assert "leaves at most" not in invoke(*RANGED).stdout


def test_a_proof_about_the_nominal_arm_answers_no_question_about_ranges(monkeypatch):
    def nominal(controlled, *rest, **more):
        return certified_epsilon(replace(controlled, ranges=False), *rest, **more)

    monkeypatch.setattr("lyapcheck.answers.epsilon.compute.certified_epsilon", nominal)
    done = invoke(*EPSILON, "--vary", "viscous=-20%..+20%")
    assert done.exit_code == 3
    assert done.stdout.startswith("? no ε₀ is certified for one")
    assert "what is proved does not answer the question" in " ".join(done.stdout.split())


def test_a_proof_about_less_friction_or_larger_errors_answers_no_question_of_bounds(monkeypatch):
    words = (*BOUNDS, "--friction", "1,0.5")
    assert invoke(*words).exit_code == 0
    with_less_friction(monkeypatch, F(9, 10))
    done = invoke(*words)
    assert done.exit_code == 3
    assert done.stdout.startswith("? not all errors at rest are proved")
    assert "what is proved does not answer the question (Resting.torque" in " ".join(done.stdout.split())


def test_the_words_are_found():
    assert words_of_proof("✓ accepted; at most 3.2°")
    assert not words_of_proof("no ε₀ is certified")
    assert not words_of_proof("use `gate --condition stable` or --stable")
