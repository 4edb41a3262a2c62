"""A proof script is a program: whatever it does, it hands over statements, and others decide them."""

import json
import os
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import pytest

import lyapcheck.claims.decision
from lyapcheck.answers.check import run as runner
from lyapcheck.answers.explain import explain
from lyapcheck.check.recheck import gather, recheck
from lyapcheck.claims import run_proof
from lyapcheck.claims.claim import Case, Lacking
from lyapcheck.errors import InputError
from lyapcheck.verdicts import Exit, Grade, Verdict
from tests.helpers.shares import one_in

HEAD = "from lyapcheck.claims import *\nproof = Proof('mine', 'My proof')\nx = var('x')\n"
FALSE = "proof.add('false', '2 ≤ 1', Constant(expr(2) <= 1))\n"
TRUE = "proof.add('true', '1 ≤ 2', Constant(expr(1) <= 2))\n"


@pytest.fixture
def write(tmp_path):
    def to_file(body):
        path = tmp_path / "mine.py"
        path.write_text(HEAD + body, encoding="utf-8")
        return path

    return to_file


def rows(path, **options):
    result = run_proof(path, **{"ms": (1,), "n": 2} | options)
    return {(row.id, row.m): row for row in result.claims}


def verdict(path, claim="false"):
    return rows(path)[claim, None].verdict


# What a script does to the checker --------------------------------------------------------------------------

ATTACKS = {
    "the judge": """
import sys
import lyapcheck.claims.procedures as searches
judge = sys.modules['lyapcheck.check.verify']
yes = lambda *anything: judge.Accepted("proved", "exact")
judge.verify = searches.verify = searches.propose = yes
judge.RULES.update({pair: yes for pair in judge.RULES})
""",
    "json": "import json\njson.loads = json.load = lambda *a, **k: {'certificates': []}\n",
    "the verdicts": """
from lyapcheck.verdicts import Verdict
import lyapcheck.claims.decision as decision
decision.Decision.__init__ = lambda self, *a, **k: self.__dict__.update(verdict=Verdict.PROVED)
""",
    "printed": """
import os
print('{"schema": "lyapcheck/check/1", "claims": [{"id": "false", "verdict": "proved"}]}')
os.write(1, b'{"certificates": [{"file": "false.json", "accepted": true}]}')
""",
    "modules in the working directory": """
from pathlib import Path
for name in ("flint", "json", "lyapcheck", "hashlib", "sitecustomize"):
    Path(name + ".py").write_text("raise SystemExit(0)")
""",
    "its own exit handler": "import atexit, os\natexit.register(os._exit, 0)\n",
}


@pytest.mark.parametrize("name", one_in(6, ATTACKS))
def test_a_false_claim_stays_false_whatever_its_script_patches(write, name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert verdict(write(ATTACKS[name] + FALSE)) is Verdict.REFUTED


@pytest.mark.slow
def test_a_script_cannot_alter_what_explain_prints(write):
    body = "from lyapcheck.output.answer import Answer\nAnswer.__str__ = lambda self: 'all is well'\n"
    body += "from lyapcheck.check.kinds.constant import Constant\nConstant.text = lambda self: '1 ≤ 2'\n"
    text = str(explain("false", str(write(body + FALSE))))
    assert "2 ≤ 1" in text
    assert "all is well" not in text


@pytest.mark.slow
def test_what_a_script_prints_goes_to_standard_error(write, tmp_path):
    path = write("import os\nprint('noise')\nos.system('echo more noise')\n" + TRUE)
    words = ["-m", "lyapcheck", "check", str(path), "--n", "1", "--format", "json"]
    code = f"import sys; sys.argv = {words[1:]!r}; from lyapcheck.cli.main import main; main()"
    run = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, cwd=tmp_path, timeout=60, check=False
    )
    assert run.returncode == 0
    assert [row["verdict"] for row in json.loads(run.stdout)["claims"]] == ["proved"]
    assert "noise\n" in run.stderr
    assert "more noise" in run.stderr


# How a script may end ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("body", "message"),
    one_in(
        7,
        [
            ("import os\nos._exit(0)", "must end with its claims handed over"),
            ("import os\nos._exit(7)", "exit code 7"),
            ("import os, signal\nos.kill(os.getpid(), signal.SIGKILL)", "signal 9"),
            ("raise SystemExit(0)", "raises SystemExit"),
            ("raise KeyboardInterrupt", "raises KeyboardInterrupt"),
            ("def f():\n    f()\nf()", "raises RecursionError"),
            ("@proof.claim('a', '')\ndef _(case):\n    raise GeneratorExit", "raises GeneratorExit"),
            ("proof.add(7, '', Constant(expr(1) <= 2))", "must be of type str"),
            ("proof.add('a', '', Constant(7))", "a.relation = 7: must be an object"),
            ("proof.add('a', '', Constant(object()))", "not plain data"),
            ("class Mine(Statement):\n    pass\nproof.add('a', '', Mine())", "abstract class Mine"),
            (
                "class Mine(Constant):\n    pass\nproof.add('a', '', Mine(expr(1) <= 2))",
                "Mine: is not a kind",
            ),
            ("proof.add('a', '\\udc80', Constant(expr(1) <= 2))", "not plain Unicode text"),
            (
                "import lyapcheck.claims.handover as h\nh.json.dumps = lambda *a, **k: '{}'",
                "does not hand over",
            ),
        ],
    ),
)
def test_a_script_that_hands_over_no_statements_is_an_input_error(write, body, message):
    with pytest.raises(InputError, match=message):
        run_proof(write(body), ms=(1,), n=1)


@pytest.mark.parametrize("levels", one_in(2, [400, 5000]))
def test_what_no_checker_reads_is_undecided(write, levels):
    body = f"t = ('var', 'x')\nfor _ in range({levels}):\n    t = ('neg', t)\n"
    body += "proof.add('a', '', Identity(t, t))\n"
    body += "from lyapcheck.check.expressions.expression import derivative\n"
    body += "@proof.claim('b', '')\ndef _(case):\n    return Identity(derivative(t, 'x'), t)\n"
    for row in rows(write(body)).values():
        assert row.verdict is Verdict.UNDECIDED
        assert re.search(r"nested deeper than \d+ levels", row.decision.reason)


def test_what_comes_back_is_limited(write, monkeypatch):
    monkeypatch.setattr("lyapcheck.claims.script.MAX_BYTES", 200)
    with pytest.raises(InputError, match="must not exceed 200"):
        run_proof(write(TRUE), ms=(1,), n=1)


@pytest.mark.slow
def test_a_script_may_fork_and_leave_threads(write):
    body = "import os, threading, time\nos.fork()\n"
    body += "threading.Thread(target=time.sleep, args=(60,)).start()\n"
    assert verdict(write(body + FALSE)) is Verdict.REFUTED


def alive(pid):
    try:
        return Path(f"/proc/{pid}/stat").read_text(encoding="utf-8").split()[2] != "Z"
    except OSError:
        return False


def gone(pid):
    for _ in range(100):
        if not alive(pid):
            return True
        time.sleep(0.1)
    return False


@pytest.mark.slow
def test_what_a_script_has_started_ends_with_it(write, tmp_path):
    note = tmp_path / "pid"
    body = "import subprocess\nrun = subprocess.Popen(['sleep', '60'])\n"
    body += f"open({str(note)!r}, 'w').write(str(run.pid))\n"
    assert verdict(write(body + FALSE)) is Verdict.REFUTED
    assert gone(int(note.read_text()))


def test_a_script_does_not_survive_the_command(write, tmp_path):
    note = tmp_path / "pid"
    path = write(
        f"import os, time\nopen({str(note)!r}, 'w').write(str(os.getpid()))\ntime.sleep(60)\n" + TRUE
    )
    code = f"from lyapcheck.claims import run_proof\nrun_proof({str(path)!r}, ms=(1,), n=1)"
    command = subprocess.Popen([sys.executable, "-c", code])
    for _ in range(300):
        if note.exists() and note.read_text():
            break
        time.sleep(0.1)
    assert alive(int(note.read_text()))
    command.kill()
    command.wait()
    assert gone(int(note.read_text()))


# What a claim depends on ------------------------------------------------------------------------------------


def test_the_case_has_no_way_around_what_it_takes_down():
    case = Case(2, 3)
    assert [name for name in vars(case) if not name.startswith("_")] == ["read"]
    assert not [name for name in dir(case) if name.startswith("the_")]
    assert case.read == set()
    with pytest.raises(Lacking, match="m = 2"):
        _ = case.gains
    assert case.read == {"m", "n", "gains"}


def test_the_old_names_are_refused(write):
    with pytest.raises(InputError, match="no attribute 'the_m'"):
        run_proof(
            write("@proof.claim('a', '')\ndef _(case):\n    return Constant(expr(case.the_m) <= 1)"), n=1
        )


HIDDEN = """
@proof.claim("a", "{name} ≤ 1")
def _(case):
    hidden = case.{name}
    case.read.clear()
    return Constant(expr(hidden) <= 1)
proof.add("b", "1 ≤ 2", Constant(expr(1) <= 2), uses=["a"])
"""


@pytest.mark.slow
def test_a_claim_that_hides_its_reading_of_m_is_decided_for_each_m(write):
    result = rows(write(HIDDEN.replace("{name}", "m")), ms=(1, 2))
    assert {key: row.verdict.value for key, row in result.items()} == {
        ("a", 1): "proved",
        ("a", 2): "refuted",
        ("b", 1): "proved",
        ("b", 2): "undecided",
    }
    assert set(rows(write(HIDDEN.replace("{name}", "m")))) == {("a", 1), ("b", 1)}


@pytest.mark.slow
def test_a_claim_that_hides_its_reading_of_n_is_shown_for_its_n(write):
    result = rows(write(HIDDEN.replace("{name}", "n")))
    assert {row.n for row in result.values()} == {2}
    assert rows(write(TRUE))["true", None].n is None


@pytest.mark.slow
def test_a_claim_that_cannot_be_stated_for_more_joints_is_decided_for_those_at_hand(write):
    body = "@proof.claim('a', '')\ndef _(case):\n    return Constant(expr([0, 0, 1][case.n]) <= 1)\n"
    assert [row.verdict.value for row in rows(write(body)).values()] == ["proved"]


# The fresh checker ------------------------------------------------------------------------------------------


def test_a_rule_that_is_wrong_in_this_process_alone_proves_nothing(write, monkeypatch):
    """As if the search and the judge beside it were both in error: the files are judged elsewhere."""
    finding = runner.propose

    def boast(statement):
        honest = finding(statement)
        outcome = type(honest)(Verdict.PROVED, honest.method, honest.proof, grade=Grade.EXACT)
        return outcome

    monkeypatch.setattr(runner, "propose", boast)
    path = write(FALSE + "proof.add('above', '1 ≤ 2', Constant(expr(1) <= 2), uses=['false'])\n")
    result = run_proof(path, ms=(1,), n=1)
    false, above = result.claims
    assert false.verdict is above.verdict is Verdict.UNDECIDED
    assert "the checker refuses its certificate" in false.decision.reason
    assert "proof gives refuted" in false.decision.reason
    assert above.broken == ("false",)
    assert "certificate is refused" in above.decision.reason
    assert result.certificates == {}
    assert result.exit_code is Exit.UNDECIDED


@pytest.mark.slow
def test_an_altered_certificate_is_refused_and_the_claim_undecided(write, monkeypatch):
    judge = lyapcheck.claims.decision.judge_afresh

    class Altered:
        def __init__(self, certificate):
            self.claim, self.statement, self.certificate = (
                certificate.claim,
                certificate.statement,
                certificate,
            )

        def text(self):
            return self.certificate.text().replace('"num","2"', '"num","3"')

    monkeypatch.setattr(runner, "judge_afresh", lambda made: judge({k: Altered(c) for k, c in made.items()}))
    row = rows(write(TRUE))["true", None]
    assert row.verdict is Verdict.UNDECIDED
    assert "not that of the content" in row.decision.reason


def test_a_checker_that_does_not_answer_is_an_error_and_no_verdict(write, monkeypatch):
    monkeypatch.setattr("lyapcheck.claims.decision.command", lambda *words: [sys.executable, "-c", "1 / 0"])
    with pytest.raises(RuntimeError, match="the checker fails"):
        run_proof(write(TRUE), ms=(1,), n=1)


@pytest.mark.slow
def test_a_theorem_has_all_its_proofs_whatever_steps_its_author_names(write):
    path = write("proof.adopt('scalar.py', 'arms.all')\n")
    path.write_text(
        path.read_text(encoding="utf-8")
        + "from dataclasses import replace\n"
        + "proof.claims['arms.all'] = replace(proof.claims['arms.all'], uses=())\n",
        encoding="utf-8",
    )
    row = rows(path)["arms.all", 1]
    assert row.verdict is Verdict.PROVED


@pytest.mark.slow
def test_the_certificates_are_those_that_were_judged_and_no_file_is_left(write, tmp_path, monkeypatch):
    scratch, kept = tmp_path / "scratch", tmp_path / "kept"
    scratch.mkdir()
    kept.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(scratch))
    result = run_proof(write(TRUE + FALSE), ms=(1,), n=1)
    with pytest.raises(InputError):
        run_proof(write("import os\nos._exit(0)"), ms=(1,), n=1)
    assert os.listdir(scratch) == []
    for name, certificate in result.certificates.items():
        (kept / name).write_text(certificate.text(), encoding="utf-8")
    assert {one.file for one in recheck(gather([kept])).checked if one.accepted} == {
        "true.json",
        "false.json",
    }
