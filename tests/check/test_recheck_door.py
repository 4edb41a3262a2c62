"""What recheck is handed by whoever wants it to stop, to hang, or to say something else than it judged."""

import json
import os
import signal
import socket
import subprocess
import sys
import threading
import time
from dataclasses import replace
from pathlib import Path

import pytest

from lyapcheck.answers.recheck import Recheck
from lyapcheck.check.certificate import digest_of, judged, parse, read
from lyapcheck.check.codec import members
from lyapcheck.check.guard import CannotStart, Guard
from lyapcheck.check.judgement import MAX_BYTES, Judgement, Limits
from lyapcheck.check.recheck import content, gather, recheck
from lyapcheck.check.refusal import Refused
from lyapcheck.check.statement import Proof, Statement
from tests.arena.run import ARENA
from tests.helpers.shares import but, one_in

MODULE = [sys.executable, "-P", "-m", "lyapcheck.check"]
COMMAND = [sys.executable, "-c", "from lyapcheck.cli.main import main; main()", "recheck"]
X = ["var", "x"]
ONE = ["num", "1"]
GOOD = {"kind": "Identity", "left": X, "right": X, "variables": []}


def sealed(statement, proof=None, **more):
    data = {
        "schema": "lyapcheck/certificate/1",
        "claim": {"id": "a", "says": "words", "m": None, "n": None, "proof": "p"},
        "statement": statement,
        "verdict": "proved",
        "grade": "exact",
        "proof": proof or {"rule": "normal form"},
        "uses": {},
        "versions": {},
        **more,
    }
    return json.dumps({**data, "digest": digest_of(data)})


def same(tree):
    """A certificate that an expression is itself: all the work is in its normal form."""
    return sealed({"kind": "Identity", "left": tree, "right": tree, "variables": []})


def sines(depth):
    tree = X
    for _ in range(depth):
        tree = ["sin", tree]
    return same(tree)


def run(*arguments, command=MODULE):
    return subprocess.run(
        [*command, *map(str, arguments)], capture_output=True, text=True, timeout=60, check=False
    )


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "good.json").write_text(sealed(GOOD), encoding="utf-8")
    return tmp_path


def statuses(folder, *options):
    data = json.loads(run(folder, "--format", "json", *options).stdout)
    return {row["file"]: (row["status"], row["reason"]) for row in data["certificates"]}


# Files ------------------------------------------------------------------------------------------------------


def bound(path):
    """A socket by its short name: the path of one has few characters."""
    here = os.getcwd()
    os.chdir(path.parent)
    try:
        with socket.socket(socket.AF_UNIX) as made:
            made.bind(path.name)
    finally:
        os.chdir(here)


PLANT = {
    "pipe": (os.mkfifo, "is a pipe, not a regular file"),
    "socket": (bound, "is a socket, not a regular file"),
    "directory": (Path.mkdir, "is a directory, not a regular file"),
    "loop": (lambda path: path.symlink_to(path.name), "cannot be read (Too many levels of symbolic links)"),
    "link to a device": (lambda path: path.symlink_to("/dev/zero"), "is a device, not a regular file"),
    "link to nothing": (lambda path: path.symlink_to("none"), "cannot be read (No such file or directory)"),
    "no text": (lambda path: path.write_bytes(b'{"a": "\xff"}'), "is not JSON in UTF-8 ('utf-8' codec can't"),
    "empty": (Path.touch, "is not JSON in UTF-8 (Expecting value"),
    "large": (
        lambda path: path.touch() or os.truncate(path, MAX_BYTES + 1),
        f"has {MAX_BYTES + 1} bytes, above {MAX_BYTES}, which no certificate has",
    ),
}
"""How an entry comes to be that is no certificate, and what is said of it."""


def plant(folder, what):
    make, said = PLANT[what]
    make(folder / "x.json")
    return said


@pytest.mark.parametrize("what", one_in(3, PLANT))
def test_an_entry_that_is_no_certificate_is_refused_and_the_rest_goes_on(folder, what):
    said = plant(folder, what)
    result = statuses(folder)
    assert result["good.json"] == ("accepted", "")
    assert result["x.json"][0] == "refused"
    assert result["x.json"][1].startswith(said)


@pytest.mark.parametrize("command", one_in(2, [MODULE, COMMAND]), ids=["module", "command"])
@pytest.mark.parametrize("what", one_in(3, [what for what in PLANT if what != "directory"]))
def test_named_by_itself_it_is_exit_code_2(folder, what, command):
    said = plant(folder, what)
    done = run(folder / "x.json", folder / "good.json", command=command)
    assert (done.returncode, done.stdout) == (2, "")
    assert f"x.json: CERTIFICATE: {said}" in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read everything")
def test_what_may_not_be_read_is_named(folder):
    (folder / "good.json").chmod(0)
    assert "cannot be read (Permission denied)" in run(folder / "good.json").stderr
    folder.chmod(0)
    try:
        assert run(folder / "good.json", folder.parent).stderr.count("(Permission denied)") == 2
    finally:
        folder.chmod(0o700)


def test_a_file_that_grows_is_not_read_in_part(folder, monkeypatch):
    real = os.fstat

    def before(descriptor):
        result = real(descriptor)
        with (folder / "good.json").open("ab") as file:
            file.write(b" ")
        return result

    monkeypatch.setattr(os, "fstat", before)
    with pytest.raises(ValueError, match="changes while it is read"):
        content(folder / "good.json")


def test_a_file_that_vanishes_between_listing_and_judging_is_refused(folder):
    (folder / "gone.json").write_text(sealed(GOOD))
    documents = gather([folder])
    (folder / "gone.json").unlink()
    result = {one.file: one for one in recheck(documents).checked}
    assert result["good.json"].accepted
    assert result["gone.json"].reason == "cannot be read (No such file or directory)"


@pytest.mark.slow
def test_a_name_that_is_no_unicode_is_printed_as_an_escape(folder):
    os.rename(folder / "good.json", os.fsencode(folder) + b"/b\xffd\x1b.json")
    for form in ("text", "json"):
        done = run(folder, "--format", form)
        assert done.returncode == 0, done.stderr
        assert "\x1b" not in done.stdout


# Content ----------------------------------------------------------------------------------------------------


def test_what_no_certificate_contains_is_refused_each_for_its_reason():
    """The certificates ``door.*`` of the arena, which says what is in each and the reason."""
    rows = [row for row in json.loads((ARENA / "expected.json").read_text()) if "/door." in row["path"]]
    assert len(rows) > 30
    for row in rows:
        assert row["why"].partition(": ")[2] in judged((ARENA / row["path"]).read_bytes()).reason, row


def test_only_the_classes_of_the_checker_are_read():
    class Everything(Statement):
        def require_well_formed(self):
            pass

        def text(self):
            return "everything"

    class Anything(Proof):
        rule = "normal form"

    assert "Everything" not in members(Statement)
    assert members(Proof)["normal form"] is not Anything
    with pytest.raises(Refused, match="is not a kind"):
        read(parse(sealed({"kind": "Everything"})))


# Limits -----------------------------------------------------------------------------------------------------

SLOW = sines(290)
LARGE = same(["mul", *(["add", ["var", f"a{k}"], ONE] for k in range(22))])


@pytest.mark.parametrize("command", one_in(2, [MODULE, COMMAND]), ids=["module", "command"])
def test_what_takes_too_long_is_undecided_and_the_rest_goes_on(folder, command):
    (folder / "a slow one.json").write_text(SLOW, encoding="utf-8")
    done = run(folder, "--format", "json", "--seconds", "1", command=command)
    rows = {row["file"]: row for row in json.loads(done.stdout)["certificates"]}
    slow = rows["a slow one.json"]
    said = "takes more than 1 s of computing time; --seconds allows more"
    assert (slow["status"], slow["reason"], slow["verdict"]) == ("undecided", said, None)
    assert rows["good.json"]["status"] == "accepted"
    assert done.returncode == 3


def test_what_waits_has_not_computed(folder):
    """As on a machine where others compute: it is by the clock that it takes longer than it may."""
    with Guard(Limits(seconds=1)) as guard:
        good = (folder / "good.json").read_bytes()
        assert not guard.judge(good, False).reason
        os.kill(guard._process.pid, signal.SIGSTOP)
        threading.Timer(1.4, os.kill, (guard._process.pid, signal.SIGCONT)).start()
        assert guard.judge(good, False) == guard.judge(good, False)
        assert not guard.judge(good, False).reason


def test_what_is_undecided_for_want_of_time_can_be_written(folder):
    outcome = recheck(gather([folder]))
    one = replace(outcome.checked[0], status="undecided", reason="late", finding=Judgement(spent=True))
    answer = Recheck(replace(outcome, checked=(one,), granted={}, rules={}))
    for form in ("text", "markdown", "csv", "sarif", "junit", "github", "html", "latex"):
        text = answer.written(form)
        assert "late" in text, form
        assert "None" not in text, form


@pytest.mark.slow
def test_what_takes_too_much_memory_is_undecided_and_the_rest_goes_on(folder):
    (folder / "a large one.json").write_text(LARGE, encoding="utf-8")
    result = statuses(folder, "--memory", "200")
    assert result["a large one.json"][0] == "undecided"
    assert "200 MiB may be too few; --memory allows more" in result["a large one.json"][1]
    assert result["good.json"][0] == "accepted"


@pytest.mark.parametrize("number", one_in(3, ["SIGSEGV", "SIGABRT", "SIGKILL"]))
def test_whatever_ends_the_process_that_judges_ends_no_more_than_that(folder, number):
    """The process is asked for the second time when it is dead already."""
    with Guard(Limits()) as guard:
        good = (folder / "good.json").read_bytes()
        assert not guard.judge(good, False).reason
        os.kill(guard._process.pid, signal.Signals[number])
        guard._process.wait()
        ended = guard.judge(good, False)
        assert number in ended.reason
        assert ended.spent
        assert not guard.judge(good, False).reason


@pytest.mark.slow
def test_a_large_parent_does_not_count_as_memory_of_the_process_that_judges(folder):
    script = (
        "import sys; from pathlib import Path; from lyapcheck.check.guard import Guard, Limits\n"
        "large = bytearray(b'x') * (700 << 20)\n"
        "with Guard(Limits()) as guard:\n"
        "    assert not guard.judge(Path(sys.argv[1]).read_bytes(), False).reason\n"
        "    assert guard._process is not None\n"
    )
    subprocess.run([sys.executable, "-c", script, str(folder / "good.json")], check=True)


def test_too_little_memory_to_start_is_not_the_fault_of_a_certificate(folder):
    with Guard(Limits(memory=1)) as guard, pytest.raises(CannotStart):
        guard.judge((folder / "good.json").read_bytes(), False)
    done = run(folder, "--memory", "1")
    assert done.returncode == 2
    assert "allow more" in done.stderr


def children(pid):
    return Path(f"/proc/{pid}/task/{pid}/children").read_text().split()


def is_running(pid):
    """Whether there is such a process; one that has ended and nobody has asked after does not run."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(") ")[2][0] != "Z"
    except FileNotFoundError:
        return False


def interruptible():
    """A shell lets what it runs in the background ignore Ctrl-C; here it is not to."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="counts processes as Linux lists them")
@pytest.mark.parametrize("command", [MODULE, COMMAND], ids=["module", "command"])
@pytest.mark.parametrize(("number", "code"), [(signal.SIGTERM, 143), (signal.SIGINT, 130)])
def test_no_process_is_left_behind(folder, command, number, code):
    (folder / "slow.json").write_text(SLOW, encoding="utf-8")
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    with subprocess.Popen([*command, str(folder)], **pipes, preexec_fn=interruptible) as parent:  # noqa: PLW1509
        deadline = time.monotonic() + 20
        while not (result := children(parent.pid)) and time.monotonic() < deadline:
            time.sleep(0.05)
        time.sleep(1)
        parent.send_signal(number)
        parent.communicate(timeout=20)
    assert parent.returncode == code
    assert result
    while any(map(is_running, result)) and time.monotonic() < deadline + 20:
        time.sleep(0.05)
    assert not any(map(is_running, result))


def test_where_the_system_keeps_no_limits_it_is_said(folder, monkeypatch):
    result = recheck(gather([folder]))
    assert result.limited == ("seconds", "memory")
    monkeypatch.setattr(
        "lyapcheck.check.guard.CODE", "import sys; sys.modules['resource'] = None\n" + _without()
    )
    assert recheck(gather([folder])).limited == ()


def _without():
    from lyapcheck.check import guard

    return guard.CODE.replace(
        "serve(Limits", "import lyapcheck.check.guard as worker; worker.resource = None\nserve(Limits"
    )


@pytest.mark.slow
def test_both_doors_have_the_same_options_and_say_the_same(folder):
    for options in (["--format", "json"], ["--format", "json", "--trusted", "--full"]):
        first, second = (run(folder, *options, command=command) for command in (MODULE, COMMAND))
        assert (first.returncode, first.stdout) == (second.returncode, second.stdout) != (2, "")
    shown = [run("--help", command=command).stdout for command in (MODULE, COMMAND)]
    for option in ("--format", "--full", "--trusted", "--seconds", "--memory"):
        assert all(option in text for text in shown)
        assert (
            run(folder, "--seconds", "0").returncode
            == run(folder, "--seconds", "0", command=COMMAND).returncode
            == 2
        )


def test_a_library_beside_the_certificates_is_not_imported(folder):
    (folder / "flint.py").write_text("raise SystemExit(7)")
    done = subprocess.run(
        [sys.executable, "-c", "from lyapcheck.check.__main__ import main; raise SystemExit(main(['.']))"],
        cwd=folder,
        capture_output=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr


# Where modules come from ------------------------------------------------------------------------------------

PLANTED = "print('accepted, believe me'); import os; os._exit(0)\n"
UNSAFE = [sys.executable, "-m", "lyapcheck.check"]
WHOLE = [sys.executable, "-m", "lyapcheck", "recheck"]


@pytest.mark.parametrize(
    ("command", "name"),
    but(
        [(MODULE, "lyapcheck/__init__.py"), (UNSAFE, "json.py"), (WHOLE, "flint.py")],
        [
            *((command, name) for command in (MODULE, UNSAFE, WHOLE) for name in ("json.py", "flint.py")),
            (MODULE, "types.py"),
            (MODULE, "lyapcheck/__init__.py"),
        ],
    ),
)
def test_nothing_is_imported_from_the_working_directory(folder, tmp_path_factory, command, name):
    """Without ``-P`` a planted ``lyapcheck`` runs before any code of the project does."""
    here = tmp_path_factory.mktemp("here")
    (here / name).parent.mkdir(exist_ok=True)
    (here / name).write_text(PLANTED, encoding="utf-8")
    (folder / "wrong.json").write_text(sealed(GOOD, {"rule": "no rule"}), encoding="utf-8")
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONSAFEPATH"}
    result = subprocess.run(
        [*command, str(folder)], cwd=here, env=environment, capture_output=True, text=True, check=False
    )
    assert "believe me" not in result.stdout
    assert result.returncode == 1, result.stderr
