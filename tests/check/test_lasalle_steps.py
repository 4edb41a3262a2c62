"""LaSalle's theorem in steps: loops close to the rule that do not converge, and steps that say too much."""

from random import Random

import pytest

from lyapcheck.claims import any_vector, constant_goal, lasalle, norm, step
from tests.helpers.stated import verdict, why
from tests.oracle.stability import stable


def swings(statement):
    """Whether the equations of motion of some arm show that the origin does not attract."""
    return stable(statement, Random(1)) is not None


class Filter:
    """τ = K e − L z + g(q), dz/dt = w − A z; more states and torques may be added."""

    def __init__(self, rate=None, torque=None, goal=None, more=None):
        self.goal = goal = goal or constant_goal("none")
        self.e, self.w, self.M = goal.e, goal.w, goal.M
        self.K, self.L, self.A = goal.gains("K L A")
        self.z, self.x, self.y = map(any_vector, ("z", "a", "b"))
        self.plain = self.w - self.A @ self.z
        goal.state("z", self.plain if rate is None else rate(self))
        for name, change in (more or {}).items():
            goal.state(name, change(self))
        self.pd = self.K @ self.e - self.L @ self.z
        self.loop = goal.under((self.pd if torque is None else torque(self)) + goal.gravity)
        self.V = self.w @ self.M @ self.w / 2 + self.e @ self.K @ self.e / 2 + self.z @ self.L @ self.z / 2
        self.above = goal.mu / 2 * norm(self.w) ** 2 + self.K.min / 2 * norm(self.e) ** 2
        self.above = self.above + self.L.min / 2 * norm(self.z) ** 2
        self.rate = self.L.min * self.A.min * norm(self.z) ** 2
        self.moving = step(norm(self.w) ** 2, z=self.w)
        self.resting = step(self.K.min * norm(self.e) ** 2, w=self.e)

    def argued(self, *steps, **changed):
        own = {"V": self.V, "above": self.above, "rate": self.rate, "rest": list(steps)}
        return lasalle(self.loop, **(own | changed))


def proved():
    f = Filter()
    return f.argued(f.moving, f.resting)


def test_the_proof_that_faults_are_planted_in():
    statement = proved()
    assert verdict(statement) == "proved"
    assert not swings(statement)


# Loops that do not converge -------------------------------------------------------------------------------


def forgets_nothing():
    """A = 0: z is q − q₀, a spring."""
    f = Filter(rate=lambda f: f.w)
    return f.argued(f.moving, f.resting)


def deaf():
    """The filter does not hear the arm."""
    f = Filter(rate=lambda f: -f.A @ f.z, torque=lambda f: f.K @ f.e)
    return f.argued(f.moving, f.resting)


def beside():
    """PD control, and an oscillator of its own that nothing damps: da/dt = Kb, db/dt = −Ka."""
    goal = constant_goal("none")
    e, w, a, b = goal.e, goal.w, any_vector("a"), any_vector("b")
    K, L = goal.gains("K L")
    goal.state("a", K @ b)
    goal.state("b", -K @ a)
    V = w @ goal.M @ w / 2 + e @ K @ e / 2 + a @ a / 2 + b @ b / 2
    own = norm(a) ** 2 + norm(b) ** 2
    return lasalle(
        goal.under(K @ e - L @ w + goal.gravity),
        V,
        above=goal.mu / 2 * norm(w) ** 2 + K.min / 2 * norm(e) ** 2 + own / 2,
        rate=L.min * norm(w) ** 2,
        rest=[step(K.min * norm(e) ** 2, w=e), step(K.min * own, still=[a, b], a=b, b=-a)],
    )


def deaf_to_some():
    """dz/dt = (K − L)w − Az, τ = … − (K − L)z: where K = L, this is :func:`deaf`."""
    f = Filter(
        rate=lambda f: f.K @ f.w - f.L @ f.w - f.A @ f.z,
        torque=lambda f: f.K @ f.e - f.K @ f.z + f.L @ f.z,
    )
    V = f.w @ f.M @ f.w / 2 + f.e @ f.K @ f.e / 2 + f.z @ f.z / 2
    above = f.goal.mu / 2 * norm(f.w) ** 2 + f.K.min / 2 * norm(f.e) ** 2 + norm(f.z) ** 2 / 2
    still = step(norm(f.w) ** 2, still=[f.w, f.e], e=-f.w)
    return f.argued(still, f.resting, V=V, above=above, rate=f.A.min * norm(f.z) ** 2)


def through_friction():
    """The filter hears Bw, and B may vanish: τ = … − Bz, dz/dt = Bw − Az."""
    goal = constant_goal("any")
    f = Filter(goal=goal, rate=lambda f: goal.B @ f.w - f.A @ f.z, torque=lambda f: f.K @ f.e - goal.B @ f.z)
    V = f.w @ f.M @ f.w / 2 + f.e @ f.K @ f.e / 2 + f.z @ f.z / 2
    above = f.goal.mu / 2 * norm(f.w) ** 2 + f.K.min / 2 * norm(f.e) ** 2 + norm(f.z) ** 2 / 2
    still = step(norm(f.w) ** 2, still=[f.w, f.e], e=-f.w)
    return f.argued(still, f.resting, V=V, above=above, rate=f.A.min * norm(f.z) ** 2)


def friction_that_is_absent():
    """ψ has B, which is positive for some arms only; nothing else damps."""
    goal = constant_goal("any")
    f = Filter(goal=goal, rate=lambda f: f.w)
    return f.argued(f.resting, step(norm(f.z) ** 2, w=-f.z), rate=goal.B.min * norm(f.w) ** 2)


def undamped_motors():
    """Flexible joints without K_d: ψ has nothing to see."""
    f = Filter(rate=lambda f: f.w)
    return f.argued(f.moving, f.resting, rate=0 * norm(f.z) ** 2)


FALSE = (
    (forgets_nothing, "rate"),
    (deaf, "V|rest"),
    (beside, "still = a: is not shown to stand still"),
    (deaf_to_some, "still = w: is not shown to stand still"),
    (through_friction, "still = w: is not shown to stand still"),
    (friction_that_is_absent, "rate"),
    (undamped_motors, "rate|must be seen"),
)


@pytest.mark.parametrize(("loop", "reason"), FALSE)
def test_a_loop_that_does_not_converge_is_not_proved(loop, reason):
    assert swings(deaf() if loop is deaf_to_some else loop()), "the loop is no counterexample"
    assert any(part in why(loop()) for part in reason.split("|"))


# Steps that say too much ----------------------------------------------------------------------------------


def test_what_stands_still():
    """Through A y + c with A positive and diagonal; not through M, a number that moves, or a sum of gains."""

    def said(motion, still, **more):
        f = Filter(rate=motion, more=more)
        first = step(norm(f.w) ** 2, still=[any_vector(name) for name in still], e=-f.w)
        above = f.above + sum((norm(any_vector(name)) ** 2 for name in more), 0 * norm(f.w))
        return why(f.argued(first, f.resting, above=above))

    no = "is not shown to stand still"
    assert f"still = w: {no}" in said(lambda f: f.M @ f.w - f.A @ f.z, "w")
    assert f"still = w: {no}" in said(lambda f: f.K @ f.w + f.L @ f.w - f.A @ f.z, "w")
    assert f"still = w: {no}" in said(lambda f: f.w + f.e - f.A @ f.z, "w")
    assert f"still = w: {no}" in said(lambda f: f.w + f.goal.gravity - f.A @ f.z, "w")
    assert f"still = w: {no}" in said(lambda f: (f.e @ f.e) * f.w - f.A @ f.z, "w")
    assert f"still = w: {no}" in said(lambda f: f.w - f.w - f.A @ f.z, "w")
    assert f"still = a: {no}" in said(lambda f: f.plain, "a", a=lambda f: f.e)
    assert f"still = e: {no}" in said(lambda f: f.plain, "e")
    assert "rest = e: must stand still" in said(lambda f: 2 * f.K @ f.w - f.A @ f.z, "w")


def test_a_function_that_stands_still_leaves_its_state_free():
    """k may be flat on an interval; so k(w) = 0 says w = 0, and that it is constant says nothing."""
    goal = constant_goal("none")
    k = goal.entrywise("k", goal.w)
    f = Filter(goal=goal, rate=lambda f: k - f.A @ f.z)
    reason = why(f.argued(step(norm(f.w) ** 2, still=[f.w], e=-f.w), f.resting))
    assert "still = w: is not shown" in reason
    with pytest.raises(ValueError, match="is no letter of a state"):
        step(norm(f.w) ** 2, still=[2 * f.w])
