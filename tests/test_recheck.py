"""The recheck command: what it accepts and refuses, collections of certificates, and its independence."""

import json
import os
import shutil
import subprocess
import sys
import time
import venv
from pathlib import Path

import flint
import pytest

import lyapcheck
from lyapcheck.check.certificate import digest_of
from lyapcheck.check.files import Unreadable, gather
from lyapcheck.check.recheck import recheck
from lyapcheck.claims import run_proof
from lyapcheck.claims.certificates import certificates, file_name

SCRIPT = """
from lyapcheck.claims import *
proof = Proof("mine", "My proof")
x = var("x")
proof.add("a", "tanh x ≤ x", for_all(tanh(x) <= x, 0))
proof.add("b", "1 ≤ 2", Constant(expr(1) <= 2), uses=["a"])
proof.add("c", "√2 ≤ 3", Constant(sqrt(2) <= 3), uses=["b"])
proof.add("d", "3 ≤ 1", Constant(expr(3) <= 1), uses=["a"])
proof.add("e", "open", identity(log((1 + x**2) ** 2), 2 * log(1 + x**2)))

@proof.claim("f", "h_m ≤ 1.06", uses=["c"])
def _(case):
    return for_all(h(case.m, x) <= "1.06")

proof.add("P", "2 ≤ 3", Constant(expr(2) <= 3), uses=["b"])
"""


def run(*arguments, folder=None):
    code = (
        f"import sys; sys.argv = {['lyapcheck', *map(str, arguments)]!r}; "
        "from lyapcheck.cli.main import main; main()"
    )
    return subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, cwd=folder, timeout=120, check=False
    )


@pytest.fixture
def folder(tmp_path):
    script, made = tmp_path / "mine.py", tmp_path / "made"
    script.write_text(SCRIPT, encoding="utf-8")
    made.mkdir()
    for name, certificate in certificates(run_proof(script, ms=(2, 3), n=1)).items():
        (made / name).write_text(certificate.text(), encoding="utf-8")
    return made


def outcome(*paths):
    return {one.file: one for one in recheck(gather(paths)).checked}


def rewrite(path, change, seal=True):
    data = json.loads(path.read_text(encoding="utf-8"))
    change(data)
    if seal:
        data["digest"] = digest_of({key: value for key, value in data.items() if key != "digest"})
    path.write_text(json.dumps(data), encoding="utf-8")


def test_all_of_a_proof_is_accepted_and_undecided_claims_have_no_certificate(folder):
    found = outcome(folder)
    assert set(found) == {"P.json", "a.json", "b.json", "c.json", "d.json", "f.m2.json", "f.m3.json"}
    assert all(one.accepted and not one.given for one in found.values())
    assert [found[name].certificate.verdict for name in ("d.json", "f.m2.json", "f.m3.json")] == [
        "refuted",
        "proved",
        "refuted",
    ]
    assert found["b.json"].certificate.grade == "exact"
    assert found["b.json"].grade == "enclosure", "the weakest link is that of a"


def test_single_files_are_accepted_given_what_they_use(folder):
    found = outcome(folder / "c.json")["c.json"]
    assert found.accepted
    assert found.given == ("b",)
    assert outcome(folder / "c.json", folder / "b.json")["c.json"].given == ("a",)


def test_in_a_directory_nothing_may_be_missing(folder):
    (folder / "a.json").unlink()
    found = outcome(folder)
    assert "rests on a, whose certificate" in found["b.json"].reason
    assert found["c.json"].reason == "rests on b, whose certificate is refused"
    assert found["d.json"].accepted, "a witness rests on nothing"


def test_a_changed_certificate_takes_down_what_rests_on_it(folder):
    rewrite(folder / "a.json", lambda d: d["claim"].update(n=7), seal=False)
    found = outcome(folder)
    assert found["a.json"].reason.startswith("digest")
    rewrite(folder / "a.json", lambda d: None)
    found = outcome(folder)
    assert found["a.json"].accepted, "true as it is, but no longer what b names"
    assert "is not here" in found["b.json"].reason


@pytest.mark.parametrize(
    ("claim", "file", "m", "reason"),
    [
        ("x", "d", 2, "about d"),
        ("d", "d", 2, "which is refuted"),
        ("f", "f.m2", 3, "for m = 2"),
        ("f", "f.m2", None, "for m = 2"),
        ("f", "f.m2", 2, ""),
    ],
)
def test_uses_must_be_proved_and_of_that_claim(folder, claim, file, m, reason):
    digest = json.loads((folder / f"{file}.json").read_text(encoding="utf-8"))["digest"]

    def change(data):
        data["uses"][claim] = digest
        data["claim"]["m"] = m

    rewrite(folder / "P.json", change)
    found = outcome(folder)["P.json"]
    assert found.accepted if not reason else reason in found.reason


# The command ----------------------------------------------------------------------------------------------


def test_check_writes_and_recheck_accepts(tmp_path):
    made = tmp_path / "deep" / "made"
    checked = run("check", "published.py", "--m", "2", "--only", "9", "--certificates", made, folder=tmp_path)
    assert checked.returncode == 0, checked.stderr
    assert sorted(os.listdir(made)) == ["2.8.json", "6.m2.json", "7a.m2.json", "9.m2.json"]
    rechecked = run("recheck", made, folder=tmp_path)
    assert rechecked.returncode == 0, rechecked.stderr
    lines = rechecked.stdout.splitlines()
    assert lines[-1] == "4 accepted (4 proved, 0 refuted), 0 refused"
    assert lines[0] == "accepted  2.8.json: 2.8 is proved [exact]"


def test_exit_codes_and_one_line_each(folder):
    assert run("recheck", folder / "a.json", folder / "d.json").returncode == 0
    rewrite(folder / "a.json", lambda d: d.update(grade="exact"))
    refused = run("recheck", folder / "a.json", folder / "d.json")
    assert refused.returncode == 1
    assert refused.stdout.startswith(
        "refused   a.json: grade = exact: the proof gives enclosure\naccepted  d"
    )


def test_json_is_versioned_and_complete(folder):
    rewrite(folder / "d.json", lambda d: d.update(verdict="proved"))
    data = json.loads(run("recheck", folder, "--format", "json").stdout)
    assert data["schema"] == "lyapcheck/recheck/1"
    assert data["counts"] == {"accepted": 6, "refused": 1, "proved": 5, "refuted": 1}
    rows = {row["file"]: row for row in data["certificates"]}
    assert rows["d.json"]["reason"] == "verdict = proved: the proof gives refuted"
    assert rows["f.m2.json"] | {"digest": ""} == {
        "file": "f.m2.json",
        "accepted": True,
        "reason": "",
        "id": "f",
        "m": 2,
        "n": None,
        "statement": "h_m ≤ 1.06",
        "verdict": "proved",
        "grade": "enclosure",
        "uses": ["c"],
        "given": [],
        "digest": "",
    }


@pytest.mark.parametrize(
    ("name", "content"),
    [("nowhere.json", None), ("bad.json", b"{"), ("latin.json", b'"\xe9"'), ("empty", b"")],
)
def test_a_file_that_cannot_be_read_is_exit_code_2(tmp_path, name, content):
    path = tmp_path / name
    if content is not None:
        path.write_bytes(content)
    run_ = run("recheck", path)
    assert run_.returncode == 2
    assert run_.stdout == ""
    assert name in run_.stderr
    assert "Traceback" not in run_.stderr


def test_every_unreadable_file_is_named_and_an_empty_directory_too(tmp_path):
    (tmp_path / "bad.json").write_text("{")
    (tmp_path / "none").mkdir()
    with pytest.raises(Unreadable) as caught:
        gather([tmp_path / "bad.json", tmp_path / "none", tmp_path / "nowhere"])
    assert len(caught.value.problems) == 3


@pytest.mark.parametrize(
    "content", ["[]", "3", '{"schema": 1.5}', '{"schema": "lyapcheck/check/1"}', "[" * 9999]
)
def test_json_that_is_no_certificate_is_refused_not_unreadable(tmp_path, content):
    path = tmp_path / "other.json"
    path.write_text(content)
    assert not outcome(path)["other.json"].accepted


def test_what_a_certificate_says_cannot_play_tricks_on_a_terminal(folder):
    rewrite(folder / "a.json", lambda d: d["claim"].update(id="a\x1b[2J\nall accepted"))
    text = run("recheck", folder).stdout
    assert "\x1b" not in text
    assert "all accepted\n" not in text


def test_file_names_are_safe_for_any_id():
    assert file_name("16.6", 2) == "16.6.m2.json"
    assert file_name("../up", None) == "%2E.%2Fup.json"
    assert file_name("a b", 1) == "a%20b.m1.json"


@pytest.mark.parametrize("target", ["file", "file/below"])
def test_a_directory_that_cannot_be_made_is_exit_code_2(tmp_path, target):
    (tmp_path / "file").write_text("")
    code = run("check", "published.py", "--only", "2.3", "--certificates", tmp_path / target).returncode
    assert code == 2


@pytest.mark.slow
def test_the_published_proof_is_rechecked_within_seconds(tmp_path):
    for name, certificate in certificates(run_proof("published.py", ms=(2,))).items():
        (tmp_path / name).write_text(certificate.text(), encoding="utf-8")
    begin = time.process_time()
    assert recheck(gather([tmp_path])).all_accepted
    assert time.process_time() - begin < 5


# Independence ---------------------------------------------------------------------------------------------

ALONE = """
import sys
from importlib.abc import MetaPathFinder
class OnlyTheChecker(MetaPathFinder):
    def find_spec(self, name, path, target=None):
        root = name.partition(".")[0]
        if root in sys.stdlib_module_names or root == "flint" or name == "lyapcheck":
            return None
        if name == "lyapcheck.check" or name.startswith("lyapcheck.check."):
            return None
        raise ImportError(f"the checker must not import {name}")
sys.meta_path.insert(0, OnlyTheChecker())
from lyapcheck.check.__main__ import main
sys.exit(main(sys.argv[1:]))
"""


def test_the_checker_imports_only_the_standard_library_and_flint(folder):
    alone = subprocess.run(
        [sys.executable, "-c", ALONE, str(folder)], capture_output=True, text=True, timeout=120, check=False
    )
    assert alone.returncode == 0, alone.stderr
    assert alone.stdout == run("recheck", folder).stdout


def test_the_module_has_the_exit_codes_of_the_command(folder):
    def code(*arguments):
        command = [sys.executable, "-m", "lyapcheck.check", *map(str, arguments)]
        return subprocess.run(command, capture_output=True, check=False).returncode

    assert code(folder, "--format", "json") == 0
    assert code(folder / "x.json") == 2
    rewrite(folder / "a.json", lambda d: d.update(grade="exact"))
    assert code(folder) == 1


@pytest.mark.slow
def test_an_empty_environment_with_the_checker_alone_rechecks_the_published_proof(tmp_path):
    """A new environment gets python-flint and lyapcheck/check, nothing else, and judges every certificate."""
    made = tmp_path / "made"
    made.mkdir()
    for name, certificate in certificates(run_proof("published.py")).items():
        (made / name).write_text(certificate.text(), encoding="utf-8")
    packages = tmp_path / "packages"
    (packages / "lyapcheck").mkdir(parents=True)
    source = Path(lyapcheck.__file__).parent
    shutil.copy(source / "__init__.py", packages / "lyapcheck")
    shutil.copytree(source / "check", packages / "lyapcheck" / "check")
    installed = Path(flint.__file__).parent.parent
    for part in ("flint", "python_flint.libs"):
        if (installed / part).exists():
            (packages / part).symlink_to(installed / part)
    venv.create(tmp_path / "env", with_pip=False)
    python = tmp_path / "env" / "bin" / "python"
    (site,) = (tmp_path / "env" / "lib").glob("python*/site-packages")
    (site / "checker.pth").write_text(f"{packages}\n")
    missing = subprocess.run([python, "-I", "-c", "import typer"], capture_output=True, check=False)
    assert missing.returncode == 1, "the environment must be empty"
    run_ = subprocess.run(
        [python, "-I", "-m", "lyapcheck.check", str(made)], capture_output=True, text=True, check=False
    )
    assert run_.returncode == 0, run_.stdout[-2000:] + run_.stderr
    assert run_.stdout.count("accepted  ") == len(list(made.iterdir()))
