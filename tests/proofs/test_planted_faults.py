"""Faults planted in every script of proofs, of which none is proved, and changes that are still proved."""

from __future__ import annotations

import runpy
from pathlib import Path
from typing import NamedTuple

import pytest

from lyapcheck.answers.check.run import paper_case_data
from lyapcheck.claims.claim import Case
from lyapcheck.claims.procedures import propose
from lyapcheck.claims.script import find_script
from tests.helpers.shares import one_in
from tests.proofs.test_library import REFUSED

pytestmark = pytest.mark.usefixtures("few_tries")
PROOFS = Path(find_script("published.py")).parent

FAULTS: dict[str, list[tuple[str, ...]]] = {
    "takegaki_arimoto": [
        ("P", "K_p @ e - K_v @ w", "-1 * K_p @ e - K_v @ w"),
        ("P", "K_p @ e - K_v @ w", "K_p @ e + K_v @ w"),
        ("P", " + goal.gravity)\nV", ")\nV"),
        ("P", "V = w @ M @ w / 2", "V = w @ M @ w"),
    ],
    "tomei": [
        ("P", "K_p @ e - K_v @ w", "-1 * K_p @ e - K_v @ w"),
        ("P", "K_p @ e - K_v @ w", "K_p @ e + K_v @ w"),
        ("P", 'stable", theorem(k_g < K_p.min)', 'stable", theorem()'),
        ("P", 'stable", theorem(k_g < K_p.min)', 'stable", theorem(K_p.min < k_g)'),
    ],
    "kelly_gravity": [
        ("P", "K_p @ e - K_v @ w", "-1 * K_p @ e - K_v @ w"),
        ("P", "K_p @ e - K_v @ w", "K_p @ e + K_v @ w"),
        ("P", "V = energy - ε * e @ M @ w", "V = energy + ε * e @ M @ w"),
        ("P", "where=[k_g < K_p.min], small=True, **form)\n\n", "small=True, **form)\n\n"),
    ],
    "kelly_tanh": [
        ("P", "K_p @ e - K_v @ w", "-1 * K_p @ e - K_v @ w"),
        ("P", "K_p @ e - K_v @ w", "K_p @ e + K_v @ w"),
        ("P", "V = energy - γ * h @ M @ w", "V = energy + γ * h @ M @ w"),
        ("P", "rho=1", 'rho="1/2"'),
    ],
    "kelly_santibanez": [
        ("P", "K_p @ f - damping", "-1 * K_p @ f - damping"),
        ("P", "- damping * K_v @ k", "+ damping * K_v @ k"),
        ("P", " + goal.gravity)", ")"),
    ],
    "pd_plus": [
        ("P", "K_p @ e - K_v @ w", "-1 * K_p @ e - K_v @ w"),
        ("P", "K_p @ e - K_v @ w", "K_p @ e + K_v @ w"),
        ("P", "V = energy - ε", "V = energy + ε"),
        ("P", "feedforward = M @ goal.acceleration + C", "feedforward = C"),
    ],
    "slotine_li": [
        ("P", "+ goal.gravity + K @ s", "+ goal.gravity - K @ s"),
        ("P", "M @ (goal.acceleration - Λ @ w)", "M @ goal.acceleration"),
        ("P", "C @ reference + B", "C @ goal.velocity + B"),
        ("convergence", "+ goal.gravity + K @ s", "+ goal.gravity - K @ s"),
        ("convergence", "rate=K.min * norm(y) ** 2", "rate=K.min * b**2"),
        ("convergence", "contraction=Λ.min * r**2 - r * norm(y)", "contraction=Λ.min * r**2"),
    ],
    "pid": [
        ("P", "K_p @ e - K_v @ w", "-1 * K_p @ e - K_v @ w"),
        ("P", "K_p @ e - K_v @ w", "K_p @ e + K_v @ w"),
        ("P", "+ K_i @ z +", "- K_i @ z +"),
        ("P", "α * e), any", "-α * e), any"),
    ],
    "nonlinear_pid": [
        ("P", "K @ e + K_i @ e - K_v @ w", "K @ e + K_i @ e + K_v @ w"),
        ("P", "+ K_i @ z +", "- K_i @ z +"),
        ("P", "integral * α * (f", "integral * -α * (f"),
        ("P", "- α * f @ M @ w\n", "+ α * f @ M @ w\n"),
        ("P", "        f.kg < K.min * f.sector,\n", "        K.min * f.sector < f.kg,\n"),
        ("P", "(z, K_i.min * norm(z) ** 2)", "(z, K_i.max * norm(z) ** 2)"),
        ("P", "(f if bounded else e)", "w"),
        ("P", "(f if bounded else e)", "(0 * f)"),
        ("P", "where=where[:conditions]", "where=where[1:]"),
        ("P", "where=where[:conditions]", "where=where[::2]"),
        ("P", "where=where[:conditions]", "where=where[:2]"),
        ("P", "where=where[:conditions]", "where=where[:3]"),
        ("P", "K @ e + K_i @ e - K_v", "K @ e - K_v"),
        ("P", "        gravity=True,\n", ""),
        ("P", " + goal.gravity_at_goal)", ")"),
        ("P", "rest=(z, ", "rest=(e, "),
    ],
    "saturated_pd_gravity_goal": [
        ("P", "goal.under(L @ f - damping", "goal.under(-1 * L @ f - damping"),
        ("P", "- damping * K @ k +", "+ damping * K @ k +"),
        ("P", "[f.load < 1] if firm", "[1 < f.load] if firm"),
        ("P", "+ L.entries @ f.U", "+ A.entries @ f.U"),
        ("P", "rest=(f.probe, (1 - f.load) * f.sum_T)", "rest=(f.probe, f.sum_T)"),
        ("P", "gravity=True,\n        where", "where"),
        ("P", "[f.load < 1] if firm", "[f.load <= 1] if firm"),
        ("P", "[f.load < 1] if firm", "[f.load < 2] if firm"),
        ("P", "[f.load < 1] if firm", "[f.kg < 1] if firm"),
        ("P", "(1 - f.load) * f.sum_LU", "f.sum_LU"),
        ("P", "(1 - f.load) * f.sum_LU", "(2 - f.load) * f.sum_LU"),
        ("P", "(1 - f.load) * f.sum_LU", "(1 - f.load) * f.sum_T"),
        ("P", " + (1 - f.load) * f.sum_LU", ""),
        ("P", "rest=(f.probe, (1 - f.load) * f.sum_T)", "rest=(f.probe, (1 - f.load / 2) * f.sum_T)"),
        ("P", "rest=(f.probe, (1 - f.load) * f.sum_T)", "rest=(f.probe, 2 * (1 - f.load) * f.sum_T)"),
        ("P", "rest=(f.probe, (1 - f.load) * f.sum_T)", "rest=(f, (L.min - f.load) * norm(f) ** 2)"),
        ("P", "rest=(f.probe, (1 - f.load) * f.sum_T)", "rest=(f, L.min * norm(f) ** 2)"),
        ("P", "rest=(f.probe, (1 - f.load) * f.sum_T)", "rest=(goal.e, (1 - f.load) * f.sum_T)"),
        ("P", "rest=(f.probe, (1 - f.load) * f.sum_T)", "rest=(-f.probe, (1 - f.load) * f.sum_T)"),
        ("P", "rest=(f.probe, (1 - f.load) * f.sum_T)", "rest=(A @ f.probe, (1 - f.load) * f.sum_T)"),
        ("P", "rest=(f.probe, (1 - f.load) * f.sum_T)", "rest=(k, (1 - f.load) * f.sum_T)"),
        (
            "P",
            "goal.under(L @ f -",
            "goal.under(L @ (A @ f) -",
            "(1 - f.load) * f.sum_T",
            "(1 - f.load) * A.min * f.sum_T",
        ),
        ("P", "- damping * K @ k +", "- damping * K @ k + f.probe +"),
        ("P", "goal.under(L @ f", "goal.under(A @ f"),
        ("P", " + goal.gravity_at_goal)", ")"),
        ("P", "+ goal.gravity_at_goal)", "- goal.gravity_at_goal)"),
        ("P", "- damping * K @ k +", "- 0 * K @ k +"),
        (
            "P",
            "- damping * K @ k +",
            "- 0 * K @ k +",
            "rate=K.min * k.sector * norm(k) ** 2",
            "rate=goal.B.min * norm(w) ** 2",
            'friction="none"',
            'friction="any"',
        ),
        ("P", "rate=K.min * k.sector * norm(k) ** 2", "rate=K.min * norm(w) ** 2"),
        (
            "P",
            "lasalle(\n",
            "strict(\n",
            "    lasalle,\n",
            "    strict,\n",
            "        rest=(f.probe, (1 - f.load) * f.sum_T),\n",
            "",
        ),
    ],
    "spd_plus": [
        ("P", "goal.under(L @ d.value + model", "goal.under(-1 * L @ d.value + model"),
        ("P", "A @ e - sign * K @ w", "A @ e + sign * K @ w"),
        ("P", "M @ goal.acceleration + goal.C_desired @ goal.velocity", "M @ goal.acceleration"),
        ("P", "[k_c * v_d < B.min] if", "[B.min < k_c * v_d] if"),
        ("P", "rate=ε0 * (L.min", "rate=ε0 * (L.max"),
        ("P", "z, y = w - ε0 * h", "z, y = w + ε0 * h"),
        ("R", "L @ c.value + goal.gravity)", "L @ (h + c) + goal.gravity)"),
        ("R", "L @ c.value + goal.gravity)", "L @ c.value + goal.gravity_at_goal)"),
        ("R", "L @ c.value + goal.gravity)", "goal.gravity - L @ c)"),
        ("R", "rate=L.min * c.sector", "rate=2 * L.min * c.sector"),
        ("R", "c.sector * norm(c)", "c.secant * norm(c)"),
        ("R", "c.sector * norm(c)", "c.sector * norm(w)"),
        ("R", "norm(w) ** 2 + L.min * h.sum_U", "norm(w) ** 2 + norm(c) ** 2"),
        ("R", "rest=(h, L.min", "rest=(w, L.min"),
        ("R", "rest=(h, L.min", "rest=(c, L.min"),
    ],
    "feedforward": [
        ("P", "K_p @ e - K_v @ w", "-1 * K_p @ e - K_v @ w"),
        ("P", "goal.M_at_goal @ goal.acceleration +", "2 * goal.M_at_goal @ goal.acceleration +"),
        ("P", "+ goal.gravity_at_goal\n", "\n"),
    ],
    "bounded_filter": [
        ("P", "- N @ (L @ k) + goal", "+ N @ (L @ k) + goal"),
        ("P", "N @ w - leak", "-N @ w - leak"),
        ("P", " + goal.gravity)", ")"),
        ("P", "K_p.min * norm(f) ** 2, w=f", "K_p.min * norm(f) ** 2, w=-f"),
    ],
    "kelly_filter": [
        ("P", "leak * A @ any_vector", "-leak * A @ any_vector"),
        ("P", "[] if soft else [k_g < K_p.min]", "[] if soft else [K_p.min < k_g]"),
        ("P", "step(N.min * b**2, z=w), ", ""),
    ],
    "flexible_joints": [
        ("P", '"f", -J @ p', '"f", J @ p'),
        ("P", "- damping * K_d @ (J @ p)", "+ damping * K_d @ (J @ p)"),
        ("P", "K.max**2 < (K.min - k_g) * (K.min + K_p.min)", "k_g < K_p.min"),
        ("P", "K @ (e - f) + goal.gravity_at_goal", "K @ (e + f) + goal.gravity_at_goal"),
        ("P", "e=-w), step", "f=-w), step"),
    ],
    "computed_torque": [
        ("P", "e - K_v @ w\n", "e + K_v @ w\n"),
        ("P", "share * goal.M @ wanted", "share * goal.M_at_goal @ wanted"),
        ("P", "[a < K_v.min] if", "[K_v.min < a] if"),
        ("P", "goal.C @ velocity + goal.gravity", "goal.gravity"),
    ],
    "textbook": [
        ("P", "- (1 - x**2) * y", "+ (1 - x**2) * y"),
        ("P", "x**2 / 2 - x * y + y**2", "x**2 / 2 + x * y + y**2"),
        ("P", "x**2 / 2 - x * y + y**2", "x**2 / 2 - 2 * x * y + y**2"),
        ("P", "within=4", "within=2"),
    ],
    "pendulum": [
        ("P", 'damped = system({"θ": w, "w": -sin(θ) - w})', 'damped = system({"θ": w, "w": -sin(θ) + w})'),
        ("P", "V = E + w * sin(θ) / 2", "V = E - w * sin(θ) / 2"),
        ("P", "V = E + w * sin(θ) / 2", "V = E + 2 * w * sin(θ)"),
        ("P", "Fraction(1, 2) >= V, within=3", "Fraction(5, 2) >= V, within=5"),
    ],
    "adaptive_pd": [
        ("P", "(w - ε * e)", "(w + ε * e)"),
        ("P", "K_p @ e - K_v @ w + goal", "K_p @ e + K_v @ w + goal"),
        ("P", "a * (K_v.max + goal.B.max) ** 2 / 4 < K_p.min * d", "a * (K_v.max + goal.B.max) < K_p.min"),
        ("P", " + goal.gravity + Y", " + Y"),
    ],
    "slotine_li_adaptive": [
        ("P", "model + K @ s + Y", "model - K @ s + Y"),
        ("P", "adapt * transpose(Y) @ s", "adapt * transpose(Y) @ w"),
        ("P", "(goal.acceleration - Λ @ w)", "goal.acceleration"),
        ("P", "+ f @ G @ f / 2, goal", "- f @ G @ f / 2, goal"),
    ],
    "published": [
        ("7a", "sqrt(n) * largest(m), power)", "largest(m), power)"),
        ("12", "- ε_e * h_e @ M @ w", "+ ε_e * h_e @ M @ w"),
        ("14", "ε_e**2 * (2 * êw", "ε_e**2 * (êw"),
        ("15", "total(loops.terms(S))", "total(loops.terms(S)[1:])"),
        ("16.2", "b * norm_w**2)", "b / 2 * norm_w**2)"),
        ("16.4", '"s u 7a M w"', '"u 7a M w"'),
        ("16.8", "return above(secant_bound(m))", "return above(secant_bound(m)) / 2"),
        ("16.11", "ε * ε0 * n * γ * ρ * β", "ε * ε0 * γ * ρ * β"),
        ("T2.19.m1.true", 'VISCOUS_MIN = "0.406"', 'VISCOUS_MIN = "0.403"'),
        ("1.PD", "companion(PD).theorem", "companion(PID).theorem(local=False)"),
        ("1.PID", "companion(PID).theorem()", "companion(PID).theorem(local=False)"),
        ("2.2.strict", "size < shown + more)", "size + more < shown)"),
        ("9.hold.arm", "expr(gravity) <= limit", "expr(gravity) * 4 <= limit"),
        ("S4.period", 'expr("0.0025")', 'expr("0.0868")'),
        ("S4.percent.m1", '("m1", "8"), ("m3", "16")', '("m1", "7"), ("m3", "16")'),
        ("F.4.fit", '("47", "120", "10")', '("47", "120", "11")'),
        ("F.reach", '("6", "m2", "shoulder", "126.33")', '("6", "m2", "shoulder", "94.33")'),
        ("F.limits", '("8", "m3", "shoulder", "122.16")', '("8", "m3", "shoulder", "151")'),
        ("21.rest", "h_rate = -h_w", "h_rate = h_w"),
        ("21.rest", "M @ still", "M @ h_w"),
        ("R.8b", "sqrt(n) * rho(m), 1)", "rho(m), 1)"),
        (
            "R.7b",
            'norm_bound(h(m, x), n, secant_of(m), power=1), "(7)"',
            'norm_bound(h(m, x), n, secant_of(m) / 2, power=1), "(7)"',
        ),
        ("R.16.6", "-Z.eps * kp * size**2", "-2 * Z.eps * kp * size**2"),
        ("R.17a", "(sqrt(n) * whole * inner", "(n * whole * inner"),
        ("R.17c", "(start <= 1, line(1))", "(start <= 2, line(1))"),
        (
            "R.9.hold",
            "(abs_g <= k_g, k_g <= τ_max), abs_g <= τ_max",
            "(abs_g <= k_g, abs_g <= τ_max), k_g <= τ_max",
        ),
        ("R.19.m2", '(2, "0.222")', '(2, "0.223")'),
        ("R.7g", '2: "1.054"', '2: "1.0535"'),
    ],
    "scalar": [
        ("arm.theta", "SHARE = Fraction(99, 100)", "SHARE = Fraction(101, 100)"),
        ("arm.states", "SHARE = Fraction(99, 100)", "SHARE = Fraction(60)"),
        ("arm.integral", "eps * k * a**2 / 2 <= whole", "eps * k * a**2 <= whole"),
        ("arm.integral", "most = above(energy)", "most = above(energy) / 2"),
        ("arm.integral", "most / k_i + 1 for", "most / k_i / 2 for"),
        ("arm.integral", "gains) / 2\n    at_rest", "gains) * 2\n    at_rest"),
        (
            "h.slope",
            "Bounds(n, gamma(m), rho(m), secant_bound(m))",
            "Bounds(n, gamma(m), rho(m), expr('0.8'))",
        ),
        ("h.share", "<= reach * L / (reach + L)", "<= reach * L / (reach + 2 * L)"),
        (
            "V.positive",
            "FAMILY.regulator(FAMILY.h_of(m), eps0)",
            "FAMILY.regulator(FAMILY.member(h(m, x), 2 * potential(m, x), 2, 2, 2), eps0)",
        ),
        (
            "V.smooth",
            "FAMILY.regulator(FAMILY.h_of(m), eps0)",
            "FAMILY.regulator(FAMILY.member(2 * h(m, x), potential(m, x), 2, 2, 2), eps0)",
        ),
        (
            "equilibrium",
            "AT_REST.regulator(AT_REST.h_of(m), ",
            "AT_REST.regulator(FAMILY.member(x**3 - x, x**4 / 4 - x**2 / 2, 2, 2, 2), ",
        ),
        ("rate.1", '["h.odd"], [], ["damping"]', '["h.odd"], ["w"]'),
        ("rate.4", "eps * known.G * beta * b**2", "eps * known.G / 2 * beta * b**2"),
        ("rate.8", "eps * known.L * kv_max", "eps * '0.8' * kv_max"),
        ("rate.form", "return eps * k, -eps / 2", "return eps * k, -eps / 3"),
        (
            "arm.C",
            "ArmBounds(robot).coriolis_below()",
            "(lambda arm: type(arm.coriolis_below())(arm.mass, (), arm.kc / 100))(ArmBounds(robot))",
        ),
        ("arm.stable", "Kp=gains.kp, Kv", "Kp=[k / 9 for k in gains.kp], Kv"),
        ("arm.properties", "plus(turning, transpose(turning))", "plus(turning, turning)"),
    ],
    "tracking": [
        ("arm.21.theta", "SHARE = Fraction(99, 100)", "SHARE = Fraction(101, 100)"),
        ("arm.21.theta", "robot, gains)\n\n    def", "robot, gains)\n    turn = turn / 2\n\n    def"),
        ("21.loop", "scaled(s.kp, s.h) - scaled(s.kv, s.hw)", "scaled(s.kp, s.h) + scaled(s.kv, s.hw)"),
        ("21.5", "eps * kc * vd * a * b + eps * known.reach * kc * b**2", "eps * known.reach * kc * b**2"),
        ("21.9", "eps**2 * kc * vd * a**2 +", "eps**2 * kc * vd * a**2 / 2 +"),
        (
            "21.loop",
            "FAMILY.tracking(FAMILY.h_of(m), eps0)",
            "FAMILY.tracking(FAMILY.member(h(m, x) + 1, FAMILY.potential(m, x), 2, 2, 2), eps0)",
        ),
        (
            "21.above",
            "FAMILY.tracking(FAMILY.h_of(m), eps0)",
            "FAMILY.tracking(FAMILY.member(-h(m, x), FAMILY.potential(m, x) * (-1), 2, 2, 2), eps0)",
        ),
        ("arm.21", "vd=SPEED)", "vd=2 * SPEED)"),
        (
            "21",
            "FAMILY.tracking(FAMILY.h_of(m), eps0)",
            "FAMILY.tracking(FAMILY.member(x, FAMILY.x, 2, 2, 2), eps0)",
        ),
    ],
    "examples/arctan": [
        ("bound", "atan(x) <= pi / 2", "atan(x) <= '1.57'"),
        ("slope", 'gamma="1.58", rho=1, L=1', "gamma='1.58', rho=1, L='0.99'"),
        ("steep", 'gamma="1.58", rho=1, L=1', "gamma='1.58', rho='0.99', L=1"),
        ("potential", "log(1 + x**2) / 2", "log(1 + x**2)"),
        ("bounds", "term_9=term(9, eps**2 * known.reach", "term_9=term(9, eps**3 * known.reach"),
        ("arm", '"0.02"', '"20"'),
        ("sizes", 'gamma="1.58", rho=1, L=1', "gamma='1.57', rho=1, L=1"),
        ("sizes", 'gamma="1.58", rho=1, L=1', "gamma='1.58', rho='0.99', L=1"),
        ("sizes", 'gamma="1.58", rho=1, L=1', "gamma='1.58', rho=1, L='0.99'"),
        ("positive", "log(1 + x**2) / 2", "log(1 + x**2)"),
        ("positive", "log(1 + x**2) / 2", "log(2 + x**2) / 2"),
        ("steep", "SLOPE = 1 / (1 + x**2)", "SLOPE = 1 / (2 + x**2)"),
    ],
    "examples/must_fail": [
        ("right", "x - x**3 / 3 <= atan(x), 0)", "x - x**3 / 4 <= atan(x), 0)"),
    ],
    "every_function": [
        ("F.family", "K_p @ h - K_v @ k", "K_p @ h + K_v @ k"),
        ("F.family", "- K_v @ k + goal.gravity", "- K_v @ k + goal.gravity_at_goal"),
        ("F.family", "shifted = w - ε * h", "shifted = w + ε * h"),
        ("F.family", " + K_p.entries @ h.U", ""),
        ("F.family", 'constant_goal("positive")', 'constant_goal("any")'),
        ("F.arms", "β * (h.slope + h.share)", "β * h.share"),
        ("F.arms", "B.max + k.secant", "B.min + k.secant"),
        (
            "F.family",
            '"given": {"where": where}',
            '"given": {}',
            "return regulator(h_of(m))",
            'return regulator(h_of(m), "given")',
        ),
        (
            "F.family.tracking",
            "return uniform(loop",
            "return exponential(loop",
            "    uniform,\n",
            "    exponential,\n",
        ),
        ("F.family.tracking", "below=β / 2", "below=goal.mu / 2"),
        ("F.family.tracking", " + B @ goal.velocity", ""),
        (
            "F.family.tracking",
            "rate - ε**2 * D * a**2 - ε * D * a * b",
            "rate - ε**2 * D * a**2 - ε * D * a * b / 2",
        ),
        ("F.family", "(gamma, rho, secant_bound)))", "(gamma, gamma, secant_bound)))"),
        ("F.family", "member(h(m, x), potential(m, x)", "member(-h(m, x), -potential(m, x)"),
    ],
}
"""For each script the claim, and a passage that is written otherwise, or several."""
STILL_TRUE: dict[str, list[tuple[str, ...]]] = {
    "scalar": [("arm.states", "SHARE = Fraction(99, 100)", "SHARE = Fraction(12, 10)")],
    "tracking": [
        ("arm.21", "SPEED = Fraction(2)", "SPEED = Fraction(1000)"),
        ("arm.21", "SPEED = Fraction(2)", "SPEED = Fraction(0)"),
        ("arm.21", "SPEED = Fraction(2)", "SPEED = Fraction(1, 10)"),
    ],
    "published": [
        ("7g", '2: "1.05"', '2: "1.06"'),
        ("T1.torque.m2.elbow", '"m2": (("50", "150", "150")', '"m2": (("50", "150", "15")'),
        ("17a", "(ε * (whole * inner + last**2 / 4))", "(ε * (sqrt(n) * whole * inner + last**2 / 4))"),
        ("17c", "last = flat + ε0 * steep if with_eps0 else flat", "last = flat"),
        ("13.first", "expr(0) < y_w**2 + y_h**2", "expr(0) < y_w**2 + y_h**2, expr(0) < (y_w - y_h) ** 2"),
        (
            "12.any",
            "(share <= 1, condition_19(n)), det_positive(n)",
            "(share <= 1, det_positive(n)), det_positive(n)",
        ),
        ("9.hold", "g[0] ** 2 <= limit[0] ** 2", "g[0] ** 2 <= total(limit_i**2 for limit_i in limit)"),
        ("F.10.base", '("0.8", "2.5"', '("0.89", "2.5"'),
    ],
    "examples/must_fail": [
        ("wrong", "x - x**3 / 3, 0)", "x, 0)"),
        ("sign", "w) / 2 + ε", "w) / 2 - ε"),
        ("large", "robot, gains, 2)", 'robot, gains, "0.02")'),
    ],
}


class Row(NamedTuple):
    """A script, one of its claims, and passages with what stands in their place."""

    script: str
    claim: str
    changes: tuple[str, ...]


def rows(table: dict[str, list[tuple[str, ...]]]) -> list[Row]:
    return [Row(script, claim, tuple(changes)) for script in table for claim, *changes in table[script]]


def named(row: Row) -> str:
    return f"{row.script} {row.claim}: {row.changes[1]}"


def verdict(folder: Path, row: Row) -> str:
    """Of a claim for m = 2 and the arm of the paper, from a script with passages exchanged."""
    source = (PROOFS / f"{row.script}.py").read_text(encoding="utf-8")
    for right, wrong in zip(row.changes[::2], row.changes[1::2], strict=True):
        assert right in source, right
        source = source.replace(right, wrong)
    path = folder / "altered.py"
    path.write_text(source, encoding="utf-8")
    statement = runpy.run_path(str(path))["proof"].claims[row.claim].statement(Case(*paper_case_data(2)))
    return propose(statement).verdict.value


@pytest.mark.parametrize("row", one_in(12, rows(FAULTS)), ids=named)
def test_a_planted_fault_is_not_proved(tmp_path: Path, row: Row) -> None:
    assert verdict(tmp_path, row) in ("undecided", "refuted")


@pytest.mark.parametrize("row", one_in(6, rows(STILL_TRUE)), ids=named)
def test_what_is_repaired_or_of_another_size_is_proved(tmp_path: Path, row: Row) -> None:
    assert verdict(tmp_path, row) == "proved"


def test_faults_are_planted_in_each_script_of_the_library() -> None:
    assert {name for name in REFUSED if len(FAULTS[name]) >= 3} == set(REFUSED)
