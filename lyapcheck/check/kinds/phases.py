"""How near its goal an arm stays from which times on, by levels of V at an ε₀ that grows as the arm slows.

No proof refutes such a statement: bounds that are too small are refused, not shown to be false.

References: ``reyes2019family`` (11), (12), (13), (15).
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise

from lyapcheck.check.expressions.text import angles_text, list_text, number_text
from lyapcheck.check.kinds.of_loop import OfLoop
from lyapcheck.check.kinds.settling import Envelope, require_falling, require_signs
from lyapcheck.check.limits import LARGEST
from lyapcheck.check.loop.closed_loop import RateProof
from lyapcheck.check.loop.decay.estimate import Disturbance, Estimate
from lyapcheck.check.loop.decay.margin import Margin
from lyapcheck.check.loop.decay.speeds import fastest, regraded, secant_above, slowed
from lyapcheck.check.loop.decay.tail import covers, degree, shortest
from lyapcheck.check.numbers.members import member
from lyapcheck.check.refusal import Refused, require
from lyapcheck.check.statement import Proof, Total
from lyapcheck.check.verify import Accepted, require_proved, rule, weakest

Times = tuple[tuple[Fraction, tuple[Fraction, ...]], ...]
"""Pairs (s, rad): from that time on each |e_i| is at most that."""


@dataclass(frozen=True)
class DiesOut:
    """From the last time of ``within`` on, T: |e_i| ≤ a_i exp(−(t − T)/s), or for m ≥ 2 a power of time.

    ``sizes`` are the a_i, rad, and ``scale`` is s; the power is (1 + (t − T)/s)^(−1/(2m − 2)).
    """

    sizes: tuple[Fraction, ...]
    scale: Fraction


@dataclass(frozen=True)
class StaysWithin(OfLoop, Total):
    """Every solution of (11) from some starts has |e_i| within bounds from times on.

    ``errors_at_start``, rad, and ``rates_at_start``, rad/s, bound each |e_i(0)| and
    |w_i(0)|, for any q(0). ``after`` says how errors die out.
    """

    errors_at_start: tuple[Fraction, ...]
    rates_at_start: tuple[Fraction, ...]
    within: Times
    after: DiesOut | None

    def require_well_formed(self) -> None:
        """One number a joint, none below 0 where sizes are bounded; times that rise."""
        super().require_well_formed()
        self.require_sizes("errors_at_start", "rates_at_start")
        n = len(self.mass)
        require(len(self.within) > 0, "within", "", "must have a time")
        for time, errors in self.within:
            require(time >= 0, "time", time, "must not be negative")
            require(len(errors) == n, "errors", len(errors), f"must be {n}, one a joint")
            for value in errors:
                require(0 <= value <= LARGEST, "errors", value, f"must be from 0 to {LARGEST}")
        for (before, _), (after, _) in pairwise(self.within):
            require(before < after, "time", after, f"must be after {before}")
        if self.after is not None:
            count = len(self.after.sizes)
            require(count == n, "sizes", count, f"must be {n}, one a joint")
            require(min(self.after.sizes) >= 0, "sizes", min(self.after.sizes), "must not be negative")
            require(self.after.scale > 0, "scale", self.after.scale, "must be positive")
            require(degree(self.family, self.m) is not None, "after", self.family, "is not of this family")

    @property
    def largest_errors(self) -> tuple[Fraction, ...]:
        """rad, from the first time on."""
        return self.within[0][1]

    @property
    def errors(self) -> tuple[Fraction, ...]:
        """rad, from the last time on."""
        return self.within[-1][1]

    @property
    def granted(self) -> tuple[str, ...]:
        """What ties the numbers to a robot."""
        return (*super().granted, "no other torque acts")

    def text(self) -> str:
        """The statement in one line."""
        within = ", ".join(
            f"|e_i(t)| ≤ {angles_text(errors)} for all t ≥ {number_text(time)} s"
            for time, errors in self.within
        )
        return (
            f"every solution of (11) that starts with "
            f"|e_i(0)| ≤ {angles_text(self.errors_at_start)} and |w_i(0)| ≤ "
            f"{list_text(self.rates_at_start)} rad/s, at any q(0), has {within}{self._dying()}; "
            f"for {self.gains_text()} and {self.mass_text()}"
        )

    def _dying(self) -> str:
        """How errors die out."""
        if self.after is None:
            return ""
        elapsed = f"(t − {number_text(self.within[-1][0])} s)/{number_text(self.after.scale)} s"
        m = degree(self.family, self.m) or 1
        falling = f"exp(−{elapsed})" if m == 1 else f"(1 + {elapsed})^(−1/{2 * m - 2})"
        return f", and from then on |e_i(t)| ≤ a_i {falling} with a = {angles_text(self.after.sizes)}"


@dataclass(frozen=True)
class Phase:
    """Levels of V with ε = ε₀, while h(w_i)/w_i are at least ``floors`` and |e_i| at most ``within``, rad.

    ``friction`` η, ``stiffness`` κ and ``split`` t are those of ``lyapcheck.check.loop.decay``, for the loop
    of ``decay.speeds`` with these ``floors``; ``inertia`` shows M(q) ≺ diag(u) for the u in ``heaviest``,
    kg·m²; ``rate`` shows dV/dt < 0 at (1 − η)B and (1 − κ)K_p of that loop.
    """

    eps0: Fraction
    within: tuple[Fraction, ...]
    floors: tuple[Fraction, ...]
    friction: Fraction
    stiffness: Fraction
    split: Fraction
    heaviest: tuple[Fraction, ...]
    inertia: Proof
    rate: RateProof
    envelope: Envelope
    slopes: tuple[Fraction, ...]


@dataclass(frozen=True)
class FallingPhases(Proof):
    """Phases one after the other; M ≻ 0, and for each floor above 0 a ν_i with M ⪰ ν_i at place (i, i).

    ``lightest`` are the ν_i, kg·m², 0 where none is used.
    """

    rule = "falling levels in phases"
    positive: Proof
    lightest: tuple[Fraction, ...]
    lightness: tuple[Proof, ...]
    phases: tuple[Phase, ...]


@rule(StaysWithin, FallingPhases)
def by_phases(statement: StaysWithin, proof: FallingPhases) -> Accepted:
    """Soundness: in each phase V falls through its bands, as for ``settling``, and is kept.

    E does not rise, so that speeds keep below what E is at the start of a phase, and floors that hold then
    hold from then on. V ≤ v bounds the errors, as M ≻ 0 leaves Σ k_pi U(e_i) ≤ V; so does E.
    """
    grades = [require_proved(statement.mass_positive, proof.positive, "M ≻ 0")]
    grades += _require_lightest(statement, proof)
    require(len(proof.phases) > 0, "phases", 0, "must be at least one")
    energy = last = eps0 = time = Fraction(0)
    levels: list[tuple[Fraction, Fraction]] = []
    for phase in proof.phases:
        grades.append(require_proved(statement.mass_below(phase.heaviest), phase.inertia, "M ≺ diag(u)"))
        estimate = _estimate(statement, phase)  # the last one is asked again how errors die out
        start = statement.errors_at_start, statement.rates_at_start
        if not levels:
            energy, first = estimate.start_energy(*start), estimate.start_level(*start)
            levels.append((time, energy))
        else:
            first = regraded(last, phase.eps0 - eps0, estimate.margin.loop, phase.heaviest)
        _require_slow(statement, proof, phase, energy)
        require(len(phase.within) > 0, "within", "", "must bound the errors: ε = ε₀ there")
        near = estimate.keeps(energy, phase.within)
        require(near, "within", list_text(phase.within), "is not shown to be kept by the energy")
        require(len(phase.envelope) > 1, "envelope", "one level", "must have a band to fall through")
        begins, level = phase.envelope[0]
        require(begins == time, "time", begins, f"must be {time}, when the phase before ends")
        require(first <= level, "first level", level, f"must be at least {float(first):.6g} J")
        require_falling(estimate, phase.envelope, phase.slopes)
        levels += phase.envelope
        (time, last), eps0 = phase.envelope[-1], phase.eps0
        energy = min(energy, regraded(last, eps0, estimate.margin.loop, phase.heaviest))
    for since, errors in statement.within:
        level = min((level for reached, level in levels if reached <= since))
        kept = estimate.keeps(level, errors)
        require(kept, "errors", list_text(errors), f"are not what V ≤ {float(level):.6g} J allows at most")
    if statement.after is not None:
        _require_dying(statement, estimate, time, last)
    return Accepted("proved", weakest([*grades, "enclosure"]))


def _require_dying(statement: StaysWithin, estimate: Estimate, time: Fraction, level: Fraction) -> None:
    """Errors die out as stated from the end of the last phase on."""
    after = statement.after
    since, errors = statement.within[-1]
    if after is None or since < time or not estimate.keeps(level, errors):
        raise Refused("after", since, "must begin when the last phase ends, with errors that its level keeps")
    within = covers(estimate, level, errors, after.sizes)
    require(within, "sizes", list_text(after.sizes), f"are not what V ≤ {float(level):.6g} J allows at most")
    least = shortest(estimate, level, errors)
    enough = least is not None and after.scale >= least
    require(enough, "scale", number_text(after.scale), "is shorter than what is shown")


def _estimate(statement: StaysWithin, phase: Phase) -> Estimate:
    """What follows from the margin of a phase, which is shown here."""
    loop = statement.loop(phase.eps0, within=phase.within)
    shares = (phase.friction, phase.stiffness, phase.split, Fraction(0))
    margin = Margin(slowed(loop, phase.floors), *shares, phase.heaviest)
    require_signs(margin)
    phase.rate.require_shown(margin.reduced)
    return Estimate(margin, Disturbance.none(len(statement.mass)))


def _require_slow(statement: StaysWithin, proof: FallingPhases, phase: Phase, energy: Fraction) -> None:
    """Each h(w_i)/w_i is at least its floor while the energy is at most that."""
    known = member(statement.family, statement.m)
    for floor, inertia in zip(phase.floors, proof.lightest, strict=True):
        if floor > 0:
            require(inertia > 0, "floor", floor, "needs a bound of M from below")
            speed = fastest(energy, inertia)
            slow = secant_above(known, floor, speed)
            require(slow, "floor", floor, f"is not shown to be below h(w)/w up to {float(speed):.6g} rad/s")


def _require_lightest(statement: StaysWithin, proof: FallingPhases) -> list[str]:
    """The grades of M ⪰ ν_i at place (i, i)."""
    n = len(statement.mass)
    used = [i for i, inertia in enumerate(proof.lightest) if inertia]
    require(len(proof.lightest) == n, "lightest", len(proof.lightest), f"must be {n}, one a joint")
    require(len(proof.lightness) == len(used), "lightness", len(proof.lightness), f"must be {len(used)}")
    grades = []
    for i, by in zip(used, proof.lightness, strict=True):
        inertia = proof.lightest[i]
        require(inertia > 0, "lightest", inertia, "must not be negative")
        lighter = statement.mass_lightened(i, inertia)
        grades.append(require_proved(lighter, by, f"M − {number_text(inertia)} at joint {i + 1} ≻ 0"))
    return grades
