"""The gate's quick start: the same calls, files and arms as the long way, with hardly anything imported."""

from __future__ import annotations

import copy
import os
import pickle
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import pytest
import typer
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from typer.testing import CliRunner

from lyapcheck import load_robot, robot_names
from lyapcheck.cli import gate_run
from lyapcheck.cli import main as cli
from lyapcheck.cli.gate_options import GateCall, quick_call
from lyapcheck.control import known_arms, known_arms_data, limits, paper_gain_file, read_gain_file
from lyapcheck.control.limits import arm_limits
from lyapcheck.control.model_limits import model_limits
from lyapcheck.control.plain import read_plain
from lyapcheck.control.reading import read_toml
from lyapcheck.control.write_known_arms import data_text
from lyapcheck.errors import InputError
from lyapcheck.gating import gate
from lyapcheck.verdicts import Exit

QUICK = settings(deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])

# --- the command line --------------------------------------------------------------------------------

WORDS = st.lists(
    st.sampled_from(
        [
            "a.toml", "b c.toml", "--format", "--format=json", "json", "text", "--condition", "10", "scalar",
            "--condition=19", "--robot", "--robot=", "buap3", "--gamma=printed", "--gamma", "true",
            "--certificates", "--certificates=made",
            "--strict", "--", "--help", "-h", "--nope", "--strict=1", "--form", "-", "", "--condition=20",
        ]
    ),
    max_size=8,
)  # fmt: skip


def by_typer(words: Sequence[str], monkeypatch: pytest.MonkeyPatch) -> GateCall | None:
    """The call that Typer makes of the words; ``None`` where it shows help or a mistake."""
    calls: list[GateCall] = []

    def keep(call: GateCall) -> Exit:
        calls.append(call)
        return Exit.PROVED

    with monkeypatch.context() as patch:
        patch.setattr(gate_run, "run", keep)
        CliRunner().invoke(APP, ["gate", *words])
    return calls[0] if calls else None


APP: typer.Typer = cli.build_app(("gate", "table"))


@settings(QUICK, max_examples=150)
@given(WORDS)
def test_plain_words_mean_what_typer_makes_of_them(monkeypatch: pytest.MonkeyPatch, words: list[str]) -> None:
    found = quick_call(words)
    if found is not None:
        assert found == by_typer(words, monkeypatch)


@pytest.mark.parametrize(
    "words",
    [
        ["a.toml"],
        ["a.toml", "b.toml", "--strict"],
        ["--format", "sarif", "a.toml", "--condition=10p", "--condition", "19"],
        ["--robot=buap3", "--gamma", "printed", "--", "--a.toml"],
    ],
)
def test_usual_words_are_plain(monkeypatch: pytest.MonkeyPatch, words: list[str]) -> None:
    found = quick_call(words)
    assert found is not None
    assert found == by_typer(words, monkeypatch)


@pytest.mark.parametrize(
    "words", [[], ["--help"], ["a.toml", "--nope"], ["a.toml", "--format"], ["a.toml", "--format", "xml"]]
)
def test_help_and_mistakes_are_left_to_typer(words: list[str]) -> None:
    assert quick_call(words) is None


# --- gain files --------------------------------------------------------------------------------------

LINES = st.sampled_from(
    [
        'robot = "buap3"', "robot = 'buap3'", 'robot = "arm.toml"', "[[gains]]", "[[gains]]  ",
        "[[gains]]]", "[gains]",
        " [[gains]] # c", 'name = "a"', 'name = "b"', '\tname = "λ 关节" # c',
        'name = "a\\n"', 'name = ""', 'name = """a"""',
        "m = 2", "m = 2 # two", "m = 02", "m = 2.0", "m = 0", "m = 1_0", "m = true", "m = 100001",
        'family = "tanh"', 'family = "sinc"', 'angle = "deg"', 'family = "linear"',
        "kp = [1, 2]", "kp = [1.50, 2]", "kp = [ 1 ,\t2.000 ] # c ]", "kp = [1, 0]", "kp = [1]",
        "name = 'a\\n'", "name = '''a'''",
        "kp = [-1, 2]", "kp = [1e3, 2]", "kp = [1, 2,]", "kp = []",
        "kp = [1, 2] 3", "kp = 1", "kp = [01, 2]", "kp = [.5, 1]",
        "kv = [0.1, 0.2]", "kv = [0.1, 0.2]#", "  kv=[0.1,0.20]", "kv = [1., 2]", "kv = [٣, 1]", "kv = [0.1",
        "[bounds]", "viscous_min = 0.4", "torque = [50, 60.5]", "gravity = [0, 1]", "gravity = [0]",
        "# a comment = 1", "#\x0c", "", "   ", "other = 1", "\x00", "kp.x = 1", '"kp" = [1, 2]', "= 1",
    ]
)  # fmt: skip
USUAL = {
    "name": ['name = "{}"', "name = '{}' # c", '\tname="λ {} 关节"', 'name  =  "{} # ]"'],
    "m": ["m = 2", "m = 3 # three", " m=1", "m = 100000"],
    "kp": ["kp = [1, 2]", "kp = [1.50,2]", "kp = [ 1 ,\t2.000 ] # c ]", "kp = [0.5, 120.25] "],
    "kv": ["kv = [0.1, 0.2]", "kv = [0.1, 0.20]#", "  kv=[3,0.2]", "\tkv = [0.100,\t0.001]"],
}


@st.composite
def usual(draw: st.DrawFn) -> str:
    """Sets as people write them, their keys in any order, with a line among them now and then that is odd."""
    top = draw(st.sampled_from(["", 'robot = "buap3"', "# c\nrobot = 'buap3' # c", 'robot = "arms/a.toml"']))
    lines = [top]
    for name in draw(st.lists(st.sampled_from("abcd"), min_size=1, max_size=3, unique=True)):
        lines.append(draw(st.sampled_from(["[[gains]]", "  [[gains]] # c", "[[gains]]\t"])))
        keys = [draw(st.sampled_from(variants)).format(name) for variants in USUAL.values()]
        lines += draw(st.permutations([*keys, draw(st.sampled_from(["", "# c = [", "   "]))]))
    if draw(st.booleans()):
        lines += ["[bounds]", "viscous_min = 0.40", "torque = [50, 60.5]", "gravity = [0, 1.0]"]
    if draw(st.integers(0, 2)) == 0:
        lines.insert(draw(st.integers(0, len(lines))), draw(LINES))
    return "\n".join(lines)


TEXTS = st.one_of(usual(), usual(), st.lists(LINES, max_size=12).map("\n".join))
ENDS = st.sampled_from(["\n", "\r\n", "\n\n"])


@settings(QUICK, max_examples=300)
@given(TEXTS, ENDS, st.booleans())
def test_what_is_read_quickly_is_what_toml_says(tmp_path: Path, text: str, end: str, mark: bool) -> None:
    """Numbers with the digits written, places, bounds and arm; what is a mistake is never read quickly."""
    path = tmp_path / "g.toml"
    path.write_bytes((b"\xef\xbb\xbf" if mark else b"") + (text + "\n").replace("\n", end).encode())
    quick = read_plain(str(path))
    if quick is None:
        return
    slow = read_toml(path)  # raises on a mistake
    assert (quick.path, quick.robot, quick.gains, quick.bounds) == (
        slow.path, slow.robot, slow.gains, slow.bounds
    )  # fmt: skip
    for one, other in zip(quick.gains, slow.gains, strict=True):
        for key in ("kp", "kv"):
            assert [repr(x) for x in getattr(one, key)] == [repr(x) for x in getattr(other, key)]
            for joint in (None, *range(one.n)):
                assert quick.place(one, key, joint) == slow.place(other, key, joint)
        assert quick.place(one) == slow.place(other)
    if quick.robot:
        assert quick.document is not None
        assert slow.document is not None
        assert quick.document.place(("robot",)) == slow.document.place(("robot",))


def test_results_are_equal_where_what_they_say_is() -> None:
    """Judged twice, and sent to another process and back."""
    gain_file = read_plain(str(paper_gain_file()))
    assert gain_file is not None
    results = gate(gain_file)
    assert gate(read_gain_file(paper_gain_file())) == results == pickle.loads(pickle.dumps(results))
    assert gate(gain_file, gamma="printed") != results
    assert len({*gain_file.gains, *copy.deepcopy(gain_file.gains)}) == 3


@pytest.mark.parametrize("name", ["table2", "table2_pd", "table2_shoulder_elbow"])
def test_the_papers_files_are_plain(name: str) -> None:
    assert read_plain(str(paper_gain_file(name))) is not None


@pytest.mark.parametrize("content", [b"", b"\xff\xfe", b"robot = 1\n", b"[[gains]]\r"])
def test_what_is_not_plain_is_left_alone(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "g.toml").write_bytes(content)
    for path in (tmp_path / "g.toml", tmp_path, tmp_path / "none.toml"):
        assert read_plain(str(path)) is None
        with pytest.raises(InputError):
            read_toml(path)


# --- arms --------------------------------------------------------------------------------------------


def test_the_limits_that_are_kept_are_those_of_the_models() -> None:
    assert set(known_arms_data.ARMS) == set(robot_names())
    for name in robot_names():
        assert known_arms.known_arm(name) == model_limits(load_robot(name)) == arm_limits(name)
    kept = Path(known_arms_data.__file__).read_text(encoding="utf-8")
    assert kept == data_text(), "run python -m lyapcheck.control.write_known_arms"


def test_an_arm_whose_file_has_changed_is_not_known(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    source = Path(known_arms._ROBOTS, "buap3.toml").read_text(encoding="utf-8")
    monkeypatch.setattr(known_arms, "_ROBOTS", str(tmp_path))
    assert known_arms.known_arm("buap3") is None
    for text, known in ((source, True), (source.replace("\n", "\r\n"), True), (source + "#", False)):
        (tmp_path / "buap3.toml").write_bytes(text.encode())
        assert (known_arms.known_arm("buap3") is not None) == known


def test_an_arm_is_read_once_for_many_files(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """And only for one call: an arm file that has changed since is read again."""
    arm = tmp_path / "arm.toml"
    shutil.copy(Path(known_arms._ROBOTS, "pendulum1.toml"), arm)
    text = 'robot = "arm.toml"\n[[gains]]\nname = "a"\nm = 1\nkp = [0.1]\nkv = [0.05]\n'
    files = [tmp_path / f"g{i}.toml" for i in range(3)]
    for file in files:
        file.write_text(text)
    reads: list[str] = []
    monkeypatch.setattr(limits, "arm_limits", lambda name: (reads.append(name), arm_limits(name))[1])
    call = GateCall(tuple(map(str, files)))
    assert gate_run.run(call) == Exit.PROVED
    assert reads == [str(arm)]
    arm.write_text(arm.read_text().replace("low = 0.1", "low = 0.01"))
    assert gate_run.run(call) == Exit.REFUTED


# --- the process -------------------------------------------------------------------------------------

RUN = "from lyapcheck.cli.main import main; main()"
LIGHT = (
    "argparse",
    "difflib",
    "lyapcheck.check.loop",
    "lyapcheck.robots",
    "numpy",
    "pathlib",
    "tomllib",
    "typer",
)
"""What a plain call does without; python-flint and ``Constant``, by which the checker judges, it needs."""


@pytest.mark.parametrize("name", ["text", "markdown", "github"])
def test_a_plain_call_imports_the_checker_of_numbers_and_next_to_nothing_else(name: str) -> None:
    code = (
        "import sys\nfrom lyapcheck.cli.main import main\ntry:\n    main()\n"
        f"except SystemExit:\n    print([x for x in {LIGHT!r} if x in sys.modules], file=sys.stderr)\n"
    )
    words = [sys.executable, "-I", "-c", code, "gate", str(paper_gain_file()), "--format", name]
    done = subprocess.run(words, capture_output=True, text=True, check=True, env={"PATH": os.environ["PATH"]})
    assert done.stderr == "[]\n"


def cpu_seconds(*words: str) -> float:
    """Processor time of a whole process, which other processes hardly change."""
    pid = os.posix_spawn(words[0], words, os.environ, file_actions=SILENT)
    _, _, used = os.wait4(pid, 0)
    return used.ru_utime + used.ru_stime


SILENT = [(os.POSIX_SPAWN_OPEN, fd, os.devnull, os.O_WRONLY, 0) for fd in (1, 2)]


def test_the_gate_starts_nearly_as_fast_as_the_arithmetic_of_the_checker() -> None:
    """The goal is 1.7 times the start of python-flint; the bound leaves room for a busy machine."""
    bare = [sys.executable, "-c", "import flint"]
    gate = [sys.executable, "-c", RUN, "gate", str(paper_gain_file())]
    times = [(cpu_seconds(*bare), cpu_seconds(*gate)) for _ in range(12)]
    assert min(gate for _, gate in times) < 2.5 * min(bare for bare, _ in times)


def test_a_reader_that_goes_away_gets_no_traceback() -> None:
    reader, writer = os.pipe()
    os.close(reader)
    words = [sys.executable, "-c", RUN, "gate", str(paper_gain_file())]
    done = subprocess.run(words, stdout=writer, stderr=subprocess.PIPE, check=False)
    os.close(writer)
    assert (done.returncode, done.stderr) == (cli.CLOSED_PIPE, b"")


def test_an_interrupted_gate_says_nothing(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def interrupt(call: GateCall) -> Exit:
        raise KeyboardInterrupt

    monkeypatch.setattr(gate_run, "run", interrupt)
    monkeypatch.setattr(sys, "argv", ["lyapcheck", "gate", "a.toml"])
    with pytest.raises(SystemExit) as left:
        cli.main()
    assert left.value.code == cli.INTERRUPTED
    assert capsys.readouterr().err == ""


# --- the summary of a job ----------------------------------------------------------------------------


def test_the_summary_of_a_job_is_added_to(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    path = tmp_path / "summary.md"
    path.write_text("before\n")
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", str(path))
    call = GateCall((str(paper_gain_file()),), "github")
    gate_run.run(call)
    text = path.read_text()
    assert text.startswith("before\n### ✓ tau_m1")
    assert "### ✗ tau_m2" in text
    gate_run.run(GateCall(call.files, "text"))
    assert path.read_text() == text
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", str(tmp_path / "none" / "summary.md"))
    with pytest.raises(InputError, match="GITHUB_STEP_SUMMARY"):
        gate_run.run(call)


def test_a_summary_of_many_sets_keeps_to_the_size_that_is_shown(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    sets = (
        f'[[gains]]\nname = "s{i}"\nm = 1\nkp = [1, 1, 1]\nkv = [{0.1 if i % 2 else 0.3}, 0.1, 0.1]\n'
        for i in range(3000)
    )
    (tmp_path / "g.toml").write_text('robot = "buap3"\n' + "".join(sets))
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", str(tmp_path / "summary.md"))
    assert gate_run.run(GateCall((str(tmp_path / "g.toml"),), "github")) == Exit.REFUTED
    text = (tmp_path / "summary.md").read_text(encoding="utf-8")
    assert len(text.encode()) < 2**20
    assert text.startswith("1500 of 3000 gain sets accepted, ")
    assert "### ✓" not in text
