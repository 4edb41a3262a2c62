"""The library of published proofs: what each proves and refuses."""

import re
from pathlib import Path

import pytest

from lyapcheck.claims import run_proof
from lyapcheck.claims.script import SHIPPED, find_script
from tests.helpers.shares import but

pytestmark = pytest.mark.usefixtures("in_this_process")

REFUSED = {
    "takegaki_arimoto": {"strict": "refuted", "weightless": "undecided"},
    "tomei": {"soft": "undecided", "soft.pelican": "undecided"},
    "kelly_gravity": {"corner": "undecided", "soft": "undecided"},
    "kelly_tanh": {"turned": "refuted", "exponential": "undecided"},
    "kelly_santibanez": {"turned": "refuted"},
    "pd_plus": {"LaSalle": "undecided", "feedforward": "undecided", "rest": "refuted"},
    "slotine_li": {"printed": "undecided", "printed.form": "undecided"},
    "pid": {"global": "undecided", "damping": "undecided"},
    "nonlinear_pid": {"turned": "refuted", "linear": "undecided", "soft": "undecided"},
    "saturated_pd_gravity_goal": {"firm": "undecided", "weak": "undecided", "turned": "refuted"},
    "spd_plus": dict.fromkeys(("turned", "R.turned"), "refuted")
    | dict.fromkeys(("friction", "fast"), "undecided"),
    "feedforward": {"global": "undecided", "soft.pelican": "undecided"},
    "bounded_filter": dict.fromkeys(("leak", "order", "at once"), "undecided"),
    "kelly_filter": {"soft": "undecided", "turned": "refuted", "leak": "undecided"},
    "flexible_joints": dict.fromkeys(("soft", "undamped", "still"), "undecided"),
    "computed_torque": dict.fromkeys(("any a", "turned", "twice"), "undecided"),
    "textbook": dict.fromkeys(("forwards", "wide", "open", "undamped", "small ball", "at 0"), "undecided"),
    "pendulum": dict.fromkeys(
        ("pushed", "undamped", "bottom", "upright", "global", "energy", "swing down", "soft"), "undecided"
    ),
    "adaptive_pd": dict.fromkeys(("any a", "turned", "learned", "asymptotic"), "undecided"),
    "slotine_li_adaptive": dict.fromkeys(
        ("printed", "turned", "unbounded", "learned", "exponential"), "undecided"
    ),
}
"""Claims that are there to be refused; all others are proved."""
REASONS = {
    ("pd_plus", "LaSalle"): "is not for q_d(t)",
    ("slotine_li", "printed"): "must be seen by sizes that grow without end",
    ("kelly_gravity", "corner"): "V is not C¹",
    ("kelly_tanh", "exponential"): "must be quadratic in the norms of all states",
    ("tomei", "soft.pelican"): " < 10 is refuted",
    ("pendulum", "global"): "have no single rest that attracts all",
    ("feedforward", "soft.pelican"): " < 10 is refuted",
    ("saturated_pd_gravity_goal", "weak"): " < 1 is refuted",
    ("bounded_filter", "order"): "rest = w: must stand still before the step that uses it",
    ("adaptive_pd", "asymptotic"): "has no letters of other sizes",
    ("slotine_li_adaptive", "unbounded"): "must be bounded where q_d depends on time",
    ("flexible_joints", "still"): "rest = e: must stand still before the step that uses it",
}


@pytest.mark.parametrize("name", but(("takegaki_arimoto", "pd_plus"), REFUSED))
def test_each_concludes_and_refuses_what_is_wrong(name):
    rows = run_proof(f"{name}.py", ms=(2,)).claims
    result = {row.id: row.verdict.value for row in rows}
    assert result == dict.fromkeys(result, "proved") | REFUSED[name]
    conclusion = next(row for row in rows if row.id == "P")
    assert "stable" in conclusion.statement[:200]
    for (script, claim), reason in REASONS.items():
        if script == name:
            assert reason in next(row for row in rows if row.id == claim).decision.reason
    assert len(Path(find_script(f"{name}.py")).read_text(encoding="utf-8").splitlines()) <= 120


@pytest.mark.slow
def test_the_class_theorem_serves_every_n_and_every_function():
    """One statement whatever n is; its members are of m."""
    rows = {row.id: row for row in run_proof("every_function.py", ms=(2,), n=4).claims}
    assert {row.verdict.value for row in rows.values()} == {"proved"}
    assert {rows[name].n for name in rows} == {None}
    assert (rows["F.arms"].m, rows["F.family"].m) == (None, 2)
    assert rows["F.arms"].decision.grade.name == "EXACT"


def test_no_verdict_is_written_in_a_script():
    for script in (*SHIPPED, *(f"{name}.py" for name in REFUSED)):
        text = Path(find_script(script)).read_text(encoding="utf-8")
        assert re.findall(r"\b(proved|refuted|undecided|Verdict|Decision)\b", text) == [], script
