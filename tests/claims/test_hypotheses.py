"""Proved statements whose hypotheses nothing meets: true, and said to be of nothing."""

import csv
import io
import json

import pytest

from lyapcheck.claims import Reals, all_of, exp, implies, nonnegative, positive, reals, run_proof, sin, var
from lyapcheck.claims.procedures import propose
from lyapcheck.claims.statements import NOTHING, UNMET, remarks
from lyapcheck.verdicts import Verdict

x, y, z = map(var, "xyz")
CONCLUSION = x <= 7

MET = {
    "a ray": (reals("x"), [x <= -500]),
    "one point": (reals("x"), [x <= 1, x >= 1]),
    "an end": (nonnegative("x"), [x <= 0]),
    "far": (reals("x"), [x >= 1000, x <= 1001]),
    "near 0": (positive("x"), [x >= "0.0001", x <= "0.00011"]),
    "a line": (reals("x", "y"), [y <= 2 * x, 2 * x <= y]),
    "a sphere": (reals("x", "y", "z"), [x**2 + y**2 + z**2 <= 1, x**2 + y**2 + z**2 >= 1]),
    "a corner": (positive("x", "y", "z"), [x + y + z <= "1.01", x >= y, y >= z, z >= "0.33"]),
}
"""Hypotheses that hold somewhere, if in few places."""


@pytest.mark.parametrize("name", MET)
def test_nothing_is_said_where_a_point_meets_all_hypotheses(name):
    assert not list(remarks(implies(*MET[name], CONCLUSION), propose))


CONTRADICTIONS = {
    "bounds": (reals("x"), [x <= 1, x >= 2]),
    "strict": (reals("x"), [x < 1, x >= 1]),
    "product": (positive("x", "y"), [x * y <= 1, x >= 2, y >= 2]),
    "squares": (reals("x", "y"), [x**2 + y**2 <= -1]),
    "a sine": (reals("x"), [sin(x) >= 2]),
}


@pytest.mark.parametrize("name", CONTRADICTIONS)
def test_hypotheses_that_contradict_each_other_are_decided_to(name):
    assert list(remarks(implies(*CONTRADICTIONS[name], CONCLUSION), propose)) == [NOTHING]


@pytest.mark.parametrize("hypothesis", [exp(x) <= -1, x**2 <= -(exp(x) ** 2) - 1])
def test_what_is_not_decided_is_not_said_to_be(hypothesis):
    assert list(remarks(implies(reals("x"), [hypothesis], CONCLUSION), propose)) == [UNMET]


BODY = """
from lyapcheck.claims import Proof, implies, reals, sqrt, var
proof, x = Proof("mine", "Mine"), var("x")
proof.add("never", "", implies(reals("x"), [x <= 1, 2 <= x], x <= 5))
proof.add("perhaps", "", implies(reals("x"), [x**2 <= 2, 2 <= x**2], x**2 <= 5))
proof.add("open", "", implies(reals("x"), [x <= 1, 2 <= x], 7 <= sqrt(1 + x**2)))
proof.add("some", "", implies(reals("x"), [2 <= x], 1 <= x))
"""


def test_every_format_says_so_and_the_verdict_stays(tmp_path, in_this_process):
    path = tmp_path / "mine.py"
    path.write_text(BODY, encoding="utf-8")
    result = run_proof(path, (1,), n=1, only=("never", "perhaps", "some"))
    rows = {row.id: row for row in result.claims}
    assert result.exit_code == 0
    assert {row.verdict for row in rows.values()} == {Verdict.PROVED}
    assert {name: row.decision.reason for name, row in rows.items()} == {
        "never": NOTHING,
        "perhaps": UNMET,
        "some": "",
    }
    for form in ("markdown", "html", "junit", "github", "json", "csv"):
        said = result.written(form)
        assert [text for text in (NOTHING, UNMET) if text not in said] == [], form
    text = result.written("text")
    assert "Proved, but perhaps of nothing; -v shows the remark at each: never, perhaps" in text
    assert " ".join(result.written("markdown").split()).count("remark: ") == 2
    junit = result.written("junit")
    assert 'tests="3" failures="0" skipped="0"' in junit
    assert "<system-out>never proved" in junit
    for claims in (
        json.loads(result.written("json"))["claims"],
        csv.DictReader(io.StringIO(result.written("csv"))),
    ):
        assert [row["reason"] for row in claims] == [NOTHING, UNMET, ""]


NESTED = {
    "hypotheses[0] must be a relation, not list": lambda: implies(reals("x"), [[x <= 1]], CONCLUSION),
    "hypotheses must be a list, not Relation": lambda: implies(reals("x"), x <= 1, CONCLUSION),
    "variables[0] must be a variable, not tuple": lambda: implies([reals("x"), reals("y")], [], CONCLUSION),
    "variables must be a list, not str": lambda: implies("x", [], CONCLUSION),
    "conclusion must be a relation, not bool": lambda: implies(reals("x"), [], True),
    "left must be a statement, not Relation": lambda: all_of(left=x <= 1),
    "given[0] must be a relation, not list": lambda: Reals().for_small("e", x < 1, [[x < 2]]),
}


@pytest.mark.parametrize("fault", NESTED)
def test_what_stands_in_the_wrong_place_is_named_with_its_repair(fault):
    with pytest.raises(ValueError, match="; write ") as error:
        NESTED[fault]()
    assert str(error.value).startswith(f"{fault}; write ")


def test_lists_are_as_good_as_tuples():
    given = [x <= 1]
    assert implies(list(reals("x")), given, CONCLUSION) == implies(reals("x"), tuple(given), CONCLUSION)
