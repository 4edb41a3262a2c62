"""The command line as a whole: bad input, help, versions, faults and readers that go away."""

from __future__ import annotations

import io
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
import typer

from lyapcheck import __version__
from lyapcheck.cli import main as command_line
from lyapcheck.cli.main import CLOSED_PIPE, COMMANDS, main
from lyapcheck.errors import argument_error

SCRIPT = str(Path(sys.executable).with_name("lyapcheck"))
TABLE2 = str(Path(__file__).parents[2] / "proofs" / "table2.toml")


@pytest.fixture
def run(monkeypatch, capsys):
    """Run a command line in this process: exit code, standard output, standard error."""
    monkeypatch.delenv("LYAPCHECK_DEBUG", raising=False)
    monkeypatch.setenv("COLUMNS", "400")
    monkeypatch.setenv("NO_COLOR", "1")

    def invoke(*arguments):
        monkeypatch.setattr(sys, "argv", ["lyapcheck", *arguments])
        with pytest.raises(SystemExit) as leave:
            main()
        out, err = capsys.readouterr()
        return int(leave.value.code or 0), out, err

    return invoke


# The command line, and for every error it has a piece of the message that tells it.
BAD = [
    ("frobnicate", ["No such command 'frobnicate'"]),
    ("--frobnicate", ["No such option: --frobnicate"]),
    ("table --m 0", ["--m = 0: m must be at least 1"]),
    ("table --m -3", ["--m = -3: m must be at least 1"]),
    ("table --m 1.5", ["--m = 1.5: is not a whole number"]),
    ("table --m nan", ["--m = nan: is not a whole number"]),
    ("table --m 3:1", ["--m = 3:1: the range is empty; write 1:3"]),
    ("table --m 1:2:3", ["--m = 1:2:3: is not a whole number or a range"]),
    ("table --m 0,x,2:1", ["--m = 0:", "--m = x:", "--m = 2:1:"]),
    ("table --m 99999999999999999999999", ["m must be at most"]),
    ("table --m", ["Option '--m' requires an argument"]),
    ("table --digits 0", ["--digits = 0: must be from 1 to"]),
    ("table --digits many", ["--digits"]),
    ("table --format xml", ["'xml' is not one of"]),
    ("table leftover", ["unexpected extra argument"]),
    ("gate", ["Missing argument 'FILE...'"]),
    ("gate none.toml", ["none.toml: file: cannot be read"]),
    ("gate none.toml nil.toml", ["none.toml: file: cannot be read", "nil.toml: file: cannot be read"]),
    ("gate .", ["file: is a folder"]),
    ("gate TABLE2 --robot nobody", ["robot = nobody: is neither a built-in arm nor a file"]),
    ("gate TABLE2 --condition 11", ["'11' is not one of"]),
    ("gate TABLE2 --gamma rounded", ["'rounded' is not one of"]),
    ("check", ["Missing argument 'PROOF.py'"]),
    ("check none.py", ["none.py: PROOF = none.py: no such proof script"]),
    ("check published.py --only 99", ["id = 99: no claim has this id"]),
    ("check published.py --only 7x --only 99", ["id = 7x: no claim has this id", "id = 99: no claim"]),
    ("check published.py --n 0", ["--n = 0: there is at least one joint"]),
    ("check published.py --n 2 --robot pelican2", ["--n = 2: a robot already says"]),
    ("check published.py --m 0", ["--m = 0: m must be at least 1"]),
    ("check published.py --robot nobody", ["robot = nobody: is neither"]),
    ("check published.py --gains none.toml", ["none.toml: file: cannot be read"]),
    ("check published.py --certificates TABLE2", ["--certificates = TABLE2: cannot be made"]),
    ("recheck", ["Missing argument 'CERTIFICATE"]),
    ("recheck none.json", ["none.json: CERTIFICATE: cannot be read"]),
    ("recheck TABLE2", ["TABLE2: CERTIFICATE: is not JSON"]),
    ("explain", ["Missing argument 'ID'"]),
    ("explain 99", ["id = 99: no claim has this id"]),
    ("explain 7a --proof none.py", ["none.py: PROOF = none.py: no such proof script"]),
    ("epsilon", ["Missing argument 'FILE'"]),
    ("epsilon none.toml", ["none.toml: file: cannot be read"]),
    ("epsilon TABLE2 --m 9", ["--m = 9:"]),
    ("epsilon TABLE2 --max-boxes 0", ["--max-boxes"]),
    ("epsilon TABLE2 --jobs -1", ["--jobs"]),
    ("epsilon TABLE2 --robot pelican2", ["tau_m1 has gains for 3", "tau_m2 has gains", "tau_m3 has gains"]),
    ("bounds", ["Missing argument 'FILE'"]),
    ("bounds none.toml", ["none.toml: file: cannot be read"]),
    ("bounds TABLE2 --max-boxes 0", ["--max-boxes"]),
    ("bounds TABLE2 --robot pelican2", ["tau_m1 has gains for 3", "tau_m2 has gains", "tau_m3 has gains"]),
    (
        "bounds TABLE2 --delta nan --disturbance 1,2 --friction a,b,c --start 1,2",
        ["--delta = nan", "--disturbance = 1,2: must be 3", "--friction = a,b,c: must be 3", "--start = 1,2"],
    ),
    ("robot", ["Missing argument 'NAME|FILE'"]),
    ("robot nobody", ["robot = nobody: is neither"]),
    ("robot pelican2 --tip hand", ["tip = hand: pelican2 is no URDF file"]),
    ("simulate", ["Missing argument 'FILE'"]),
    ("simulate none.toml", ["none.toml: file: cannot be read"]),
    ("simulate TABLE2 --time 0", ["--time = 0.0: must be from 1e-06 to 3600 s"]),
    (
        "simulate TABLE2 --time nan --eps0 -1 --target 1,2 --start a,b,c",
        ["--time = nan", "--eps0 = -1.0", "--target = 1,2: has 2 angles", "--start = a,b,c: every angle"],
    ),
    ("simulate TABLE2 --csv none/run.csv", ["--csv = none/run.csv: there is no directory none"]),
    ("simulate TABLE2 --plot none", ["--plot = none: is not a directory"]),
    ("simulate TABLE2 --robot pelican2", ["--target: is missing"]),
    ("tune", ["Missing argument 'ROBOT'"]),
    ("tune nobody", ["robot = nobody: is neither"]),
    ("tune buap3 --m 0", ["--m = 0: m must be at least 1"]),
    ("tune buap3 --digits -1", ["--digits = -1: must be from 0"]),
    ("tune buap3 --torque 1,2", ["--torque = 1,2: has 2 values for 3 joints"]),
    ("tune buap3 --kv-min x", ["--kv-min = x: is not a decimal number"]),
    ("tune buap3 --out none/x.toml", ["--out = none/x.toml: there is no directory none"]),
    ("tune buap3 --compare none.toml", ["none.toml: file: cannot be read"]),
    ("report --m 0", ["--m = 0: m must be at least 1"]),
    ("report --m 1:21", ["a report covers at most 20 members"]),
    ("report --format html,docx", ["'docx' is not a format"]),
    ("report --robot nobody", ["robot = nobody: is neither"]),
    ("report --gains none.toml", ["none.toml: file: cannot be read"]),
    ("report --out TABLE2", ["--out = TABLE2: is a file; name a folder"]),
]


def messages(stderr):
    """The errors told: lines that begin with ``error:``, and the box that Typer draws around its own."""
    return [line for line in stderr.splitlines() if re.match(r"error: |│ ", line)]


@pytest.mark.parametrize(("line", "pieces"), BAD, ids=[line for line, _ in BAD])
def test_bad_input_gets_a_message_an_error_and_nothing_else(line, pieces, run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code, out, err = run(*[TABLE2 if word == "TABLE2" else word for word in line.split()])
    assert (code, out) == (2, "")
    assert "Traceback" not in err
    told = messages(err)
    assert len(told) == len(pieces)
    for piece in pieces:
        assert sum(piece.replace("TABLE2", TABLE2) in message for message in told) == 1
    assert not list(tmp_path.iterdir()), "bad input must leave nothing behind"


def test_the_table_covers_every_command():
    assert {line.split()[0] for line, _ in BAD} >= set(COMMANDS)


@pytest.mark.parametrize("command", COMMANDS)
def test_no_command_takes_an_option_it_does_not_know(command, run):
    code, out, err = run(command, "--frobnicate")
    assert (code, out) == (2, "")
    assert len(messages(err)) == 1
    assert "No such option: --frobnicate" in err


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_explains_itself(command, run):
    code, out, err = run(command, "--help")
    assert (code, err) == (0, "")
    assert f"lyapcheck {command}" in out
    assert "--help" in out


def test_the_help_page_lists_every_command_and_the_exit_codes(run):
    code, out, err = run("--help")
    assert (code, err) == (0, "")
    for command in COMMANDS:
        assert re.search(rf"^\W*{command}\s", out, re.MULTILINE)
    assert "4 internal error" in " ".join(out.split())


def test_without_a_command_there_is_help_and_a_usage_code(run):
    assert run()[0] == 2


def test_the_version_is_that_of_the_package(run):
    assert run("--version") == (0, f"lyapcheck {__version__}\n", "")


def with_command(monkeypatch, body):
    """Put a command called table in place of the real one."""

    def build(names=()):
        app = typer.Typer(pretty_exceptions_enable=False, add_completion=False)
        app.callback()(lambda: None)
        app.command("table")(body)
        return app

    monkeypatch.setattr(command_line, "build_app", build)


def broken():
    raise RuntimeError("line one\nline two \x1b[31mred")


def test_a_fault_in_lyapcheck_is_told_in_one_line(run, monkeypatch):
    with_command(monkeypatch, broken)
    code, out, err = run("table")
    assert (code, out) == (4, "")
    assert err.count("\n") == 1
    assert err.startswith("internal error: RuntimeError: line one\\nline two \\x1b[31mred; ")
    assert "LYAPCHECK_DEBUG=1" in err


def test_a_developer_can_see_the_traceback(monkeypatch):
    with_command(monkeypatch, broken)
    monkeypatch.setenv("LYAPCHECK_DEBUG", "1")
    monkeypatch.setattr(sys, "argv", ["lyapcheck", "table"])
    with pytest.raises(RuntimeError, match="line one"):
        main()


def test_a_value_cannot_forge_a_second_line_of_output(run, monkeypatch):
    def refuse():
        raise argument_error("--only", "x\nerror: y\x1b[2J γ", "no", "write γ")

    with_command(monkeypatch, refuse)
    assert run("table") == (2, "", "error: argument: --only = x\\nerror: y\\x1b[2J γ: no; write γ\n")


def test_an_interrupted_command_is_not_a_verdict(run, monkeypatch):
    def interrupted():
        raise KeyboardInterrupt

    with_command(monkeypatch, interrupted)
    assert run("table") == (130, "", "")


@pytest.mark.parametrize("script", ["import sys\nsys.exit(0)\n", "raise SystemExit\n", "exit()\n"])
def test_a_proof_script_cannot_choose_the_exit_code(script, run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("mine.py").write_text(script, encoding="utf-8")
    code, out, err = run("check", "mine.py")
    assert (code, out) == (2, "")
    assert "SystemExit" in err


def test_a_claim_cannot_choose_the_exit_code(run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    script = (
        "from lyapcheck.claims import Proof\n"
        "proof = Proof('mine', 'Mine')\n"
        "@proof.claim('a', 'nothing')\n"
        "def a(c):\n    raise SystemExit(0)\n"
    )
    Path("mine.py").write_text(script, encoding="utf-8")
    code, out, err = run("check", "mine.py")
    assert (code, out) == (2, "")
    assert "mine.py: a: its statement raises SystemExit" in err


@pytest.mark.parametrize("arguments", [("table", "--m", "1:2"), ("gate", TABLE2), ("table", "--m", "1:300")])
def test_a_reader_that_went_away_is_no_verdict_and_no_traceback(arguments):
    reader, writer = os.pipe()
    os.close(reader)
    try:
        done = subprocess.run(
            [SCRIPT, *arguments], stdout=writer, stderr=subprocess.PIPE, text=True, check=False
        )
    finally:
        os.close(writer)
    assert (done.returncode, done.stderr) == (CLOSED_PIPE, "")


def test_head_gets_its_line_and_no_noise():
    both = subprocess.run(
        ["sh", "-c", f"'{SCRIPT}' table --m 1:100 | head -1"], capture_output=True, text=True, check=False
    )
    assert (both.returncode, both.stderr, both.stdout.count("\n")) == (0, "", 1)


def test_the_same_bytes_in_every_locale():
    def table(**environment):
        variables = {**os.environ, **environment}
        return subprocess.run([SCRIPT, "table", "--m", "3"], capture_output=True, env=variables, check=True)

    plain, odd = table(), table(PYTHONIOENCODING="latin-1", LC_ALL="C")
    assert plain.stdout == odd.stdout
    assert "γ" in plain.stdout.decode("utf-8")


def test_streams_that_are_not_files_are_left_alone(run, monkeypatch):
    monkeypatch.setattr(sys, "stderr", io.StringIO())
    assert run("--version")[0] == 0


@pytest.mark.parametrize("module", ["lyapcheck", "lyapcheck.cli.main"])
@pytest.mark.parametrize("words", [["table", "--m", "1"], ["gate", TABLE2], ["gate"], ["explain", "--help"]])
def test_the_modules_run_as_the_script_does(module, words):
    module_run, script = (
        subprocess.run([*start, *words], capture_output=True, check=False)
        for start in ([sys.executable, "-m", module], [SCRIPT])
    )
    assert module_run.stdout + module_run.stderr != b""
    assert (module_run.returncode, module_run.stdout) == (script.returncode, script.stdout)
    assert module_run.stderr == script.stderr


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs a device that is full")
@pytest.mark.parametrize("unbuffered", ["", "1"])
@pytest.mark.parametrize(
    "words",
    [["table", "--m", "1"], ["gate", TABLE2], ["--help"], ["report"], ["epsilon", TABLE2]],
)
def test_a_full_output_is_named(words, unbuffered):
    with open("/dev/full", "wb") as full:
        done = subprocess.run(
            [SCRIPT, *words],
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
            env={**os.environ, "PYTHONUNBUFFERED": unbuffered},
        )
    assert done.returncode == 2
    (line,) = done.stderr.splitlines()  # and no progress: nothing was begun
    assert line.startswith("error: argument: standard output: cannot be written (No space left on device); ")


@pytest.mark.parametrize("words", [["gate", TABLE2], ["epsilon", TABLE2]])
def test_where_nobody_reads_nothing_is_begun(words):
    reader, writer = os.pipe()
    os.close(reader)
    done = subprocess.run([SCRIPT, *words], stdout=writer, stderr=subprocess.PIPE, check=False)
    os.close(writer)
    assert (done.returncode, done.stderr) == (141, b"")


@pytest.mark.skipif(not Path("/proc/self").exists(), reason="needs a folder that takes no file")
@pytest.mark.parametrize(
    "words",
    [
        ["epsilon", TABLE2, "--certificates", "/proc/self"],
        ["gate", TABLE2, "--certificates", "/proc/self"],
        ["simulate", TABLE2, "--csv", "/proc/self/motion.csv"],
        ["simulate", TABLE2, "--plot", "/proc/self"],
        ["tune", "buap3", "--out", "/proc/self/gains.toml"],
        ["report", "--out", "/proc/self"],
    ],
    ids=" ".join,
)
def test_a_place_that_takes_nothing_is_named_before_the_work(words):
    done = subprocess.run([SCRIPT, *words], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (2, "")
    (line,) = done.stderr.splitlines()
    assert line.startswith(f"error: argument: {words[-2]} = /proc/self")
    assert "/proc/self cannot be written to" in line


@pytest.mark.parametrize("words", [["table", "--m", "1"], ["gate", TABLE2]])
def test_a_closed_output_is_refused_and_a_closed_error_output_is_silence(words):
    line = " ".join([SCRIPT, *words])
    done = subprocess.run(["sh", "-c", f"{line} >&-"], capture_output=True, text=True, check=False)
    message = "error: argument: standard output: is closed; open it, or send it to /dev/null\n"
    assert (done.returncode, done.stderr) == (2, message)
    told, silent = (
        subprocess.run(["sh", "-c", f"{line} {end}"], stdout=subprocess.PIPE, check=False)
        for end in ("2>/dev/null", "2>&-")
    )
    assert (told.returncode, told.stdout) == (silent.returncode, silent.stdout)


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs a device that is full")
def test_a_full_error_output_changes_no_exit_code():
    with open("/dev/full", "wb") as full:
        assert subprocess.run([SCRIPT, "robot", "nosuch"], stderr=full, check=False).returncode == 2
