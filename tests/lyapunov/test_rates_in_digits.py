"""dV/dt in doubles against V differentiated along the flow in forty digits, which knows nothing of (15)."""

import mpmath as mp
import numpy as np
import pytest

from lyapcheck import family, robots
from lyapcheck.lyapunov import numeric as numeric_module
from lyapcheck.lyapunov.numeric import LyapunovNumeric
from tests.helpers.shares import one_in

KP, KV, EPS0 = (25.0, 50.0, 5.0), (0.25, 0.5, 0.125), 0.375


def exact(value):
    return mp.mpf(value.numerator) / value.denominator


class Flow:
    """V along (11) from one state, as a function of time with its right first derivative."""

    def __init__(self, kept, q, e, w):
        self.kept, self.m, self.n = kept, kept.family.m, kept.model.n
        self.q, self.e, self.w = ([mp.mpf(float(x)) for x in row] for row in (q, e, w))
        self.a = mp.lu_solve(mp.matrix(self.mass(self.q)), mp.matrix(self.force()))

    def h(self, x):
        return mp.sinh(x) ** (2 * self.m - 1) * mp.cosh(x) / (1 + mp.sinh(x) ** (2 * self.m))

    def mass(self, q):
        return self.kept.model.at([mp.sin(x) for x in q], [mp.cos(x) for x in q], exact).mass()

    def force(self):
        turns = [mp.sin(x) for x in self.q], [mp.cos(x) for x in self.q]
        C = self.kept.model.at(*turns, exact).coriolis(self.w)
        return [
            KP[i] * self.h(self.e[i])
            - KV[i] * self.h(self.w[i])
            - self.kept.viscous[i] * self.w[i]
            - sum(C[i][j] * self.w[j] for j in range(self.n))
            for i in range(self.n)
        ]

    def value(self, t):
        moved = ((self.q, t), (self.e, -t))
        q, e = ([x + by * v for x, v in zip(row, self.w, strict=True)] for row, by in moved)
        eps = mp.mpf(EPS0) / (1 + mp.sqrt(sum(x * x for x in e)))
        y = [v + t * a - eps * self.h(x) for v, a, x in zip(self.w, self.a, e, strict=True)]
        M = self.mass(q)
        kinetic = sum(M[i][j] * y[i] * y[j] for i in range(self.n) for j in range(self.n)) / 2
        U = [mp.log(1 + mp.sinh(x) ** (2 * self.m)) / (2 * self.m) for x in e]
        return kinetic + sum(k * u for k, u in zip(KP[: self.n], U, strict=True))


@pytest.mark.parametrize("m", one_in(3, [2, 1, 3]))
@pytest.mark.parametrize("arm", ["pendulum1", "reyes-kelly2", "buap3"])
def test_rate_and_value_are_right_to_the_last_places(arm, m, monkeypatch):
    model = robots.load(arm)
    kept = LyapunovNumeric(model, family.hyperbolic(m), KP[: model.n], KV[: model.n], EPS0)
    random = np.random.default_rng(m)
    q, e, w = (size * random.standard_normal((8, model.n)) for size in (3, 2, 4))
    by_numpy = kept.V(q, e, w), kept.rate(q, e, w)
    monkeypatch.setattr(numeric_module, "LARGE", 1)
    compiled = kept.V(q, e, w), kept.rate(q, e, w)
    with mp.workdps(40):
        for k in range(8):
            flow = Flow(kept, q[k], e[k], w[k])
            for values in (by_numpy, compiled):
                assert abs(values[0][k] / flow.value(0) - 1) < 2e-15
                assert abs(values[1][k] / mp.diff(flow.value, 0) - 1) < 5e-15
