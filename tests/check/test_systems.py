"""Closed loops as data: what is derived from them, and arguments of an attacker, which must be refused."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from lyapcheck.check.kinds.every_n import EveryN
from lyapcheck.check.kinds.stability import ByObligations, Stable
from lyapcheck.check.kinds.stable_arm import hessian
from lyapcheck.check.refusal import Refused
from lyapcheck.check.statement import Witness
from lyapcheck.check.systems.forms import is_positive
from lyapcheck.check.verify import verify
from lyapcheck.claims import any_matrix, any_vector, diagonal, expr, var
from lyapcheck.claims.arguments import at_arm, cascade, form_of, lasalle, strict, uniform
from lyapcheck.claims.goals import constant_goal, moving_goal, norm
from lyapcheck.claims.procedures import propose
from lyapcheck.robots import load
from lyapcheck.robots.numeric import NumericModel
from lyapcheck.robots.trig import to_terms
from tests.helpers.stated import verdict, why

x = var("x")


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


def test_the_proof_that_faults_are_planted_in():
    statement = PD().argued()
    assert verdict(statement) == "proved"


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


def test_a_function_of_what_is_no_state():
    pd = PD()
    with pytest.raises(ValueError, match="is of one state"):
        pd.goal.entrywise("h", any_vector("g"))


# Theorems -------------------------------------------------------------------------------------------------


def test_lasalles_theorem_is_not_for_what_depends_on_time():
    pd = PD(moving_goal())
    torque = (
        pd.torque + pd.M @ pd.goal.acceleration + pd.goal.C @ pd.goal.velocity + pd.goal.B @ pd.goal.velocity
    )
    assert "is not for q_d(t)" in why(pd.argued(torque=torque))
    assert "is not for q_d(t)" in why(pd.argued(strict, torque=torque, rate=pd.rate + pd.r**2))


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


def test_a_bound_that_holds_nearby_concludes_nothing_far_away():
    pd = PD()
    below = pd.goal.beta / 2 * pd.b**2 + pd.K.max / 2 * pd.r**2
    assert "rate: it is refuted" in why(pd.argued(uniform, below=below, rate=pd.rate + pd.r**2, local=True))
    assert "attracts where ‖e‖ ≤ R and V is below" in pd.argued(local=True).text()
    assert "globally" not in pd.argued(local=True).text()


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
    assert verdict(statement) == "proved"
    assert "globally attractive" in statement.text()
    assert "stable" not in statement.text().split(" under ")[0]


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


def test_a_form_is_quadratic():
    r, b = var("norm_e"), var("norm_w")
    assert form_of(r**2 + 2 * r * b).sizes == ("norm_e", "norm_w")
    for wrong in (r**3, r * b * b, expr(1) + r**2):
        with pytest.raises(ValueError, match="a form is quadratic"):
            form_of(wrong)
