"""The gate's verdict on one gain set: gravity of the arm, torques of the motors and (19) in one statement.

With √n γ = N: (10) λmax(K_p) + λmax(K_v) ≤ (‖τmax‖ − ‖k_g‖)/N, (10p) k_pi + k_vi < (τmax_i − k_gi)/N,
(10i) k_pi + k_vi ≤ (τmax_i − k_gi)/γ and (19) k_vi < λmin(B)/N.

References: ``reyes2019family`` (6), (10), (19) and Section 4.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction

from flint import arb

from lyapcheck.check.expressions.text import list_text, number_text
from lyapcheck.check.judgement import LARGEST, TORQUE
from lyapcheck.check.kinds.decreasing import OfLoop
from lyapcheck.check.kinds.gravity import GravityBelow, GravityOfPotential
from lyapcheck.check.kinds.identity import SameHarmonics
from lyapcheck.check.kinds.inertia import (
    OfArm,
    PostureWitness,
    law_text,
    polynomial_text,
    potential_text,
    require_one_a_joint,
    require_posture,
    variable_names,
    written_out,
)
from lyapcheck.check.loop.field import value_at
from lyapcheck.check.numbers.balls import hyperbolic_constants, precision, to_arb
from lyapcheck.check.numbers.members import member
from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.check.refusal import require
from lyapcheck.check.statement import Ends, Monomials, Proof, Statement, Total
from lyapcheck.check.verify import Accepted, require_proved, rule, weakest

TORQUES = ("10p", "10i")
"""Each of these bounds |τ_i| ≤ γ (k_pi + k_vi) + k_gi by τmax_i at every state."""
MOST_DIGITS = 1000


@dataclass(frozen=True)
class GateAccepted(Total):
    """For every arm in the ranges |g_i(q)| ≤ k_gi for all q, and the conditions hold with these k_gi.

    With (10p) or (10i) then |τ_i| ≤ τmax_i at every state. Without ``gravity`` the k_gi are a premise.
    ``gravity`` is the gradient of ``potential``; ``limits`` are τmax, ``k_g`` and gains in N·m; ``viscous``
    has the range of each b_i. ``stability`` are statements about M(q) of the same arm and the same loop.
    """

    joints: int
    gravity: tuple[Monomials, ...]
    potential: Monomials
    parameters: tuple[Ends, ...]
    k_g: tuple[Fraction, ...]
    viscous: tuple[Ends, ...]
    limits: tuple[Fraction | None, ...]
    family: str
    m: int | None
    kp: tuple[Fraction, ...]
    kv: tuple[Fraction, ...]
    conditions: tuple[str, ...]
    stability: tuple[Statement, ...]

    def require_well_formed(self) -> None:
        """One number a joint; positive gains; conditions that are known, and parts about this arm."""
        n = self.joints
        require_one_a_joint(self, n, "k_g", "viscous", "limits", "kp", "kv")
        require(min(*self.kp, *self.kv) > 0, "gains", "", "must be positive")
        require(min(self.k_g) >= 0, "k_g", min(self.k_g), "must not be negative")
        require(
            all(0 <= low <= high for low, high in self.viscous), "viscous", "", "must be ranges from 0 on"
        )
        require(all(x is None or x >= 0 for x in self.limits), "limits", "", "must not be negative")
        known = [name for name in ("10", "10p", "10i", "19") if name in self.conditions]
        require(list(self.conditions) == known, "conditions", self.conditions, "must be some, in order")
        limited = known in ([], ["19"]) or None not in self.limits
        require(limited, "limits", "", "must be known where a condition needs them")
        if self.gravity:
            require(len(self.gravity) == n, "gravity", len(self.gravity), f"must be {n}, one a joint")
            self.gradient.require_well_formed()
        else:
            require(not self.potential, "potential", "", "must be empty without gravity")
        for part in self.stability:
            require(self._is_about(part), "stability", type(part).__name__, "is not about this arm and loop")
            part.require_well_formed()

    def _is_about(self, part: Statement) -> bool:
        """Whether a statement is about as many joints in these ranges, and about this loop."""
        if not isinstance(part, OfArm | OfLoop) or len(part.mass) != self.joints:
            return False
        same = self._has_ranges_of(part)
        if isinstance(part, OfLoop):
            pairs = zip(part.viscous, self.viscous, strict=False)
            same = same and all(a <= low and high <= b for (a, b), (low, high) in pairs)
            loop = "family", "m", "kp", "kv"
            same = same and all(getattr(part, name) == getattr(self, name) for name in loop)
        return same

    def _has_ranges_of(self, part: OfArm | OfLoop) -> bool:
        """Whether a statement has these ranges; of what its M does not depend on any number serves.

        A statement about an exact arm says nothing of the others in ranges.
        """
        if not part.parameters:
            return all(low == high for low, high in self.parameters)
        powers = [powers for row in part.mass for entry in row for powers, _ in entry]
        pairs = zip(part.parameters, self.parameters, strict=False)
        return len(part.parameters) == len(self.parameters) and all(
            own == asked or not any(power[2 * self.joints + k] for power in powers)
            for k, (own, asked) in enumerate(pairs)
        )

    @property
    def gradient(self) -> GravityOfPotential:
        return GravityOfPotential(self.gravity, self.potential, self.parameters)

    @property
    def bounds(self) -> list[GravityBelow]:
        pairs = zip(self.gravity, self.k_g, strict=True) if self.gravity else ()
        return [GravityBelow(self.joints, (entry,), self.parameters, k) for entry, k in pairs]

    def comparisons(self) -> Iterator[tuple[str, int]]:
        """Each condition, with each joint that it is about."""
        for name in self.conditions:
            yield from ((name, i) for i in range(1 if name == "10" else self.joints))

    def holds(self, name: str, i: int, gamma: Fraction) -> bool:
        """Whether a condition holds at one joint with this number for γ; if so, also with a smaller one."""
        n = self.joints
        if name == "19":
            return _root_below(n, self.kv[i], gamma, min(low for low, _ in self.viscous))
        limits = [Fraction(0) if limit is None else limit for limit in self.limits]
        reach, room = self.kp[i] + self.kv[i], limits[i] - self.k_g[i]
        if name == "10i":
            return reach * gamma <= room
        if name == "10p":
            return _root_below(n, reach, gamma, room)
        # √a + √G ≤ √T, as a + G ≤ T and 4aG ≤ (T − a − G)²
        T, G = (sum((x * x for x in values), Fraction(0)) for values in (limits, self.k_g))
        a = n * ((max(self.kp) + max(self.kv)) * gamma) ** 2
        return a + G <= T and 4 * a * G <= (T - a - G) ** 2

    @property
    def theorems(self) -> tuple[tuple[str, str], ...]:
        return tuple(pair for part in self.stability for pair in part.theorems)

    @property
    def granted(self) -> tuple[str, ...]:
        premise = (
            f"|g_i(q)| ≤ k_gi with k_g = {list_text(self.k_g)} N·m at every posture, for which no g is given"
        )
        parts = (line for part in self.stability for line in part.granted)
        return tuple(dict.fromkeys((TORQUE, *(() if self.gravity else (premise,)), *parts)))

    def text(self) -> str:
        limits = ", ".join("none" if x is None else number_text(x) for x in self.limits)
        words = [
            f"|g_i(q)| ≤ k_gi for all q{'' if self.gravity else ', a premise'}",
            *(f"({name}) with these k_gi" for name in self.conditions),
            *(["|τ_i| ≤ τmax_i at every state"] if set(TORQUES) & set(self.conditions) else []),
            *(part.text() for part in self.stability),
        ]
        names = variable_names(self.joints, len(self.parameters))
        pairs = zip(names[2 * self.joints :], self.parameters, strict=True)
        over = [f"{name} in {number_text(a)} … {number_text(b)}" for name, (a, b) in pairs]
        entries = [f"g{i} = {polynomial_text(g, names)}" for i, g in enumerate(self.gravity, 1)]
        if self.gravity:
            over += [written_out(entries, "g(q)", self.gravity, ())]
            over += [
                potential_text(self.potential, self.joints, len(self.parameters), "potential U(q) of it")
            ]
        return (
            f"{'; '.join(words)}: for every arm with k_g = {list_text(self.k_g)}, τmax = ({limits}), "
            f"{', '.join([law_text(self.viscous, self.family, self.m, self.kp, self.kv), *over])}"
        )


def _root_below(n: int, gain: Fraction, gamma: Fraction, room: Fraction) -> bool:
    """√n·gain·γ < room, all but room positive; in integers, as squares of fractions take longer."""
    (a, b), (c, d), (e, f) = (x.as_integer_ratio() for x in (gain, gamma, room))
    return e > 0 and n * (a * c * f) ** 2 < (e * b * d) ** 2


def gamma_between(family: str, m: int | None, digits: int) -> Enclosure:
    """Two numbers with γ between them; of a hyperbolic function so many digits apart.

    Soundness: no value of h is above its supremum, and γ of a member is at least that.
    """
    require(1 <= digits <= MOST_DIGITS, "digits", digits, f"must be from 1 to {MOST_DIGITS}")
    known = member(family, m)
    if family in ("hyperbolic", "tanh"):
        return hyperbolic_constants(m or 1, digits).gamma
    return Enclosure(Enclosure.from_arb(known.h(arb(10) ** 30)).lower, known.gamma)


@dataclass(frozen=True)
class GateParts(Proof):
    """A proof of each bound of gravity and of each part about stability, and how many digits of γ suffice."""

    rule = "gravity, gains and limits"
    gravity: tuple[Proof, ...]
    digits: int
    stability: tuple[Proof, ...]


@dataclass(frozen=True)
class SaturatingState(Proof):
    """A state at which a motor cannot give its torque: e_i = x, w_i = −x, in rad, and a posture.

    ``turns`` are the angles in quarters of a turn; ``joint`` counts from 0.
    """

    rule = "saturating state"
    joint: int
    turns: tuple[Fraction, ...]
    parameters: tuple[Fraction, ...]
    x: Fraction


@dataclass(frozen=True)
class BrokenCondition(Proof):
    """A condition that fails at one joint, from 0, with γ from below to so many digits."""

    rule = "broken condition"
    condition: str
    joint: int
    digits: int


@rule(GateAccepted, GateParts)
def by_parts(statement: GateAccepted, proof: GateParts) -> Accepted:
    """Soundness: |τ_i| ≤ (k_pi + k_vi) γ + |g_i(q)|; (10p) implies (10i), as √n ≥ 1 and k_pi + k_vi > 0."""
    gamma = gamma_between(statement.family, statement.m, proof.digits)
    for name, i in statement.comparisons():
        require(statement.holds(name, i, gamma.upper), f"({name})", f"joint {i + 1}", "is not shown to hold")
    for subject, have, want in (
        ("gravity", proof.gravity, statement.bounds),
        ("stability", proof.stability, statement.stability),
    ):
        require(len(have) == len(want), subject, len(have), f"must be one a part, {len(want)}")
    pairs: list[tuple[Statement, Proof]] = [*zip(statement.bounds, proof.gravity, strict=True)]
    pairs += zip(statement.stability, proof.stability, strict=True)
    pairs += [(statement.gradient, SameHarmonics())] if statement.gravity else []
    grades = ["exact" if gamma.width == 0 or not statement.conditions else "enclosure"]
    grades += [require_proved(part, own, type(part).__name__) for part, own in pairs]
    return Accepted("proved", weakest(grades))


@rule(GateAccepted, SaturatingState)
def by_saturation(statement: GateAccepted, proof: SaturatingState) -> Accepted:
    """Soundness: |(k_pi + k_vi) h(x) + g_i(q)| > τmax_i at one state, so that (10i) and (10p) fail."""
    torques = set(TORQUES) & set(statement.conditions) and statement.gravity
    require(bool(torques), "conditions", statement.conditions, "say nothing of a torque at each state")
    i = proof.joint
    require(0 <= i < statement.joints, "joint", i, f"must be from 0 to {statement.joints - 1}")
    require(abs(proof.x) <= LARGEST, "x", proof.x, f"must be from −{LARGEST} to {LARGEST}")
    at = PostureWitness(proof.turns, proof.parameters, ())
    require_posture(at, statement.joints, statement.parameters)
    (entry,), limit = statement.bounds[i].entries, statement.limits[i] or Fraction(0)
    with precision(192):
        h = member(statement.family, statement.m).h(to_arb(proof.x))
        pull = value_at(entry, proof.turns, proof.parameters, arb.pi() / 2)
        torque = to_arb(statement.kp[i] + statement.kv[i]) * h + pull
        require(abs(torque) > to_arb(limit), "torque", torque, f"is not shown to exceed {limit} N·m")
    return Accepted("refuted", "enclosure")


@rule(GateAccepted, BrokenCondition)
def by_condition(statement: GateAccepted, proof: BrokenCondition) -> Accepted:
    """Soundness: a condition that fails with a γ from below fails with γ."""
    name, i = proof.condition, proof.joint
    require((name, i) in statement.comparisons(), f"({name})", i, "is not among the conditions")
    gamma = gamma_between(statement.family, statement.m, proof.digits)
    require(not statement.holds(name, i, gamma.lower), f"({name})", i, "is not shown to fail")
    return Accepted("refuted", "exact" if gamma.width == 0 else "enclosure")
