"""Two scalar forms that bound dV/dt: the paper's Θ of (16), and Θ' in ‖h(e)‖ instead of ‖e‖.

Θ' term by term, from dV/dt = −ε hᵀK_p h − wᵀ(B + K_v D)w − ε wᵀS w + ε hᵀ(B + K_v D)w + ε² hᵀS w
(``lyapcheck.lyapunov.quadratic``), with a = ‖h(e)‖, b = ‖w‖, r = ‖e‖:

- ε hᵀK_p h ≥ ε λmin(K_p) a², and wᵀ(B + K_v D)w ≥ λmin(B) b² as D ⪰ 0;
- hᵀ(B + K_v D)w ≤ (λmax(B) + L λmax(K_v)) a b as D ⪯ L;
- ‖S‖ ≤ c with S = C(q,h) + (M h) êᵀ/(1+r) − M H': ‖C(q,h)‖ ≤ k_c a ≤ k_c √n γ, ‖M H'‖ ≤ β_M ρ, and
  ‖M h‖/(1+r) ≤ β_M G because a ≤ min(L r, √n γ) and min(L r, √n γ)/(1+r) is largest where both agree,
  at r = √n γ/L, with the value G = √n γ L/(L + √n γ).

So c = β_M (ρ + G) + √n γ k_c, d = λmax(B) + L λmax(K_v), and dV/dt ≤ −[a b] Θ' [a b]ᵀ.

``sharp_form`` keeps ε = ε₀/(1+r) with C: ε ‖C(q,h)‖ ≤ ε₀ k_c a/(1+r) ≤ ε₀ k_c G. With c₁ = β_M (ρ + G) and
c₂ = k_c G the bounds are θ'22 = λmin(B) − (ε c₁ + ε₀ c₂) and θ'12 = −½ ε (d + ε c₁ + ε₀ c₂). Then det Θ'/ε =
λmin(K_p) θ'22 − ¼ ε (d + ε c₁ + ε₀ c₂)² does not increase with ε, so its value at ε = ε₀ is the least, and
there it is that of Θ' with c = c₁ + c₂: the same form, program and check. It needs no bound of h; where h is
unbounded, G is the limit L.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

from flint import arb

from lyapcheck.check.loop import ScalarForm
from lyapcheck.check.numbers.balls import precision, to_arb
from lyapcheck.check.numbers.polynomials import Enclosure, root_above

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.family.base import FamilyConstants

_PER_DEGREE = (Fraction(57295779513082, 10**12), Fraction(57295779513083, 10**12))
"""180/π = 57.2957795130823…, from below and from above."""


@dataclass(frozen=True)
class RobotBounds:
    """Enclosures of the bounds of one arm, which the checker judges only within a certificate.

    Args:
        beta_M: at least ‖M(q)‖ for all q, kg·m².
        k_c: at least ‖C(q,x)y‖ for all q and unit x, y, kg·m².
        viscous_min: λmin(B), N·m·s/rad.
        viscous_max: λmax(B), N·m·s/rad.
    """

    beta_M: Fraction
    k_c: Fraction
    viscous_min: Fraction
    viscous_max: Fraction


def scalar_form(gains: GainSet, constants: FamilyConstants, bounds: RobotBounds) -> ScalarForm | None:
    """Θ' with every irrational constant replaced by a rational on the safe side; ``None`` if h is unbounded.

    Soundness: c and d enter det Θ' with a minus sign, so each is rounded up; G grows with √n γ and with L.
    """
    if constants.gamma is None:
        return None
    norm_h = root_above(Fraction(len(gains.kp))) * _up(constants.gamma)
    return sharp_form(gains, constants, bounds, norm_h)


def sharp_form(
    gains: GainSet, constants: FamilyConstants, bounds: RobotBounds, coriolis: Fraction | None = None
) -> ScalarForm:
    """The form whose check at ε₀ proves dV/dt < 0 with less loss than ``scalar_form``, bounded h or not.

    Its drift is β_M (ρ + G) + k_c G instead of β_M (ρ + G) + k_c √n γ, and G < √n γ.

    Args:
        gains: diagonal gains, N·m, per rad or per degree where h is linear.
        constants: of the family.
        bounds: of the arm.
        coriolis: at least ‖h‖ where it meets C, instead of G.

    Soundness: as ``scalar_form``; what holds for ε < ε₀ follows from ε₀ as the module says.
    """
    rho, L = _up(constants.rho), _up(constants.L)
    G = L
    if constants.gamma is not None:
        norm_h = root_above(Fraction(len(gains.kp))) * _up(constants.gamma)
        G = norm_h * L / (L + norm_h)
    low, high = _PER_DEGREE if gains.angle_unit == "deg" else (Fraction(1), Fraction(1))
    return ScalarForm(
        stiffness=min(gains.kp) * low,
        friction=bounds.viscous_min,
        drift=_short(bounds.beta_M * (rho + G) + bounds.k_c * (coriolis or G)),
        cross=_short(bounds.viscous_max + L * max(gains.kv) * high),
    )


def published_limit(gains: GainSet, constants: FamilyConstants, bounds: RobotBounds) -> Enclosure | None:
    """The end of the interval (18) for ε₀, or ``None`` where (19) fails and the interval is empty.

    N [λmin(B) − √n γ λmax(K_v)] / (N [β_M (ρ+γ) + γ k_c] + ¼ [√n γ λmax(B) + n ρ γ λmax(K_v)]²) with
    N = n γ² λmin(K_p), read with ε ≤ ε₀.

    References: (18), (19) of reyes2019family.
    """
    if constants.gamma is None:
        return None
    with precision(160):
        root, gamma, rho = arb(len(gains.kp)).sqrt(), constants.gamma.to_arb(), constants.rho.to_arb()
        kp, kv = to_arb(min(gains.kp)), to_arb(max(gains.kv))
        beta, k_c = to_arb(bounds.beta_M), to_arb(bounds.k_c)
        slack = to_arb(bounds.viscous_min) - root * gamma * kv
        if not slack > 0:
            return None
        N = (root * gamma) ** 2 * kp
        bracket = root * gamma * to_arb(bounds.viscous_max) + root**2 * rho * gamma * kv
        return Enclosure.from_arb(N * slack / (N * (beta * (rho + gamma) + gamma * k_c) + bracket**2 / 4))


def _up(enclosure: Enclosure) -> Fraction:
    return _short(enclosure.upper)


def _short(value: Fraction) -> Fraction:
    """A decimal of twelve places that is not below a value: short numbers keep certificates readable."""
    scale = 10**12
    return Fraction(-((-value.numerator * scale) // value.denominator), scale)
