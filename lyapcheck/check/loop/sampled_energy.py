"""An energy that falls along the loop on a computer, whatever its posture: forms of each joint by itself.

Intervals are T, velocities backward differences: with κ = k − d, e = q_d − q, v = (q_κ − q_{κ−1})/T
K_p h(e_κ) − K_v h(v) + g(q_κ) is held from t_k on. Let z = (t − t_k)/T', T' = λT, δ = w − w_k, r = q − q_k,

    V = ½wᵀMw + Σ k̂_i U(e_i) − Σ ε_i h(e_i)(Mw)_i + ½c(1/z − 1) δᵀMδ + ½Σ Q_i/T' (1/z − 1) r_i² + credits.

With F the torque less g(q) and Bw, and by Ṁ = C + Cᵀ,

    −V̇ = −wᵀF + hᵀK̂w − wᵀED'Mw + hᵀEF + hᵀECᵀw + c/(2T'z²) δᵀMδ − c(1/z − 1) δᵀ[F − C(w − δ)]
          + Σ Q_i/T' [r_i²/(2T'z²) − (1/z − 1) r_i w_i] + Σ credits,
    F = K_p h(e) + (K_p D_e − G) r̂ − K_v D (w − η) − Bw,   r̂ = q − q_κ,   η = w − v,

D from s_i ≤ h(v)/v, |v| ≤ w̄_i, to L, D_e from inf h' to ρ, |G_ij| at most sup |∂g_i/∂q_j|. With δ = z y,
r = z T' x, Δ_j = w_{k−j+1} − w_{k−j}, Tρ_j = q_{k−j+1} − q_{k−j} and μ the mean of δ over step κ − 1

    η = z y + Δ_1 + … + Δ_{d+1} − μ,   r̂ = z T' x + T (ρ_1 + … + ρ_d).

Credits are stored as they are earned and spent evenly over the step that needs them: as a step ends V loses
½c(λ − 1)Σ u_iδ_i², of which ½ω_j u_i Δ_ij²/T is spent in the j-th step after; β_iδ_i² is paid for β_iμ_i²
(Jensen) and R_ij w_i² for R_ij ρ_ij². What M, G and C couple is at most C|x||y| ≤ ½C(t x² + y²/t) for some t.
Left are forms of (h_i, w_i, y_i, x_i, Δ_i1 …, ρ_i1 …, μ_i), quadratic in z and affine in D, D_e and b_i.

References: ``reyes2019family`` (11), (12) for V of the continuous loop.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise, product

from lyapcheck.check.loop.field import BALLS
from lyapcheck.check.numbers.balls import to_arb
from lyapcheck.check.numbers.polynomials import root_above
from lyapcheck.check.statement import Piece

Numbers = tuple[Fraction, ...]
Rows = tuple[Numbers, ...]
PIECES = 3
"""Parts of a step, over each of which the coefficients of Bernstein's form are definite."""


@dataclass(frozen=True)
class ArmBounds:
    """Bounds for all postures: M ≽ diag(u), |M_ij|, |∂g_i/∂q_j| and |c_ijk|."""

    least: Numbers
    mass: Rows
    slope: Rows
    symbols: tuple[Rows, ...]

    def turning(self, speed: Fraction) -> Rows:
        """A_ij ≥ |C(q, w)_ij| for wᵀMw ≤ speed²: by Cauchy and Schwarz with Σ u_k w_k² ≤ wᵀMw."""
        return tuple(
            tuple(
                root_above(
                    sum((c * c / u for c, u in zip(row, self.least, strict=True)), Fraction(0)) * speed**2
                )
                for row in rows
            )
            for rows in self.symbols
        )


@dataclass(frozen=True)
class Splits(Piece):
    """The t > 0 of each product, rows (n, n): of a joint's quantity with that of another one."""

    mass: Rows
    gravity_w: Rows
    gravity_h: Rows
    gravity_y: Rows
    turning_h: Rows
    turning_y: Rows
    turning_yy: Rows
    turning_w: Rows


@dataclass(frozen=True)
class SampledEnergy(Piece):
    """The numbers of V: c, λ, ε, k̂, Q, ω, β, R, and how terms are shared out.

    ``slow`` is the share of ε_i hᵢ(Cᵀw)_i that is bounded by |h_i||w_j| and not by |w_j||w_k|.
    """

    weight: Fraction
    reach: Fraction
    coupling: Numbers
    stiffness: Numbers
    moved: Numbers
    kept: Rows
    mean: Numbers
    late: Rows
    slow: Numbers
    splits: Splits


@dataclass(frozen=True)
class Gains:
    """K_p, K_v, T, d, and bounds of h: ρ ≥ sup |h'|, the least slope, L, γ and s_i."""

    kp: Numbers
    kv: Numbers
    period: Fraction
    delay: int
    rho: Fraction
    least_slope: Fraction
    L: Fraction
    gamma: Fraction
    sector: Numbers


def shared(V: SampledEnergy, arm: ArmBounds, turning: Rows, gains: Gains) -> list[dict[str, Fraction]]:
    """What each joint pays for the products of joints: coefficients of w², h², y² and r̂²."""
    n, t, c = len(arm.least), V.splits, V.weight
    pays = [dict.fromkeys("whyr", Fraction(0)) for _ in range(n)]

    def split(C: Fraction, by: Fraction, first: tuple[int, str], second: tuple[int, str]) -> None:
        pays[first[0]][first[1]] += C * by / 2
        pays[second[0]][second[1]] += C / by / 2

    for i, j in product(range(n), repeat=2):
        eps, A = V.coupling[i], turning
        split(gains.rho * eps * arm.mass[i][j], t.mass[i][j], (i, "w"), (j, "w"))
        split(arm.slope[i][j], t.gravity_w[i][j], (i, "w"), (j, "r"))
        split(eps * arm.slope[i][j], t.gravity_h[i][j], (i, "h"), (j, "r"))
        split(c * arm.slope[i][j], t.gravity_y[i][j], (i, "y"), (j, "r"))
        split(V.slow[i] * eps * A[j][i], t.turning_h[i][j], (i, "h"), (j, "w"))
        split(c * A[i][j], t.turning_y[i][j], (i, "y"), (j, "w"))
        split(c * A[i][j] / 4, t.turning_yy[i][j], (i, "y"), (j, "y"))  # z(1 − z) ≤ ¼
        for k in range(n):
            fast = (1 - V.slow[i]) * eps * gains.gamma * arm.symbols[j][i][k]
            split(fast, t.turning_w[j][k], (j, "w"), (k, "w"))
    return pays


def form_of(
    i: int, V: SampledEnergy, u: Fraction, pays: dict[str, Fraction], gains: Gains, at: tuple[Fraction, ...]
) -> list[list[Fraction]]:
    """The form of joint i at (z, D, D_e, b_i)."""
    z, D, slope, b = at
    d, T, reach = gains.delay, gains.period, V.reach * gains.period
    size = 6 + 2 * d
    unit = [[Fraction(int(a == k)) for k in range(size)] for a in range(size)]
    h, w, y, x, *others, mu = unit
    steps, moves = others[: d + 1], others[d + 1 :]
    eta = [z * a + sum(column) - m for a, m, *column in zip(y, mu, *steps, strict=True)]
    behind = [z * reach * a + T * sum(column) for a, *column in zip(x, *moves, strict=True)]
    felt = [a - e for a, e in zip(w, eta, strict=True)]
    kp, kv, eps, c, Q = gains.kp[i], gains.kv[i] * D, V.coupling[i], V.weight, V.moved[i]
    P, now = kp * slope, c * (1 - z)
    result = [[Fraction(0)] * size for _ in range(size)]

    def add(scale: Fraction, left: Sequence[Fraction], right: Sequence[Fraction]) -> None:
        for a, p in enumerate(left):
            for k, q in enumerate(right):
                if p and q:
                    result[a][k] += scale * p * q / 2
                    result[k][a] += scale * p * q / 2

    add(b - pays["w"] - sum(V.late[i], Fraction(0)), w, w)
    add(eps * kp - pays["h"], h, h)
    add(c * u / reach / 2 - V.mean[i] * z * z - pays["y"], y, y)
    add(-pays["r"], behind, behind)
    add(V.stiffness[i] - kp - eps * b, w, h)
    for scale, vector in ((Fraction(1), w), (-eps, h), (now, y)):
        add(scale * kv, vector, felt)
        add(-scale * P, vector, behind)
    add(-now * kp, y, h)
    add(now * b, y, w)
    add(Q / 2, x, x)
    add(-Q * (1 - z), x, w)
    for own, step in zip(V.kept[i], steps, strict=True):
        add(own * u / T / 2, step, step)
    for own, move in zip(V.late[i], moves, strict=True):
        add(own, move, move)
    add(V.mean[i], mu, mu)
    return result


def falls(
    V: SampledEnergy, arm: ArmBounds, speed: Fraction, friction: Sequence[Numbers], gains: Gains
) -> bool:
    """Whether the form of each joint is positive definite throughout a step; ``False`` says nothing.

    Args:
        V: with n joints and d late readings.
        arm: bounds for all postures.
        speed: of which wᵀMw is at most the square.
        friction: the ends of each b_i.
        gains: with s_i for this speed.

    Soundness: affine in D, D_e and b_i, so that their ends are enough. In z it is quadratic: over a part of
        [0, 1/λ] a mean of its values at both ends and of 2N(middle) − ½(N(left) + N(right)).
    """
    pays = shared(V, arm, arm.turning(speed), gains)
    places = [Fraction(k, PIECES) / V.reach for k in range(PIECES + 1)]
    for i, u in enumerate(arm.least):
        ends = product({gains.sector[i], gains.L}, {gains.least_slope, gains.rho}, set(friction[i]))
        for at in ends:
            of = {z: form_of(i, V, u, pays[i], gains, (z, *at)) for z in places}
            forms = list(of.values())
            for left, right in pairwise(places):
                middle = form_of(i, V, u, pays[i], gains, ((left + right) / 2, *at))
                rows = zip(middle, of[left], of[right], strict=True)
                forms.append([[2 * m - (a + b) / 2 for m, a, b in zip(*row, strict=True)] for row in rows])
            for form in forms:
                lower = [[to_arb(x) for x in row[: a + 1]] for a, row in enumerate(form)]
                if not BALLS.positive_definite(lower):
                    return False
    return True
