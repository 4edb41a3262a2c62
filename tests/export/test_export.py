"""The controller in C: compiled, run under sanitizers, held against balls, simulations and readings."""

from __future__ import annotations

import ctypes
import json
import math
import re
import shutil
import subprocess
from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from flint import arb
from hypothesis import example, given
from hypothesis import strategies as st

import lyapcheck
from lyapcheck.answers.export import export
from lyapcheck.check.numbers.balls import precision, to_arb
from lyapcheck.control.gains import GainSet, read_gain_file
from lyapcheck.control.sampling import LoopRecord, record_of
from lyapcheck.export import ANGLES, Controller, c_names
from lyapcheck.export.functions import NEAR
from lyapcheck.export.steps import BITS, Rounded, Unbounded
from lyapcheck.robots import load
from tests.helpers.arm_texts import ONE_JOINT
from tests.helpers.command import invoke
from tests.helpers.shares import but, one_in

ROOT = Path(__file__).parents[2]
WARNED = ("-std=c99", "-pedantic", "-Wall", "-Wextra", "-Wconversion", "-Wshadow", "-Werror")
SANITIZED = ("-O1", "-fsanitize=address,undefined", "-fno-sanitize-recover=all")
FUSED = ("-O3", "-march=native", "-ffp-contract=fast")
ARMS = {
    "buap3": ROOT / "proofs" / "table2.toml",
    str(ROOT / "examples" / "ur5.toml"): ROOT / "examples" / "ur5_gains.toml",
    str(ROOT / "examples" / "panda.toml"): ROOT / "examples" / "panda_gains.toml",
}
pytestmark = pytest.mark.skipif(shutil.which("gcc") is None, reason="gcc is not installed")
LOOP = LoopRecord(period=Fraction(1, 1000))
ANY = st.floats() | st.floats(-10, 10) | st.floats(-(2.0**12), 2.0**12) | st.floats(-(2.0**31), 2.0**31)


def controller(
    arm: str = "pendulum1", m: int | None = 1, family: str = "hyperbolic", **how: Any
) -> Controller:
    model = load(arm).fixed()
    kp, kv = (tuple(Fraction(k, 10 + i) for i in range(model.n)) for k in (70, 30))
    limits = tuple(Fraction(21, 4 + i) for i in range(model.n))
    return Controller(GainSet("one", m, kp, kv), model, limits, LOOP, "one", **how)


def built(
    one: Controller, folder: Path, *flags: str, compiler: str = "gcc", change: tuple[str, str] = ("", "")
) -> Path:
    """The test program of a controller."""
    for name, text in one.texts().items():
        assert change[0] in text or not name.endswith(f"{one.name}.c")
        (folder / name).write_text(text.replace(*change) if name == f"{one.name}.c" else text)
    sources = [str(folder / f"{one.name}{end}.c") for end in ("", "_test")]
    subprocess.run([compiler, *WARNED, *flags, *sources, "-o", str(folder / "run"), "-lm"], check=True)
    return folder / "run"


def run(program: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run([program], capture_output=True, text=True, check=False)


def of_file(arm: str, number: int = 0) -> Controller:
    gains = read_gain_file(ARMS[arm]).gains[number]
    model = load(arm).fixed()
    limits = tuple(None if limit is None else limit.value for limit in model.torque_limit)
    return Controller(gains, model, limits, LOOP, c_names([gains.name])[0])


class Compiled:
    """The functions of a controller, by ctypes."""

    def __init__(self, one: Controller, folder: Path) -> None:
        n, taps = one.model.n, len(one.loop.filter)
        self.one, self.n, self.row = one, n, ctypes.c_double * n
        texts = one.texts()
        for name, text in texts.items():
            (folder / name).write_text(text)
        place = folder / f"{one.name}.so"
        source = str(folder / f"{one.name}.c")
        subprocess.run(["gcc", "-std=c99", "-O2", "-shared", "-fPIC", source, "-o", str(place)], check=True)
        library = ctypes.CDLL(str(place))
        self._torque, self._step = (getattr(library, f"{one.name}_{what}") for what in ("torque", "step"))
        rows = [(name, self.row) for name in ("reading", "turns", "q")]
        rates = [("rate", self.row * taps), ("tau", self.row)]
        ints = [(name, ctypes.c_int) for name in ("started", "missed", "flag")]
        self.State = type("State", (ctypes.Structure,), {"_fields_": [*rows, *rates, *ints]})
        self.bounds = one.rounding

    def torque(
        self, q: Sequence[float], w: Sequence[float], goal: Sequence[float]
    ) -> tuple[int, list[float]]:
        tau = self.row(*[-7.0] * self.n)
        return self._torque(self.row(*q), self.row(*w), self.row(*goal), tau), list(tau)

    def step(self, state: Any, q: Sequence[float], goal: Sequence[float]) -> tuple[int, list[float]]:
        tau = self.row()
        return self._step(ctypes.byref(state), self.row(*q), self.row(*goal), tau), list(tau)

    def hold(self, q: Sequence[float], w: Sequence[float], goal: Sequence[float]) -> None:
        """Refused and left alone, or within the bound of the torque in balls."""
        flag, tau = self.torque(q, w, goal)
        places = [abs(x) for x in (*q, *goal)]
        if not all(x <= ANGLES[1] for x in places) or not all(map(math.isfinite, w)):
            assert (flag, tau) == (1, [-7.0] * self.n)
            return
        assert flag == 0
        bounds = self.bounds[ANGLES[0] if max(places) <= ANGLES[0] else ANGLES[1]]
        with precision(1200 if max(places) < 1e-100 or max(map(abs, w)) < 1e-100 else BITS):
            for found, exact, bound in zip(tau, self.one.torque(q, w, goal), bounds, strict=True):
                assert abs(arb(found) - exact) <= to_arb(bound), (q, w, goal, found, exact)


@pytest.fixture(scope="module")
def compiled(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., Compiled]:
    """Controllers, each compiled once: of gains for an arm or of others, see `controller`."""

    @cache
    def one(arm: str = "pendulum1", m: int = 1, taps: Any = LOOP.filter, wrapped: bool = False) -> Compiled:
        made = of_file(arm) if arm in ARMS else controller(arm, m, wrapped=wrapped)
        return Compiled(replace(made, loop=replace(LOOP, filter=taps)), tmp_path_factory.mktemp("c"))

    return one


@pytest.mark.parametrize("flags", [SANITIZED, FUSED], ids=["sanitized", "fused"])
@pytest.mark.parametrize("arm", one_in(3, ARMS))
@pytest.mark.parametrize("compiler", ["gcc", "clang"])
def test_it_compiles_without_a_warning_and_keeps_its_bound(
    arm: str, compiler: str, flags: tuple[str, ...], tmp_path: Path
) -> None:
    if shutil.which(compiler) is None:
        pytest.skip(f"{compiler} is not installed")
    done = run(built(of_file(arm, 1), tmp_path, *flags, compiler=compiler))
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.startswith("PASS: tau_m2, 1000 vectors")


@pytest.mark.parametrize(
    ("right", "wrong"),
    one_in(
        3,
        [
            ("0x1.5555555555555p-3", "0x1.5555555556555p-3"),
            ("0x1.0000000000000p-1 *", "0x1.0000000001000p-1 *"),
            ("KP[i]", "KP[0]"),
        ],
    ),
)
def test_the_test_program_finds_a_fault(right: str, wrong: str, tmp_path: Path) -> None:
    """A coefficient of the sine or of exp off in its fortieth bit, another torque: all are found."""
    done = run(built(of_file("buap3"), tmp_path, change=(right, wrong)))
    assert done.returncode == 1
    assert "farther" in done.stdout


@pytest.mark.parametrize("flag", ["-ffast-math", "-mfpmath=387"])
def test_a_compiler_that_breaks_the_bound_is_refused(flag: str, tmp_path: Path) -> None:
    with pytest.raises(subprocess.CalledProcessError):
        built(controller(), tmp_path, flag)


@pytest.mark.parametrize("key", one_in(4, ["pelican2", *ARMS]))
@given(data=st.data())
def test_any_arguments_are_refused_or_within_the_bound(
    compiled: Callable[..., Compiled], key: str, data: st.DataObject
) -> None:
    one = compiled(key, 2)
    rows = [data.draw(st.lists(ANY, min_size=one.n, max_size=one.n)) for _ in range(3)]
    one.hold(*rows)


@pytest.mark.parametrize("m", but([2, 10_000], [*range(1, 10), 100, 10_000]))
def test_the_seams_of_h_for_every_m(m: int, compiled: Callable[..., Compiled]) -> None:
    """Where the branch, the k of the reduction and the flat end change, by single doubles; and far beyond."""
    one = compiled(m=m)
    seams = [0.0, 5e-324, 1e-9, NEAR, 20.0, 2.0**27, 1e308, 1.7976931348623157e308]
    seams += [(k + 0.5) * math.log(2) for k in range(30)]
    beside = [math.nextafter(x, end) for x in seams for end in (0, 2 * x)]
    for x in [*seams, *beside, *np.linspace(0, 22, 100)]:
        for w in (x, -x):
            one.hold([1.0], [w], [1.0])
            one.hold([0.0], [0.0], [math.copysign(min(x, 4096.0), w)])


@pytest.mark.parametrize("key", one_in(3, ARMS))
def test_it_is_the_torque_of_the_simulation_and_of_the_arm(
    compiled: Callable[..., Compiled], key: str
) -> None:
    one = compiled(key, 2)
    controlled, model = one.one, load(key)
    goal = [0.3 + 0.04 * i for i in range(one.n)]
    run = lyapcheck.run_simulation(controlled.gains, model, goal, T=0.5, points=20, stop=False)
    same = lyapcheck.torque(controlled.gains, model, run.q, run.w, goal)
    for q, w, tau, again in zip(run.q, run.w, run.tau, same, strict=True):
        found = one.torque(q, w, goal)[1]
        # both round, the simulation as much as C
        most = 2 * np.array(one.bounds[ANGLES[0]], dtype=float)
        assert np.all(np.abs(np.array([tau, again]) - found) <= most)
        with precision(BITS):
            sines, cosines = ([getattr(arb(x), name)() for x in q] for name in ("sin", "cos"))
            pull = model.fixed().at(sines, cosines, to_arb).gravity()
            still = controlled.torque(q, [0.0] * one.n, list(q))
            assert all(a.overlaps(b) for a, b in zip(pull, still, strict=True))


READING = st.tuples(st.floats(-0.4, 0.4), st.booleans())


@given(st.lists(READING, min_size=1, max_size=25), st.booleans())
@example([(-1.5, True), *[(5e-4, False)] * 1100, (0.0, True)], False)
def test_steps_by_a_list_of_all_readings(
    compiled: Callable[..., Compiled], moves: list[tuple[float, bool]], wrapped: bool
) -> None:
    """Differences of all angles, gaps filled by straight lines; held, then gravity; within the limit."""
    one = compiled(taps=(Fraction(3, 4), Fraction(1, 4)), wrapped=wrapped)
    state, arm, angle, goal = one.State(), "pendulum1", 3.0, [2.0]
    known: list[float] = []
    last, missed, flag = 0.0, 0, 0
    for move, good in moves:
        angle += move
        reading = math.remainder(angle, 2 * math.pi) if wrapped else angle
        if good:
            turns = round((known[-1] - reading) / (2 * math.pi)) if wrapped and known else 0
            at = reading + turns * 2 * math.pi
            gap = missed + 1 if known else 1
            known += [known[-1] + (at - known[-1]) * (k + 1) / gap for k in range(gap)] if known else [at]
            rates = np.diff(known)[::-1][:2] * 1000
            w = float(np.dot(rates, [0.75, 0.25][: len(rates)]))
            tau = float(lyapcheck.torque(one.one.gains, arm, known[-1:], [w], goal)[0])
            missed = 0
        else:
            missed += 1
            flag = max(flag, 2 if missed <= 3 or not known else 3)
            if missed > 3 and known:
                tau = float(lyapcheck.torque(one.one.gains, arm, known[-1:], [0.0], known[-1:])[0])
            else:
                tau = last
        last = max(-5.25, min(5.25, tau))
        found, sent = one.step(state, [reading if good else math.nan], goal)
        assert found == flag
        assert sent[0] == pytest.approx(last, abs=1e-9)
        assert abs(sent[0]) <= 5.25


OPERATION = st.tuples(st.sampled_from("+-*/"), st.integers(0, 9), st.integers(0, 9))
DOUBLE = st.floats(-1e6, 1e6)


@given(st.lists(DOUBLE, min_size=2, max_size=4), st.lists(OPERATION, max_size=12))
def test_running_errors_hold_for_any_program(
    values: list[float], operations: list[tuple[str, int, int]]
) -> None:
    act: dict[str, Callable[[Any, Any], Any]] = {
        "+": lambda a, b: a + b, "-": lambda a, b: a - b, "*": lambda a, b: a * b, "/": lambda a, b: a / b,
    }  # fmt: skip
    rows = [(x, Fraction(x), Rounded(arb(x), arb(0))) for x in values]
    with precision(BITS):
        for sign, a, b in operations:
            left, right = rows[a % len(rows)], rows[b % len(rows)]
            try:
                found = act[sign](left[2], right[2])
            except Unbounded:
                continue
            rows.append((act[sign](left[0], right[0]), act[sign](left[1], right[1]), found))
        for computed, exact, bound in rows:
            assert bound.exact.overlaps(to_arb(exact))
            assert abs(to_arb(Fraction(computed) - exact)) <= bound.error


def test_names_in_c() -> None:
    hostile = [
        "τ",
        "",
        "9",
        "a*/b",
        "??/",
        "a",
        "A",
        "a_test",
        "while",
        "_Bool",
        "../../etc",
        "a\nb",
        "x" * 99,
    ]
    names = c_names(hostile)
    assert all(re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", name) and "__" not in name for name in names)
    files = [f"{name}{end}".lower() for name in names for end in ("", "_test")]
    assert len(set(files)) == len(files)


def gain_file(folder: Path, name: str = "one", more: str = "m = 1", robot: str = "pendulum1") -> Path:
    path = folder / "gains.toml"
    head = f"robot = {json.dumps(robot)}\n[[gains]]\nname = {json.dumps(name)}\n"
    path.write_text(f"{head}{more}\nkp = [0.5]\nkv = [0.01]\n")
    return path


@pytest.mark.parametrize("name", one_in(3, ["a */ int x; /*", "??/", "ε\\", "x" * 300]))
def test_hostile_names_compile(name: str, tmp_path: Path) -> None:
    out = tmp_path / "out"
    assert invoke("export", str(gain_file(tmp_path, name)), "--out", str(out), "--rate", "1e3").exit_code == 0
    sources = list(map(str, out.glob("*.c")))
    subprocess.run(["gcc", *WARNED, *sources, "-o", str(out / "run"), "-lm"], check=True)
    records = [json.loads(path.read_text()) for path in out.glob("*.json") if "_sampled" not in path.name]
    assert [record["name"] for record in records] == [name]


def test_the_same_bytes_and_no_other_file_is_lost(tmp_path: Path) -> None:
    words = ("export", str(gain_file(tmp_path)), "--out", str(tmp_path / "out"), "--format", "json", "--rate")
    first = invoke(*words, "1000")
    files = {path.name: path.read_bytes() for path in (tmp_path / "out").iterdir()}
    assert sorted(files) == ["one.c", "one.h", "one.json", "one_sampled.json", "one_test.c"]
    assert invoke(*words, "1000") == first
    assert "is there already" in str(invoke(*words, "999").exception)
    assert files == {path.name: path.read_bytes() for path in (tmp_path / "out").iterdir()}
    record, (shown,) = json.loads(files["one.json"]), json.loads(first.stdout)["results"]
    assert record == {"schema": "lyapcheck/export/1"} | shown
    assert str(tmp_path) not in first.stdout + files["one.c"].decode()


def test_the_certified_period(tmp_path: Path) -> None:
    """From the paper's printed numbers; one sample late nothing is known at 2.5 ms."""
    words = ("export", str(ARMS["buap3"]), "--format", "json", "--rate", "400", "--out")
    done = invoke(*words, str(tmp_path / "at once"), "--delay", "0")
    rows = json.loads(done.stdout)["results"]
    assert [row["certified_period"] for row in rows] == ["0.003388", "0.003378", "0.002184"]
    assert [row["period_covered"] for row in rows] == [True, True, False]
    assert invoke("recheck", *map(str, (tmp_path / "at once").glob("*_sampled.json"))).exit_code == 0
    late = invoke(*words[:2], *words[4:], str(tmp_path / "late")).stdout.splitlines()[1]
    assert late == ("  open at 2.5 ms, as a computer runs it: tau_m1, tau_m2, tau_m3")


def test_a_loop_that_the_gate_shows_from_rest_is_not_open(tmp_path: Path) -> None:
    """Gains above the friction, of which (S) shows no period; of another loop nothing is shown."""
    (tmp_path / "arm.toml").write_text(ONE_JOINT.format(viscous="0.3", torque=40, more=""))
    path = tmp_path / "gains.toml"
    path.write_text(
        'robot = "arm.toml"\ncondition = ["10i", "sampled"]\n'
        '[[gains]]\nname = "one"\nm = 1\nkp = [5]\nkv = [0.5]\n[loop]\nrate = 1000\nwithin = 30\n'
    )
    file = read_gain_file(path)
    model, runs = load(str(file.robot)), record_of(gain_file=file.loop)
    assert runs is not None
    answer = export(file, model, runs)
    assert answer.document().title.endswith("run at 1 ms: stable at exactly 1 ms, from rest within 30°")
    assert "no period is proved" not in str(answer)
    (one,) = answer.sets
    loop = replace(one.controller.loop, delay=0)
    other = replace(one, controller=replace(one.controller, loop=loop))
    assert "run at 1 ms: open" in replace(answer, sets=(other,)).document().title


@pytest.mark.parametrize(
    ("words", "more", "said"),
    [
        ("", "m = 1", "--rate"),
        ("--rate 0", "m = 1", "--rate"),
        ("--rate fast", "m = 1", "--rate"),
        ("--rate 1000 --lowpass 50", "m = 1", "finitely many taps"),
        ("--rate 1000 --velocity measured", "m = 1", "takes differences"),
        ("--rate 1000 --hold-samples -1", "m = 1", "at least 0"),
        ("--rate 1000", 'family = "linear"', "without bound"),
        ("--rate 1000", 'family = "algebraic"', "no formula in C"),
        ("--rate 1000 --robot buap3", "m = 1", "joints"),
    ],
)
def test_what_is_refused(words: str, more: str, said: str, tmp_path: Path) -> None:
    out = tmp_path / "out"
    done = invoke("export", str(gain_file(tmp_path, more=more)), "--out", str(out), *words.split())
    assert done.exit_code == 2
    assert said in str(done.exception)
    assert not out.exists()


def test_the_torque_in_python() -> None:
    gains = GainSet("one", 3, (Fraction(2),), (Fraction(1),))
    extreme = [[0.0], [1e308], [-1.7e308]]
    assert np.isfinite(lyapcheck.torque(gains, "pendulum1", [0.0], extreme, extreme)).all()
    with pytest.raises(lyapcheck.InputError, match="last axis"):
        lyapcheck.torque(gains, "pendulum1", [0.0, 1.0], [0.0], [0.0])
