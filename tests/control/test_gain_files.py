"""Reading gain files: what is read is exact, and what is wrong is told, all of it and where."""

import copy
import os
import pickle
import subprocess
import sys
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lyapcheck import load_robot, run_simulation
from lyapcheck.control.gains import GainFile, paper_gain_file, read_gain_file
from lyapcheck.control.limits import limits_for
from lyapcheck.errors import InputError
from lyapcheck.files.decimals import Written, decimal_text, places_of, round_down, written
from lyapcheck.output.escapes import printable
from tests.helpers.command import invoke, lyapcheck
from tests.helpers.letters import letters

GOOD = """\
robot = "buap3"

[[gains]]
name = "one"
m = 2
kp = [1.5, 2, 3e-1]
kv = [0.1, 0.20, 0.3]
"""
LINES = {key: number for number, line in enumerate(GOOD.splitlines(), 1) for key in [line.split(" = ")[0]]}


@pytest.fixture
def file(tmp_path):
    return tmp_path / "gains.toml"


def problems(file, text):
    file.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(InputError) as caught:
        read_gain_file(file)
    return caught.value.problems


# --- what is right -----------------------------------------------------------------------------------------


def test_a_file_is_read_whole(file):
    file.write_text(
        GOOD + "[bounds]\nviscous_min = 0.406\ntorque = [50, 150, 15]\ngravity = [0, 40.28, 1.81]\n"
    )
    result = read_gain_file(file)
    (gains,) = result.gains
    assert (result.robot, gains.name, gains.m, gains.family, gains.n) == ("buap3", "one", 2, "hyperbolic", 3)
    assert gains.kp == (Fraction(3, 2), 2, Fraction(3, 10))
    assert gains.kv == (Fraction(1, 10), Fraction(1, 5), Fraction(3, 10))
    assert result.bounds.viscous_min == Fraction(203, 500)
    assert result.bounds.torque == (50, 150, 15)
    assert result.bounds.gravity == (0, Fraction(1007, 25), Fraction(181, 100))


@pytest.mark.parametrize(
    ("text", "value", "places"),
    [
        ("0.223", Fraction(223, 1000), 3),
        ("0.50", Fraction(1, 2), 2),
        ("5e-3", Fraction(1, 200), 3),
        ("1.25E+1", Fraction(25, 2), 1),
        ("28", Fraction(28), 0),
        ("1_000.000_1", Fraction(10000001, 10000), 4),
        ("0.1000000000000000055511151231257827", Fraction("0.1000000000000000055511151231257827"), 34),
        ("1e-15", Fraction(1, 10**15), 15),
        ("1e15", Fraction(10**15), 0),
        ("0x1F", Fraction(31), 0),
    ],
)
def test_decimals_are_exact_and_keep_their_digits(file, text, value, places):
    file.write_text(GOOD.replace("1.5", text))
    result = read_gain_file(file).gains[0].kp[0]
    assert result == value
    assert places_of(result) == places


@given(st.integers(0, 10**40), st.integers(0, 60), st.integers(-15, 15))
def test_every_decimal_is_its_own_exact_value(digits, places, exponent):
    text = f"{str(digits).rjust(places + 1, '0')}"
    text = f"{text[:-places]}.{text[-places:]}e{exponent}" if places else f"{text}e{exponent}"
    assert written(text) == Fraction(digits) * Fraction(10) ** (exponent - places)


@given(st.fractions(), st.integers(0, 30))
def test_rounding_down_is_the_largest_decimal_not_above(value, places):
    rounded, unit = round_down(value, places), Fraction(1, 10**places)
    assert rounded <= value < rounded + unit
    assert (rounded / unit).denominator == 1
    assert Fraction(decimal_text(rounded, places)) == rounded


@given(st.fractions(), st.integers(0, 30))
def test_decimal_text_says_the_exact_value(value, places):
    text = decimal_text(value, places)
    assert Fraction(text) == value
    assert "/" in text or len(text.partition(".")[2]) >= places


def test_a_written_decimal_survives_copies(file):
    file.write_text(GOOD)
    gains = read_gain_file(file).gains[0]
    for other in (copy.copy(gains), copy.deepcopy(gains), pickle.loads(pickle.dumps(gains))):
        assert other == gains
        assert [places_of(k) for k in other.kv] == [1, 2, 1]
        assert isinstance(other.kv[1], Written)
        assert repr(other.kv[1]) == "0.20"


def test_every_gain_knows_its_line_and_column(file):
    file.write_text(GOOD)
    result = read_gain_file(file)
    gains = result.gains[0]
    for key, joint, text in (("kp", 0, "1.5"), ("kp", 2, "3e-1"), ("kv", 1, "0.20"), ("name", None, "name")):
        place = result.place(gains, key, joint)
        assert place is not None
        assert place.line == LINES[key]
        assert GOOD.splitlines()[place.line - 1][place.column - 1 :].startswith(text)


@pytest.mark.parametrize(
    "text",
    [
        'gains = [{name="a", m=1, kp=[1], kv=[1]},\n   {name="b", m=2, kp=[1], kv=[\n1, # one\n]}]\n',
        "\ufeff" + GOOD,
        GOOD.replace("\n", "\r\n"),
        GOOD.replace("name", '"name"').replace("kp", "'kp'"),
        '[[gains]]\nname = """\na\\\n  b\\"""" # [[gains]]\nm=1\nkp=[1]\nkv=[1]\n',
        "[[gains]]\nname = 'x = [1, 2'\nm = 1_0\nkp = [ 1, ]\nkv = [0b1]\n",
    ],
    ids=["inline", "byte-order mark", "CRLF", "quoted keys", "multi-line text", "odd but right"],
)
def test_every_way_to_write_toml_is_read(file, text):
    file.write_bytes(text.encode())
    result = read_gain_file(file)
    last = result.place(result.gains[-1], "kv", 0)
    assert last is not None
    assert text.lstrip("\ufeff").splitlines()[last.line - 1][last.column - 1] in "01"


def test_the_gains_of_the_paper_travel_with_lyapcheck():
    """Table 2 of the paper."""
    sets = {gains.name: gains for gains in read_gain_file(paper_gain_file("table2")).gains}
    assert [sets[f"tau_m{m}"].kp for m in (1, 2, 3)] == [(28, 60, 5), (27, 50, 5), (25, 50, 5)]
    assert [set(sets[f"tau_m{m}"].kv) for m in (1, 2, 3)] == [
        {Fraction(233, 1000)},
        {Fraction(223, 1000)},
        {Fraction(223, 1000)},
    ]
    (pd,) = read_gain_file(paper_gain_file("table2_pd")).gains
    assert (pd.family, pd.angle_unit, pd.kp) == (
        "linear",
        "deg",
        (Fraction(4, 5), Fraction(5, 2), Fraction(133, 1000)),
    )
    with pytest.raises(InputError, match="table2_pd"):
        paper_gain_file("table3")


def test_a_robot_file_is_looked_for_beside_the_gain_file(file):
    file.write_text(GOOD.replace("buap3", "arms/mine.toml"))
    assert read_gain_file(file).robot == str(file.parent / "arms" / "mine.toml")


# --- what is wrong -----------------------------------------------------------------------------------------


def changed(old, new):
    assert old in GOOD
    return GOOD.replace(old, new)


BOUNDS = GOOD + "[bounds]\n"
HUGE = "9" * 6000
BROKEN = {
    # name: (file, line, key, part of the rule, part of the repair)
    "no value": (changed("m = 2", "m ="), 5, "TOML", "Invalid value", "syntax"),
    "a key twice": (changed("m = 2", "m = 2\nm = 3"), 6, "TOML", "overwrite", "syntax"),
    "comma for a decimal point": (changed("0.1,", "0,1;"), 7, "TOML", "Unclosed array", "syntax"),
    "control character": (changed("one", "o\x01ne"), 4, "TOML", "Illegal character", "syntax"),
    "not UTF-8": (GOOD.encode() + b"# \xff\xfe\n", None, "file", "not UTF-8", "UTF-8"),
    "nothing": (b"", None, "gains", "is missing", "[[gains]]"),
    "gains of one table": (changed("[[gains]]", "[gains]"), 3, "gains", "array of tables", "[[gains]]"),
    "no gain sets": ("gains = []\n", 1, "gains", "array of tables", "[[gains]]"),
    "unknown key": (GOOD + "kk = [1, 1, 1]\n", 8, "gains[1].kk", "not a known key", "use one of: angle"),
    "misspelt key": (changed("name", "nmae"), 4, "gains[1].nmae", "not a known key", "did you mean name?"),
    "key of other letters": (
        changed("kp", "Kp"),
        6,
        "gains[1].Kp",
        "the gain of the error is kp",
        "write kp",
    ),
    "misspelt family": (
        changed("m = 2", 'family = "linaer"'),
        5,
        "gains[1].family",
        "one of algebraic",
        'write family = "linear"',
    ),
    "XML": ("\n<robot/>", None, "file", "is XML", 'robot = "arm.urdf"'),
    "unknown top key": ("robots = 1\n" + GOOD, 1, "robots", "not a known key", "did you mean robot?"),
    "unknown table": (
        GOOD + "[limits]\n",
        8,
        "limits",
        "not a known key",
        "use one of: bounds, certificates, condition, gains, loop, robot",
    ),
    "key of another room": (
        BOUNDS + "friction = 1\n",
        9,
        "bounds.friction",
        "not a known key",
        "viscous_min",
    ),
    "key of control characters": (
        GOOD + '"a\\u001b\\n" = 1\n',
        8,
        r"gains[1].a\x1b\n",
        "known key",
        "remove",
    ),
    "no name": (changed('name = "one"\n', ""), 3, "gains[1].name", "is missing", "add name"),
    "empty name": (changed('"one"', '" "'), 4, "gains[1].name", "non-empty text", 'write name = "…"'),
    "no m": (changed("m = 2\n", ""), 3, "gains[1].m", "is missing", "add m"),
    "no kp": (changed("kp = [1.5, 2, 3e-1]\n", ""), 3, "gains[1].kp", "is missing", "add kp"),
    "m = 0": (changed("m = 2", "m = 0"), 5, "gains[1].m", "from 1 to 10000", "write m = 1"),
    "m too large": (changed("m = 2", "m = 100001"), 5, "gains[1].m", "from 1 to 10000", "write m = 1"),
    "m of another size": (changed("m = 2", "m = 0x" + "F" * 9000), 5, "gains[1].m", "whole", "write m = 1"),
    "gain 0.0": (changed("1.5", "0.0"), 6, "gains[1].kp[1]", "must be positive", "correct the sign"),
    "gain < 0": (changed("1.5", "-1.5"), 6, "gains[1].kp[1]", "must be positive", "correct the sign"),
    "gain nan": (changed("1.5", "nan"), 6, "gains[1].kp[1]", "finite decimal", "0.223"),
    "gain a text": (changed("1.5", '"1.5"'), 6, "gains[1].kp[1]", "finite decimal", "0.223"),
    "gain of 10^999999": (changed("1.5", "1e999999"), 6, "gains[1].kp[1]", "1e15 in size", "0.223"),
    "decimal of many digits": (changed("1.5", "1." + HUGE), 6, "gains[1].kp[1]", "1000 characters", "0.223"),
    "integer of many digits": (changed("1.5", HUGE), 6, "number", "absurd length", "physical size"),
    "kp one number": (changed("[1.5, 2, 3e-1]", "1.5"), 6, "gains[1].kp", "list of numbers", "[1.5, 1.5]"),
    "kp empty": (changed("[1.5, 2, 3e-1]", "[]"), 6, "gains[1].kp", "list of numbers", "[1.0, 1.0]"),
    "kp a table": (changed("[1.5, 2, 3e-1]", "{base = 1.5}"), 6, "gains[1].kp", "no gain for", "each joint"),
    "kv too short": (changed("0.20, ", ""), 7, "gains[1].kv", "2 gains where kp has 3", "as the arm"),
    "unknown family": (
        changed("m = 2", 'm = 2\nfamily = "cubic"'),
        6,
        "gains[1].family",
        "one of algebraic",
        "hyper",
    ),
    "m of another family": (
        changed("m = 2", 'm = 2\nfamily = "tanh"'),
        5,
        "gains[1].m",
        "not to tanh",
        "remove m",
    ),
    "degrees of torques": (
        changed("m = 2", 'm = 2\nangle = "deg"'),
        6,
        "gains[1].angle",
        "torques",
        "remove",
    ),
    "unknown angle": (changed("m = 2", 'm = 2\nangle = "grad"'), 6, "gains[1].angle", "rad, deg", '"rad"'),
    "robot a number": (changed('"buap3"', "3"), 1, "robot", "non-empty text", 'write robot = "…"'),
    "bounds a number": ("bounds = 1\n" + GOOD, 1, "bounds", "must be a table", "[bounds]"),
    "friction 0": (BOUNDS + "viscous_min = 0\n", 9, "bounds.viscous_min", "must be positive", "correct"),
    "friction a list": (BOUNDS + "viscous_min = [1]\n", 9, "bounds.viscous_min", "finite decimal", "0.223"),
    "torque < 0": (BOUNDS + "torque = [1, -1, 1]\n", 9, "bounds.torque[2]", "must be positive", "correct"),
    "torque too short": (BOUNDS + "torque = [1]\n", 9, "bounds.torque", "1 entries for 3 joints", "give 3"),
    "gravity < 0": (BOUNDS + "gravity = [0, 0, -1]\n", 9, "bounds.gravity[3]", "not be negative", "correct"),
    "gravity nan": (BOUNDS + "gravity = [0, nan, 0]\n", 9, "bounds.gravity[2]", "finite decimal", "0.223"),
    "a name twice": (GOOD + GOOD.partition("\n")[2], 10, "gains[2].name", "used twice", "its own name"),
    "another number of joints": (
        GOOD + '[[gains]]\nname = "two"\nm = 1\nkp = [1]\nkv = [1]\n',
        11,
        "gains[2].kp",
        "1 joints where the first set has 3",
        "one arm to a file",
    ),
    "condition a text": (
        'condition = "19"\n' + GOOD,
        1,
        "condition",
        "list of conditions",
        'condition = ["10p", "19"]',
    ),
    "condition a number": (
        "condition = [19]\n" + GOOD,
        1,
        "condition",
        "must be of 10, 10p",
        '["10p", "19"]',
    ),
    "no conditions": (
        GOOD + "condition = []\n",
        8,
        "gains[1].condition",
        "list of conditions",
        "condition =",
    ),
    "unknown condition": (
        GOOD + 'condition = ["10p", "stable"]\n',
        8,
        "gains[1].condition",
        "must be of 10, 10p, 10i, 19, scalar, global, lasalle",
        "condition =",
    ),
    "a condition twice": (GOOD + 'condition = ["19", "19"]\n', 8, "gains[1].condition", "twice", "once"),
    "too deep": (changed("1.5", "[" * 5000 + "]" * 5000), None, "file", "nested too deeply", "plain tables"),
}


def test_a_broken_file_is_told_where_and_how_and_the_command_leaves_with_2(file):
    for name, (text, line, key, rule, repair) in BROKEN.items():
        found = problems(file, text)
        about = [problem for problem in found if problem.key == key]
        assert about, (name, [str(problem) for problem in found])
        assert about[0].line == line, name
        assert rule in about[0].rule, name
        assert repair in about[0].repair, name
        assert all(len(str(problem).removeprefix(str(file))) < 400 for problem in found), name
        assert all(str(problem).isprintable() for problem in found), name
        done = lyapcheck("gate", file)
        place = str(file) if line is None else f"{file}:{line}"
        rows = done.stderr.splitlines()
        assert (done.returncode, done.stdout) == (2, ""), name
        assert all(row.startswith("error: ") for row in rows), name
        assert any(row.startswith(f"error: {place}: {key}") and repair in row for row in rows), name


def test_all_that_is_wrong_is_told_at_once(file):
    text = """\
robot = 3
colour = "red"
[[gains]]
name = "a"
m = 0
kp = [1, -2, nan]
kv = [true, "x", 1e999999]
[[gains]]
name = "a"
m = 1.5
gain = 1
kp = [1, 1]
[bounds]
torque = [0, 1]
viscous_min = -1
"""
    result = {(problem.line, problem.key) for problem in problems(file, text)}
    assert result == {
        (1, "robot"),
        (2, "colour"),
        (5, "gains[1].m"),
        (6, "gains[1].kp[2]"),
        (6, "gains[1].kp[3]"),
        (7, "gains[1].kv[1]"),
        (7, "gains[1].kv[2]"),
        (7, "gains[1].kv[3]"),
        (9, "gains[2].name"),
        (10, "gains[2].m"),
        (11, "gains[2].gain"),
        (8, "gains[2].kv"),
        (14, "bounds.torque[1]"),
        (15, "bounds.viscous_min"),
    }


def test_problems_come_in_the_order_of_the_file(file):
    result = problems(file, changed("m = 2", "m = 0").replace("1.5", "-1").replace("robot", "robo"))
    assert [problem.line for problem in result] == [1, 5, 6]


def test_an_unknown_arm_is_a_mistake_on_its_line(file):
    file.write_text("# first\n" + changed('"buap3"', '"buap4"'))
    with pytest.raises(InputError) as caught:
        limits_for(read_gain_file(file))
    (problem,) = caught.value.problems
    assert (problem.file, problem.line, problem.key) == (str(file), 2, "robot")
    assert "buap3" in problem.repair
    assert str(problem).isprintable()


def test_without_an_arm_the_bounds_must_say_everything(file):
    bounds = "[bounds]\ntorque = [9, 9, 9]\ngravity = [0, 1, 2]\n"
    file.write_text(changed('robot = "buap3"', "") + bounds)
    with pytest.raises(InputError, match="robot: is missing"):
        limits_for(read_gain_file(file))
    file.write_text(changed('robot = "buap3"', "") + bounds + "viscous_min = 0.5\n")
    limits = limits_for(read_gain_file(file))
    assert (limits.torque, limits.gravity, limits.viscous_min) == ((9, 9, 9), (0, 1, 2), Fraction(1, 2))


def test_bounds_of_the_file_come_before_those_of_the_arm(file):
    file.write_text(GOOD + "[bounds]\ntorque = [7, 8, 9]\n")
    limits = limits_for(read_gain_file(file))
    assert limits.torque == (7, 8, 9)
    assert limits.viscous_min == Fraction("0.406")
    assert limits.gravity == (0, Fraction("40.28"), Fraction("1.81"))


def test_a_file_name_of_any_bytes_can_be_said(tmp_path):
    name = os.fsencode(tmp_path) + b"/g\xff\n.toml"
    with open(name, "wb") as stream:
        stream.write(GOOD.encode())
    for text in (GOOD, "x"):
        with open(name, "wb") as stream:
            stream.write(text.encode())
        done = subprocess.run([sys.executable, "-c", RUN, "gate", name], capture_output=True, check=False)
        assert done.returncode in (0, 1) if text == GOOD else done.returncode == 2
        assert b"Traceback" not in done.stderr
        assert rb"g\udcff" in done.stdout + done.stderr


RUN = "from lyapcheck.cli.main import main; main()"


# --- whatever comes ----------------------------------------------------------------------------------------

SCALARS = st.one_of(
    st.sampled_from(
        ["nan", "-inf", "true", '"x"', "1e999999", "1e-401", "0", "-1", "0x10", "1979-05-27", "{}"]
    ),
    st.integers().map(str),
    st.floats(allow_nan=False, allow_infinity=False).map(repr),
    st.decimals(allow_nan=False, allow_infinity=False, places=4).map(str),
)
VALUES = st.recursive(SCALARS, lambda inner: st.lists(inner, max_size=4).map(lambda x: f"[{', '.join(x)}]"))
KEYS = st.sampled_from(
    [
        "name",
        "m",
        "kp",
        "kv",
        "family",
        "angle",
        "robot",
        "gains",
        "bounds",
        "torque",
        '"a\\n"',
        "a.b",
        "kp.x",
    ]
)
HEADS = st.sampled_from(["[[gains]]", "[gains]", "[bounds]", "[[gains.kp]]", "[[bounds]]", "[a.b]", ""])
PAIRS = st.builds(lambda key, value: f"{key} = {value}", KEYS, VALUES)
SHUFFLED = st.lists(st.one_of(HEADS, PAIRS), max_size=12).map("\n".join)
SPLICED = st.builds(
    lambda at, cut, new: GOOD[:at] + new + GOOD[at + cut :],
    st.integers(0, len(GOOD)),
    st.integers(0, 12),
    st.one_of(
        letters(most=6), VALUES, st.sampled_from(['"""', "'''", "[[", "]]", "=", "\r", "#", "{", "\\"])
    ),
)


def refusal(path):
    try:
        result = read_gain_file(path)
    except InputError as error:
        return error
    assert isinstance(result, GainFile)
    assert result.gains
    for gains in result.gains:
        assert all(k > 0 for k in (*gains.kp, *gains.kv))
        assert result.place(gains, "kv", gains.n - 1) is not None
    return None


def read_or_refuse(path, content):
    path.write_bytes(content)
    error = refusal(path)
    if error is not None:
        assert error.problems
        assert all(problem.rule and problem.repair for problem in error.problems)
        assert all(printable(str(problem)) == str(problem) for problem in error.problems)


@given(st.one_of(SHUFFLED, SPLICED).map(lambda text: text.encode("utf-8", "surrogatepass")))
def test_any_text_is_read_or_refused(tmp_path_factory, content):
    read_or_refuse(tmp_path_factory.getbasetemp() / "any.toml", content)


def test_python_functions_take_paths(tmp_path):
    path = tmp_path / "one.toml"
    path.write_text('robot = "pendulum1"\n[[gains]]\nname = "one"\nm = 1\nkp = [10]\nkv = [1]\n')
    by_path = run_simulation(path, "pendulum1", [0.5], T=0.1)
    as_read = run_simulation(read_gain_file(path).gains[0], load_robot("pendulum1"), [0.5], T=0.1)
    assert np.array_equal(by_path.q, as_read.q)
    with pytest.raises(InputError, match="several gain sets: tau_m1, tau_m2, tau_m3"):
        run_simulation(paper_gain_file("table2"), "buap3", [0.1, 0.1, 0.1])


@pytest.mark.parametrize(
    ("robot", "rule"),
    [
        ("../none.tml", "is no arm file"),
        ("../none.toml", "/../none.toml cannot be read"),
        ("gains.toml", "gains.toml is a gain file, not an arm file"),
        ("nobody", "is neither a built-in arm nor a file"),
    ],
)
@pytest.mark.parametrize("command", ["gate", "epsilon", "bounds", "simulate"])
def test_an_arm_that_is_none_is_told_at_the_line_that_names_it(command, robot, rule, file):
    file.write_text(GOOD.replace("buap3", robot))
    (problem,) = refused_by(command, str(file)).problems
    assert (problem.file, problem.line, problem.key, problem.value) == (str(file), 1, "robot", robot)
    assert rule in problem.rule


def test_an_arm_of_the_command_line_is_not_told_at_the_gain_file(file):
    file.write_text(GOOD)
    assert [problem.file for problem in refused_by("gate", str(file), "--robot", "no.tml").problems] == [
        "no.tml"
    ]


def refused_by(*words):
    done = invoke(*words)
    assert done.exception is not None
    return done.exception
