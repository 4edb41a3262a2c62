"""The matrix that must be positive definite over a box of states, as intervals.

dV/dt = −zᵀQz with z = [√ε h; w] (``lyapcheck.lyapunov.quadratic``). Two exact steps make Q small:

- **No damping vertices.** K_v D enters zᵀQz by Σ k_vi d_i (w_i² − √ε a_i w_i) ≥ −¼ ε Σ k_vi d_i a_i², with
  a = √ε h and 0 ≤ d_i ≤ L. So Q ⪰ Q at D = 0 with K_p replaced by K̃ = K_p − ¼ ε₀ L K_v.
- **Schur complement.** With K̃ ≻ 0 that matrix is positive definite exactly when
  P = Y − ¼ ε Xᵀ K̃⁻¹ X is, where X = B + ε S, Y = B + ½ ε (S + Sᵀ).

P ≻ 0 for all q and e therefore gives dV/dt < 0 for every state but the origin, whatever w.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from lyapcheck.check.enclosure import Enclosure
from lyapcheck.family import Family
from lyapcheck.intervals import Interval, inverse_one_plus, norm, unit_vector
from lyapcheck.intervals.arm import ArmIntervals, coriolis
from lyapcheck.intervals.family import dh_range, h_range
from lyapcheck.robots import RobotModel

Entry = Interval | float
Rows = list[list[Interval]]


@dataclass(frozen=True)
class Problem:
    """One controller on one arm at one ε₀, ready to be enclosed over boxes.

    Args:
        arm: the arm's polynomials.
        family: the function h.
        viscous: diagonal of B, exact.
        stiffness: diagonal of K̃ from below, all positive.
        eps0: ε₀, exact.
    """

    arm: ArmIntervals
    family: Family
    viscous: tuple[Fraction, ...]
    stiffness: tuple[Interval, ...]
    eps0: Fraction

    def schur(self, q: list[Interval], e: list[Interval]) -> Rows:
        """P over boxes of q (n intervals) and e (n intervals): the entries on and below the diagonal."""
        shrink = inverse_one_plus(norm(e))
        eps = shrink * Interval.of(self.eps0)
        S = self._coupling(q, e, shrink)
        B = [Interval.of(b) for b in self.viscous]
        X = self._plus(B, S, eps)
        quarter = eps * 0.25
        joints = range(self.arm.n)
        inverse = [quarter * k.reciprocal() for k in self.stiffness]
        return [[self._entry(i, j, B, S, X, eps, inverse) for j in joints[: i + 1]] for i in joints]

    def _coupling(self, q: list[Interval], e: list[Interval], shrink: Interval) -> list[list[Entry]]:
        """S = C(q,h) + (M h) êᵀ/(1+r) − M H'."""
        box = self.arm.at(q)
        M, h, dh = box.mass(), [h_range(self.family, x) for x in e], [dh_range(self.family, x) for x in e]
        Ch = coriolis(box.symbols(), h)
        pushed = [_dot(row, h) for row in M]
        pull = [unit * shrink for unit in unit_vector(e)]
        joints = range(self.arm.n)
        return [[Ch[i][j] + pushed[i] * pull[j] - _product(M[i][j], dh[j]) for j in joints] for i in joints]

    @staticmethod
    def _plus(B: list[Interval], S: list[list[Entry]], eps: Interval) -> list[list[Interval]]:
        joints = range(len(B))
        return [[eps * S[i][j] + B[i] if i == j else eps * S[i][j] for j in joints] for i in joints]

    @staticmethod
    def _entry(
        i: int,
        j: int,
        B: list[Interval],
        S: list[list[Entry]],
        X: Rows,
        eps: Interval,
        inverse: list[Interval],
    ) -> Interval:
        if i == j:
            fast = eps * S[i][i] + B[i]
            slow = [x[i].square() * k for x, k in zip(X, inverse, strict=True)]
        else:
            fast = eps * (S[i][j] + S[j][i]) * 0.5
            slow = [x[i] * x[j] * k for x, k in zip(X, inverse, strict=True)]
        return fast - sum(slow[1:], slow[0])


def problem(
    model: RobotModel, family: Family, kp: Sequence[Fraction], kv: Sequence[Fraction], eps0: Fraction
) -> Problem | None:
    """The problem of an ε₀, or ``None`` where K̃ is not positive: ε₀ is then out of this method's reach.

    Args:
        model: the arm without parameters.
        family: the function h; its L bounds the damping ratios.
        kp: diagonal of K_p, exact.
        kv: diagonal of K_v, exact.
        eps0: ε₀ > 0.
    """
    L: Enclosure = family.constants().L
    stiffness = [a - eps0 * L.upper * b / 4 for a, b in zip(kp, kv, strict=True)]
    if min(stiffness) <= 0:
        return None
    viscous = tuple(number.value for number in model.viscous)
    return Problem(ArmIntervals(model), family, viscous, tuple(map(Interval.of, stiffness)), eps0)


def _dot(row: list[Entry], h: list[Interval]) -> Entry:
    total: Entry = 0.0
    for entry, x in zip(row, h, strict=True):
        if isinstance(entry, Interval):
            total = entry * x + total
    return total


def _product(entry: Entry, x: Interval) -> Entry:
    return entry * x if isinstance(entry, Interval) else 0.0
