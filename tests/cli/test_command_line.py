"""The command line as a whole: bad input, help, versions, faults and readers that go away."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from lyapcheck import __version__
from lyapcheck.cli import main as command_line
from lyapcheck.cli.commands import NAMES
from lyapcheck.cli.main import CLOSED_PIPE, main
from lyapcheck.errors import argument_error
from tests.helpers.command import lyapcheck
from tests.helpers.shares import one_in

SCRIPT = str(Path(sys.executable).with_name("lyapcheck"))
TABLE2 = str(Path(__file__).parents[2] / "proofs" / "table2.toml")


@pytest.fixture
def run(monkeypatch, capsys):
    """Run a command line in this process: exit code, standard output, standard error."""
    monkeypatch.delenv("LYAPCHECK_DEBUG", raising=False)

    def invoke(*arguments):
        monkeypatch.setattr(sys, "argv", ["lyapcheck", *arguments])
        with pytest.raises(SystemExit) as leave:
            main()
        out, err = capsys.readouterr()
        return int(leave.value.code or 0), out, err

    return invoke


# The command line, and for every error it has a piece of the message that tells it.
# What is no file that can be read is the matter of test_user_files.py.
BAD = [
    ("frobnicate", ["COMMAND = frobnicate: is not a command of lyapcheck; choose from bounds, check, "]),
    ("gaet", ["COMMAND = gaet: is not a command of lyapcheck; did you mean gate?"]),
    ("--frobnicate", ["lyapcheck: --frobnicate: is not an option here; see lyapcheck --help"]),
    ("--verison", ["lyapcheck: --verison: is not an option here; did you mean --version?"]),
    ("--completion powershell", ["--completion = powershell: is not one of bash, zsh, fish"]),
    ("table --m 0", ["--m = 0: m must be at least 1"]),
    ("table --m -3", ["--m = -3: m must be at least 1"]),
    ("table --m 1.5", ["--m = 1.5: is not a whole number"]),
    ("table --m nan", ["--m = nan: is not a whole number"]),
    ("table --m 3:1", ["--m = 3:1: the range is empty; write 1:3"]),
    ("table --m 1:2:3", ["--m = 1:2:3: is not a whole number or a range"]),
    ("table --m 1:,²,1e3", ["--m = 1::", "--m = ²: is not", "--m = 1e3: is not"]),
    ("table --m 10001", ["--m = 10001: m must be at most 10000;"]),
    ("table --m 0,x,2:1", ["--m = 0:", "--m = x:", "--m = 2:1:"]),
    ("table --m 99999999999999999999999", ["m must be at most"]),
    ("table --m", ["lyapcheck table: --m: expected one argument; see lyapcheck table --help"]),
    ("table --digits 0", ["--digits = 0: must be from 1 to"]),
    ("table --digits many", ["--digits = many: is not a whole number; write --digits 1"]),
    ("table --format xml", ["--format = xml: is not one of csv, html, json, latex, markdown, text"]),
    ("table --format jsn", ["did you mean json?"]),
    ("table left over", ["table: left: is one argument too many", "over: is one argument too many"]),
    ("table --digit 3 --certificate c", ["did you mean --digits?", "did you mean --certificates?"]),
    ("recheck --kernel=yes", ["--kernel: ignored explicit argument 'yes'"]),
    ("gate", ["lyapcheck gate: arguments: the following arguments are required: FILE...;"]),
    ("gate TABLE2 --rate 1e-30", ["--rate = 1e-30: must be between 1e-15 and 1e15 in size"]),
    ("export TABLE2 --rate 0", ["--rate = 0: must be positive; correct the sign or the value"]),
    ("gate none.toml nil.toml", ["none.toml: file: cannot be read", "nil.toml: file: cannot be read"]),
    ("sweep none.toml", ["none.toml: file: cannot be read"]),
    ("gate TABLE2 --robot nobody", ["robot = nobody: is neither a built-in arm nor a file"]),
    (
        "gate TABLE2 --condition 11",
        ["--condition = 11: is not one of 10, 10p, 10i, 19, scalar, global, lasalle"],
    ),
    ("derive --n 0", ["--n = 0: must be from 1 to 7; give 2"]),
    ("robot ur5 --fixed a=x", ["--fixed = a: x is no decimal number"]),
    ("check", ["the following arguments are required: PROOF.py"]),
    ("check published.py --only 7x --only 99", ["id = 7x: no claim has this id", "id = 99: no claim"]),
    ("check published.py --n 0", ["--n = 0: there is at least one joint"]),
    ("check published.py --n 2 --robot pelican2", ["--n = 2: a robot already says"]),
    ("check published.py --m 0", ["--m = 0: m must be at least 1"]),
    ("check published.py --robot nobody", ["robot = nobody: is neither"]),
    ("check published.py --certificates TABLE2", ["--certificates = TABLE2: cannot be made"]),
    ("recheck", ["the following arguments are required: CERTIFICATE"]),
    ("recheck TABLE2", ["TABLE2: CERTIFICATE: is not JSON"]),
    ("table --certificates TABLE2", ["--certificates = TABLE2: cannot be made"]),
    ("table --clean", ["--clean: is not an option here"]),
    ("explain 99 --proof scalar.py", ["scalar.py: id = 99: no claim has this id"]),
    ("epsilon", ["the following arguments are required: FILE"]),
    ("epsilon TABLE2 --m 9", ["--m = 9:"]),
    ("epsilon TABLE2 --max-boxes 0", ["--max-boxes = 0: must be at least 1; write --max-boxes 1"]),
    ("epsilon TABLE2 --jobs -1", ["--jobs = -1: must be at least 1"]),
    ("epsilon TABLE2 --jobs 65", ["--jobs = 65: must be at most 64; write --jobs 64"]),
    ("epsilon TABLE2 --seconds -1", ["--seconds = -1: must be at least 0"]),
    ("epsilon TABLE2 --robot pelican2", ["tau_m1 has gains for 3", "tau_m2 has gains", "tau_m3 has gains"]),
    ("bounds", ["the following arguments are required: FILE"]),
    ("bounds TABLE2 --delta x", ["--delta = x: is not a number; write --delta 1"]),
    ("bounds TABLE2 --robot pelican2", ["tau_m1 has gains for 3", "tau_m2 has gains", "tau_m3 has gains"]),
    (
        "bounds TABLE2 --delta nan --friction 1,2 --start 1,2",
        ["--delta = nan", "--friction = 1,2: must be 3", "--start = 1,2"],
    ),
    ("init TABLE2", ["DIR = TABLE2: cannot be made"]),
    ("robot", ["the following arguments are required: NAME|FILE"]),
    ("robot nobody", ["robot = nobody: is neither"]),
    ("robot pelican2 --tip hand", ["has no links to choose from"]),
    ("derive --n 3 --robot pelican2", ["--n = 3: cannot go with --robot"]),
    ("simulate TABLE2 --time 0", ["--time = 0: must be from 1e-06 to 3600 s"]),
    (
        "simulate TABLE2 --time nan --eps0 -1 --target 1,2 --start a,b,c",
        ["--time = nan", "--eps0 = -1", "--target = 1,2: has 2 numbers", "--start = a,b,c: each must be"],
    ),
    ("simulate TABLE2 --experiment --time 0.001", ["T = 0.001"]),
    ("simulate TABLE2 --robot pelican2 --target 10,20", ["gains"]),
    ("simulate TABLE2 --csv none/run.csv", ["--csv = none/run.csv: there is no directory none"]),
    ("simulate TABLE2 --plot TABLE2", ["--plot = TABLE2: cannot be made (File exists)"]),
    ("simulate TABLE2 --robot pelican2", ["tau_m1: has gains for 3 joints, but pelican2 has 2"]),
    ("tune", ["the following arguments are required: ROBOT"]),
    ("tune buap3 --m 0", ["--m = 0: m must be at least 1"]),
    ("tune buap3 --digits -1", ["--digits = -1: must be from 0"]),
    ("tune buap3 --torque 1,2", ["--torque = 1,2: has 2 values for 3 joints"]),
    ("tune buap3 --kv-share x", ["--kv-share = x: is not a decimal number"]),
    ("tune buap3 --out none/x.toml", ["--out = none/x.toml: there is no directory none"]),
    ("report --m 1:21", ["a report covers at most 20 members"]),
    ("report --format html,docx", ["'docx' is not a format"]),
    ("report --robot reyes-kelly2", [f"tau_{k} has gains for 3 joints" for k in ("m1", "m2", "m3", "pd")]),
    ("report --out TABLE2", ["--out = TABLE2: cannot be made (File exists)"]),
]


def messages(stderr):
    """The errors told: all lines, each of which begins with ``error:``."""
    lines = stderr.splitlines()
    assert all(line.startswith("error: ") for line in lines)
    return lines


@pytest.mark.parametrize(("line", "pieces"), BAD, ids=[line for line, _ in BAD])
def test_bad_input_gets_a_message_an_error_and_nothing_else(line, pieces, run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code, out, err = run(*[TABLE2 if word == "TABLE2" else word for word in line.split()])
    assert (code, out) == (2, "")
    assert "Traceback" not in err
    printed = messages(err)
    assert len(printed) == len(pieces)
    for piece in pieces:
        assert sum(piece.replace("TABLE2", TABLE2) in message for message in printed) == 1
    assert not list(tmp_path.iterdir()), "bad input must leave nothing behind"


def test_the_table_covers_every_command():
    assert {line.split()[0] for line, _ in BAD} >= set(NAMES)


@pytest.mark.parametrize("command", NAMES)
def test_no_command_takes_an_option_it_does_not_know(command, run):
    code, out, err = run(command, "--frobnicate")
    assert (code, out) == (2, "")
    (message,) = messages(err)
    assert f"lyapcheck {command}: --frobnicate: is not an option here; " in message


@pytest.mark.parametrize("command", NAMES)
def test_every_command_explains_itself(command, run):
    code, out, err = run(command, "--help")
    assert (code, err) == (0, "")
    assert out.startswith(f"usage: lyapcheck {command} [options]")
    assert f"\nExamples:\n  lyapcheck {command}" in out
    assert "--help" in out
    assert max(map(len, out.splitlines())) <= 80


def test_the_help_page_lists_every_command_and_the_exit_codes(run):
    code, out, err = run("--help")
    assert (code, err) == (0, "")
    for command in NAMES:
        assert re.search(rf"^\W*{command}\s", out, re.MULTILINE)
    assert "4 internal error" in " ".join(out.split())


def test_without_a_command_there_is_help_and_a_usage_code(run):
    assert run()[0] == 2


def test_the_version_is_that_of_the_package(run):
    assert run("--version") == (0, f"lyapcheck {__version__}\n", "")


def with_command(monkeypatch, body):
    """Put a command in place of whatever is asked for."""

    class Module:
        arguments = staticmethod(lambda parser: None)
        run = staticmethod(body)

    monkeypatch.setattr(command_line, "load", lambda name: Module)


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


@pytest.mark.parametrize("script", one_in(3, ["import sys\nsys.exit(0)\n", "raise SystemExit\n", "exit()\n"]))
def test_a_proof_script_cannot_choose_the_exit_code(script, run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("mine.py").write_text(script, encoding="utf-8")
    code, out, err = run("check", "mine.py")
    assert (code, out) == (2, "")
    assert "SystemExit" in err


@pytest.mark.parametrize("parts", [["--m", "1,3"], ["--m", "1", "--m", "3"], ["--m", "3", "--m", "1,3"]])
def test_a_list_may_come_in_parts(parts):
    rows = json.loads(lyapcheck("table", *parts, "--digits", "5", "--format", "json").stdout)["rows"]
    assert [row["m"] for row in rows] == [1, 3]


@pytest.mark.parametrize("arguments", [("gate", TABLE2), ("table", "--m", "1:300"), ("epsilon", TABLE2)])
def test_a_reader_that_went_away_is_no_verdict_and_no_traceback(arguments):
    """And nothing is begun for it: ``epsilon`` takes minutes."""
    reader, writer = os.pipe()
    os.close(reader)
    try:
        done = subprocess.run(
            [SCRIPT, *arguments], stdout=writer, stderr=subprocess.PIPE, text=True, check=False
        )
    finally:
        os.close(writer)
    assert (done.returncode, done.stderr) == (CLOSED_PIPE, "")


@pytest.mark.parametrize("encoding", one_in(2, ["ascii", "cp1252"]))
def test_a_terminal_without_the_signs_gets_their_names_and_a_program_the_same_bytes(encoding):
    def table(*words, **environment):
        variables = {**os.environ, **environment}
        command = [SCRIPT, "table", "--m", *words]
        return subprocess.run(command, capture_output=True, env=variables, check=False)

    assert "γ = sup h_m, ρ" in table("3").stdout.decode("utf-8")
    odd = {"PYTHONIOENCODING": encoding, "LC_ALL": "C"}
    assert b"gamma = sup h_m, rho" in table("3", **odd).stdout
    assert table("3", "--format", "json", **odd).stdout == table("3", "--format", "json").stdout
    refused = table("x", **odd)
    assert refused.returncode == 2
    assert refused.stderr.isascii()
    assert b"\\" not in refused.stderr


@pytest.mark.parametrize(
    "words", one_in(2, [["table", "--m", "1"], ["gate", TABLE2], ["gate"], ["explain", "--help"]])
)
def test_the_module_runs_as_the_script_does(words):
    module_run, script = (
        subprocess.run([*start, *words], capture_output=True, check=False)
        for start in ([sys.executable, "-m", "lyapcheck"], [SCRIPT])
    )
    assert module_run.stdout + module_run.stderr != b""
    assert (module_run.returncode, module_run.stdout) == (script.returncode, script.stdout)
    assert module_run.stderr == script.stderr


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs a device that is full")
@pytest.mark.parametrize("unbuffered", one_in(2, ["", "1"]))
@pytest.mark.parametrize(
    "words", one_in(2, [["table", "--m", "1"], ["gate", TABLE2], ["--help"], ["report"], ["epsilon", TABLE2]])
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


@pytest.mark.skipif(not Path("/proc/self").exists(), reason="needs a folder that takes no file")
@pytest.mark.parametrize(
    "words",
    one_in(
        2,
        [
            ["epsilon", TABLE2, "--certificates", "/proc/self"],
            ["gate", TABLE2, "--certificates", "/proc/self"],
            ["tune", "buap3", "--out", "/proc/self/gains.toml"],
            ["simulate", TABLE2, "--csv", "/proc/self/motion.csv"],
            ["report", "--out", "/proc/self"],
            ["simulate", TABLE2, "--plot", "/proc/self"],
        ],
    ),
    ids=" ".join,
)
def test_a_place_that_takes_nothing_is_named_before_the_work(words):
    done = lyapcheck(*words)
    assert (done.returncode, done.stdout) == (2, "")
    (line,) = done.stderr.splitlines()
    assert line.startswith(f"error: argument: {words[-2]} = /proc/self")
    assert "/proc/self cannot be written to" in line


@pytest.mark.parametrize("words", one_in(2, [["table", "--m", "1"], ["gate", TABLE2]]))
def test_a_closed_output_is_refused_and_a_closed_error_output_is_silence(words):
    line = " ".join([SCRIPT, *words])
    done = subprocess.run(["sh", "-c", f"{line} >&-"], capture_output=True, text=True, check=False)
    message = "error: argument: standard output: is closed; open it, or send it to /dev/null\n"
    assert (done.returncode, done.stderr) == (2, message)
    printed, silent = (
        subprocess.run(["sh", "-c", f"{line} {end}"], stdout=subprocess.PIPE, check=False)
        for end in ("2>/dev/null", "2>&-")
    )
    assert (printed.returncode, printed.stdout) == (silent.returncode, silent.stdout)


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs a device that is full")
def test_a_full_error_output_changes_no_exit_code():
    with open("/dev/full", "wb") as full:
        assert subprocess.run([SCRIPT, "robot", "nosuch"], stderr=full, check=False).returncode == 2


COMPLETE = """
source /dev/stdin
complete_with="$(complete -p lyapcheck | sed 's/.* -F \\([^ ]*\\) .*/\\1/')"
COMP_WORDS=(lyapcheck "$@")
COMP_CWORD=$#
$complete_with lyapcheck "${@: -1}" "${COMP_WORDS[-2]}"
echo "${COMPREPLY[@]}"
"""


@pytest.mark.parametrize(
    ("words", "completed"),
    [
        (["ga"], "gate"),
        (["gate", "--fo"], "--format"),
        (["gate", "--format", "j"], "json junit"),
        (["gate", "--condition", "g"], "global"),
        (["gate", "gai"], "gains.toml"),
        (["report", "--out", "f"], "folder"),
    ],
)
def test_bash_completes_commands_options_choices_and_files(words, completed, run, tmp_path):
    (tmp_path / "folder").mkdir()
    (tmp_path / "gains.toml").touch()
    code, script, err = run("--completion", "bash")
    assert (code, err) == (0, "")
    line = ["bash", "--norc", "-c", COMPLETE, "bash", *words]
    done = subprocess.run(line, input=script, capture_output=True, text=True, check=True, cwd=tmp_path)
    assert done.stdout.split() == completed.split()


@pytest.mark.parametrize("files", [["--strict", TABLE2], [TABLE2, "--strict"], ["--strict", "--", TABLE2]])
def test_options_stand_before_arguments_or_behind_them(files, run):
    assert run("gate", "--format", "csv", *files) == run("gate", TABLE2, "--strict", "--format=csv")


@pytest.mark.parametrize("name", ["-x.toml", "-h.toml", "--strict"])
def test_behind_two_dashes_stand_files_whatever_they_begin_with(name, run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path(name).write_text(Path(TABLE2).read_text(encoding="utf-8"), encoding="utf-8")
    assert run("gate", "--format", "csv", "--", name) == run("gate", TABLE2, "--format", "csv")


def test_files_that_an_earlier_run_left_beside_the_certificates_are_named_and_stay(run, tmp_path):
    command = ("gate", TABLE2, "--certificates", str(tmp_path))
    for _ in range(2):
        assert "did not write" not in run(*command)[2]
    (tmp_path / "former.10.json").write_text("{}", encoding="utf-8")
    note = f"note: {tmp_path} has files that this run did not write, and recheck {tmp_path} judges them, too"
    assert f"{note}: former.10.json\n" in run(*command)[2]
    assert (tmp_path / "former.10.json").read_text(encoding="utf-8") == "{}"
