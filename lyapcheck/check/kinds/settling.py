"""How near its goal an arm comes, and when, under bounded torques and dry friction: by falling levels of V.

No proof refutes such a statement: bounds that are too small are refused, not shown to be false.

References: ``reyes2019family`` (11), (12), (13), (15).
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from hashlib import sha256
from itertools import pairwise

from lyapcheck.check.expressions.text import angles_text, diagonal_text, list_text, number_text
from lyapcheck.check.kinds.decreasing import PositiveAndDecreasing, friction_text, statement_of
from lyapcheck.check.kinds.inertia import LONGEST, Mass, mass_text
from lyapcheck.check.kinds.ranges import of_arm, require_arm
from lyapcheck.check.kinds.resting import LARGEST
from lyapcheck.check.loop.closed_loop import ClosedLoop, InertiaBound
from lyapcheck.check.loop.decay.estimate import Disturbance, Estimate
from lyapcheck.check.loop.decay.margin import Margin
from lyapcheck.check.loop.states import Arm
from lyapcheck.check.refusal import require
from lyapcheck.check.statement import Ends, Proof, Total
from lyapcheck.check.verify import Accepted, require_proved, rule, weakest

Envelope = tuple[tuple[Fraction, Fraction], ...]
"""Pairs (s, J), times rising and levels falling: from that time on V is at most that."""


@dataclass(frozen=True)
class Settling(Total):
    """Every solution of (11) from some starts, under a torque d − φ, stays below levels of V and errors.

    For every arm in the ranges: ``mass`` is M(q), kg·m²; ``viscous`` the range of each diagonal entry of B,
    N·m·s/rad; ``parameters`` the range of each parameter in M; ``family`` and ``m`` name h; ``kp`` and
    ``kv`` are in N·m; ``eps0`` is ε₀ of (12). ``torque`` bounds each |d_i|, and ``dry`` each |φ_i| with
    φ_i w_i ≥ 0, in N·m. ``errors_at_start``, rad, and ``rates_at_start``, rad/s, bound each |e_i(0)| and
    |w_i(0)|, for any q(0). ``errors`` bounds |e_i|, rad, from the last time of ``envelope`` on,
    ``largest_errors`` from its first time on.
    """

    mass: Mass
    viscous: tuple[Ends, ...]
    parameters: tuple[Ends, ...]
    family: str
    m: int | None
    kp: tuple[Fraction, ...]
    kv: tuple[Fraction, ...]
    eps0: Fraction
    torque: tuple[Fraction, ...]
    dry: tuple[Fraction, ...]
    errors_at_start: tuple[Fraction, ...]
    rates_at_start: tuple[Fraction, ...]
    envelope: Envelope
    largest_errors: tuple[Fraction, ...]
    errors: tuple[Fraction, ...]

    def require_well_formed(self) -> None:
        """One number a joint, none below 0 where sizes are bounded; times that rise and levels that fall."""
        n = require_arm(self.mass, self.parameters, self.viscous)
        for subject in ("kp", "kv", *SIZES):
            size = len(getattr(self, subject))
            require(size == n, subject, size, f"must be {n}, one a joint")
        for subject in SIZES:
            for value in getattr(self, subject):
                require(0 <= value <= LARGEST, subject, value, f"must be from 0 to {LARGEST}")
        require(len(self.envelope) > 0, "envelope", "", "must have a level")
        (time, _), (_, level) = self.envelope[0], self.envelope[-1]
        require(time >= 0, "time", time, "must not be negative")
        require(level >= 0, "level", level, "must not be negative")
        for (before, above), (after, below) in pairwise(self.envelope):
            require(before < after, "time", after, f"must be after {before}")
            require(above > below, "level", below, f"must be below {above}")

    @property
    def granted(self) -> tuple[str, ...]:
        """What ties the numbers to a robot."""
        friction = "dry friction opposes each joint's motion, or holds it, with at most the torque stated"
        others = (
            "no other torque acts than d within its bounds" if any(self.torque) else "no other torque acts"
        )
        return (
            *of_arm(self.parameters, self.viscous),
            *([friction] if any(self.dry) else []),
            others,
        )

    def text(self) -> str:
        """The statement in one line."""
        member_m = "" if self.m is None else f"_{self.m}"
        first, last = (number_text(self.envelope[end][0]) for end in (0, -1))
        return (
            f"every absolutely continuous solution of (11){self._acting()} that starts with "
            f"|e_i(0)| ≤ {angles_text(self.errors_at_start)} and |w_i(0)| ≤ "
            f"{list_text(self.rates_at_start)} rad/s, at any q(0), "
            f"has |e_i(t)| ≤ {angles_text(self.errors)} for all t ≥ {last} s, "
            f"|e_i(t)| ≤ {angles_text(self.largest_errors)} for all t ≥ {first} s, "
            f"and V of (13) is {_envelope_text(self.envelope)}; for B = {friction_text(self.viscous)}, "
            f"h = {self.family}{member_m}, K_p = {diagonal_text(self.kp)}, K_v = {diagonal_text(self.kv)}, "
            f"ε₀ = {number_text(self.eps0)} and {mass_text(self.mass, self.parameters)}"
        )

    def _acting(self) -> str:
        """The torques beside those of (11)."""
        torque = f"|d_i| ≤ {list_text(self.torque)} N·m" if any(self.torque) else ""
        dry = f"|φ_i| ≤ {list_text(self.dry)} N·m and φ_i w_i ≥ 0 (dry friction)" if any(self.dry) else ""
        if not torque and not dry:
            return ""
        sum_of = "d − φ" if torque and dry else "d" if torque else "−φ"
        return f" with a torque {sum_of} on its right, {', '.join(filter(None, (torque, dry)))},"


SIZES = ("torque", "dry", "errors_at_start", "rates_at_start", "largest_errors", "errors")


@dataclass(frozen=True)
class FallingLevels(Proof):
    """What dV/dt is below 0 by, and how steep V is taken to be in each band between two levels.

    ``friction`` is η, ``stiffness`` κ, ``split`` t, ``slack`` s and ``slopes`` the λ of
    ``lyapcheck.check.loop.decay``; ``inertia`` has the weights d_i, μ and what shows it (cuts are not
    used); ``decreasing`` shows M ≻ 0, and dV/dt < 0 at (1 − η)B and (1 − κ)K_p.
    """

    rule = "falling levels"
    friction: Fraction
    stiffness: Fraction
    split: Fraction
    slack: Fraction
    inertia: InertiaBound
    decreasing: PositiveAndDecreasing
    slopes: tuple[Fraction, ...]


@rule(Settling, FallingLevels)
def by_levels(statement: Settling, proof: FallingLevels) -> Accepted:
    """Soundness: V starts below the first level, and falls through each band in the time that is stated.

    All of it holds for every arm in the ranges, which is the same one throughout a motion.
    In a band −dV/dt is at least its fall φ > 0, so that V passes it in its height over φ and does not come
    back; a level without a band below it is kept only where nothing acts, as −dV/dt ≥ 0 then. V ≤ v bounds
    the errors, as M ≻ 0 leaves Σ k_pi U(e_i) ≤ V.
    """
    acting = any(statement.torque) or any(statement.dry)
    require(len(statement.envelope) > acting, "envelope", "one level", "need not be kept under a disturbance")
    margin = margin_of(statement, proof)
    grade = require_margin(margin, proof.decreasing)
    estimate = Estimate(margin, Disturbance(statement.torque, statement.dry))
    _, first = statement.envelope[0]
    start = estimate.start_level(statement.errors_at_start, statement.rates_at_start)
    require(start <= first, "first level", first, f"must be at least {float(start):.6g} J, where V may start")
    require_falling(estimate, statement.envelope, proof.slopes)
    for subject, level in (("largest_errors", first), ("errors", statement.envelope[-1][1])):
        errors = getattr(statement, subject)
        kept = estimate.keeps(level, errors)
        require(kept, subject, list_text(errors), f"are not what V ≤ {float(level):.6g} J allows at most")
    return Accepted("proved", weakest([grade, "enclosure"]))


def require_falling(estimate: Estimate, envelope: Envelope, slopes: tuple[Fraction, ...]) -> None:
    """V is shown to fall through every band of an envelope in the time that is stated.

    Raises:
        Refused: in one band it is not.
    """
    bands = len(envelope) - 1
    require(len(slopes) == bands, "slopes", len(slopes), f"must be {bands}, one a band")
    for ((t, high), (later, low)), slope in zip(pairwise(envelope), slopes, strict=True):
        steepest = estimate.steepest
        require(0 <= slope <= steepest, "slope", slope, f"must be from 0 to {float(steepest):.6g}")
        fall = estimate.fall(low, high, slope)
        band = f"between {float(high):.6g} J and {float(low):.6g} J"
        require(fall > 0, "V", band, "is not shown to fall")
        require((later - t) * fall >= high - low, "time", later, f"is too short for V to fall {band}")


def margin_of(statement: Settling, proof: FallingLevels) -> Margin:
    """What dV/dt is said to be below 0 by."""
    loop = ClosedLoop(
        Arm(statement.mass, tuple(low for low, _ in statement.viscous)),
        statement.family,
        statement.m,
        statement.kp,
        statement.kv,
        statement.eps0,
        parameters=statement.parameters,
        viscous=statement.viscous,
    )
    shares = (proof.friction, proof.stiffness, proof.split, proof.slack)
    return Margin(loop, *shares, proof.inertia)


def require_margin(margin: Margin, decreasing: PositiveAndDecreasing) -> str:
    """The grade of the margin: M ≻ 0, dV/dt < 0 for the reduced closure, and λmax(D⁻¹MD⁻¹) ≤ μ.

    Raises:
        Refused: one of them is not shown.

    Soundness: dV/dt of the reduced closure is taken at the same states as that of the arm itself; how it was
        proved to be below 0 does not matter.
    """
    signs = (
        "have a sign or size that does not fit: gains, B, K̃ and ε₀ must be positive, shares within 0 and 1"
    )
    require(margin.admissible and margin.reduced.admissible, "gains, friction, shares or weights", "", signs)
    grade = require_proved(
        statement_of(margin.reduced), decreasing, "M ≻ 0 and dV/dt < 0 of the reduced loop"
    )
    mu = float(margin.inertia.inertia)
    require(margin.inertia_shown(), "μ", f"{mu:.6g}", "is not shown to be above λmax(D⁻¹MD⁻¹)")
    return grade


def _envelope_text(envelope: Envelope) -> str:
    """``at most v J from t s on, …``, or where that is long its ends and a digest."""
    rows = [f"at most {number_text(level)} J from {number_text(time)} s on" for time, level in envelope]
    written = ", ".join(rows)
    if len(written) <= LONGEST:
        return written
    digest = sha256(repr(envelope).encode()).hexdigest()[:32]
    return f"{rows[0]}, …, {rows[-1]} ({len(rows)} times and levels with digest {digest})"
