"""How near its goal an arm comes, and when, under bounded torques and dry friction: by falling levels of V.

No proof refutes such a statement: bounds that are too small are refused, not shown to be false.

References: ``reyes2019family`` (11), (12), (13), (15).
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from hashlib import sha256
from itertools import pairwise

from lyapcheck.check.expressions.text import angles_text, list_text, number_text
from lyapcheck.check.kinds.decreasing import PositiveAndDecreasing, statement_of
from lyapcheck.check.kinds.inertia import LONGEST
from lyapcheck.check.kinds.of_loop import OfLoop
from lyapcheck.check.loop.decay.estimate import Disturbance, Estimate
from lyapcheck.check.loop.decay.margin import Margin
from lyapcheck.check.refusal import require
from lyapcheck.check.statement import Proof, Total
from lyapcheck.check.verify import Accepted, require_proved, rule, weakest

Envelope = tuple[tuple[Fraction, Fraction], ...]
"""Pairs (s, J), times rising and levels falling: from that time on V is at most that."""


@dataclass(frozen=True)
class Settling(OfLoop, Total):
    """Every solution of (11) from some starts, under a torque d − φ, stays below levels of V and errors.

    ``eps0`` is ε₀ of (12). ``torque`` bounds each |d_i|, and ``dry`` each |φ_i| with
    φ_i w_i ≥ 0, in N·m. ``errors_at_start``, rad, and ``rates_at_start``, rad/s, bound each |e_i(0)| and
    |w_i(0)|, for any q(0). ``errors`` bounds |e_i|, rad, from the last time of ``envelope`` on,
    ``largest_errors`` from its first time on.
    """

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
        super().require_well_formed()
        self.require_sizes("torque", "dry", "errors_at_start", "rates_at_start", "largest_errors", "errors")
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
            *super().granted,
            *([friction] if any(self.dry) else []),
            others,
        )

    def text(self) -> str:
        """The statement in one line."""
        first, last = (number_text(self.envelope[end][0]) for end in (0, -1))
        return (
            f"every absolutely continuous solution of (11){self._acting()} that starts with "
            f"|e_i(0)| ≤ {angles_text(self.errors_at_start)} and |w_i(0)| ≤ "
            f"{list_text(self.rates_at_start)} rad/s, at any q(0), "
            f"has |e_i(t)| ≤ {angles_text(self.errors)} for all t ≥ {last} s, "
            f"|e_i(t)| ≤ {angles_text(self.largest_errors)} for all t ≥ {first} s, "
            f"and V of (13) is {_envelope_text(self.envelope)}; for {self.gains_text()}, "
            f"ε₀ = {number_text(self.eps0)} and {self.mass_text()}"
        )

    def _acting(self) -> str:
        """The torques beside those of (11)."""
        torque = f"|d_i| ≤ {list_text(self.torque)} N·m" if any(self.torque) else ""
        dry = f"|φ_i| ≤ {list_text(self.dry)} N·m and φ_i w_i ≥ 0 (dry friction)" if any(self.dry) else ""
        if not torque and not dry:
            return ""
        sum_of = "d − φ" if torque and dry else "d" if torque else "−φ"
        return f" with a torque {sum_of} on its right, {', '.join(filter(None, (torque, dry)))},"


@dataclass(frozen=True)
class FallingLevels(Proof):
    """What dV/dt is below 0 by, and how steep V is taken to be in each band between two levels.

    ``friction`` is η, ``stiffness`` κ, ``split`` t, ``slack`` s and ``slopes`` the λ of
    ``lyapcheck.check.loop.decay``; ``inertia`` shows M(q) ≺ diag(u) for the u in ``heaviest``, kg·m²;
    ``decreasing`` shows M ≻ 0, and dV/dt < 0 at (1 − η)B and (1 − κ)K_p.
    """

    rule = "falling levels"
    friction: Fraction
    stiffness: Fraction
    split: Fraction
    slack: Fraction
    heaviest: tuple[Fraction, ...]
    inertia: Proof
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
    require_signs(margin)
    grades = [
        require_proved(statement.mass_below(proof.heaviest), proof.inertia, "M ≺ diag(u)"),
        require_proved(
            statement_of(margin.reduced), proof.decreasing, "M ≻ 0 and dV/dt < 0 of the reduced loop"
        ),
    ]
    estimate = Estimate(margin, Disturbance(statement.torque, statement.dry))
    _, first = statement.envelope[0]
    start = estimate.start_level(statement.errors_at_start, statement.rates_at_start)
    require(start <= first, "first level", first, f"must be at least {float(start):.6g} J, where V may start")
    require_falling(estimate, statement.envelope, proof.slopes)
    for subject, level in (("largest_errors", first), ("errors", statement.envelope[-1][1])):
        errors = getattr(statement, subject)
        kept = estimate.keeps(level, errors)
        require(kept, subject, list_text(errors), f"are not what V ≤ {float(level):.6g} J allows at most")
    return Accepted("proved", weakest([*grades, "enclosure"]))


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
    shares = (proof.friction, proof.stiffness, proof.split, proof.slack)
    return Margin(statement.loop(statement.eps0), *shares, proof.heaviest)


def require_signs(margin: Margin) -> None:
    """The argument applies to the numbers of a margin.

    Raises:
        Refused: it does not.

    Soundness: dV/dt of the reduced loop is taken at the same states as that of the arm itself; how it is
        proved to be below 0 does not matter.
    """
    signs = (
        "have a sign or size that does not fit: gains, B, K̃ and ε₀ must be positive, shares within 0 and 1"
    )
    require(margin.admissible and margin.reduced.admissible, "gains, friction, shares or u", "", signs)


def _envelope_text(envelope: Envelope) -> str:
    """``at most v J from t s on, …``, or where that is long its ends and a digest."""
    rows = [f"at most {number_text(level)} J from {number_text(time)} s on" for time, level in envelope]
    written = ", ".join(rows)
    if len(written) <= LONGEST:
        return written
    digest = sha256(repr(envelope).encode()).hexdigest()[:32]
    return f"{rows[0]}, …, {rows[-1]} ({len(rows)} times and levels with digest {digest})"
