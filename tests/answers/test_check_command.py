"""The check and explain commands: exit codes, formats, and one clear message for every bad input."""

import json
from dataclasses import replace

import pytest

from lyapcheck.answers.check import run
from lyapcheck.answers.check.run import run_proof
from tests.helpers.command import lyapcheck

pytestmark = pytest.mark.usefixtures("in_this_process")


@pytest.mark.parametrize(
    ("claim", "m", "code"), [("7a", 2, 0), ("16.6", 2, 1), ("7g", 4, 3), ("T1.torque.m1.elbow", 2, 0)]
)
def test_exit_codes_follow_the_verdicts(claim, m, code, tmp_path):
    run = lyapcheck("check", "published.py", "--m", m, "--only", claim, "--all", folder=tmp_path)
    assert run.returncode == code, run.stderr
    assert claim in run.stdout


def test_json_goes_to_stdout_and_progress_to_stderr(tmp_path):
    run = lyapcheck(
        "check", "proofs/published.py", "--m", "1,2", "--only", "8b", "--format", "json", folder=tmp_path
    )
    data = json.loads(run.stdout)
    assert [(row["m"], row["verdict"]) for row in data["claims"]] == [(1, "refuted"), (2, "proved")]
    assert data["claims"][0]["witness"]["point"] == {"x1": "0", "x2": "0", "x3": "0"}
    assert "seconds" not in data["claims"][0]


SET = '[[gains]]\nname = "{}"\nm = {}\nkp = [20, 5]\nkv = [0.1, 0.1]\n'


def test_gains_for_another_number_of_joints_are_refused(tmp_path):
    (tmp_path / "own.toml").write_text(SET.format("two", 1), encoding="utf-8")
    run = lyapcheck("check", "published.py", "--gains", "own.toml", "--only", "8b", folder=tmp_path)
    assert run.returncode == 2
    assert "own.toml:4: kp: two has gains for 2 joints, but the claims are about 3" in run.stderr


def test_gain_sets_that_are_left_out_are_told(tmp_path):
    linear = '[[gains]]\nname = "pd"\nfamily = "linear"\nkp = [20, 5]\nkv = [0.1, 0.1]\n'
    text = SET.format("a", 2) + SET.format("b", 5) + SET.format("c", 2) + linear
    (tmp_path / "own.toml").write_text(text, encoding="utf-8")
    words = ("published.py", "--m", "2", "--n", "2", "--gains", "own.toml", "--only", "7a")
    run = lyapcheck("check", *words, folder=tmp_path)
    assert run.returncode == 0
    notes = [line for line in run.stderr.splitlines() if line.startswith("note: ")]
    assert notes == [
        "note: own.toml: b is left out: --m does not ask for m = 5",
        "note: own.toml: c is left out: a set before it has m = 2, too",
        "note: own.toml: pd is left out: it is of the family linear, and scripts are about members of the "
        "hyperbolic family",
    ]


def test_what_is_assumed_about_an_arm_is_said_where_a_claim_looks_at_it(tmp_path):
    said = {
        claim: "numbers of this arm are assumed"
        in lyapcheck("check", "published.py", "--only", claim, folder=tmp_path).stdout
        for claim in ("2.7", "19")
    }
    assert said == {"2.7": True, "19": False}


def test_markdown_is_one_table_a_section(tmp_path):
    run = lyapcheck(
        "check", "published.py", "--only", "17a", "--format", "markdown", "--timings", folder=tmp_path
    )
    assert run.stdout.startswith("# ✗ 1 refuted: published\n\nA family of hyperbolic-type control schemes")
    assert run.stdout.count("|  | claim | grade | seconds | statement |") == 1


def test_lines_fit_a_terminal(tmp_path):
    asked = "--m", "2", "--only", "2.1", "--only", "16.6", "--all"
    run = lyapcheck("check", "published.py", *asked, folder=tmp_path)
    assert max(map(len, run.stdout.splitlines())) <= 102, "combining accents take no column"


@pytest.fixture(scope="module")
def answer(in_this_process):
    """About the theorem of the paper, and a step of its argument that fails."""
    return run_proof("published.py", (1, 2), only=("P", "16.6"))


@pytest.mark.slow
def test_a_theorem_whose_argument_fails_is_looked_for_elsewhere(answer):
    said = "theorem P still holds, proved by F.family of every_function.py"
    assert str(answer).splitlines()[1] == f"  {said}"
    rows = answer.data()["theorems"]
    assert [(row["m"], row["verdict"], row["otherwise"]["id"]) for row in rows] == [
        (1, "undecided", "F.family"),
        (2, "undecided", "F.family"),
    ]
    assert "open here: P" in replace(answer, elsewhere={}).document().lead[0]
    some = {key: other for key, other in answer.elsewhere.items() if key[1] == 1}
    assert "open here: P" in replace(answer, elsewhere=some).document().lead[0]


@pytest.mark.slow
def test_another_theorem_counts_only_with_the_same_conclusion_and_no_more_conditions(answer):
    asked = answer.theorems[0].stated
    rows = run_proof("every_function.py", (1,), only=("F.family", "F.family.tracking", "F.tanh")).claims
    stated = {row.id: row.stated for row in rows}
    family = stated["F.family"]
    assert run._says_as_much(family, asked)
    assert not run._says_as_much(stated["F.family.tracking"], asked)
    assert not run._says_as_much(stated["F.tanh"], asked)
    assert not run._says_as_much(asked, family), "(19) is a condition of one only"
    local = replace(family, argument=replace(family.argument, local=True))
    assert not run._says_as_much(local, asked)
