"""No answer says a word of proof but through a promise: with promises turned into *seen*, none is left."""

from dataclasses import replace
from fractions import Fraction
from importlib import import_module

import pytest

from lyapcheck.control.judgement import resting
from lyapcheck.search.certified import certified_epsilon
from tests.helpers.command import invoke
from tests.helpers.shares import but
from tests.helpers.words_of_proof import left_over

FILES = {
    "pendulum.toml": 'robot = "pendulum1"\n[[gains]]\nname = "one"\nm = 1\nkp = [5]\nkv = [0.2]\n',
    "arm.toml": """
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
EPSILON = ("epsilon", "pendulum.toml", "--starts", "2", "--max-boxes", "60")
BOUNDS = ("bounds", "arm.toml", "--target", "45,90", "--time", "0.1")
SIMULATE = ("simulate", "arm.toml", "--time", "0.2")
TARGET = ("--target", "45,90")
ASKED = {
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
    "sweep": ("sweep", "plan.toml", "--jobs", "1", "--out", "sweep"),
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


@pytest.mark.parametrize("name", but(set(ASKED) - {"epsilon with weights", "sweep", "check"}, ASKED))
def test_every_word_of_proof_is_a_promise(name, monkeypatch):
    assert not left_over(ASKED[name], monkeypatch)


def test_a_proof_about_the_nominal_arm_answers_no_question_about_ranges(monkeypatch):
    def nominal(controlled, *rest, **more):
        return certified_epsilon(replace(controlled, ranges=False), *rest, **more)

    monkeypatch.setattr("lyapcheck.answers.epsilon.compute.certified_epsilon", nominal)
    done = invoke(*EPSILON, "--vary", "viscous=-20%..+20%")
    assert done.exit_code == 3
    assert done.stdout.startswith("? no ε₀ is certified for one")
    assert "what is proved does not answer the question" in " ".join(done.stdout.split())


def test_a_proof_about_less_friction_or_larger_errors_answers_no_question_of_bounds(monkeypatch):
    def easier(gains, dry):
        return resting(gains, [Fraction(9, 10) * f for f in dry])

    words = (*BOUNDS, "--friction", "1,0.5")
    assert invoke(*words).exit_code == 0
    monkeypatch.setattr(import_module("lyapcheck.answers.bounds.compare"), "resting", easier)
    done = invoke(*words)
    assert done.exit_code == 3
    assert done.stdout.startswith("? not all errors at rest are proved")
    assert "what is proved does not answer the question (Resting.torque" in " ".join(done.stdout.split())
