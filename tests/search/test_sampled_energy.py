"""Energies that fall on a computer: the form against the loop itself, exact limits, planted faults."""

from dataclasses import fields, replace
from fractions import Fraction as F
from functools import cache
from itertools import pairwise, product

import numpy as np
import pytest

from lyapcheck.check.kinds.sampled import SampledStable
from lyapcheck.check.kinds.sampled_from_rest import (
    FallingEnergy,
    SampledFromRest,
    arm_bounds,
    bounded_gains,
)
from lyapcheck.check.loop.sampled_energy import (
    ArmBounds,
    Gains,
    SampledEnergy,
    Splits,
    falls,
    form_of,
    shared,
)
from lyapcheck.check.refusal import Refused
from lyapcheck.check.verify import Accepted, verify
from lyapcheck.family.base import named
from lyapcheck.robots import load
from lyapcheck.robots.fields import Vary
from lyapcheck.robots.numeric import NumericModel
from lyapcheck.robots.trig import to_terms
from lyapcheck.robots.vary import varied
from lyapcheck.search.controlled_arm import chains_of
from lyapcheck.search.sampled import loops
from lyapcheck.search.sampled_energy import falling_energy
from tests.helpers.shares import but
from tests.helpers.urdf_texts import ARMS, TWO

PROVED = Accepted("proved", "enclosure")
UR5 = str(ARMS / "ur5.toml")
GAINS = {
    "buap3": ("19.063 44.342 5.331", "8.170 19.004 1.757"),
    "reyes-kelly2": ("41.089 5.618", "17.610 2.112"),
    UR5: ("43.977 23.008 32.827 10.461 10.698 11.429", "17.260 13.477 3.676 0.635 0.732 0.001"),
}
"""Gains that targets at infinite rate suggest."""
STEEP = Gains((), (), F(1), 1, F(2), F(0), F(1), F(3), ())
"""Of an h with |h'| ≤ 2 and |h| ≤ 3."""
ARM_OF = {tuple(map(F, kp.split())): name for name, (kp, _) in GAINS.items()}


def h(m, x):
    """h_m, and U_m of which it is the slope."""
    s = np.sinh(x)
    return s ** (2 * m - 1) * np.cosh(x) / (1 + s ** (2 * m)), np.log1p(s ** (2 * m)) / (2 * m)


def question(name: str, period="0.001", within=90, delay=1, m=1) -> SampledFromRest:
    arm = load(name).fixed()
    kp, kv = (tuple(map(F, row.split())) for row in GAINS[name])
    friction = tuple((number.value, number.value) for number in arm.viscous)
    return SampledFromRest(
        *("hyperbolic", m, kp, kv, friction, arm.mass_terms, tuple(to_terms(arm.potential)), ()),
        *(F(period), delay, F(within)),
    )


@cache
def shown(statement: SampledFromRest) -> FallingEnergy:
    arm = load(ARM_OF[statement.kp]).fixed()
    proof = falling_energy(statement, chains_of(arm, ()))
    assert proof is not None
    return proof


@pytest.mark.parametrize(("d", "seed", "m"), [*product((0, 1, 2), (1, 2, 3), (1, 3))])
def test_of_one_joint_the_form_is_the_rate_of_the_energy_itself(d, seed, m):
    """One inertia without gravity, its exact motion, credits by quadrature, D, D_e and h' as they are."""
    random = np.random.default_rng(seed)
    M, b, kp, kv, T, reach, c, eps, stiff, Q, beta = random.uniform(0.5, 2, 11)
    kept, late, reach = random.uniform(0, 1, d + 1), random.uniform(0, 1, d), reach + 1
    V = SampledEnergy(c, reach, (eps,), (stiff,), (Q,), (kept,), (beta,), (late,), (0.0,), None)  # type: ignore[arg-type]
    q, w, steps, fine = random.normal(), random.normal(), d + 4, 400
    step, past = T / fine, []
    for _ in range(steps):
        past.append((q, w, []))
        late_q, before = (past[max(len(past) - 1 - d - k, 0)][0] for k in (0, 1))
        tau = kp * h(m, -late_q)[0] - kv * h(m, (late_q - before) / T)[0]
        q0, w0 = q, w
        for k in range(1, fine + 1):  # the exact motion under a held torque
            s = k * step
            decay = np.exp(-b / M * s)
            w = tau / b + (w0 - tau / b) * decay
            q = q0 + tau / b * s + (w0 - tau / b) * M / b * (1 - decay)
            past[-1][2].append((q, w))
    (q_now, w_now, inside), back = past[-1], past[::-1]
    means = [sum(pair[1] - own[1] for pair in own[2]) / fine for own in back]
    exact = [(own[0] - older[0]) / T - older[1] for own, older in pairwise(back)]
    assert np.allclose(exact, means[1:], atol=2e-2)

    def energy(k):
        q, w = inside[k]
        s, e = (k + 1) * step, -q
        z, spent = s / T / reach, (k + 1) / fine
        value = M * w * w / 2 + stiff * h(m, e)[1] - eps * h(m, e)[0] * M * w
        value += (
            c / 2 * (1 / z - 1) * M * (w - w_now) ** 2 + Q / (reach * T) / 2 * (1 / z - 1) * (q - q_now) ** 2
        )
        for j in range(d + 1):
            value -= spent * kept[j] * M / 2 * (back[j][1] - back[j + 1][1]) ** 2
        value -= spent * T * beta * exact[d] ** 2
        value += beta * step * (sum((x[1] - w_now) ** 2 for x in inside[:k]) + (w - w_now) ** 2 / 2)
        for j in range(d):
            value -= spent * T * late[j] * ((back[j][0] - back[j + 1][0]) / T) ** 2
            value += (
                late[j]
                * step
                * (sum(x[1] ** 2 for x in [(0, w_now), *inside][: k + 1]) + (w**2 - w_now**2) / 2)
            )
        return value

    for k in (60, 200, 350):
        q, w = inside[k]
        s, e, behind, v = (k + 1) * step, -q, q - back[d][0], (back[d][0] - back[d + 1][0]) / T
        z, D = s / T / reach, h(m, v)[0] / v
        De = (h(m, e + behind)[0] - h(m, e)[0]) / behind
        slope = (h(m, e + 1e-6)[0] - h(m, e - 1e-6)[0]) / 2e-6
        pays = {"w": eps * slope * M, "h": 0.0, "y": 0.0, "r": 0.0}
        gains = Gains((kp,), (kv,), T, d, 1.0, 0.0, 1.0, 1.0, (0.0,))  # type: ignore[arg-type]
        form = np.array(form_of(0, V, M, pays, gains, (z, D, De, b)), dtype=float)  # type: ignore[arg-type]
        x = [h(m, e)[0], w, (w - w_now) / z, (q - q_now) / (z * reach * T)]
        x += [back[j][1] - back[j + 1][1] for j in range(d + 1)]
        x += [*((back[j][0] - back[j + 1][0]) / T for j in range(d)), exact[d]]
        rate = (energy(k + 1) - energy(k - 1)) / (2 * step)
        assert -rate == pytest.approx(np.array(x) @ form @ np.array(x), rel=2e-3, abs=2e-3)


def test_what_joints_do_to_each_other_is_paid_for():
    """With M, G and C anything within their bounds: the worst of the terms of −V̇ that have them."""
    random, n, least = np.random.default_rng(4), 3, 1.0

    def draw(*shape):
        return random.uniform(0.1, 1, shape)

    for _ in range(2000):
        mass, slope, symbols, u = draw(n, n), draw(n, n), draw(n, n, n), draw(n)
        sizes = 10.0 ** random.uniform(-6, 0, 3)  # so that one of the three is nearly alone
        mass, slope, symbols = (mass + mass.T) * sizes[0], (slope + slope.T) * sizes[1], symbols * sizes[2]
        eps, slow, c, speed, z = draw(n), random.uniform(0, 1, n), *draw(2), random.uniform(0, 1)
        h, y, r = (random.normal(size=n) for _ in range(3))
        h, w = 3 * np.tanh(h), random.normal(size=n)
        w *= speed / np.sqrt((u * w * w).sum())
        splits = Splits(*(1.3 ** random.normal(size=(n, n)) for _ in fields(Splits)))
        V = SampledEnergy(c, 2.0, eps, None, None, None, None, None, slow, splits)  # type: ignore[arg-type]
        turning = np.sqrt((symbols**2 / u).sum(-1)) * speed
        pays = shared(V, ArmBounds(u, mass, slope, symbols), turning, STEEP)  # type: ignore[arg-type]
        paid = sum(
            own["w"] * w[i] ** 2 + own["h"] * h[i] ** 2 + own["y"] * y[i] ** 2 + own["r"] * r[i] ** 2
            for i, own in enumerate(pays)
        )
        now, push = c * (1 - z), w - h * eps + c * (1 - z) * y
        both = np.outer(w, h * eps) + now * np.outer(y, w - z * y)  # what C_ij is a factor of
        worst = -2 * (eps * np.abs(w)) @ mass @ np.abs(w) - np.abs(push) @ slope @ np.abs(r)
        worst -= (symbols * np.abs(both[:, :, None] * w)).sum()
        least = min(least, 1 + worst / paid)
    assert 0 < least < 0.2


@pytest.mark.parametrize(
    ("family", "m"),
    [("tanh", None), ("algebraic", None), ("arctan", None), *(("hyperbolic", m) for m in (1, 2, 3, 9))],
)
def test_h_keeps_its_bounds_at_rates_up_to_the_speed(family, m):
    known, asked = named(family, m), replace(question("reyes-kelly2"), family=family, m=m)
    least, speed = (F(1, 2), F(2)), F(5)
    gains, rate = bounded_gains(asked, least, speed), np.linspace(1e-3, 5, 20000)
    for u, sector in zip(least, gains.sector, strict=True):
        inside = rate[rate <= 5 / np.sqrt(float(u))]
        secant = known.h(inside) / inside
        assert sector <= secant.min() + 1e-12
        assert secant.max() <= gains.L + 1e-12
    x = np.linspace(0, 12, 20000)
    slope = known.dh(x)
    assert gains.least_slope <= slope.min()
    assert slope.max() <= gains.rho + 1e-12
    assert (known.potential(x) >= known.h(x) ** 2 / (2 * float(gains.rho)) - 1e-12).all()
    assert (0 in gains.sector) == (gains.least_slope < 0) == (m not in (None, 1))


def test_both_ends_of_the_slope_count():
    asked = question("reyes-kelly2")
    proof = shown(asked)
    gains, arm = bounded_gains(asked, proof.least, proof.speed), arm_bounds(asked, proof.least)
    assert falls(proof.energy, arm, proof.speed, asked.viscous, gains)
    for steeper in ({"rho": F(60)}, {"least_slope": F(-60)}):
        assert not falls(proof.energy, arm, proof.speed, asked.viscous, replace(gains, **steeper))


def run(statement: SampledFromRest, proof: FallingEnergy, starts: np.ndarray, goal: np.ndarray, samples: int):
    """V as each sample begins, (samples, N), with what is stored; an integrator of fourth order."""
    arm, V, d, T = (
        NumericModel(load(ARM_OF[statement.kp]).fixed()),
        proof.energy,
        statement.delay,
        float(statement.period),
    )
    kp, kv, eps, stiff, mean = (
        np.array(x, float) for x in (statement.kp, statement.kv, V.coupling, V.stiffness, V.mean)
    )
    b, u, kept, late = (
        np.array(x, float) for x in ([x for x, _ in statement.viscous], proof.least, V.kept, V.late)
    )
    q, w, values = goal + starts, np.zeros_like(starts), []
    readings, produced, m = [q] * (d + 2), [], statement.m

    def rates(q, w, tau):
        force = tau - np.einsum("aij,aj->ai", arm.coriolis(q, w), w) - b * w - arm.gravity(q)
        return w, np.linalg.solve(arm.mass(q), force[..., None])[..., 0]

    for k in range(samples):
        readings = [q, *readings[:-1]] if k else readings
        e = goal - q
        momentum = np.einsum("aij,aj->ai", arm.mass(q), w)
        value = (momentum * w).sum(1) / 2 + (stiff * h(m, e)[1]).sum(1) - (eps * h(m, e)[0] * momentum).sum(1)
        for age, (delta, moved, mu) in enumerate(produced[::-1][: d + 1], 1):
            value += (kept[:, age - 1 :].sum(1) * u / 2 * delta**2).sum(1) + (T * mean * mu**2).sum(1)
            value += (late[:, age - 1 :].sum(1) * T * (moved / T) ** 2).sum(1)
        values.append(value)
        tau = (
            kp * h(m, goal - readings[d])[0]
            - kv * h(m, (readings[d] - readings[d + 1]) / T)[0]
            + arm.gravity(readings[d])
        )
        q0, w0, parts = q, w, 4 if arm.n < 6 else 1
        s = T / parts
        for _ in range(parts):
            a, c = rates(q, w, tau)
            a2, c2 = rates(q + s / 2 * a, w + s / 2 * c, tau)
            a3, c3 = rates(q + s / 2 * a2, w + s / 2 * c2, tau)
            a4, c4 = rates(q + s * a3, w + s * c3, tau)
            q, w = q + s / 6 * (a + 2 * a2 + 2 * a3 + a4), w + s / 6 * (c + 2 * c2 + 2 * c3 + c4)
        produced.append((w - w0, q - q0, (q - q0) / T - w0))
    return np.array(values), q - goal, w


@pytest.mark.parametrize(
    ("name", "period", "m", "within"),
    but(
        [("reyes-kelly2", "0.005", 1, 90)],
        [
            ("reyes-kelly2", "0.005", 1, 90),
            ("buap3", "0.001", 1, 90),
            ("buap3", "0.0016", 1, 90),
            ("buap3", "0.001", 2, 90),
            ("reyes-kelly2", "0.002", 3, 90),
            (UR5, "0.001", 1, 5),
        ],
    ),
)
def test_gains_above_the_friction_are_proved_from_rest_and_the_energy_falls(name, period, m, within):
    statement = question(name, period, within, m=m)
    proof = shown(statement)
    assert verify(statement, proof) == PROVED
    random, n = np.random.default_rng(1), len(statement.kp)
    samples = 300 if n < 6 else 100
    corners = random.choice([-1.0, 1.0], (6, n))
    starts = np.radians(within) * np.concatenate([random.uniform(-1, 1, (6, n)), corners])
    goal = random.uniform(-np.pi, np.pi, (12, n))
    values, _, _ = run(statement, proof, starts, goal, samples)
    assert (np.diff(values, axis=0) < 0).all()
    assert (values[0] <= float(proof.speed) ** 2 * (1 - float(proof.share)) / 2).all()
    assert (values[-1] < 0.9 * values[0]).all()


@pytest.mark.slow
def test_no_random_joint_is_proved_beyond_its_exact_limit():
    random, found = np.random.default_rng(8), 0
    for _ in range(8):
        M, b, kp, kv = (
            F(round(float(x) * 1000) + 1, 1000)
            for x in 10 ** random.uniform([-2, -1, 0, -1], [0.5, 1, 1.5, 1])
        )
        d, T = int(random.integers(0, 3)), float(M / (kv + b)) * 10 ** random.uniform(-1.5, 0.5)
        period, mass, potential = F(round(T * 10**6) + 1, 10**6), (((((0, 0), M),),),), (((0, 1), kp / 3),)
        gains = ("tanh", None, (kp,), (kv,))
        if (
            falling_energy(SampledFromRest(*gains, ((b, b),), mass, potential, (), period, d, F(1, 100)))
            is None
        ):
            continue
        found += 1
        arm = ((), (), (), mass, potential, ())
        (loop,) = loops(SampledStable(*gains, (b,), *arm, period, F(1), d, (F(1),), "goal"))
        assert loop.radii(np.arange(-180.0, 180.0, 15.0)[:, None], float(period)).max() < 1
    assert 1 < found < 8


def test_where_the_inertia_is_not_positive_there_is_nothing_to_find():
    asked = question("reyes-kelly2")
    (_, cross), (_, own) = asked.mass
    assert falling_energy(replace(asked, mass=((own, cross), (cross, own)))) is None


def linked(folder):
    """Two links with a payload from 0 to 1 kg, and a proof by them."""
    (folder / "arm.urdf").write_text(TWO)
    arm = varied(load(str(folder / "arm.urdf")), [Vary.parsed("payload=0..1")])
    chains, friction = chains_of(arm, arm.ranges), tuple(number.bounds for number in arm.viscous)
    statement = SampledFromRest(
        *("hyperbolic", 1, (F(10), F(4)), (F(3), F(1)), friction, arm.mass_terms),
        *(tuple(to_terms(arm.potential)), arm.ranges, F("0.001"), 1, F(5)),
    )
    proof = falling_energy(statement, chains)
    assert proof is not None
    assert proof.along is not None
    return statement, proof, proof.along


@pytest.mark.slow
def test_links_show_how_small_the_inertia_is_at_each_corner_and_no_more(tmp_path):
    statement, proof, along = linked(tmp_path)
    assert verify(statement, proof) == PROVED
    assert len(along.arms) == 2
    arms, forms, u = along.arms, along.forms, proof.least
    lighter = replace(arms[0][1], mass=arms[0][1].mass / 2)
    for bad in (
        replace(proof, along=None, least=tuple(x * F("1.2") for x in u)),
        replace(proof, least=(u[0] * F("1.01"), u[1])),
        replace(proof, least=(u[0], u[1] * F("1.01"))),
        replace(proof, along=replace(along, arms=arms[1:])),
        replace(proof, along=replace(along, arms=arms[1:], forms=forms[1:])),
        replace(proof, along=replace(along, arms=arms[::-1], forms=forms[::-1])),
        replace(proof, along=replace(along, arms=((arms[0][0], lighter), arms[1]))),
        replace(
            proof, along=replace(along, forms=(forms[0], tuple(tuple(-x for x in row) for row in forms[1])))
        ),
    ):
        with pytest.raises(Refused, match="least"):
            verify(statement, bad)
