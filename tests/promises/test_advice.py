"""What one command recommends the next accepts, and what advice names holds once it is followed."""

import re
import shlex
from fractions import Fraction
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lyapcheck.robots import load, names
from tests.helpers.arm_texts import ONE_JOINT
from tests.promises.draws import FAMILIES, arms, asked, drawn, invoke, near_the_border, results, shares

EXAMPLES = Path(__file__).parents[2] / "examples"
ARMS = [*names(), *(str(EXAMPLES / f"{name}.toml") for name in ("px100", "ur5", "xarm6", "panda", "iiwa14"))]
LARGE = {str(EXAMPLES / f"{name}.toml") for name in ("xarm6", "panda", "iiwa14")}
ROUNDS = 6


def text_of(words):
    return " ".join(invoke(*words).stdout.split())


@pytest.mark.parametrize(
    "arm", [pytest.param(arm, marks=[pytest.mark.slow] * (arm in LARGE), id=Path(arm).stem) for arm in ARMS]
)
def test_the_gate_accepts_what_tune_writes(tmp_path, arm):
    out = tmp_path / "gains.toml"
    tuned = invoke("tune", arm, "--m", "1", "--out", str(out))
    given = []
    if tuned.exit_code != 0:  # something is not known: what is advised is given
        text = " ".join(tuned.stdout.split())
        given += ["--viscous-min", "0.5"] if "give --viscous-min" in text else []
        given += ["--torque", ",".join(["60"] * load(arm).n)] if "give --torque" in text else []
        assert given, text
        assert invoke("tune", arm, "--m", "1", *given, "--out", str(out)).exit_code == 0
    assert invoke("gate", str(out)).exit_code == 0


@drawn(2, 30)
@given(arms(2), st.sampled_from(["0.5", "1"]), st.sampled_from([(), ("--damping", "0.1")]))
def test_the_gate_accepts_what_tune_writes_for_ranges(arm, share, more):
    with TemporaryDirectory() as name:
        folder, out = Path(name), Path(name) / "gains.toml"
        words = [str(folder / arm.written(folder, "arm")), "--m", "1", "--peak-share", share, *more]
        tuned = invoke("tune", *words, *arm.options, "--out", str(out))
        assert tuned.exit_code in (0, 2), tuned.output
        if tuned.exit_code == 0:
            assert invoke("gate", str(out), *arm.options).exit_code == 0, (arm, out.read_text())


@pytest.mark.slow
def test_what_the_file_of_init_says_leads_to_gains_that_commands_take(tmp_path, monkeypatch):
    """init, tune by the line of its gain file, gate, simulate; tests/cli/test_layout.py makes a report."""
    monkeypatch.chdir(tmp_path)
    assert invoke("init", ".").exit_code == 0
    (line,) = re.findall(r"lyapcheck (tune .*)$", Path("gains.toml").read_text(), re.MULTILINE)
    assert invoke(*shlex.split(line)).exit_code == 0
    assert invoke("gate", "tuned.toml").exit_code == 0
    assert invoke("simulate", "tuned.toml", "--target", "45,45", "--time", "3").exit_code == 0


# --- advice of the gate --------------------------------------------------------------------------


def gains_of(path):
    text = path.read_text(encoding="utf-8")
    rows = {key: re.search(rf"^{key} = \[(.*)\]$", text, re.MULTILINE) for key in ("kp", "kv")}
    return {key: [Fraction(x) for x in row[1].split(",")] for key, row in rows.items() if row}


def followed(path, result, joints):
    """Write the file anew with each value that the checks advise, and return which checks these were."""
    gains, done = gains_of(path), []
    for check in result["checks"]:
        told = re.search(r"lower (k_p \+ k_v|k_p|it) to at most ([0-9.]+)$", check["message"])
        if told is None or check["id"] not in result["deciding"] or check["joint"] not in joints:
            continue
        i, value = joints.index(check["joint"]), Fraction(told[2])
        both = told[1] == "k_p + k_v"
        for key in ("kp", "kv") if both else ("kv",) if told[1] == "it" else ("kp",):
            gains[key][i] = min(gains[key][i], value / (1 + both))  # only ever lowered
        done.append((check["id"], check["joint"]))
    text = path.read_text(encoding="utf-8")
    for key, values in gains.items():
        written = ", ".join(str(float(x)) for x in values)
        text = re.sub(rf"^{key} = \[.*\]$", f"{key} = [{written}]", text, flags=re.MULTILINE)
    path.write_text(text, encoding="utf-8")
    return done


def follow_advice(path, joints, options):
    """Follow it until there is none; each value that is advised must pass."""
    for _ in range(ROUNDS):
        done = asked("gate", str(path), *options)
        (result,) = results(done)
        remarks_hold(path, result, options)
        if done.exit_code == 0 or any(check["id"] == "gravity" for check in result["checks"]):
            return  # a false bound of gravity is for who measured the arm to mend
        tried = followed(path, result, joints)
        if not tried:
            said = " ".join(check["message"] for check in result["checks"])
            missing = "give [bounds] torque" in said
            assert missing or "needs the motor" in said or "no k_v > 0" in said, result
            if not missing:
                return
            bounds = f"[bounds]\ntorque = [{', '.join(['60'] * len(joints))}]\n"
            path.write_text(path.read_text(encoding="utf-8") + bounds, encoding="utf-8")
            continue
        (again,) = results(asked("gate", str(path), *options))
        fails = {(check["id"], check["joint"]) for check in again["checks"] if check["verdict"] != "accepted"}
        assert not fails & set(tried), (path.read_text(), result, again)
    raise AssertionError(f"advice without end: {path.read_text()}")


def remarks_hold(path, result, options):
    """Options that are said to be accepted are."""
    for remark in result["remarks"]:
        told = re.search(r"; ((?:--condition \w+ ?)+)accepts it$", remark)
        if told is not None:
            assert invoke("gate", str(path), *told[1].split(), *options).exit_code == 0, remark


@drawn(2, 30)
@given(arms(2), st.sampled_from(FAMILIES), st.sampled_from([Fraction(101, 100), Fraction(3)]))
def test_what_the_gate_advises_passes(arm, family, share):
    with TemporaryDirectory() as name:
        folder = Path(name)
        path = near_the_border(folder, arm.written(folder, "arm"), arm.n, family, arm.options, share)
        follow_advice(path, [f"j{k + 1}" for k in range(arm.n)], arm.options)


@pytest.mark.parametrize("kp", ["500", "0.05"])
@pytest.mark.parametrize("arm", names())
def test_what_the_gate_advises_for_a_shipped_arm_passes(tmp_path, arm, kp):
    model, path = load(arm), tmp_path / "gains.toml"
    rows = "\n".join(f"{key} = [{', '.join([x] * model.n)}]" for key, x in (("kp", kp), ("kv", "5")))
    path.write_text(f'robot = "{arm}"\n[[gains]]\nname = "a"\nm = 1\n{rows}\n', encoding="utf-8")
    follow_advice(path, list(model.joints), ())
    path.write_text(f'robot = "{arm}"\n[bounds]\nviscous_min = 0.25\n[[gains]]\nname = "a"\nm = 1\n{rows}\n')
    assert "lyapcheck tune" not in (told := text_of(["gate", str(path)])) or "--viscous-min 0.25" in told


# --- advice of tune ------------------------------------------------------------------------------


@pytest.mark.parametrize("arm", ["pendulum1", "buap3-small"])
def test_what_tune_advises_leaves_gains(arm):
    base = ["tune", arm, "--m", "1", "--digits", "6", "--viscous-min", "5"]
    text = text_of([*base, "--kv-share", "1"])
    values = [Fraction(x) for x in re.findall(r"lower --kv-share below ([0-9.]+)", text)]
    assert values, text
    assert invoke(*base, "--kv-share", str(float(min(values) * Fraction(99, 100)))).exit_code == 0, text


@pytest.mark.slow
def test_tune_names_targets_where_there_is_no_friction(tmp_path):
    text = ONE_JOINT.format(viscous=0, torque=20, more="")
    (tmp_path / "arm.toml").write_text(text, encoding="utf-8")
    words, out = ["tune", str(tmp_path / "arm.toml"), "--m", "1"], tmp_path / "gains.toml"
    assert "give targets, such as --overshoot 5" in text_of(words)
    assert invoke(*words, "--overshoot", "5", "--goal", "45", "--out", str(out)).exit_code == 0
    assert invoke("gate", str(out)).exit_code == 0


@drawn(2, 50)
@given(arms(1), shares)
def test_gains_for_ranges_are_gains_for_their_members(arm, at):
    with TemporaryDirectory() as name:
        folder, out = Path(name), Path(name) / "gains.toml"
        tuned = invoke(
            "tune", str(folder / arm.written(folder, "arm")), "--m", "1", *arm.options, "--out", str(out)
        )
        if tuned.exit_code == 0:
            text = out.read_text(encoding="utf-8").partition("[bounds]")[0]
            member = arm.at(at).written(folder, "member")
            (folder / "own.toml").write_text(text.replace("arm.toml", member), encoding="utf-8")
            assert invoke("gate", str(folder / "own.toml")).exit_code == 0, (arm, at)


# --- advice of bounds and epsilon ----------------------------------------------------------------

CORRECTED = {
    "bounds, --delta": ("bounds", "--delta", "0"),
    "bounds, --friction": ("bounds", "--friction", "0.1,0.1,0.1"),
    "bounds, --target": ("bounds", "--target", "45,45,45,45,45"),
    "epsilon, --m": ("epsilon", "--m", "7"),
}


def written(path, arm, kp, kv, family="m = 1"):
    rows = "\n".join(f"{key} = [{', '.join([x] * load(arm).n)}]" for key, x in (("kp", kp), ("kv", kv)))
    path.write_text(f'robot = "{arm}"\n[[gains]]\nname = "a"\n{family}\n{rows}\n', encoding="utf-8")
    return path


@pytest.mark.parametrize(
    "words",
    [
        *(pytest.param(words, id=name) for name, words in CORRECTED.items()),
        pytest.param(("epsilon", "--spread", "0"), id="epsilon, --spread", marks=pytest.mark.slow),
    ],
)
def test_what_an_error_tells_to_write_is_taken(tmp_path, words):
    gains = written(tmp_path / "gains.toml", "pendulum1", "3", "0.05")
    line, told = [words[0], str(gains), *words[1:]], []
    while (done := invoke(*line)).exit_code == 2:
        text = str(done.exception)
        advice = re.search(r"(?:write (--[a-z]+) ([^\s;]+))|(?:(--m) = .*choose from ([0-9]+))", text)
        assert advice is not None, text
        option, value = (part for part in advice.groups() if part is not None)
        assert option not in told, text
        told.append(option)
        if option in line:
            line[line.index(option) + 1] = value
        else:
            line += [option, value]
    assert told
    assert done.exit_code in (0, 3), done.output


def test_bounds_tells_what_is_missing_and_takes_it(tmp_path):
    """Dry friction that no file states; a k_p that does not exceed it; an h without a bound."""
    words = ["bounds", str(written(tmp_path / "gains.toml", "pendulum1", "0.1", "0.05")), "--target", "45"]
    unknown = ["bounds", str(written(tmp_path / "free.toml", "buap3-small", "3", "0.05"))]
    assert "give --friction" in text_of(unknown)
    assert invoke(*unknown, "--friction", "1,1,1").exit_code == 0
    (friction,) = re.findall(
        r"does not exceed its dry friction of ([0-9.]+) N·m: raise k_p",
        text_of([*words, "--friction", "0.15"]),
    )
    written(tmp_path / "gains.toml", "pendulum1", f"{float(friction) * 2}", "0.05")
    assert invoke(*words, "--friction", friction).exit_code == 0
    written(tmp_path / "gains.toml", "pendulum1", "30", "0.05", 'family = "linear"')
    assert "choose gains of a bounded family" in str(invoke(*words).exception)
    written(tmp_path / "gains.toml", "pendulum1", "30", "0.05", 'family = "tanh"')
    assert invoke(*words, "--friction", friction).exit_code == 0


def test_gains_lowered_as_epsilon_tells_have_an_epsilon(tmp_path):
    gains = written(tmp_path / "gains.toml", "pendulum1", "3", "5")
    assert "lower the gains k_v to below λmin(B)/(√n γ)" in text_of(["epsilon", str(gains)])
    (result,) = results(asked("gate", str(gains), "--condition", "19"))
    (most,) = [check["largest_admissible"] for check in result["checks"] if check["id"] == "19"]
    written(gains, "pendulum1", "3", most)
    done = invoke("epsilon", str(gains))
    assert done.exit_code == 0, done.output
