"""Bounded controllers: gravity beside a function, functions at another argument, and lies about both."""

import json
from dataclasses import replace

import pytest

from lyapcheck.certificate import to_json
from lyapcheck.check.codec import from_json
from lyapcheck.check.kinds.stability import Stable
from lyapcheck.check.kinds.stable_arm import StableArm
from lyapcheck.check.refusal import Refused
from lyapcheck.check.statement import Statement
from lyapcheck.check.verify import verify
from lyapcheck.claims import (
    any_vector,
    at_arm,
    constant_goal,
    cosh,
    lasalle,
    norm,
    strict,
    tanh,
    var,
)
from lyapcheck.claims import (
    log as logarithm,
)
from lyapcheck.claims.procedures import propose
from lyapcheck.robots import load

x = var("x")
TANH = {"gamma": 1, "rho": 1, "secant": 1, "low": "3/4", "start": 1, "steep": "3/4"}


def why(statement):
    result = propose(statement)
    assert result.verdict.value != "proved"
    return result.reason


class Regulator:
    """τ = L f(A e) − K k(w) + g(q_d)."""

    def __init__(self, goal=None, torque=None, member=False):
        self.goal = goal = goal or constant_goal("none")
        self.e, self.w, self.M = goal.e, goal.w, goal.M
        self.L, self.A, self.K = goal.gains("L A K")
        of = self.A @ self.e
        if member:
            self.f = goal.function("f", of, tanh(x), logarithm(cosh(x)), level=self.L, **TANH)
        else:
            self.f = goal.entrywise("f", of, level=self.L)
        self.k = goal.entrywise("k", self.w)
        self.pd = self.L @ self.f - self.K @ self.k
        self.torque = self.pd + goal.gravity_at_goal if torque is None else torque(self)
        self.V = self.w @ self.M @ self.w / 2 + self.L.entries @ self.f.U
        spare = 1 - self.f.load
        self.own = {
            "gravity": True,
            "where": [self.f.load < 1],
            "above": goal.mu / 2 * norm(self.w) ** 2 + spare * self.f.sum_LU,
            "rate": self.K.min * self.k.sector * norm(self.k) ** 2,
            "rest": (self.f.probe, spare * self.f.sum_T),
        }

    def argued(self, theorem=lasalle, **changed):
        own = self.own | changed
        V = own.pop("V", self.V)
        return theorem(self.goal.under(own.pop("torque", self.torque)), V, **own)


class Single:
    """τ = L f(A e − K w) + g(q), as L (h − c)."""

    def __init__(self, to=None, torque=None):
        self.goal = goal = constant_goal("none")
        self.e, self.w, self.M = goal.e, goal.w, goal.M
        self.L, self.A, self.K = goal.gains("L A K")
        self.h = goal.entrywise("h", self.A @ self.e)
        self.c = goal.increase("c", self.h, self.A @ self.e - self.K @ self.w if to is None else to(self))
        self.torque = self.L @ self.c.value + goal.gravity if torque is None else torque(self)

    def argued(self, **changed):
        own = {
            "above": self.goal.mu / 2 * norm(self.w) ** 2 + self.L.min * self.h.sum_U,
            "rate": self.L.min * self.c.sector * norm(self.c) ** 2,
            "rest": (self.h, self.L.min * norm(self.h) ** 2),
        } | changed
        V = own.pop("V", self.w @ self.M @ self.w / 2 + self.L.entries @ self.h.U)
        return lasalle(self.goal.under(self.torque), V, **own)


class Pid:
    """τ = (K + G)e − Dw + Gz + g(q_d), dz/dt = alpha f(e), with V of ``proofs/nonlinear_pid.py``."""

    def __init__(self, rate=None, friction="any"):
        self.goal = goal = constant_goal(friction)
        self.e, self.w, self.M = goal.e, goal.w, goal.M
        self.K, self.H, self.G = goal.gains("K H G")
        (self.alpha,) = goal.constants("alpha")
        self.f, self.y = goal.entrywise("f", self.e), any_vector("y_z")
        self.z = goal.state("z", self.alpha * self.f if rate is None else rate(self))

    def argued(self, sign=1, **changed):
        goal, alpha, f, e, w, z, y = self.goal, self.alpha, self.f, self.e, self.w, self.z, self.y
        K, H, G, r, b, a = self.K, self.H, self.G, norm(self.e), norm(self.w), norm(self.f)
        k, p = K.min - goal.kg, K.min * f.sector - f.kg
        d = H.min - alpha * (goal.beta * f.slope + goal.kc * f.reach)
        cross = alpha * goal.beta * f.secant
        own = {
            "torque": K @ e + G @ e - H @ w + G @ z + goal.gravity_at_goal,
            "gravity": True,
            "changes": {"z": y - e},
            "where": [
                cross**2 < goal.mu * k,
                f.kg < K.min * f.sector,
                d > 0,
                alpha * (H.max + goal.B.max) ** 2 / 4 < p * d,
            ],
            "above": goal.mu / 2 * b**2 + k / 2 * r**2 - cross * r * b + G.min / 2 * norm(y) ** 2,
            "rate": alpha * p * a**2 - alpha * (H.max + goal.B.max) * a * b + d * b**2,
            "rest": (z, G.min * norm(z) ** 2),
            "V": w @ self.M @ w / 2
            + e @ K @ e / 2
            + (z + e) @ G @ (z + e) / 2
            - sign * alpha * f @ self.M @ w,
        } | changed
        loop = goal.under(own.pop("torque"))
        return lasalle(loop, own.pop("V"), **own)


@pytest.mark.parametrize("made", [Regulator, Single, Pid])
def test_the_proofs_that_faults_are_planted_in(made):
    statement = made().argued()
    result = propose(statement)
    assert result.verdict.value == "proved", result.reason
    again = from_json(Statement, json.loads(json.dumps(to_json(statement))), "statement")
    assert again == statement
    assert verify(again, result.proof).grade == "exact"


def test_the_text_says_what_gravity_is_compared_with():
    text = Regulator().argued().text()
    assert "f = f(A e) by entries" in text
    assert (
        "f_load with min(kg |x|, k_i) ≤ f_load L_i |f(A x)|, k_i ≥ |g_i(q) − g_i(p)|, for each joint" in text
    )
    single = Single().argued().text()
    assert "c = h(A e) − h(A e − K w) by entries" in single
    assert "increasing with a positive slope" in single
    assert "f_kg with ‖g(q) − g(p)‖ ‖x‖ ≤ f_kg x·f(x), x = q − p" in Pid().argued().text()


# Lies: about fifty, none of them proved -------------------------------------------------------------------


def regulator(change, **how):
    def made():
        one = Regulator(**how)
        return one.argued(**change(one))

    return made


def single(change=lambda one: {}, **how):
    def made():
        one = Single(**how)
        return one.argued(**change(one))

    return made


def pid(change=lambda one: {}, sign=1, **how):
    def made():
        one = Pid(**how)
        return one.argued(sign, **change(one))

    return made


def _where(one, *left_out):
    """The conditions of the PID without some of them."""
    every = one.argued().argument.where
    return [condition for k, condition in enumerate(every) if k not in left_out]


LIES = {
    # the saturated PD
    "no condition": regulator(lambda r: {"where": []}),
    "load at most 1": regulator(lambda r: {"where": [r.f.load <= 1]}),
    "load below 2": regulator(lambda r: {"where": [r.f.load < 2]}),
    "load above 1": regulator(lambda r: {"where": [r.f.load > 1]}),
    "another constant for load": regulator(lambda r: {"where": [r.f.kg < 1]}),
    "gravity forgotten in φ": regulator(lambda r: {"above": r.own["above"] + r.f.load * r.f.sum_LU}),
    "gravity forgotten at rest": regulator(lambda r: {"rest": (r.f.probe, r.f.sum_T)}),
    "half of gravity": regulator(lambda r: {"rest": (r.f.probe, (1 - r.f.load / 2) * r.f.sum_T)}),
    "kg in place of load": regulator(
        lambda r: {"rest": (r.f, (r.L.min - r.f.load) * norm(r.f) ** 2)}, goal=constant_goal("none")
    ),
    "rest by f alone": regulator(lambda r: {"rest": (r.f, r.L.min * norm(r.f) ** 2)}),
    "rest by e": regulator(lambda r: {"rest": (r.e, (1 - r.f.load) * r.f.sum_T)}),
    "probe turned": regulator(lambda r: {"rest": (-r.f.probe, (1 - r.f.load) * r.f.sum_T)}),
    "probe twice": regulator(lambda r: {"rest": (r.f.probe, 2 * (1 - r.f.load) * r.f.sum_T)}),
    "probe through another gain": regulator(
        lambda r: {"rest": (r.A @ r.f.probe, (1 - r.f.load) * r.f.sum_T)}
    ),
    "probe through a gain that gravity is not compared with": regulator(
        lambda r: {
            "torque": r.torque - r.L @ r.f + r.L @ (r.A @ r.f),
            "rest": (r.f.probe, (1 - r.f.load) * r.A.min * r.f.sum_T),
        }
    ),
    "probe of the velocity's function": regulator(lambda r: {"rest": (r.k, (1 - r.f.load) * r.f.sum_T)}),
    "probe in the torque": regulator(lambda r: {"torque": r.torque + r.f.probe}),
    "probe in V": regulator(lambda r: {"V": r.V + r.f.probe @ r.e}),
    "another level in V": regulator(lambda r: {"V": r.V - r.L.entries @ r.f.U + r.A.entries @ r.f.U}),
    "another level in the torque": regulator(lambda r: {"torque": r.torque - r.L @ r.f + r.A @ r.f}),
    "twice the level": regulator(lambda r: {"above": r.own["above"] + r.f.sum_LU}),
    "gravity of the arm and of the goal": regulator(lambda r: {"torque": r.pd}),
    "V without gravity": regulator(lambda r: {"gravity": False}),
    "gravity turned": regulator(lambda r: {"torque": r.pd - r.goal.gravity_at_goal}),
    "proportional term turned": regulator(lambda r: {"torque": r.torque - 2 * r.L @ r.f}),
    "damping turned": regulator(lambda r: {"torque": r.torque + 2 * r.K @ r.k}),
    "no damping": regulator(lambda r: {"torque": r.torque + r.K @ r.k}),
    "friction claimed and absent": regulator(
        lambda r: {"torque": r.torque + r.K @ r.k, "rate": r.goal.B.min * norm(r.w) ** 2},
        goal=constant_goal("any"),
    ),
    "a rate in w": regulator(lambda r: {"rate": r.K.min * norm(r.w) ** 2}),
    "strict": regulator(lambda r: {"theorem": strict, "rest": None}),
    "φ without e": regulator(lambda r: {"above": r.goal.mu / 2 * norm(r.w) ** 2}),
    "sum_T as a size of φ": regulator(
        lambda r: {"above": r.goal.mu / 2 * norm(r.w) ** 2 + (1 - r.f.load) * r.f.sum_T}
    ),
    # one saturation
    "velocity turned": single(to=lambda s: s.A @ s.e + s.K @ s.w),
    "d turned": single(torque=lambda s: s.L @ (s.h + s.c) + s.goal.gravity),
    "d twice, back once": single(lambda s: {"rate": 2 * s.L.min * s.c.sector * norm(s.c) ** 2}),
    "secant for sector": single(lambda s: {"rate": s.L.min * s.c.secant * norm(s.c) ** 2}),
    "a rate in w of d": single(lambda s: {"rate": s.L.min * s.c.sector * norm(s.w) ** 2}),
    "d in V": single(lambda s: {"V": s.w @ s.M @ s.w / 2 + s.L.entries @ s.h.U + s.c @ s.c}),
    "d in φ": single(lambda s: {"above": s.goal.mu / 2 * norm(s.w) ** 2 + norm(s.c) ** 2}),
    "gravity at the goal": single(torque=lambda s: s.L @ s.c.value + s.goal.gravity_at_goal),
    "no proportional term": single(torque=lambda s: s.goal.gravity - s.L @ s.c),
    "rest by w": single(lambda s: {"rest": (s.w, s.L.min * norm(s.h) ** 2)}),
    "rest by d": single(lambda s: {"rest": (s.c, s.L.min * norm(s.h) ** 2)}),
    # PID with a bounded integral
    "integral turned": pid(rate=lambda p: -p.alpha * p.f),
    "integral of e": pid(rate=lambda p: p.alpha * p.e),
    "integral of w": pid(rate=lambda p: p.alpha * p.w),
    "no integral": pid(rate=lambda p: 0 * p.f),
    "cross term turned": pid(sign=-1),
    "no first condition": pid(lambda p: {"where": _where(Pid(), 0)}),
    "no second condition": pid(lambda p: {"where": _where(Pid(), 1, 3)}),
    "no third condition": pid(lambda p: {"where": _where(Pid(), 2, 3)}),
    "no fourth condition": pid(lambda p: {"where": _where(Pid(), 3)}),
    "linear term without G": pid(
        lambda p: {"torque": p.K @ p.e - p.H @ p.w + p.G @ p.z + p.goal.gravity_at_goal}
    ),
    "PID without gravity's energy": pid(lambda p: {"gravity": False}),
    "PID without gravity at the goal": pid(
        lambda p: {"torque": p.K @ p.e + p.G @ p.e - p.H @ p.w + p.G @ p.z}
    ),
    "z at rest by e": pid(lambda p: {"rest": (p.e, p.G.min * norm(p.z) ** 2)}),
}


@pytest.mark.parametrize("lie", LIES)
def test_a_lie_is_not_proved(lie):
    assert why(LIES[lie]())


def test_there_are_fifty_lies():
    assert len(LIES) >= 50


# What is refused where it is written ----------------------------------------------------------------------


def test_a_function_of_something_else_is_refused_with_the_repair():
    goal = constant_goal()
    e, w, (K, H) = goal.e, goal.w, goal.gains("K H")
    for of in (e + w, 2 * K @ e, -e, K @ (H @ e), goal.M @ e, any_vector("y"), K @ e - H @ w):
        with pytest.raises(ValueError, match=r"goal\.increase\(name, f, K @ e - D @ w\)"):
            goal.entrywise("f", of)
    f = goal.entrywise("f", K @ e)
    for to in (e - H @ w, K @ e, K @ e - w, K @ e - 2 * H @ w, 2 * K @ e - H @ w, K @ e - H @ w + w, H @ w):
        with pytest.raises(ValueError, match="an increase is of a function of this goal"):
            goal.increase("c", f, to)
    with pytest.raises(ValueError, match="the function is of e itself"):
        goal.increase("c", f, K @ e + H @ e)
    with pytest.raises(ValueError, match="a level is a gain of this goal"):
        goal.entrywise("k", w, level=H)
    with pytest.raises(ValueError, match="a level is a gain of this goal"):
        goal.entrywise("k", e, level=goal.M)
    with pytest.raises(ValueError, match="c_load is no constant or size"):
        single(lambda s: {"rate": var("c_load") * norm(s.c) ** 2})()


@pytest.mark.parametrize(
    "change",
    [
        {"gain": "M"},
        {"gain": "e"},
        {"level": "nothing"},
        {"of": "w"},
        {"name": "TL"},
        {"name": "x_y"},
    ],
)
def test_functions_of_an_attacker_are_refused(change):
    argument = Regulator().argued().argument
    system = argument.system
    first = replace(system.functions[0], **change)
    new = replace(system, functions=(first, *system.functions[1:]))
    with pytest.raises(Refused):
        Stable(replace(argument, system=new)).require_well_formed()


@pytest.mark.parametrize(
    "change",
    [
        {"function": "f"},
        {"of": "e"},
        {"of": "nothing"},
        {"gain": "M"},
        {"gain": ""},
        {"name": "h"},
        {"name": "s"},
    ],
)
def test_increases_of_an_attacker_are_refused(change):
    argument = Single().argued().argument
    system = argument.system
    new = replace(system, increases=tuple(replace(one, **change) for one in system.increases))
    with pytest.raises(Refused):
        Stable(replace(argument, system=new)).require_well_formed()


def test_a_function_that_falls_has_no_increases():
    """x/(1 + x²) has the sign of x, and is smaller far away than near."""
    goal = constant_goal("none")
    L, A, K = goal.gains("L A K")
    bent, energy = x / (1 + x**2), logarithm(1 + x**2) / 2
    h = goal.function("h", A @ goal.e, bent, energy, gamma=1, rho=1, secant=1, low="1/8", start=1)
    c = goal.increase("c", h, A @ goal.e - K @ goal.w)
    statement = lasalle(
        goal.under(L @ c.value + goal.gravity),
        goal.w @ goal.M @ goal.w / 2 + L.entries @ h.U,
        above=goal.mu / 2 * norm(goal.w) ** 2 + L.min * h.sum_U,
        rate=L.min * c.sector * norm(c) ** 2,
        rest=(h, L.min * norm(h) ** 2),
    )
    named = dict(statement.obligations())
    assert propose(named["h: 0 < f'"]).verdict.value == "refuted"


def test_numbers_of_an_arm_that_are_no_bounds():
    arm = load("pelican2")
    made = Regulator(constant_goal("any"), member=True)
    good = at_arm(made.argued(), arm, L="60 6", A="2 12", K="7 3")
    assert propose(good).verdict.value == "proved"
    ((name, number),) = good.numbers
    assert name == "f_load"
    low = StableArm(good.argument, good.arm, good.gains, ((name, number / 4),))
    assert propose(low).verdict.value != "proved"
    weak = at_arm(made.argued(), arm, L="3 6", A="40 12", K="7 3")
    assert "condition 1" in why(weak)
    soft = at_arm(made.argued(), arm, L="60 6", A="1/10 12", K="7 3")
    assert "condition 1" in why(soft)
    steepless = replace(made.argued().argument.system.functions[0].member, steep=None)
    argument = good.argument
    first = replace(argument.system.functions[0], member=steepless)
    system = replace(argument.system, functions=(first, *argument.system.functions[1:]))
    with pytest.raises(Refused, match="is no such bound"):
        replace(good, argument=replace(argument, system=system)).require_well_formed()
