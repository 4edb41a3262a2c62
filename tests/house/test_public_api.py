"""What ``import lyapcheck`` offers, and what it costs."""

import ast
import doctest
import inspect
import subprocess
import sys
from dataclasses import replace
from fractions import Fraction
from importlib import import_module
from importlib.metadata import version
from pathlib import Path

import pytest

import lyapcheck
from lyapcheck import _HOMES, claims, store
from lyapcheck import __all__ as PUBLIC
from tests.helpers.command import lyapcheck as lyapcheck_command
from tests.helpers.shares import but

HEAVY = ("numpy", "scipy", "sympy", "casadi", "cvxpy", "matplotlib", "flint", "rich", "jinja2", "argparse")
OBJECTS = [name for name in PUBLIC if name != "__version__"]


def declared():
    """The imports that a type checker sees, in the form of the table that Python uses."""
    result = {}
    tree = ast.parse(Path(lyapcheck.__file__).read_text(encoding="utf-8"))
    guarded = next(node for node in tree.body if isinstance(node, ast.If))
    for node in guarded.body:
        if isinstance(node, ast.ImportFrom) and str(node.module).startswith("lyapcheck."):
            module = str(node.module).removeprefix("lyapcheck.")
            for alias in node.names:
                result[alias.asname or alias.name] = f"{module}:{alias.name}" if alias.asname else module
    return result


def test_the_list_the_homes_and_the_types_name_the_same_things():
    assert declared() == _HOMES
    assert OBJECTS == list(_HOMES) == sorted(_HOMES)


@pytest.mark.parametrize("name", OBJECTS)
def test_every_name_resolves_to_something_documented(name):
    value = getattr(lyapcheck, name)
    assert inspect.isclass(value) or inspect.isfunction(value) or callable(value)
    assert (inspect.getdoc(value) or "").strip()
    assert value.__module__.startswith("lyapcheck.")


def test_no_public_name_hides_a_room():
    """A room and a function of one name would make the meaning depend on what was imported before."""
    rooms = {path.stem for path in Path(lyapcheck.__file__).parent.iterdir()}
    assert not rooms & set(PUBLIC)


def test_the_version_is_that_of_the_distribution():
    assert lyapcheck.__version__ == version("lyapcheck")


def test_an_unknown_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match="no attribute 'frobnicate'"):
        lyapcheck.frobnicate


def test_names_are_listed_and_kept():
    assert set(PUBLIC) <= set(dir(lyapcheck))
    assert lyapcheck.Verdict is import_module("lyapcheck.verdicts").Verdict
    assert vars(lyapcheck)["Verdict"] is lyapcheck.Verdict


def test_importing_lyapcheck_imports_nothing_heavy():
    code = (
        "import sys, typing, importlib, lyapcheck\n"
        "print(*sorted({name.partition('.')[0] for name in sys.modules}))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert not set(HEAVY) & set(done.stdout.split())


def test_a_type_checker_may_trust_the_annotations():
    assert (Path(lyapcheck.__file__).parent / "py.typed").is_file()


def homes_with_examples():
    """The modules of public names whose documentation has examples."""
    root = Path(lyapcheck.__file__).parent
    names = sorted({home.partition(":")[0] for home in _HOMES.values()})
    files = [
        (name, root / f"{name.replace('.', '/')}{end}") for name in names for end in (".py", "/__init__.py")
    ]
    return [name for name, file in files if file.is_file() and ">>> " in file.read_text(encoding="utf-8")]


@pytest.mark.parametrize("home", but(["answers.table"], homes_with_examples()))
def test_the_examples_of_the_documentation_are_true(home):
    failed, tried = doctest.testmod(import_module(f"lyapcheck.{home}"))
    assert failed == 0
    assert tried > 0


ANGLES = {"q", "w", "e", "q0", "w0", "q_d", "target", "start", "goal", "velocity", "band", "within"}


@pytest.mark.parametrize("name", [name for name in OBJECTS if inspect.isfunction(getattr(lyapcheck, name))])
def test_an_argument_that_is_an_angle_names_its_unit(name):
    value = getattr(lyapcheck, name)
    names = inspect.signature(value).parameters
    assert not ANGLES & set(names)
    for argument in names:
        if argument.endswith(("_rad", "_deg")):
            (said,) = (line for line in value.__doc__.splitlines() if line.strip().startswith(f"{argument}:"))
            assert "rad" in said if argument.endswith("_rad") else "deg" in said or "angle" in said


def test_gains_and_arms_print_as_one_short_line():
    gains = lyapcheck.read_gain_file(lyapcheck.paper_gain_file("table2")).gains[0]
    assert repr(gains) == "<GainSet: tau_m1, m = 1, kp = [28, 60, 5], kv = [0.233, 0.233, 0.233]>"
    arm = lyapcheck.load_robot("buap3")
    assert repr(arm) == "<RobotModel: buap3, 3 joints, 10 of 18 numbers assumed>"
    limits = lyapcheck.limits_for(lyapcheck.read_gain_file(lyapcheck.paper_gain_file("table2")))
    assert repr(limits) == "<Limits: buap3, 3 joints, torque (50, 150, 15) N·m>"
    assert repr(lyapcheck.hyperbolic_constants(1).gamma) == "<Enclosure: 1.000000000>"
    assert repr(lyapcheck.hyperbolic_constants(2).gamma) == "<Enclosure: [1.053569219 +/- 3.38e-11]>"
    third = lyapcheck.Enclosure(Fraction(1, 3), Fraction(1, 2))
    assert repr(third) == "<Enclosure: [0.4166666667 +/- 0.0834]>"


ONE = '[[gains]]\nname = "one"\nm = 1\nkp = [0.1]\nkv = [0.02]\n'
ON_AN_ARM = {
    "bounds": lambda file, arm: lyapcheck.bounds(file, arm, seconds=1),
    "derivation": lambda file, arm: lyapcheck.derivation(1, robot=arm),
    "export_controller": lambda file, arm: lyapcheck.export_controller(file, arm, rate=1000),
    "gate": lyapcheck.gate,
    "tune_for_targets": lambda file, arm: lyapcheck.tune_for_targets(arm, overshoot=30, seconds=1),
    "tune_gains": lambda file, arm: lyapcheck.tune_gains(arm, [1]),
}


@pytest.mark.parametrize("task", but(ON_AN_ARM.keys() - {"tune_for_targets"}, ON_AN_ARM))
def test_an_arm_is_an_object_a_name_or_a_path(task, tmp_path):
    (tmp_path / "gains.toml").write_text(ONE)
    file = lyapcheck.read_gain_file(tmp_path / "gains.toml")
    by_name = str(ON_AN_ARM[task](file, "pendulum1"))
    assert str(ON_AN_ARM[task](file, lyapcheck.load_robot("pendulum1"))) == by_name
    assert str(ON_AN_ARM[task](file, Path("pendulum1"))) == by_name


SAID = {
    "bounds": (lyapcheck.bounds, ()),
    "export": (lambda file: lyapcheck.export_controller(file, rate=1000), ("--out", "c")),
    "gate": (lyapcheck.gate, ()),
}


@pytest.mark.parametrize("name", SAID)
def test_a_task_says_what_its_command_says_of_a_file(name, tmp_path, monkeypatch):
    """With all that the file says of the loop."""
    monkeypatch.chdir(tmp_path)
    loop = "[loop]\nrate = 1000\nunknown_payload = 0.1\n"
    Path("gains.toml").write_text('robot = "pendulum1"\n' + loop + ONE)
    task, options = SAID[name]
    run = lyapcheck_command(name, "gains.toml", *options, folder=tmp_path)
    assert run.stdout == f"{task('gains.toml')}\n"


def test_an_arm_that_was_changed_in_python_is_the_arm_that_counts(tmp_path):
    (tmp_path / "gains.toml").write_text('robot = "pendulum1"\n' + ONE)
    arm = lyapcheck.load_robot("pendulum1")
    (limit,) = arm.torque_limit
    weak = replace(arm, torque_limit=(replace(limit, value=limit.value / 100),))
    for robot, verdict in ((None, "accepted"), (arm, "accepted"), (weak, "rejected")):
        assert [one.verdict for one in lyapcheck.gate(tmp_path / "gains.toml", robot)] == [verdict]
    motorless = replace(arm, torque_limit=(None,))
    assert lyapcheck.tune_gains(arm, [1]).sets[0].gains is not None
    assert lyapcheck.tune_gains(motorless, [1]).sets[0].gains is None


def test_gains_are_judged_over_the_ranges_that_an_arm_was_loaded_with(tmp_path):
    (file := tmp_path / "gains.toml").write_text(ONE)
    varies = (lyapcheck.Vary.parsed("viscous=-99%..+0%"),)
    arm = lyapcheck.load_robot("pendulum1", vary=varies)
    assert [one.verdict for one in lyapcheck.gate(file, "pendulum1", ["19"])] == ["accepted"]
    (over,) = lyapcheck.gate(file, arm, ["19"])
    assert over.verdict == "rejected"
    assert over.limits.varied
    by_name = lyapcheck.tune_gains("pendulum1", [1], varies=varies)
    assert lyapcheck.tune_gains(arm, [1]).records() == by_name.records()
    with pytest.raises(lyapcheck.InputError, match="come too late"):
        lyapcheck.tune_gains(arm, [1], varies=varies)


UNUSABLE = {
    "rate": lambda file: lyapcheck.export_controller(file, rate="fast"),
    "within_deg": lambda file: lyapcheck.bounds(file, within_deg=0),
    "seconds": lambda file: lyapcheck.bounds(file, seconds=-1),
    "target_deg": lambda file: lyapcheck.bounds(file, target_deg=[1e9]),
    "overshoot": lambda file: lyapcheck.tune_for_targets("pendulum1", overshoot=-1),
}


@pytest.mark.parametrize("key", UNUSABLE)
def test_a_task_names_the_parameter_that_it_cannot_use(key, tmp_path):
    gains = tmp_path / "gains.toml"
    gains.write_text('robot = "pendulum1"\n' + ONE)
    with pytest.raises(lyapcheck.InputError) as error:
        UNUSABLE[key](gains)
    (problem,) = error.value.problems
    assert problem.key == key
    assert " rad" not in problem.rule


@pytest.mark.slow
def test_each_object_of_the_eight_tasks_prints_as_one_short_line(tmp_path):
    gains = tmp_path / "gains.toml"
    gains.write_text('robot = "pendulum1"\n' + ONE)
    file, arm, x = lyapcheck.read_gain_file(gains), lyapcheck.load_robot("pendulum1"), claims.var("x")
    answers = [
        lyapcheck.gate(file),
        lyapcheck.bounds(file),
        lyapcheck.tune_gains("pendulum1", [1]),
        lyapcheck.tune_for_targets("pendulum1", overshoot=30),
        lyapcheck.run_proof("published.py", [1], n=1, only=["19"]),
        lyapcheck.export_controller(file, rate=1000),
    ]
    gate, bounds, largest, tuned, proof, exported = answers
    (folder := tmp_path / "certificates").mkdir()
    for name, certificate in proof.certificates.items():
        (folder / name).write_text(certificate.text(), encoding="utf-8")
    outcome = lyapcheck.recheck(lyapcheck.read_certificates([folder]))
    parts = [
        file,
        *gate,
        *next(iter(gate)).checks,
        bounds.results[0],
        *largest.sets,
        tuned.best,
        *proof.claims,
    ]
    parts += [*proof.certificates.values(), outcome, *outcome.checked, *exported.sets]
    parts += [lyapcheck.decide(claims.identity(x, x)), lyapcheck.epsilon(file.gains[0], arm, max_boxes=500)]
    parts += [lyapcheck.simulate_motion(file.gains[0], arm, target_deg=[45], seconds=1)]
    for one in (*answers, *parts):
        assert repr(one).startswith(f"<{type(one).__name__}: ")
        assert len(repr(one)) < 160
        assert "\n" not in repr(one)


def test_what_is_kept_of_an_arm_has_its_own_key():
    """A digest is of all numbers, although the arm prints as one line."""
    arm = lyapcheck.load_robot("pendulum1")
    (name, number), *_ = arm.numbers.items()
    other = replace(arm, numbers={**arm.numbers, name: replace(number, value=number.value * 2)})
    assert repr(arm) == repr(other)
    assert store.exact(arm) != store.exact(other)
