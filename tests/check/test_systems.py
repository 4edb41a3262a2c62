"""Closed loops as data: what is derived from them, and arguments of an attacker, which must be refused."""

import json
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from lyapcheck.certificate import to_json
from lyapcheck.check.codec import from_json
from lyapcheck.check.kinds.every_n import EveryN
from lyapcheck.check.kinds.stability import ByObligations, Stable
from lyapcheck.check.kinds.stable_arm import StableArm, hessian
from lyapcheck.check.refusal import Refused
from lyapcheck.check.statement import Statement, Witness
from lyapcheck.check.systems.argument import Rest
from lyapcheck.check.systems.forms import is_positive
from lyapcheck.check.systems.system import Entrywise
from lyapcheck.check.systems.theorems import THEOREMS
from lyapcheck.check.verify import verify
from lyapcheck.claims import any_matrix, any_vector, cosh, diagonal, dot, expr, log, sqrt, tanh, var
from lyapcheck.claims.arguments import (
    at_arm,
    cascade,
    exponential,
    form_of,
    input_to_state,
    lasalle,
    strict,
    uniform,
)
from lyapcheck.claims.goals import constant_goal, moving_goal, norm
from lyapcheck.claims.procedures import propose
from lyapcheck.robots import load
from lyapcheck.robots.numeric import NumericModel
from lyapcheck.robots.trig import to_terms

x = var("x")
TANH = {"gamma": 1, "rho": 1, "secant": 1, "low": "1/2"}


class PD:
    """PD control with gravity compensation, and what shows it to be stable."""

    def __init__(self, goal=None, torque=None, **constants):
        self.goal = goal = goal or constant_goal()
        self.e, self.w, self.M = goal.e, goal.w, goal.M
        self.K, self.D = goal.gains("Kp Kv")
        self.r, self.b = norm(self.e), norm(self.w)
        self.pd = self.K @ self.e - self.D @ self.w
        self.V = self.w @ self.M @ self.w / 2 + self.e @ self.K @ self.e / 2
        self.above = goal.mu / 2 * self.b**2 + self.K.min / 2 * self.r**2
        self.rate, self.rest = self.D.min * self.b**2, (self.e, self.K.min * self.r**2)
        self.torque = self.pd + goal.gravity if torque is None else torque(self)

    def argued(self, theorem=lasalle, **changed):
        own = {"above": self.above, "rate": self.rate}
        own |= {"rest": self.rest} if theorem is lasalle else {}
        V = changed.pop("V", self.V)
        return theorem(self.goal.under(changed.pop("torque", self.torque)), V, **(own | changed))


def why(statement):
    result = propose(statement)
    assert result.verdict.value != "proved"
    return result.reason


def test_the_proof_that_faults_are_planted_in():
    statement = PD().argued()
    result = propose(statement)
    assert result.verdict.value == "proved"
    again = from_json(Statement, json.loads(json.dumps(to_json(statement))), "statement")
    assert again == statement
    assert verify(again, result.proof).grade == "exact"


# What is derived ------------------------------------------------------------------------------------------


def equal(left, right):
    """Whether two vectors are equal for every n."""
    test = ("vec", "x")
    return propose(EveryN(("dot", test, left), ("dot", test, right.tree))).verdict.value


def test_the_force_of_a_regulator_is_that_of_11():
    pd = PD(constant_goal())
    C, B = any_matrix("C"), diagonal(any_vector("B"))
    assert equal(pd.goal.under(pd.torque).force, pd.pd - C @ pd.w - B @ pd.w) == "proved"
    assert equal(pd.goal.under(pd.torque).force, pd.pd - C @ pd.w) == "refuted"
    soft = pd.goal.under(pd.pd + pd.goal.gravity_at_goal).force
    assert equal(soft, pd.pd - C @ pd.w - B @ pd.w - any_vector("dg")) == "proved"


def test_the_force_of_a_tracking_scheme_is_that_of_21():
    pd = PD(moving_goal())
    goal, C = pd.goal, any_matrix("C") + any_matrix("D")
    torque = pd.torque + pd.M @ goal.acceleration + goal.C @ goal.velocity + goal.B @ goal.velocity
    assert equal(goal.under(torque).force, pd.pd - C @ pd.w - goal.B @ pd.w) == "proved"
    frictionless = replace(goal.under(torque), friction="none").force
    assert equal(frictionless, pd.pd - C @ pd.w + goal.B @ goal.velocity) == "proved"


def test_m_cancels_only_where_all_of_the_force_has_it():
    """M ẇ = M b gives ẇ = b; not where a part has no M, another matrix, or M in a number."""
    for change, free in (
        (lambda pd, goal: 0 * pd.e, True),
        (lambda pd, goal: pd.M @ (pd.K @ pd.w), True),
        (lambda pd, goal: pd.e, False),
        (lambda pd, goal: goal.C @ pd.w, False),
        (lambda pd, goal: any_matrix("dM") @ pd.e, False),
        (lambda pd, goal: (pd.w @ pd.M @ pd.w) * pd.M @ pd.e, False),
        (lambda pd, goal: pd.K @ (pd.M @ pd.e), False),
    ):
        goal = moving_goal()
        pd = PD(goal)
        velocity = goal.velocity + pd.w
        more = goal.C @ velocity + goal.gravity + goal.B @ velocity + change(pd, goal)
        system = goal.under(pd.M @ (goal.acceleration + pd.pd) + more)
        assert (system.acceleration != ("vec", "dw")) is free
        assert system.rates()["vec", "w"] == system.acceleration
    arm = PD(moving_goal()).goal.under(any_matrix("M") @ any_vector("ddqd"))
    assert arm.acceleration == ("vec", "dw")


def test_the_slopes_of_gravity_are_those_of_the_robot():
    robot = load("pelican2").fixed()
    entries = hessian(tuple(to_terms(robot.potential)), 2)
    model, q, step = NumericModel(robot), np.array([0.3, -1.1]), 1e-6

    def at(entry, q):
        harmonics = [*np.sin(q), *np.cos(q)]
        return sum(
            float(c) * np.prod([v**p for v, p in zip(harmonics, powers, strict=True)]) for powers, c in entry
        )

    for j in range(2):
        ahead, behind = q.copy(), q.copy()
        ahead[j] += step
        behind[j] -= step
        slope = (model.gravity(ahead[None]) - model.gravity(behind[None]))[0] / (2 * step)
        assert [at(entries[2 * i + j], q) for i in range(2)] == pytest.approx(list(slope), abs=1e-6)


# Systems --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("torque", "reason"),
    [
        (lambda pd: pd.pd + any_vector("dw"), "dw: has no meaning"),
        (lambda pd: pd.pd + any_vector("P"), "P: has no meaning"),
        (lambda pd: pd.pd + any_vector("magic"), "magic: has no meaning"),
        (lambda pd: pd.pd + any_matrix("A") @ pd.e, "A: has no meaning"),
        (lambda pd: pd.pd + pd.goal.gravity + pd.goal.velocity, "dqd: has no meaning"),
        (lambda pd: pd.pd + pd.goal.gravity + var("norm_e") * pd.e, "norm_e: has no meaning"),
        (lambda pd: pd.pd, "origin: it is refuted"),
        (lambda pd: pd.pd + pd.goal.gravity + pd.goal.gravity_at_goal, "origin: it is refuted"),
        (lambda pd: -pd.pd + pd.goal.gravity, "rate: it is refuted"),
    ],
)
def test_a_torque_that_is_another_one(torque, reason):
    assert reason in why(PD(torque=torque).argued())


@pytest.mark.parametrize("name", ["x", "mu", "kc", "e", "dw", "s", "eps0", "K_min", "Kp", "n", "B", "norm"])
def test_a_name_that_is_taken_or_could_be_mistaken(name):
    pd = PD()
    with pytest.raises(ValueError, match=r"is taken|underscore"):
        pd.goal.gains(name)
    argument = pd.argued().argument
    named = replace(argument.system, gains=(*argument.system.gains, name))
    refused = why(Stable(replace(argument, system=named)))
    assert "is taken" in refused or "underscore" in refused


@pytest.mark.parametrize("field", ["gains", "constants", "functions"])
def test_words_in_a_name_that_no_expression_has(field):
    argument = PD().argued().argument
    words = "c > 0 and every saturated torque"
    new = Entrywise(words, "e", True, None) if field == "functions" else words
    system = replace(argument.system, **{field: (*getattr(argument.system, field), new)})
    assert "is not a name" in why(Stable(replace(argument, system=system)))


def test_a_function_of_what_is_no_state():
    pd = PD()
    with pytest.raises(ValueError, match="is of one state"):
        pd.goal.entrywise("h", any_vector("g"))


def test_nothing_can_be_typed_beside_the_system():
    data = to_json(PD().argued())
    for key in ("rates", "norms", "least", "given"):
        for where in (data, data["argument"], data["argument"]["system"]):
            with pytest.raises(Refused):
                from_json(
                    Statement,
                    json.loads(
                        json.dumps(
                            {**data, key: []}
                            if where is data
                            else data | {"argument": {**data["argument"], key: []}}
                        )
                    ),
                    "statement",
                )


# Theorems -------------------------------------------------------------------------------------------------


def test_lasalles_theorem_is_not_for_what_depends_on_time():
    pd = PD(moving_goal())
    torque = (
        pd.torque + pd.M @ pd.goal.acceleration + pd.goal.C @ pd.goal.velocity + pd.goal.B @ pd.goal.velocity
    )
    assert "is not for q_d(t)" in why(pd.argued(torque=torque))
    assert "is not for q_d(t)" in why(pd.argued(strict, torque=torque, rate=pd.rate + pd.r**2))


def test_what_a_form_does_not_see():
    pd = PD()
    assert "e: must be seen by sizes that grow" in why(pd.argued(above=pd.goal.mu / 2 * pd.b**2))
    assert "rest = e: must be seen" in why(pd.argued(rest=None))
    assert "rate = e: must be seen" in why(pd.argued(strict))
    assert "rest = w: must stand still before" in why(pd.argued(rate=pd.K.min * pd.r**2))
    assert "rest: it is refuted" in why(pd.argued(rest=(pd.e, 2 * pd.K.min * pd.r**2)))
    assert "rest: it is refuted" in why(pd.argued(rest=(-pd.e, pd.K.min * pd.r**2)))


def test_a_form_that_is_not_positive():
    pd = PD()
    assert "above, minor 1" in why(pd.argued(above=pd.goal.mu / 2 * pd.b**2 - pd.K.min * pd.r**2))
    assert "rate, minor 1" in why(pd.argued(rate=0 * pd.b**2 - pd.D.min * pd.b**2))
    assert "rest, minor 1" in why(pd.argued(rest=(pd.e, -pd.K.min * pd.r**2)))


def test_three_sizes_in_a_chain_are_decided_by_their_minors():
    """a r² − 2x r v + b v² − 2y v z + c z²: 2x² < ab and 2y² < bc are enough; without the 2 they are not."""
    goal = constant_goal()
    a, b, c, x, y = goal.constants("a b c f k")
    system = goal.under(-1 * goal.w)
    r, v, z = (var(f"norm_{name}") for name in ("e", "w", "z"))
    form = form_of(a * r**2 - 2 * x * r * v + b * v**2 - 2 * y * v * z + c * z**2)
    for share, proved in ((2, True), (1, False)):
        where = (share * x**2 < a * b, share * y**2 < b * c)
        found = [
            propose(is_positive(system, tree, where, False)).verdict.value for _, tree in form.positive()
        ]
        assert found[:2] == ["proved", "proved"]
        assert (found[2] == "proved") is proved


def test_coefficients_are_constants():
    pd = PD()
    assert "goes to 0 far away" in why(
        pd.argued(above=pd.goal.mu / 2 * pd.b**2 + pd.goal.s * pd.K.min / 2 * pd.r**2)
    )
    free = form_of(var("free") * pd.b**2)
    assert "are no constants" in why(Stable(replace(pd.argued().argument, rate=free)))
    with pytest.raises(ValueError, match="Kv_mn is no constant or size of this system; did you mean Kv_min"):
        pd.argued(rate=var("Kv_mn") * pd.b**2)
    assert "must be about constants" in why(pd.argued(where=[pd.r < 1]))
    assert "must be about constants" in why(pd.argued(small=True, where=[pd.goal.eps0 > 1]))
    magic = form_of(pd.above + var("norm_magic") ** 2)
    assert "is not one of a state" in why(Stable(replace(pd.argued().argument, lower=magic)))


def test_a_bounded_size_does_not_grow():
    goal = constant_goal()
    K, D = goal.gains("Kp Kv")
    h = goal.entrywise("h", goal.e)
    loop = goal.under(K @ h - D @ goal.w + goal.gravity)
    V = goal.w @ goal.M @ goal.w / 2 + K.entries @ h.U
    kinetic = goal.mu / 2 * norm(goal.w) ** 2
    rest = {"rate": D.min * norm(goal.w) ** 2, "rest": (h, K.min * norm(h) ** 2)}
    assert propose(lasalle(loop, V, above=kinetic + K.min * h.sum_U, **rest)).verdict.value == "proved"
    assert "e: must be seen by sizes that grow" in why(
        lasalle(loop, V, above=kinetic + K.min * norm(h) ** 2, **rest)
    )


def test_where_v_has_a_corner():
    pd = PD()
    eps = pd.goal.eps0 * pd.goal.s
    for corner in (eps, eps * pd.w @ pd.M @ pd.w, eps * pd.w @ pd.w, pd.goal.s):
        assert "V is not C¹" in why(pd.argued(V=pd.V + corner)) or "V at the origin" in why(
            pd.argued(V=pd.V + corner)
        )
    assert "not a polynomial" in why(pd.argued(V=sqrt(pd.V)))
    assert "no meaning in V" in why(pd.argued(V=pd.V + pd.e @ any_vector("dg")))
    assert "no meaning in V" in why(pd.argued(V=pd.V + pd.r**2))
    assert "V at the origin" in why(pd.argued(V=pd.V + 1))


def test_letters_are_changed_one_to_one():
    pd = PD()
    y, z = any_vector("y_w"), any_vector("y_e")
    for state, equals, reason in (
        ("w", 2 * y, "must be ±y_w"),
        ("w", y + y, "must be ±y_w"),
        ("w", pd.e, "must be ±y_w"),
        ("w", y + pd.w, "w: has no meaning"),
        ("w", pd.M @ y, "M: has no meaning"),
        ("w", y + pd.goal.mu * pd.e, "mu: has no meaning"),
        ("w", y + diagonal(y) @ pd.e, "must be ±y_w"),
        ("e", z + pd.w, "is a size of its own"),
        ("q", y, "is no state"),
    ):
        assert reason in why(pd.argued(changes={state: equals}))


def test_exponential_needs_norms():
    pd = PD()
    below = pd.goal.beta / 2 * pd.b**2 + pd.K.max / 2 * pd.r**2
    assert "e: must be seen" in why(pd.argued(exponential, below=below))
    eps = pd.goal.eps0 * pd.goal.s
    varying = pd.rate + eps * pd.K.min * pd.r**2
    assert "s: varies" in why(pd.argued(exponential, below=below, rate=varying))


@pytest.mark.parametrize(
    "added",
    [
        lambda pd: diagonal(pd.e) @ pd.e,
        lambda pd: pd.goal.eps0 * pd.e,
        lambda pd: dot(pd.e, pd.e) * pd.e,
        lambda pd: pd.K.entries,
    ],
)
def test_where_decay_is_exponential_letters_are_changed_linearly(added):
    """Norms of y and e would bound w by a power of them, which no exponential estimate follows from."""
    pd = PD()
    below = pd.goal.beta / 2 * pd.b**2 + pd.K.max / 2 * pd.r**2
    y, whole = any_vector("y_w"), pd.D.min * pd.b**2 + pd.K.min * pd.r**2
    made = {"above": pd.goal.mu / 2 * norm(y) ** 2 + pd.K.min / 2 * pd.r**2, "below": below, "rate": whole}
    reason = why(pd.argued(exponential, changes={"w": y + added(pd)}, **made))
    assert "change = w: must be linear" in reason
    assert "must be linear" not in why(pd.argued(exponential, changes={"w": y - pd.K @ pd.e}, **made))


def test_a_bound_that_holds_nearby_concludes_nothing_far_away():
    pd = PD()
    below = pd.goal.beta / 2 * pd.b**2 + pd.K.max / 2 * pd.r**2
    assert "rate: it is refuted" in why(pd.argued(uniform, below=below, rate=pd.rate + pd.r**2, local=True))
    assert "attracts where ‖e‖ ≤ R and V is below" in pd.argued(local=True).text()
    assert "globally" not in pd.argued(local=True).text()


def shaken(**changed):
    """The loop of ``slotine_li.py`` under an unknown torque."""
    goal = moving_goal(disturbed=changed.pop("disturbed", True))
    e, w, M = goal.e, goal.w, goal.M
    K, L = goal.gains("K Lambda")
    s, y, r, b = L @ e - w, any_vector("y_w"), norm(e), norm(w)
    reference = goal.velocity + L @ e
    torque = M @ (goal.acceleration - L @ w) + goal.C @ reference + goal.B @ reference + goal.gravity + K @ s
    own = {
        "changes": {"w": L @ e - y},
        "above": goal.mu / 2 * norm(y) ** 2 + L.min * K.min * r**2,
        "below": goal.beta / 2 * (L.max * r + b) ** 2 + L.max * (K.max + goal.B.max) * r**2,
        "rate": K.min * b**2 + L.min**2 * K.min * r**2,
        "gain": L.max * r + b,
    }
    V = s @ M @ s / 2 + e @ L @ K @ e + e @ L @ goal.B @ e
    return input_to_state(goal.under(torque + changed.pop("more", 0 * e)), V, **(own | changed))


@pytest.mark.slow
def test_a_disturbance_is_unknown_and_bounded():
    assert propose(shaken()).verdict.value == "proved"
    r, b = var("norm_e"), var("norm_w")
    assert "must be in the system, the theorem and its gain" in why(shaken(disturbed=False))
    assert "must be in the system, the theorem and its gain" in why(shaken(gain=None))
    assert "must be linear in the norms" in why(shaken(gain=r * b))
    assert "rate:" in why(shaken(gain=b))
    assert "rate:" in why(shaken(gain=(var("Lambda_max") * r + b) / 2))
    assert "d: has no meaning" in why(shaken(more=any_vector("d")))
    uniformly = replace(shaken().argument, theorem="uniform")
    assert "must be in the system, the theorem and its gain" in why(Stable(uniformly))


def passive(goal=None, w=None, **changed):
    """Slotine and Li's controller, by ½yᵀMy alone, with w = Λe − y."""
    goal = goal or moving_goal()
    e, B = goal.e, goal.B
    K, L = goal.gains("K Lambda")
    y, r = any_vector("y_w"), norm(e)
    s, ahead = L @ e - goal.w, goal.velocity + L @ e
    torque = goal.M @ (goal.acceleration - L @ goal.w) + goal.C @ ahead + B @ ahead + goal.gravity + K @ s
    size = norm(y)
    own = {
        "changes": {"w": L @ e - y if w is None else w(L, e, y)},
        "above": goal.mu / 2 * size**2,
        "rate": K.min * size**2,
        "motion": (goal.kc * (goal.vd + norm(goal.w)) + K.max + B.max) * size,
        "contraction": L.min * r**2 - r * size,
    }
    return cascade(goal.under(torque), s @ goal.M @ s / 2, **(own | changed))


def test_a_cascade_attracts_and_says_nothing_of_stability():
    statement = passive()
    result = propose(statement)
    assert result.verdict.value == "proved"
    assert "globally attractive" in statement.text()
    assert "stable" not in statement.text().split(" under ")[0]
    again = from_json(Statement, json.loads(json.dumps(to_json(statement))), "statement")
    assert verify(again, result.proof).grade == "exact"


def test_what_a_cascade_asks_for():
    """Boundedness, that y moves continuously, and that the error follows it."""
    r, b, size, one = var("norm_e"), var("norm_w"), var("norm_y_w"), expr(1)
    K, L = var("K_min"), var("Lambda_min")
    s = var("s")
    assert "must be seen by sizes" in why(passive(above=r**2))
    assert "must be one of its sizes" in why(passive(above=var("mu") / 2 * b**2))
    assert "must be one of its sizes" in why(passive(rate=K * b**2))
    assert "rate, minor" in why(passive(rate=-K * size**2))
    assert "rate = s: varies" in why(passive(rate=K * s * size**2))
    assert "cascade, motion" in why(passive(motion=(var("K_max") + var("B_max")) * size))
    assert "not a polynomial" in why(passive(motion=one / r))
    assert "must be in sizes and constants" in why(passive(motion=s * size))
    with pytest.raises(ValueError, match="norm_x is no constant or size"):
        passive(motion=var("norm_x"))
    assert "contraction ‖e‖²" in why(passive(contraction=-L * r**2 - r * size))
    assert "must be quadratic in norm_e" in why(passive(contraction=L * r**2 - r * b))
    assert "must be quadratic in norm_e" in why(passive(contraction=-size * r - b**2))
    assert "varies" in why(passive(contraction=L * s * r**2 - r * size))


def test_where_the_changed_letter_does_not_lead():
    """w = y alone leaves e where it is; a constant in w, and a state of the controller, keep it from 0."""
    for w, fails in (
        (lambda L, e, y: -1 * y, "contraction"),
        (lambda L, e, y: -1 * (L @ e) - y, "contraction"),
        (lambda L, e, y: L @ e - y + any_vector("K"), "w where e and y are 0"),
    ):
        statement = passive(w=w)
        why(statement)
        assert propose(dict(statement.obligations())[f"cascade, {fails}"]).verdict.value != "proved"


def test_a_state_of_the_controller_must_be_bounded():
    goals = [moving_goal() for _ in range(3)]
    for goal in goals:
        goal.state("z", goal.e)
    above = goals[0].mu / 2 * var("norm_y_w") ** 2 + var("norm_z") ** 2
    changes = {"w": goals[0].e - any_vector("y_w"), "z": any_vector("y_z")}
    assert "lower = z" in why(passive(goals[0]))
    assert "above:" in why(passive(goals[1], above=above))
    assert "must be of w alone" in why(passive(goals[2], above=above, changes=changes))


def test_parts_of_a_cascade_belong_to_it():
    argument = passive().argument
    assert "has its own data" in why(Stable(replace(argument, cascade=None)))
    assert "has its own data" in why(Stable(replace(argument, theorem="uniform", upper=argument.lower)))
    assert "is for LaSalle" in why(Stable(replace(argument, rest=Rest(any_vector("e"), argument.rate))))


def ahead(goal=None, e_share=1, **numbers):
    """M(q_d)q̈_d in the torque of a computed torque: what it lacks is at most km ad ‖e‖."""
    goal = goal or moving_goal()
    e, w, M = goal.e, goal.w, goal.M
    K, D = goal.gains("Kp Kv")
    (a,) = goal.constants("a")
    r, b, k_h = norm(e), norm(w), e_share * goal.km * goal.ad
    rest = goal.C @ goal.velocity + goal.gravity + goal.B @ goal.velocity
    loop = goal.under(K @ e - D @ w + goal.M_at_goal @ goal.acceleration + rest)
    cross = k_h + a * (D.max + goal.B.max + goal.kc * goal.vd)
    low = D.min - a * (goal.beta + goal.kc * goal.R)
    above = goal.mu / 2 * b**2 + K.min / 2 * r**2 - a * goal.beta * r * b
    statement = exponential(
        loop,
        w @ M @ w / 2 + e @ K @ e / 2 - a * e @ M @ w,
        above=above,
        below=goal.beta / 2 * b**2 + K.max / 2 * r**2 + a * goal.beta * r * b,
        rate=a * (K.min - k_h) * r**2 - cross * r * b + low * b**2,
        where=[
            a**2 * goal.beta**2 < goal.mu * K.min,
            k_h < K.min,
            a * (goal.beta + goal.kc * goal.R) < D.min,
            cross**2 / 4 < a * (K.min - k_h) * low,
        ],
        local=True,
    )
    given = {"Kp": "90 90", "Kv": "30 30", "a": "1", "R": "1/4", "vd": "0.1", "ad": "0.1"}
    return statement, at_arm(statement, load("pelican2"), **(given | numbers))


@pytest.mark.slow
def test_what_differs_between_the_arm_and_its_goal():
    """It is granted in proportion to the error, and shown for an arm by the slopes of M."""
    statement, arm = ahead()
    assert propose(statement).verdict.value == propose(arm).verdict.value == "proved"
    said = " ".join(statement.granted)
    assert "‖M(q) − M(p)‖ ≤ km" in said
    assert "‖q̈_d‖ ≤ ad" in said
    assert "kc2" not in said
    assert "exponentially stable, and attracts where ‖e‖ ≤ R and Φ is below" in statement.text()
    small = tuple((name, value / 100 if name == "km" else value) for name, value in arm.numbers)
    assert "km:" in why(replace(arm, numbers=small))
    assert "rate: no choice" in why(ahead(e_share=expr("1/2"))[0])
    assert "dM: has no meaning" in why(PD().argued(torque=any_matrix("dM") @ any_vector("e")))
    assert "is no theorem with a region" in why(Stable(replace(shaken().argument, local=True)))


def test_a_theorem_that_the_checker_does_not_know():
    argument = replace(PD().argued().argument, theorem="magic")
    assert "is not one that the checker knows" in why(Stable(argument))
    assert set(THEOREMS) == {"strict", "LaSalle", "uniform", "exponential", "ISS", "cascade", "convergence"}


def test_conditions_that_nothing_meets_show_nothing():
    """K_v with the wrong sign: dV/dt ≤ λmax(K_v)‖q̇‖², which no condition on positive gains makes negative."""
    pd = PD()
    most = pd.D.max * pd.b**2
    sets = {
        "K_v,min = 0 alone meets them": [-pd.D.min * pd.D.max >= pd.D.min],
        "least above greatest": [pd.D.max < pd.D.min, -pd.D.max >= pd.D.min - pd.D.max],
    }
    for conditions in sets.values():
        stable = pd.argued(torque=pd.K @ pd.e + pd.D @ pd.w + pd.goal.gravity, rate=-most, where=conditions)
        assert "no constants were found that meet them" in why(stable)
        for _, one in stable.obligations():
            assert propose(one).verdict.value == "proved"
        proofs = tuple(propose(one).proof for _, one in stable.obligations())
        for met in (None, Witness((("Kv_max", Fraction(7)), ("Kv_min", Fraction(3))))):
            with pytest.raises(Refused, match=r"met|point"):
                verify(stable, ByObligations(proofs, met))
    on_arm = at_arm(
        pd.argued(where=sets["K_v,min = 0 alone meets them"]), load("pelican2"), Kp="30 30", Kv="7 3"
    )
    numbers = tuple((name, Fraction(0) if name == "Kv_min" else value) for name, value in on_arm.numbers)
    assert "Kv_min = 0: is no such bound" in why(replace(on_arm, numbers=numbers))


def test_conditions_are_met_at_the_point_given():
    stable = PD().argued(where=[var("kg") < var("Kp_min")])
    proof = propose(stable).proof
    assert verify(stable, proof).verdict == "proved"
    again = from_json(type(proof), json.loads(json.dumps(to_json(proof))), "proof")
    assert again == proof
    for point in ((("Kp_min", Fraction(1)), ("kg", Fraction(1))), (("Kp_min", Fraction(1)),)):
        with pytest.raises(Refused):
            verify(stable, replace(proof, met=Witness(point)))
    with pytest.raises(Refused, match="must be given where there are conditions"):
        verify(PD().argued(), replace(proof, proofs=propose(PD().argued()).proof.proofs))


def test_proofs_of_other_obligations_show_nothing():
    statement = PD().argued()
    proof = propose(statement).proof
    for proofs in (proof.proofs[:-1], proof.proofs[::-1], (*proof.proofs, proof.proofs[0]), ()):
        with pytest.raises(Refused):
            verify(statement, ByObligations(proofs))
    stronger = PD().argued(rate=2 * var("Kv_min") * var("norm_w") ** 2)
    with pytest.raises(Refused):
        verify(stronger, proof)


# Functions ------------------------------------------------------------------------------------------------


def regulator(value, potential, **numbers):
    goal = constant_goal("none")
    K, D = goal.gains("Kp Kv")
    h = goal.function("h", goal.e, value, potential, **(TANH | numbers))
    loop = goal.under(K @ h - D @ goal.w + goal.gravity)
    V = goal.w @ goal.M @ goal.w / 2 + K.entries @ h.U
    above = goal.mu / 2 * norm(goal.w) ** 2 + K.min * h.sum_U
    return lasalle(loop, V, above=above, rate=D.min * norm(goal.w) ** 2, rest=(h, K.min * norm(h) ** 2))


U = log(cosh(x))


@pytest.mark.slow
def test_members_of_the_class():
    assert propose(regulator(tanh(x), U)).verdict.value == "proved"
    root = sqrt(1 + x**2)
    assert propose(regulator(x / root, root - 1)).verdict.value == "proved"


@pytest.mark.parametrize(
    ("value", "potential", "numbers"),
    [
        (-tanh(x), -U, {}),
        (tanh(x), 2 * U, {}),
        (tanh(x), U + 1, {}),
        (tanh(x), U, {"rho": "1/2"}),
        (tanh(x), U, {"secant": "1/2"}),
        (tanh(x), U, {"gamma": "1/2"}),
        (tanh(x), U, {"low": 2}),
        (tanh(x), U, {"low": -1}),
        (tanh(x), U, {"low": "1/2", "start": -1}),
        (x**3, x**4 / 4, {"gamma": None}),
        (x, x**2 / 2, {}),
        (x - tanh(2 * x), x**2 / 2 - log(cosh(2 * x)) / 2, {"gamma": None, "rho": 2, "secant": 2}),
        (tanh(x) + 1, U + x, {"gamma": 2}),
        (x / (1 + x**2), log(1 + x**2) / 2, {}),
    ],
)
def test_what_is_no_member_of_the_class(value, potential, numbers):
    assert propose(regulator(value, potential, **numbers)).verdict.value != "proved"


# One arm --------------------------------------------------------------------------------------------------


def tomei():
    pd = PD(torque=lambda pd: pd.pd + pd.goal.gravity_at_goal)
    kg = pd.goal.kg
    above = pd.goal.mu / 2 * pd.b**2 + (pd.K.min - kg) / 2 * pd.r**2
    rest = (pd.e, (pd.K.min - kg) * pd.r**2)
    return pd.argued(gravity=True, where=[kg < pd.K.min], above=above, rest=rest)


def test_one_arm_with_its_numbers():
    robot = load("pelican2")
    stable = at_arm(tomei(), robot, Kp="30 30", Kv="7 3")
    assert propose(stable).verdict.value == "proved"
    assert "condition 1: 11.9939 < 10 is refuted" in why(at_arm(tomei(), robot, Kp="10 30", Kv="7 3"))
    numbers = dict(stable.numbers)

    def altered(**changed):
        return replace(stable, numbers=tuple(sorted((numbers | changed).items())))

    assert "kg: it is refuted" in why(altered(kg=numbers["kg"] / 2))
    assert "Kp_min" in why(altered(Kp_min=Fraction(31)))
    assert "must be those of the conditions" in why(altered(beta=Fraction(1)))
    assert "must be those of the conditions" in why(replace(stable, numbers=()))
    for gains in (
        (("Kp", (Fraction(30), Fraction(-30))), ("Kv", (Fraction(7), Fraction(3)))),
        (("Kp", (Fraction(30),)), ("Kv", (Fraction(7), Fraction(3)))),
        (("Kv", (Fraction(7), Fraction(3))), ("Kp", (Fraction(30), Fraction(30)))),
    ):
        assert "must be" in why(replace(stable, gains=gains))
    indefinite = replace(stable.arm, mass=((stable.arm.mass[1][1], ()), ((), ())))
    assert "M:" in why(replace(stable, arm=indefinite))


def test_friction_that_a_system_does_not_have():
    arm = load("pelican2")
    goal = constant_goal("none")
    stable = at_arm(PD(goal).argued(), arm, Kp="30 30", Kv="7 3")
    assert any(stable.arm.viscous)
    assert "is none in this system" in why(stable)
    assert isinstance(stable, StableArm)


def test_a_form_is_quadratic():
    r, b = var("norm_e"), var("norm_w")
    assert form_of(r**2 + 2 * r * b).sizes == ("norm_e", "norm_w")
    for wrong in (r**3, r * b * b, expr(1) + r**2):
        with pytest.raises(ValueError, match="a form is quadratic"):
            form_of(wrong)
