"""The largest ε₀ that branch and bound proves, approached from below a falsified one."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from time import monotonic

from lyapcheck._types import Progress
from lyapcheck.check.kinds.decreasing import BoxTree
from lyapcheck.search.branch_and_bound import certify
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.search.cover import EXHAUSTED, LATE, RESISTS
from lyapcheck.search.proof import Proof
from lyapcheck.search.schur import Problem

SHARES = tuple(Fraction(n, 10_000) for n in (5000, 8000, 9000, 9500, 9800, 9900, 9950, 9980, 9992))
"""Shares of the falsified ε₀ that are tried one after the other."""

DIGITS = 7
MAX_BOXES = 400_000
MOST_JOINTS = 3
"""Boxes of (q, e) have 2n − 1 sides: with more joints the bounds in ‖e‖ alone are what can be had."""
_MANY_JOINTS = f"boxes of (q, e) are looked at up to {MOST_JOINTS} joints only"
_UNBOUNDED = "h is unbounded: branch and bound needs its γ for the states far away"


@dataclass(frozen=True)
class Certified:
    """The proof of the largest ε₀, how many boxes all attempts looked at, and why ε₀ is not larger."""

    proof: Proof | None
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
) -> Certified:
    """The largest share of a ceiling for which dV/dt < 0 is proved on the whole state space.

    Args:
        controlled: gains and arm, with its ranges where the setting has them.
        ceiling: an ε₀ that is known to fail, or any guess above what can be hoped for.
        max_boxes: the budget of all attempts together.
        jobs: processes for the checker.
        seconds: no new boxes are looked at after that time; the answer then depends on the machine.
        on_progress: told the share of the attempts done.

    Returns:
        no proof where nothing was proved; ``reason`` says why the next share was not.

    Soundness: every proof has been accepted by ``lyapcheck.check.verify``, in balls.
    """
    if not controlled.family.bounded:
        return Certified(None, 0, _UNBOUNDED)
    if controlled.n > MOST_JOINTS:
        return Certified(None, 0, _MANY_JOINTS)
    progress = on_progress or (lambda fraction, note: None)
    deadline = math.inf if seconds is None else monotonic() + seconds
    result, looked_at, reason = _attempts(controlled, ceiling, max_boxes, deadline, progress)
    while result:
        proof = result.pop()
        progress(len(SHARES) / (len(SHARES) + 1), f"checking {proof.boxes} boxes in balls")
        if proof.accepted(jobs):
            return Certified(proof, looked_at, reason)
        reason = f"the boxes found for ε₀ = {float(proof.loop.eps0):.6g} were refused by the checker"
    return Certified(None, looked_at, reason)


def _attempts(
    controlled: ControlledArm, ceiling: Fraction, max_boxes: int, deadline: float, progress: Progress
) -> tuple[list[Proof], int, str]:
    """What the search believes to be proofs, of growing ε₀; boxes looked at; why it went no further."""
    result: list[Proof] = []
    looked_at = 0
    for index, share in enumerate(SHARES):
        loop = controlled.loop(_rounded_down(ceiling * share))
        if not loop.admissible:
            return result, looked_at, f"K_p is too small beside K_v for ε₀ = {float(loop.eps0):.6g}"
        advance = _part(progress, index, f"{float(share):.1%} of falsified")
        advance(0.0, "")
        outcome = certify(Problem(loop), max_boxes - looked_at, advance, deadline)
        looked_at += outcome.boxes
        if not outcome.proved:
            return result, looked_at, _advice(outcome.reason, loop.eps0, max_boxes)
        result.append(Proof(loop, BoxTree(outcome.tree), controlled.inertia_proof))
    return result, looked_at, ""


def _part(progress: Progress, index: int, label: str) -> Progress:
    """The progress of one attempt: the share of the volume decided, and the boxes looked at."""

    def advance(fraction: float, note: str) -> None:
        decided = f", {note}, {fraction:.1%} of the volume decided" if note else ""
        progress((index + fraction) / (len(SHARES) + 1), f"{label}{decided}")

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


def _rounded_down(value: Fraction) -> Fraction:
    places = DIGITS - 1 - math.floor(math.log10(value))
    scale = Fraction(10) ** places
    return Fraction(math.floor(value * scale)) / scale
