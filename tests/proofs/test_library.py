"""The library of published proofs: what each proves and refuses, and faults planted in every one of them."""

import re
import runpy
from pathlib import Path

import pytest

from lyapcheck.claims import run_proof
from lyapcheck.claims.claim import Case
from lyapcheck.claims.procedures import propose
from lyapcheck.claims.script import SHIPPED, find_script
from tests.helpers.script_cases import rewriter
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


TURNED = [("K_p @ e - K_v @ w", "-1 * K_p @ e - K_v @ w"), ("K_p @ e - K_v @ w", "K_p @ e + K_v @ w")]
FAULTS = {
    "takegaki_arimoto": [*TURNED, (" + goal.gravity)\nV", ")\nV"), ("V = w @ M @ w / 2", "V = w @ M @ w")],
    "tomei": [
        *TURNED,
        ('stable", theorem(k_g < K_p.min)', 'stable", theorem()'),
        ('stable", theorem(k_g < K_p.min)', 'stable", theorem(K_p.min < k_g)'),
    ],
    "kelly_gravity": [
        *TURNED,
        ("V = energy - ε * e @ M @ w", "V = energy + ε * e @ M @ w"),
        ("where=[k_g < K_p.min], small=True, **form)\n\n", "small=True, **form)\n\n"),
    ],
    "kelly_tanh": [
        *TURNED,
        ("V = energy - γ * h @ M @ w", "V = energy + γ * h @ M @ w"),
        ("rho=1", 'rho="1/2"'),
    ],
    "kelly_santibanez": [
        ("K_p @ f - damping", "-1 * K_p @ f - damping"),
        ("- damping * K_v @ k", "+ damping * K_v @ k"),
        (" + goal.gravity)", ")"),
    ],
    "pd_plus": [
        *TURNED,
        ("V = energy - ε", "V = energy + ε"),
        ("feedforward = M @ goal.acceleration + C", "feedforward = C"),
    ],
    "slotine_li": [
        ("+ goal.gravity + K @ s", "+ goal.gravity - K @ s"),
        ("M @ (goal.acceleration - Λ @ w)", "M @ goal.acceleration"),
        ("C @ reference + B", "C @ goal.velocity + B"),
    ],
    "pid": [*TURNED, ("+ K_i @ z +", "- K_i @ z +"), ("α * e), any", "-α * e), any")],
    "nonlinear_pid": [
        ("K @ e + K_i @ e - K_v @ w", "K @ e + K_i @ e + K_v @ w"),
        ("+ K_i @ z +", "- K_i @ z +"),
        ("integral * α * (f", "integral * -α * (f"),
        ("- α * f @ M @ w\n", "+ α * f @ M @ w\n"),
        ("        f.kg < K.min * f.sector,\n", "        K.min * f.sector < f.kg,\n"),
        ("(z, K_i.min * norm(z) ** 2)", "(z, K_i.max * norm(z) ** 2)"),
    ],
    "saturated_pd_gravity_goal": [
        ("goal.under(L @ f - damping", "goal.under(-1 * L @ f - damping"),
        ("- damping * K @ k +", "+ damping * K @ k +"),
        ("[f.load < 1] if firm", "[1 < f.load] if firm"),
        ("+ L.entries @ f.U", "+ A.entries @ f.U"),
        ("rest=(f.probe, (1 - f.load) * f.sum_T)", "rest=(f.probe, f.sum_T)"),
        ("gravity=True,\n        where", "where"),
    ],
    "spd_plus": [
        ("goal.under(L @ d.value + model", "goal.under(-1 * L @ d.value + model"),
        ("A @ e - sign * K @ w", "A @ e + sign * K @ w"),
        ("M @ goal.acceleration + goal.C_desired @ goal.velocity", "M @ goal.acceleration"),
        ("[k_c * v_d < B.min] if", "[B.min < k_c * v_d] if"),
        ("rate=ε0 * (L.min", "rate=ε0 * (L.max"),
        ("z, y = w - ε0 * h", "z, y = w + ε0 * h"),
    ],
    "feedforward": [
        TURNED[0],
        ("goal.M_at_goal @ goal.acceleration +", "2 * goal.M_at_goal @ goal.acceleration +"),
        ("+ goal.gravity_at_goal\n", "\n"),
    ],
    "bounded_filter": [
        ("- N @ (L @ k) + goal", "+ N @ (L @ k) + goal"),
        ("N @ w - leak", "-N @ w - leak"),
        (" + goal.gravity)", ")"),
        ("K_p.min * norm(f) ** 2, w=f", "K_p.min * norm(f) ** 2, w=-f"),
    ],
    "kelly_filter": [
        ("leak * A @ any_vector", "-leak * A @ any_vector"),
        ("[] if soft else [k_g < K_p.min]", "[] if soft else [K_p.min < k_g]"),
        ("step(N.min * b**2, z=w), ", ""),
    ],
    "flexible_joints": [
        ('"f", -J @ p', '"f", J @ p'),
        ("- damping * K_d @ (J @ p)", "+ damping * K_d @ (J @ p)"),
        ("K.max**2 < (K.min - k_g) * (K.min + K_p.min)", "k_g < K_p.min"),
        ("K @ (e - f) + goal.gravity_at_goal", "K @ (e + f) + goal.gravity_at_goal"),
        ("e=-w), step", "f=-w), step"),
    ],
    "computed_torque": [
        ("e - K_v @ w\n", "e + K_v @ w\n"),
        ("share * goal.M @ wanted", "share * goal.M_at_goal @ wanted"),
        ("[a < K_v.min] if", "[K_v.min < a] if"),
        ("goal.C @ velocity + goal.gravity", "goal.gravity"),
    ],
    "textbook": [
        ("- (1 - x**2) * y", "+ (1 - x**2) * y"),
        ("x**2 / 2 - x * y + y**2", "x**2 / 2 + x * y + y**2"),
        ("x**2 / 2 - x * y + y**2", "x**2 / 2 - 2 * x * y + y**2"),
        ("within=4", "within=2"),
    ],
    "pendulum": [
        ('damped = system({"θ": w, "w": -sin(θ) - w})', 'damped = system({"θ": w, "w": -sin(θ) + w})'),
        ("V = E + w * sin(θ) / 2", "V = E - w * sin(θ) / 2"),
        ("V = E + w * sin(θ) / 2", "V = E + 2 * w * sin(θ)"),
        ("Fraction(1, 2) >= V, within=3", "Fraction(5, 2) >= V, within=5"),
    ],
    "adaptive_pd": [
        ("(w - ε * e)", "(w + ε * e)"),
        ("K_p @ e - K_v @ w + goal", "K_p @ e + K_v @ w + goal"),
        ("a * (K_v.max + goal.B.max) ** 2 / 4 < K_p.min * d", "a * (K_v.max + goal.B.max) < K_p.min"),
        (" + goal.gravity + Y", " + Y"),
    ],
    "slotine_li_adaptive": [
        ("model + K @ s + Y", "model - K @ s + Y"),
        ("adapt * transpose(Y) @ s", "adapt * transpose(Y) @ w"),
        ("(goal.acceleration - Λ @ w)", "goal.acceleration"),
        ("+ f @ G @ f / 2, goal", "- f @ G @ f / 2, goal"),
    ],
}

CONVERGENCE = [
    ("+ goal.gravity + K @ s", "+ goal.gravity - K @ s"),
    ("rate=K.min * norm(y) ** 2", "rate=K.min * b**2"),
    ("contraction=Λ.min * r**2 - r * norm(y)", "contraction=Λ.min * r**2"),
]
"""Faults in what is true beside the printed argument of Slotine and Li."""


@pytest.mark.parametrize(("right", "wrong"), CONVERGENCE)
def test_a_planted_fault_in_the_cascade_is_not_proved(tmp_path, right, wrong):
    path = rewriter("slotine_li.py", tmp_path)(right, wrong)
    conclusion = runpy.run_path(str(path))["proof"].claims["convergence"].statement(Case(2, 2))
    assert propose(conclusion).verdict.value in ("undecided", "refuted")


@pytest.mark.usefixtures("few_tries")
@pytest.mark.parametrize(
    ("name", "right", "wrong"),
    but(
        [(name, *fault) for name in ("takegaki_arimoto", "slotine_li") for fault in FAULTS[name]],
        [(name, *fault) for name, faults in FAULTS.items() for fault in faults],
    ),
)
def test_a_planted_fault_is_not_proved(tmp_path, name, right, wrong):
    path = rewriter(f"{name}.py", tmp_path)(right, wrong)
    conclusion = runpy.run_path(str(path))["proof"].claims["P"].statement(Case(2, 2))
    assert propose(conclusion).verdict.value in ("undecided", "refuted")


def test_faults_are_planted_in_each():
    assert {name for name, faults in FAULTS.items() if len(faults) >= 3} == set(REFUSED)


def test_no_verdict_is_written_in_a_script():
    for script in (*SHIPPED, *(f"{name}.py" for name in REFUSED)):
        text = Path(find_script(script)).read_text(encoding="utf-8")
        assert re.findall(r"\b(proved|refuted|undecided|Verdict|Decision)\b", text) == [], script
