"""dV/dt < 0 at the states within limits of speed and of error, and which motions keep within them.

The energy E = ½ wᵀM(q)w + Σ k_pi U(e_i) never rises along (11): dE/dt = −wᵀBw − wᵀK_v h(w). With M ⪰ ν_i
at place (i, i), E ≤ c leaves |w_i| ≤ √(2c/ν_i) and U(e_i) ≤ c/k_pi. Where that is within the limits, a motion
that starts with E ≤ c stays in this compact set, on which V of (13) falls: it tends to the origin, and the
origin is asymptotically stable.

References: ``reyes2019family`` (11), (12), (13); ``khalil2002nonlinear``, theorem 4.1.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction

from lyapcheck.check.expressions.text import angles_text, list_text, number_text
from lyapcheck.check.kinds.decreasing import (
    Decreasing,
    StateWitness,
    require_rising,
)
from lyapcheck.check.kinds.inertia import PostureWitness
from lyapcheck.check.limits import LARGEST
from lyapcheck.check.loop.closed_loop import ClosedLoop, RateProof
from lyapcheck.check.loop.decay.estimate import BITS, reach_of
from lyapcheck.check.loop.decay.speeds import secant_above, slowed
from lyapcheck.check.numbers.balls import precision, to_arb
from lyapcheck.check.numbers.members import member
from lyapcheck.check.refusal import require
from lyapcheck.check.statement import Proof, Total
from lyapcheck.check.verify import Accepted, require_proved, rule, verify, weakest


@dataclass(frozen=True)
class DecreasingNearby(Total):
    """M(q) ≻ 0, and dV/dt < 0 at every state but the origin with |w_i| ≤ ``speeds``, |e_i| ≤ ``errors``.

    ``everywhere`` has arm, gains and ε₀; ``speeds``, rad/s, and ``errors``, rad, are one a joint, or none
    where that is not limited. Motions that start with E ≤ ``energy``, J, keep within the limits and tend to
    the origin; ``None`` says nothing of motions.
    """

    everywhere: Decreasing
    speeds: tuple[Fraction, ...]
    errors: tuple[Fraction, ...]
    energy: Fraction | None

    def require_well_formed(self) -> None:
        """Limits above 0, one a joint, at least of one kind; no weights Λ."""
        self.everywhere.require_well_formed()
        n = len(self.everywhere.mass)
        require(not self.everywhere.coupling, "coupling", self.everywhere.coupling, "must be empty")
        require(
            bool(self.speeds or self.errors), "limits", "", "must be there: of speed, of error or of both"
        )
        for subject in ("speeds", "errors"):
            limits = getattr(self, subject)
            require(len(limits) in (0, n), subject, len(limits), f"must be none or {n}, one a joint")
            for value in limits:
                require(0 < value <= LARGEST, subject, value, f"must be above 0 and at most {LARGEST}")
        if self.energy is not None:
            require(0 < self.energy <= LARGEST, "energy", self.energy, f"must be above 0, up to {LARGEST} J")

    @property
    def granted(self) -> tuple[str, ...]:
        """What ties the numbers to a robot."""
        motions = () if self.energy is None else ("no other torque acts, and q_d is constant",)
        return (*self.everywhere.granted, *motions)

    def text(self) -> str:
        """The statement in one line."""
        limits = []
        if self.speeds:
            limits.append(f"|w_i| ≤ {list_text(self.speeds)} rad/s")
        if self.errors:
            limits.append(f"|e_i| ≤ {angles_text(self.errors)}")
        motions = ""
        if self.energy is not None:
            motions = (
                f"; every motion that starts with ½ wᵀM(q)w + Σ k_pi U(e_i) ≤ {number_text(self.energy)} J "
                "stays among them and tends to the origin, which is asymptotically stable"
            )
        return (
            f"M(q) ≻ 0, and dV/dt < 0 along (11) at every state but the origin with {' and '.join(limits)}, "
            f"for all q{motions}; nothing is said of other states: for {self.everywhere.loop_text()}"
        )


@dataclass(frozen=True)
class SlowerAndNearer(Proof):
    """M(q) ≻ 0, least values of h(w_i)/w_i within the limits, and a proof of dV/dt < 0 that relies on them.

    ``floors`` are 0 where none is relied on; ``lightest`` are the ν_i, kg·m², shown by ``lightness``: one a
    joint where speeds are limited and something is said of motions, else none.
    """

    rule = "slower and nearer"
    inertia: Proof
    floors: tuple[Fraction, ...]
    rate: RateProof
    lightest: tuple[Fraction, ...]
    lightness: tuple[Proof, ...]


@rule(DecreasingNearby, SlowerAndNearer)
def by_both(statement: DecreasingNearby, proof: SlowerAndNearer) -> Accepted:
    """Soundness: h(w_i)/w_i is from the floor to L within the limits, see ``decay.speeds``; E as above."""
    whole = statement.everywhere
    grades = [require_proved(whole.mass_positive, proof.inertia, "M ≻ 0")]
    known, n = member(whole.family, whole.m), len(whole.mass)
    require(len(proof.floors) == n, "floors", len(proof.floors), f"must be {n}, one a joint")
    for floor, speed in zip(proof.floors, statement.speeds or (Fraction(0),) * n, strict=True):
        shown = floor == 0 or (0 < floor < known.L and speed > 0 and secant_above(known, floor, speed))
        require(shown, "floor", floor, f"is not shown to be below h(w)/w up to {number_text(speed)} rad/s")
    loop = nearby_loop(statement, proof.floors)
    require(loop.admissible, "gains, friction or ε₀", "", "K_p, K_v, B, K̃ and ε₀ must be positive, M = Mᵀ")
    proof.rate.require_shown(loop)
    if statement.energy is not None:
        grades += _require_kept(statement, statement.energy, proof)
    return Accepted("proved", weakest([*grades, "enclosure"]))


def nearby_loop(statement: DecreasingNearby, floors: tuple[Fraction, ...]) -> ClosedLoop:
    """The closed loop that has to be shown, with what the floors add to the damping."""
    return slowed(replace(statement.everywhere.closed_loop, nearby=statement.errors), floors)


def _require_kept(statement: DecreasingNearby, energy: Fraction, proof: SlowerAndNearer) -> list[str]:
    """E ≤ ``energy`` keeps within the limits; the grades of what that rests on."""
    whole = statement.everywhere
    known = member(whole.family, whole.m)
    with precision(BITS):
        for k in whole.kp:
            reach_of(known, energy / k)  # E ≤ c bounds all errors
        for k, error in zip(whole.kp, statement.errors, strict=bool(statement.errors)):
            kept = to_arb(k) * known.potential(to_arb(error)) >= to_arb(energy)
            require(kept, "energy", energy, f"is not shown to keep |e_i| ≤ {number_text(error)} rad")
    count = len(statement.speeds)
    require(len(proof.lightest) == count, "lightest", len(proof.lightest), f"must be {count}")
    require(len(proof.lightness) == count, "lightness", len(proof.lightness), f"must be {count}")
    grades = []
    rows = zip(statement.speeds, proof.lightest, proof.lightness, strict=True)
    for i, (speed, inertia, by) in enumerate(rows):
        require(inertia > 0, "lightest", inertia, "must be positive")
        slow = speed * speed * inertia >= 2 * energy
        require(slow, "energy", energy, f"is not shown to keep |w_i| ≤ {number_text(speed)} rad/s")
        lighter = whole.mass_lightened(i, inertia)
        grades.append(require_proved(lighter, by, f"M − {number_text(inertia)} at joint {i + 1} ≻ 0"))
    return grades


@rule(DecreasingNearby, PostureWitness)
def by_posture(statement: DecreasingNearby, proof: PostureWitness) -> Accepted:
    """Soundness: M(q) is not positive definite at one posture of one arm within the ranges."""
    result = verify(statement.everywhere.mass_positive, proof)
    require(result.verdict == "refuted", "M ≻ 0", result.verdict, "must be refuted")
    return result


@rule(DecreasingNearby, StateWitness)
def by_state(statement: DecreasingNearby, proof: StateWitness) -> Accepted:
    """Soundness: dV/dt > 0 in balls at one state within the limits, of one arm within the ranges."""
    for subject, values, limits in (("w", proof.w, statement.speeds), ("e", proof.e, statement.errors)):
        if limits:
            require(len(values) == len(limits), subject, len(values), f"must be {len(limits)}, one a joint")
            near = all(abs(x) <= limit for x, limit in zip(values, limits, strict=True))
            require(near, subject, list_text(values), f"must be within {list_text(limits)}")
    require_rising(statement.everywhere, proof)
    return Accepted("refuted", "enclosure")
