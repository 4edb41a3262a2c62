"""Tuned gains: accepted by the gate, the largest of their kind, and what a user sees of them."""

from dataclasses import replace
from decimal import Decimal
from fractions import Fraction

import mpmath
import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from lyapcheck.answers.gate import gate
from lyapcheck.answers.tune import _limits, tune
from lyapcheck.answers.tune.largest import best_units, binding, damping_of, gain_ranges, propose
from lyapcheck.answers.tune.targets import Targets
from lyapcheck.control.gains import Bounds, read_gain_file
from lyapcheck.files.decimals import decimal_text
from lyapcheck.output.answer import FORMATS
from lyapcheck.robots import load
from lyapcheck.robots.fields import Vary
from lyapcheck.robots.numeric import NumericModel
from lyapcheck.robots.vary import at_values
from tests.helpers.command import invoke
from tests.helpers.costly import costly
from tests.helpers.shares import but
from tests.helpers.urdf_texts import TWO

ARMS = {"pendulum1": 1, "reyes-kelly2": 2, "pelican2": 2, "buap3": 3}
LIMIT = '<limit lower="-1" upper="1" effort="20" velocity="2"/>'


def run(*arguments):
    return invoke("tune", *arguments)


def judged(text, folder):
    path = folder / "gains.toml"
    path.write_text(text, encoding="utf-8")
    return gate(read_gain_file(path))


def raised(text, m, key, joint, digits):
    """The gain file with one gain of one set one unit larger in its last place."""
    lines, seen = text.splitlines(), None
    for index, line in enumerate(lines):
        seen = int(line.split("=")[1]) if line.startswith("m = ") else seen
        if seen == m and line.startswith(f"{key} = ["):
            gains = line.split("[")[1].split("]")[0].split(", ")
            gains[joint] = decimal_text(Fraction(gains[joint]) + Fraction(1, 10**digits), digits)
            lines[index] = f"{key} = [{', '.join(gains)}]"
    return "\n".join(lines)


def require_largest(tuning, members, folder):
    """Accepted as it is, rejected with any gain of any set one unit larger."""
    text = tuning.gain_file()
    assert [result.verdict for result in judged(text, folder)] == ["accepted"] * len(members)
    for index, m in enumerate(members):
        for key in ("kp", "kv"):
            for joint in range(tuning.limits.n):
                results = judged(raised(text, m, key, joint, tuning.targets.digits), folder)
                expected = ["accepted"] * len(members)
                expected[index] = "rejected"
                assert [result.verdict for result in results] == expected


@pytest.mark.parametrize(
    ("robot", "digits"),
    but(
        [("reyes-kelly2", 3), ("pendulum1", 2)],
        [
            *(("buap3", 1), ("buap3", 12)),
            *(("reyes-kelly2", 3), ("reyes-kelly2", 5), ("pendulum1", 2), ("pendulum1", 12)),
        ],
    ),
)
def test_no_gain_of_the_built_in_arms_can_be_one_unit_larger(robot, digits, tmp_path):
    members = (1, 2, 3, 12, 500)
    require_largest(tune(robot, members, Targets(digits)), members, tmp_path)


def decimals(low, high, places):
    scale = 10**places
    return st.integers(int(low * scale), int(high * scale)).map(lambda k: Fraction(k, scale))


@st.composite
def cases(draw):
    robot = draw(st.sampled_from(sorted(ARMS)))
    n = ARMS[robot]
    gravity = draw(st.tuples(*[decimals(0, 60, 2)] * n))
    spare = draw(st.tuples(*[decimals(0.5, 300, 3)] * n))
    torque = tuple(a + b for a, b in zip(gravity, spare, strict=True))
    targets = Targets(
        digits=draw(st.integers(2, 9)),
        kv_share=(draw(decimals(0.05, 1, 2)),),
        peak_share=(draw(st.sampled_from([Fraction(1), Fraction(4, 5), Fraction(999, 1000)])),),
    )
    m = draw(st.one_of(st.integers(1, 6), st.integers(7, 2000)))
    return robot, m, targets, Bounds(draw(decimals(0.1, 5, 3)), torque, gravity)


@costly
@given(case=cases())
def test_no_gain_of_any_arm_can_be_one_unit_larger(case, tmp_path_factory):
    robot, m, targets, bounds = case
    tuning = tune(robot, (m,), targets, bounds)
    assume(tuning.sets[0].status == "tuned")
    require_largest(tuning, (m,), tmp_path_factory.mktemp("tuned"))


@costly
@given(case=cases(), ratio=decimals(0.01, 2, 3))
def test_with_a_damping_ratio_no_other_decimals_have_a_larger_kp(case, ratio):
    robot, m, targets, bounds = case
    targets = replace(targets, digits=2, damping=(ratio,))
    tuning = tune(robot, (m,), targets, bounds)
    assume(tuning.sets[0].status == "tuned")
    best = exhaustive(load(robot), m, tuning, targets)
    assert [(joint.kp, joint.kv) for joint in tuning.sets[0].joints] == best


def exhaustive(model, m, tuning, targets):
    """For each joint the largest k_p, then the largest k_v, of all decimals, every k_v tried."""
    with mpmath.workdps(40):
        gamma = 1 if m == 1 else largest_of(lambda x: mp_h(m, x))
        slope = 1 if m == 1 else largest_of(lambda x: mp_h(m, x) / x)
        root, limits, tiny = mpmath.sqrt(model.n), tuning.limits, mpmath.mpf("1e-25")
        top = mp(limits.viscous_min) / (root * gamma)
        first = max(1, int(mpmath.floor((mp(targets.kv_share[0]) * top - tiny) * 100)))
        best = []
        for index, damping in enumerate(damping_of(model, m, targets.damping * model.n, limits.viscous_min)):
            friction, inertia, ratio = map(mp, (damping.friction, damping.inertia, damping.ratio))
            whole = mp(limits.torque[index] - limits.gravity[index]) / (root * gamma)
            result = []
            for k in range(first, int(mpmath.floor((top - tiny) * 100)) + 1):
                kv = mpmath.mpf(k) / 100
                damped = (friction + slope * kv) ** 2 / (4 * ratio**2 * inertia * slope)
                kp = mpmath.floor(100 * min(whole - kv - tiny, damped + tiny))
                result.append((Fraction(int(kp), 100), Fraction(k, 100)))
            best.append(max(result))
    return best


@pytest.mark.parametrize(
    ("robot", "varies", "bounds"),
    [
        ("reyes-kelly2", ("viscous=-80%..+0%",), {}),
        ("reyes-kelly2", ("viscous=-10%..+10%", "shoulder_viscous=0.05..3"), {}),
        ("reyes-kelly2", (), {"viscous_min": Fraction(1, 100)}),
        ("buap3", ("base_inertia=0.1..3",), {}),
        ("buap3", (), {}),
    ],
)
def test_the_damping_ratio_is_the_least_over_the_ranges(robot, varies, bounds):
    """ζ of a joint alone at drawn arms in the ranges and postures is not below what is said."""
    ranges = tuple(map(Vary.parsed, varies))
    tuning = tune(robot, [1], Targets.of(damping="0.7"), Bounds(**bounds), varies=ranges)
    model, draw = load(robot, vary=ranges), np.random.default_rng(4)
    q = draw.uniform(-np.pi, np.pi, (200, model.n))
    for _ in range(20):
        values = {
            name: number.bounds[draw.integers(2)] for name, number in model.numbers.items() if number.ranged
        }
        arm = at_values(model, values)
        inertia = np.einsum("kii->ki", NumericModel(arm).mass(q)).max(axis=0)
        for i, joint in enumerate(tuning.sets[0].joints):
            friction = float(bounds.get("viscous_min", arm.viscous[i].value))
            ratio = (friction + float(joint.kv)) / (2 * np.sqrt(inertia[i] * float(joint.kp)))
            assert ratio >= float(joint.damping) >= 0.7


def mp(value):
    return mpmath.mpf(value.numerator) / value.denominator


def mp_h(m, x):
    s = mpmath.sinh(x)
    return s ** (2 * m - 1) * mpmath.cosh(x) / (1 + s ** (2 * m))


def largest_of(function):
    """The maximum of a function with one peak in (0.5, 4), by golden section."""
    low, high, share = mpmath.mpf("0.5"), mpmath.mpf(4), (mpmath.sqrt(5) - 1) / 2
    for _ in range(120):
        a, b = high - share * (high - low), low + share * (high - low)
        low, high = (a, high) if function(a) < function(b) else (low, b)
    return function(low)


def ranges_of(robot="buap3", m=2, **targets):
    model = load(robot)
    wanted = Targets(**targets).for_joints(model.n)
    limits, _ = _limits(model, wanted, Bounds())
    return gain_ranges(m, model, limits, wanted)


@pytest.mark.parametrize(
    "targets",
    [
        {},
        {"kv_share": (Fraction(1, 3),), "digits": 6},
        {"damping": (Fraction(1, 20),), "kv_share": (Fraction(1, 10),)},
        {"damping": (Fraction(3, 100),), "digits": 5},
    ],
)
def test_the_cone_program_and_exact_search_agree(targets):
    every = ranges_of(**targets)
    status, proposed = propose(every)
    assert status == "optimal"
    for gain_range, (kp, _) in zip(every, proposed, strict=True):
        exact = best_units(gain_range)[0] * gain_range.unit
        assert float(exact) == pytest.approx(kp, rel=1e-5, abs=2.1 * float(gain_range.unit))


@given(start=st.floats(-1, 1))
def test_a_wrong_proposal_changes_nothing(start):
    for gain_range in ranges_of(damping=(Fraction(3, 100),), kv_share=(Fraction(1, 20),)):
        assert best_units(gain_range, start) == best_units(gain_range)


def test_smaller_gains_are_found_out():
    gain_range = ranges_of()[0]
    kp, kv = best_units(gain_range)
    binding(gain_range, kp, kv)
    for worse in ((kp - 1, kv), (kp - 1, kv - 1)):
        with pytest.raises(ArithmeticError):
            binding(gain_range, *worse)


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (("pelican2",), 3, "give --torque"),
        (("buap3", "--torque", "50,40,15"), 2, "not above the gravity torque of 40.28 N·m"),
        (("buap3", "--torque", "50,40,15", "--gravity", "0,0,0"), 2, "40.28 N·m from the model is used"),
        (("buap3", "--peak-share", "0.2"), 2, "larger --peak-share"),
        (("buap3", "--digits", "0"), 2, "raise --digits"),
        (("buap3", "--damping", "100"), 2, "lower --damping"),
        (("buap3", "--viscous-min", "30"), 2, "lower --kv-share below 0.43"),
    ],
)
def test_without_gains_it_says_why_and_what_to_change(arguments, code, words, tmp_path):
    out = tmp_path / "gains.toml"
    result = run(*arguments, "--out", str(out))
    assert result.exit_code == code
    assert words in " ".join(result.stdout.split())
    assert not out.exists()


def test_joints_without_friction_are_named_with_where_to_state_it(tmp_path):
    text = TWO.replace('<dynamics damping="0.25"/>', "").replace('damping="0.5"', 'damping="0"')
    text = text.replace('<parent link="upper"/>', f'<parent link="upper"/>{LIMIT}')
    (tmp_path / "two.urdf").write_text(text, encoding="utf-8")
    (tmp_path / "two.toml").write_text('title = "two"\nurdf = "two.urdf"\n', encoding="utf-8")
    known = "the viscous friction of shoulder is 0 in the file, the viscous friction of elbow is not known"
    for name, where in (("two.urdf", "an arm file that names this URDF"), ("two.toml", "the arm file")):
        (reason,) = tune(str(tmp_path / name), [1]).sets[0].reasons
        assert known in reason
        assert f"state it in {where}" in reason
    (reason,) = tune("pendulum1", [1], varies=(Vary.parsed("viscous=-100%..+0%"),)).sets[0].reasons
    assert "may be 0 in its range" in reason


def test_every_bad_option_is_named_in_one_go(tmp_path):
    bad = {
        "--m": "0,2.5",
        "--digits": "77",
        "--peak-share": "3",
        "--kv-share": "a,b",
        "--damping": ",",
        "--torque": "1,2",
        "--gravity": "-1,0,0",
        "--viscous-min": "x",
        "--out": str(tmp_path / "no" / "gains.toml"),
    }
    problems = run("buap3", *(f"{option}={value}" for option, value in bad.items())).exception.problems
    named = [problem.key for problem in problems]
    assert {*bad} == {key for key in named if key.startswith("--")}
    assert named.count("--m") == 2
    assert named.count("--kv-share") == 2
    assert all(problem.rule and problem.repair for problem in problems)


def test_an_unknown_arm_does_not_hide_the_other_mistakes():
    problems = run("nowhere", "--torque", "1,a", "--viscous-min", "0").exception.problems
    assert sorted(problem.key for problem in problems) == ["--torque", "--viscous-min", "robot"]


@pytest.mark.parametrize("form", [*FORMATS, "toml"])
def test_every_format_holds_the_gains(form):
    assert "63.112" in run("buap3", "--m", "1", "--viscous-min", "0.406", "--format", form).stdout


def test_the_first_line_tells_in_which_steps_there_are_no_gains():
    refused = tune("buap3", [2], Targets.of(digits=0)).document()
    assert refused.title == "✗ buap3: no gains in steps of 1 N·m within (10p), (19) and the targets for m = 2"
    assert "raise --digits" in refused.blocks[0].items[0]


def test_the_first_line_tells_that_the_gate_rejects_what_was_found(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    invoke("init", ".")
    done = invoke("tune", "arm.toml", "--m", "1", "--unknown-payload", "30")
    assert done.exit_code == 2
    said = "✗ arm.toml: the gate rejects the largest gains within (10p) and (19) for m = 1\n"
    assert done.stdout.startswith(said)
    assert "(holds) elbow" in done.stdout


def test_a_record_is_a_joint():
    first, *others = tune("buap3", [1, 2]).records()
    assert (first["name"], first["joint"], first["kp"]) == ("tau_m1", "base", "28.633")
    assert [row["m"] for row in others] == [1, 1, 2, 2, 2]
    (missing,) = tune("pelican2", [2]).records()
    assert missing["status"] == "undecided"
    assert "give --torque" in missing["reasons"]


def test_targets_are_read_as_they_are_written():
    several = Targets.of(peak_share=["0.8", Decimal("0.9"), 1], damping=Fraction(1, 7))
    assert several.peak_share == (Fraction(4, 5), Fraction(9, 10), Fraction(1))
    assert several.damping == (Fraction(1, 7),)
    assert several.kv_share is None
    assert Targets.of() == Targets()


@pytest.mark.parametrize("share", [0.8, [0.8], [None]])
def test_targets_that_are_not_exact_are_refused(share):
    with pytest.raises(TypeError, match="is not exact"):
        Targets.of(peak_share=share)
