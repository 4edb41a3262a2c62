"""The largest ε₀ that branch and bound proves, approached from below a falsified one.

P(q, e) of ``lyapcheck.check.loop`` must be positive definite for all q on the torus, all e, and all
values of what is uncertain about the arm. Boxes are enclosed in intervals, kept if P ≻ 0, else halved.

- **Infinity.** For ‖e‖ ≥ R the scalar form proves dV/dt < 0; boxes outside that ball are not looked at.
- **Origin.** ê = e/‖e‖ has no value at e = 0; its enclosure [−1, 1]ⁿ covers every direction, so boxes that
  touch e = 0 are proved for all of them, e = 0 (where ê counts as 0) included.
- **Symmetry.** Errors that a change of signs turns into others are looked at once, and angles that M does not
  depend on are held at 0.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np

from lyapcheck._types import Progress, silent
from lyapcheck.check.kinds.decreasing import BoxTree
from lyapcheck.check.kinds.link_bounds import LinkBounds
from lyapcheck.check.loop import ClosedLoop, certifies
from lyapcheck.computing import computing_time
from lyapcheck.files.decimals import significant_down
from lyapcheck.robots.dynamics import FEW_JOINTS
from lyapcheck.search.boxes import EXHAUSTED, LATE, RESISTS, CoverOutcome, cover
from lyapcheck.search.controlled_arm import ControlledArm, DecreaseProof, RateData
from lyapcheck.search.link_bounds import MAX_BOXES as LINKED_BOXES
from lyapcheck.search.link_bounds import ErrorBoxes, link_bounds
from lyapcheck.search.schur import SchurProblem


def certify(
    problem: SchurProblem, max_boxes: int, on_progress: Progress | None = None, deadline: float = math.inf
) -> CoverOutcome:
    """Look for a tree of boxes that proves dV/dt < 0 everywhere for one ε₀, or say why there is none.

    Args:
        problem: what must be positive definite.
        deadline: by the computing time of `lyapcheck.computing`, s.

    Soundness: the tree of the outcome is a proposal for ``lyapcheck.check.loop.proves``.
    """
    loop = problem.loop
    if certifies(loop.tail, loop.eps0):
        return CoverOutcome(True, 0, tree=".")
    start = np.array(loop.start).T[None]
    return cover(start, problem.proved, problem.sides, max_boxes, on_progress, deadline)


HOPED = Fraction(9900, 10_000), Fraction(9992, 10_000)
"""Shares of the falsified ε₀ that are tried first, in turn."""
SHARES = tuple(Fraction(n, 100) for n in (50, 80, 90, 95, 98))
"""Those that are tried one after the other where not even the first of these is proved."""
SHARES_OF_LINKS = tuple(Fraction(n, 1000) for n in (300, 600, 750, 850, 900, 930, 950, 970, 985))
"""The same by bounds along the links."""
_CHECKING = 0.8
"""The share of the work done when the checker begins."""
ENOUGH = Fraction(9, 10)
"""The share of the falsified ε₀ from which on boxes are not followed by bounds along the links."""
MOST = Fraction(5, 6)
"""How much of what is left of the budget one share may take where less than that is proved, so that something
is left for a smaller one."""
RESERVE = Fraction(1, 4)
"""Of the budget, for bounds along the links of few joints."""
DIGITS = 7
MAX_BOXES = 400_000
_UNBOUNDED = "h is unbounded: branch and bound needs its γ for the states far away"
Attempt = Callable[[ClosedLoop, int, Progress, float], tuple[CoverOutcome, RateData]]
"""What may prove one ε₀ with so many boxes by a deadline, and the data that do."""


@dataclass(frozen=True)
class CertifiedEpsilon:
    """The proof of the largest ε₀, how many boxes all attempts looked at, and why ε₀ is not larger."""

    proof: DecreaseProof | None
    looked_at: int
    reason: str

    @property
    def eps0(self) -> Fraction | None:
        """The largest ε₀ proved."""
        return None if self.proof is None else self.proof.loop.eps0


def certified_epsilon(
    controlled: ControlledArm,
    ceiling: Fraction,
    max_boxes: int = MAX_BOXES,
    jobs: int = 1,
    seconds: float | None = None,
    on_progress: Progress | None = None,
) -> CertifiedEpsilon:
    """The largest share of a ceiling for which dV/dt < 0 is proved on the whole state space.

    Args:
        controlled: gains and arm, with its ranges where the setting has them.
        ceiling: an ε₀ that is known to fail, or any guess above what can be hoped for.
        max_boxes: the budget of all attempts together.
        jobs: processes that share the boxes of the checker; they change no answer.
        seconds: of computing time, after which no new boxes are looked at; the answer depends on the machine.

    Returns:
        no proof where nothing was proved; ``reason`` says why the next share was not.

    Soundness: every proof has been accepted by ``lyapcheck.check.verify``, in balls.
    """
    if not controlled.family.bounded:
        return CertifiedEpsilon(None, 0, _UNBOUNDED)
    progress = on_progress or silent
    if controlled.n > FEW_JOINTS:
        return _along_links(controlled, ceiling, max_boxes, seconds, progress)

    def by_boxes(
        loop: ClosedLoop, most: int, advance: Progress, deadline: float
    ) -> tuple[CoverOutcome, BoxTree]:
        outcome = certify(SchurProblem(loop), most, advance, deadline)
        return outcome, BoxTree(outcome.tree)

    search = _Search(controlled, ceiling, progress, by_boxes)
    began, seconds = computing_time(), math.inf if seconds is None else seconds
    # no more than half of everything for what may be too much
    result = search.climb(HOPED[:1], max_boxes // 2, began + seconds / 2)
    result += search.climb(HOPED[1:] if result else SHARES, max_boxes, began + seconds)
    return search.accepted(result, jobs)


def _along_links(
    controlled: ControlledArm, ceiling: Fraction, max_boxes: int, seconds: float | None, progress: Progress
) -> CertifiedEpsilon:
    """The same by bounds along the links and boxes of errors alone; no attempt begins after the time."""
    progress(0.0, "bounds along the links")
    bounds = link_bounds(controlled)
    if bounds is None:
        return CertifiedEpsilon(None, 0, "no bounds along the links were shown")

    def by_links(
        loop: ClosedLoop, most: int, advance: Progress, late: float
    ) -> tuple[CoverOutcome, LinkBounds]:
        if computing_time() > late:
            return CoverOutcome(False, 0, LATE), bounds
        outcome = ErrorBoxes(loop, bounds).covered(most)
        return outcome, replace(bounds, tree=outcome.tree, scales=outcome.scales)

    search = _Search(controlled, ceiling, progress, by_links, LINKED_BOXES)
    deadline = computing_time() + (math.inf if seconds is None else seconds)
    return search.accepted(search.climb(SHARES_OF_LINKS, max_boxes, deadline), 1)


def linked_otherwise(
    controlled: ControlledArm,
    ceiling: Fraction,
    boxes: CertifiedEpsilon,
    max_boxes: int,
    seconds: float | None = None,
    on_progress: Progress | None = None,
) -> CertifiedEpsilon:
    """What boxes proved, or for three joints more by bounds along the links, where boxes end far below.

    Args:
        controlled: see `certified_epsilon`.
        ceiling: an ε₀ that is known to fail.
        boxes: what was proved without.
        max_boxes: of errors e alone, of all attempts together.
        seconds: of computing time, after which no attempt begins.

    Soundness: as for `certified_epsilon`.
    """
    near = boxes.eps0 is not None and boxes.eps0 >= ENOUGH * ceiling
    if near or max_boxes <= 0 or not links_follow(controlled):
        return boxes
    result = _along_links(controlled, ceiling, max_boxes, seconds, on_progress or silent)
    better = result if (result.eps0 or 0) > (boxes.eps0 or 0) else boxes
    return replace(better, looked_at=boxes.looked_at + result.looked_at)


def links_follow(controlled: ControlledArm) -> bool:
    """Whether bounds along the links are tried after boxes, which are many for three joints."""
    return controlled.n == FEW_JOINTS and controlled.family.bounded and bool(controlled.chains)


@dataclass
class _Search:
    """The attempts at shares of a ceiling: boxes looked at so far, and why the last one failed.

    The middle between a share that fails and the last that was proved is tried once: where the budget of the
    share is spent, or always where each has a budget of its own.
    """

    controlled: ControlledArm
    ceiling: Fraction
    progress: Progress
    attempt: Attempt
    each: int = 0
    looked_at: int = 0
    attempts: int = 0
    reason: str = ""

    def climb(self, shares: Sequence[Fraction], max_boxes: int, deadline: float) -> list[DecreaseProof]:
        """What the search believes to be proofs, up to the first share for which there is none."""
        result: list[DecreaseProof] = []
        left, proved, between = list(shares), Fraction(0), False
        while left:
            share = left.pop(0)
            loop = self.controlled.loop(significant_down(self.ceiling * share, DIGITS))
            if not loop.admissible:
                self.reason = f"K_p is too small beside K_v for ε₀ = {float(loop.eps0):.6g}"
                return result
            advance = _part(self.progress, self.attempts, f"{float(share):.1%} of falsified")
            advance(0.0, "")
            budget = max_boxes - self.looked_at
            most = int(MOST * budget) if left and proved < ENOUGH and budget > 0 else budget
            outcome, by = self.attempt(loop, min(self.each, budget) if self.each else most, advance, deadline)
            self.attempts += 1
            self.looked_at += outcome.boxes
            if outcome.proved:
                result.append(self.controlled.proof(loop, by))
                proved = share
                continue
            self.reason = _advice(outcome.reason, loop.eps0, self.each or max_boxes)
            spent = outcome.reason == EXHAUSTED and max_boxes > self.looked_at
            again = proved and (spent or self.each) and not between
            left, between = [(proved + share) / 2] if again else [], True
        return result

    def accepted(self, result: list[DecreaseProof], jobs: int) -> CertifiedEpsilon:
        """The last of some proofs that the checker accepts."""
        while result:
            proof = result.pop()
            self.progress(_CHECKING, f"checking {proof.boxes} boxes in balls")
            if (accepted := proof.accepted(jobs)) is not None:
                return CertifiedEpsilon(accepted, self.looked_at, self.reason)
            self.reason = f"the boxes found for ε₀ = {float(proof.loop.eps0):.6g} were refused by the checker"
        return CertifiedEpsilon(None, self.looked_at, self.reason)


def _part(progress: Progress, index: int, label: str) -> Progress:
    """The progress of one attempt: the share of the volume decided, and the boxes looked at."""

    def advance(fraction: float, note: str) -> None:
        decided = f", {note}, {fraction:.1%} of the volume decided" if note else ""
        progress(_CHECKING * min((index + fraction) / (1 + len(SHARES)), 1.0), f"{label}{decided}")

    return advance


def _advice(reason: str, eps0: Fraction, max_boxes: int) -> str:
    tried = f"ε₀ = {float(eps0):.6g} was not proved"
    if reason == EXHAUSTED:
        return f"{tried} within {max_boxes} boxes: allow more boxes"
    if reason == LATE:
        return f"{tried} in time: allow more seconds"
    if reason == RESISTS:
        return f"{tried}: the bound fails at one state, so more boxes would not help"
    return f"{tried}: {reason}"
