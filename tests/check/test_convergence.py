"""Convergence of a part: free regressors, and loops close to the rule that do not converge."""

from random import Random

import pytest

from lyapcheck.claims import any_vector, constant_goal, converges, expr, moving_goal, norm, transpose
from lyapcheck.claims.procedures import propose
from tests.helpers.shares import one_in
from tests.helpers.stated import verdict, why
from tests.oracle.stability import stable


def fails(statement):
    """Whether the equations of motion of some arm and regressor refute the conclusion."""
    return stable(statement, Random(1)) is not None


class Adaptive:
    """Slotine and Li's adaptive controller: s = Le − w, τ = … + Ks + YGf, df/dt = Yᵀs."""

    def __init__(self, rate=None, damping=1, more=None, goal=None, bounded=True, gains="p"):
        self.goal = goal = goal or moving_goal()
        self.e, self.w, self.M, self.f = goal.e, goal.w, goal.M, any_vector("f")
        self.K, self.L = goal.gains("K L")
        (self.G,) = goal.gains("G", size=gains)
        self.Y = goal.known("Y", columns="p", bounded=bounded)
        self.Z = goal.known("Z", columns="p", bounded=bounded)
        self.s, self.y = self.L @ self.e - self.w, any_vector("y_w")
        goal.state("f", transpose(self.Y) @ self.s if rate is None else rate(self), size="p")
        ahead = self.L @ self.e
        model = self.M @ (-1 * self.L @ self.w) + goal.C @ ahead + goal.B @ ahead + goal.gravity
        if goal.desired:
            model = model + self.M @ goal.acceleration + (goal.C + 0 * self.M) @ goal.velocity
            model = model + goal.B @ goal.velocity
        self.torque = model + damping * self.K @ self.s + self.Y @ (self.G @ self.f)
        self.torque = self.torque if more is None else self.torque + more(self)
        r, b, c, K, L, G = norm(self.e), norm(self.w), norm(self.f), self.K, self.L, self.G
        self.V = self.s @ self.M @ self.s / 2 + self.e @ L @ K @ self.e + self.e @ L @ goal.B @ self.e
        self.V = self.V + self.f @ G @ self.f / 2
        self.own = {
            "changes": {"w": L @ self.e - self.y},
            "above": goal.mu / 2 * norm(self.y) ** 2 + L.min * K.min * r**2 + G.min / 2 * c**2,
            "below": goal.beta / 2 * (L.max * r + b) ** 2
            + L.max * (K.max + goal.B.max) * r**2
            + G.max / 2 * c**2,
            "rate": K.min * b**2 + L.min**2 * K.min * r**2,
        }

    def argued(self, theorem=converges, **changed):
        own = self.own | ({"to_zero": [self.e, self.w]} if theorem is converges else {}) | changed
        V = own.pop("V", self.V)
        return theorem(self.goal.under(own.pop("torque", self.torque)), V, **own)


def test_the_proof_that_faults_are_planted_in():
    statement = Adaptive().argued()
    assert verdict(statement) == "proved"
    assert not fails(statement)


def test_what_it_says_and_what_it_does_not():
    text = Adaptive().argued().text()
    conclusion = text.split(" under ")[0]
    assert conclusion == (
        "e = 0, w = 0, f = 0 is globally uniformly stable, and all motions are bounded, and e, w → 0 "
        "(nothing is said of where f goes)"
    )
    assert (
        "every n, p, every continuous n × p matrix Y of time and the states, bounded where they are" in text
    )
    assert "G of size p, f of size p" in text
    said = " ".join(Adaptive().argued().granted)
    assert "‖q̈_d‖ ≤ ad" in said
    assert "known exactly" not in said
    still = Adaptive(goal=constant_goal(), bounded=False).argued()
    assert propose(still).verdict.value == "proved"
    assert "every continuous n × p matrix Y of the states," in still.text()


# Loops that do not converge -------------------------------------------------------------------------------


def resting(**changed):
    return Adaptive(goal=constant_goal(), **changed)


def wrong_sign():
    return resting(rate=lambda a: -1 * transpose(a.Y) @ a.s).argued()


def another_regressor():
    return resting(rate=lambda a: transpose(a.Z) @ a.s).argued()


def adapts_to_speed():
    """df/dt = Yᵀe: Y and s do not meet."""
    return resting(rate=lambda a: transpose(a.Y) @ a.e).argued()


def undamped():
    """K s is taken back; e and w swing, or grow."""
    return resting(damping=-1).argued()


def energy_alone():
    """τ = Ke + g + YGf, df/dt = −Yᵀw, without damping: V is constant."""
    a = Adaptive(goal=constant_goal("none"), rate=lambda a: -1 * transpose(a.Y) @ a.w)
    V = a.w @ a.M @ a.w / 2 + a.e @ a.K @ a.e / 2 + a.f @ a.G @ a.f / 2
    r, b, c, goal = norm(a.e), norm(a.w), norm(a.f), a.goal
    return converges(
        goal.under(a.K @ a.e + goal.gravity + a.Y @ (a.G @ a.f)),
        V,
        above=goal.mu / 2 * b**2 + a.K.min / 2 * r**2 + a.G.min / 2 * c**2,
        below=goal.beta / 2 * b**2 + a.K.max / 2 * r**2 + a.G.max / 2 * c**2,
        rate=a.L.min * b**2,
        to_zero=[a.w],
    )


def gravity_left_out():
    return resting(more=lambda a: -1 * a.goal.gravity).argued()


def the_parameters_too():
    """f is said to go to 0: with a regressor that vanishes it stays where it is."""
    a = resting()
    return a.argued(rate=a.own["rate"] + a.G.min * norm(a.f) ** 2)


FALSE = (
    (wrong_sign, "rate"),
    (another_regressor, "rate"),
    (adapts_to_speed, "rate"),
    (undamped, "rate"),
    (energy_alone, "rate"),
    (gravity_left_out, "origin"),
    (the_parameters_too, "rate"),
)


@pytest.mark.parametrize(("loop", "reason"), one_in(5, FALSE))
def test_a_loop_that_does_not_converge_is_not_proved(loop, reason):
    statement = loop()
    assert fails(statement), "the loop is no counterexample"
    assert reason in why(statement)


# What is asked of the data --------------------------------------------------------------------------------


def test_a_state_that_the_rate_does_not_see():
    a = Adaptive()
    with pytest.raises(ValueError, match="to_zero: f is not in rate"):
        a.argued(to_zero=[a.e, a.f])
    assert "rate: must see a state" in why(a.argued(rate=expr(0), to_zero=[]))


def test_names_of_sizes():
    system = Adaptive().goal.under(any_vector("e"))
    assert system.sizes == (("G", "p"), ("f", "p"))
    goal = constant_goal()
    goal.known("Y", columns="p")
    with pytest.raises(ValueError, match="p is taken"):
        goal.known("p", columns="m")
    with pytest.raises(ValueError, match="Y is taken"):
        goal.gains("Y")
