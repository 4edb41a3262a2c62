"""The paper's conditions on gains, judged by the checker: (10), its rule for each joint (10p), and (19).

With N = √n γ the three read

    (10)   λmax(K_p) + λmax(K_v) ≤ (‖τmax‖ − k_g) / N
    (10p)  k_pi + k_vi < (τmax_i − k_gi) / N          for each joint i
    (10i)  k_pi + k_vi ≤ (τmax_i − k_gi) / γ          for each joint i: (10p) without its √n, which the torque
                                                      of one joint does not need
    (19)   k_vi < λmin(B) / N                         for each joint i, which is λmax(K_v) < λmin(B)/N

Each check is a statement about numbers and has the verdict of ``lyapcheck.check.verify``; see ``threshold``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import TYPE_CHECKING

from lyapcheck.check.expressions.expression import Tree
from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.check.refusal import require
from lyapcheck.control.gains import GainSet
from lyapcheck.control.judgement import ACCEPTED, REJECTED, UNDECIDED, JudgedStatement
from lyapcheck.control.threshold import Threshold, norms, scaled
from lyapcheck.files.decimals import places_of
from lyapcheck.promise import Promise

if TYPE_CHECKING:
    from lyapcheck.control.limits import Limits
    from lyapcheck.files.decimals import Written

CONDITIONS = ("10", "10p", "10i", "19")
__all__ = ["ACCEPTED", "CONDITIONS", "REJECTED", "UNDECIDED", "Check", "Conditions"]

_UNBOUNDED = "the function is unbounded (γ = ∞): no gain keeps the torque within a limit for every state"
_NO_TORQUE = "the arm has no torque limit for this joint; give [bounds] torque"
_UNTOLD = "the checker gives no verdict: {}"
_NO_FRICTION = "the arm has no viscous friction; give [bounds] viscous_min"


@dataclass(frozen=True)
class Check:
    """One condition on one joint (or on all): its value, its limit and what would still pass.

    Args:
        id: ``10``, ``10p``, ``10i``, ``19``, ``scalar``, ``global`` or ``lasalle``.
        joint: counted from 0; ``None`` where the condition is on all joints.
        judgement: the statement, and what the checker says of it; ``None`` where there is none to make.
        value: what is compared, N·m (N·m·s/rad for 19), exact; the ε₀ that a certificate proves, ``None``
            where it proves none.
        limit: what it must stay below; ``None`` where there is none (an unbounded function, no torque limit).
        largest_admissible: the largest decimal that passes, with as many places as the user wrote, or more
            where only smaller values pass; ``None`` where no positive value does.
        reason: one sentence where ``limit`` is ``None`` or nothing was decided.
        promise: of a proof about the arm, that it is about the arm as it was given.
        admitted: that the largest value passes, where another was rejected.
        threshold: what the value is compared with.
    """

    id: str
    joint: int | None = None
    judgement: JudgedStatement | None = None
    value: Fraction | None = None
    limit: Enclosure | None = None
    largest_admissible: Written | None = None
    reason: str = ""
    promise: Promise | None = None
    admitted: JudgedStatement | None = None
    threshold: Threshold | None = field(default=None, compare=False, repr=False)

    def __repr__(self) -> str:
        where = "" if self.joint is None else f" of joint {self.joint}"
        return f"<{type(self).__name__}: ({self.id}){where}, {self.verdict}>"

    @property
    def verdict(self) -> str:
        """``accepted``, ``rejected`` or ``undecided``, as the checker says."""
        return UNDECIDED if self.judgement is None else self.judgement.verdict

    @property
    def narrow(self) -> str:
        """From where alone it is accepted, as a proof about a loop as it is run may say; else empty."""
        return ""

    @property
    def own_promise(self) -> Promise:
        """That a check holds which is accepted: of a proof about the arm, else of its value and its limit.

        Raises:
            Refused: it is not accepted, or what was judged is about another value.
        """
        if self.promise is not None:
            return self.promise
        asked = None if self.threshold is None or self.value is None else self.threshold.asked(self.value)
        require(asked is not None and self.judgement is not None, "check", self.id, "has no statement")
        assert asked is not None
        assert self.judgement is not None
        return Promise(asked, self.judgement)

    @property
    def margin(self) -> Fraction | None:
        """limit − value, from below; negative where the condition is broken."""
        return None if self.limit is None or self.value is None else self.limit.lower - self.value


class Conditions:
    """The three conditions for one arm and one γ: what they compare with is computed once for all gains."""

    def __init__(self, limits: Limits, gamma: Tree | None) -> None:
        n = limits.n
        torques = [torque for torque in limits.torque if torque is not None]
        T, G = (sum((x * x for x in row), Fraction(0)) for row in (torques, limits.gravity))
        self._norm = norms(T, G, n, gamma) if len(torques) == n else None
        rows = list(zip(limits.torque, limits.gravity, strict=True))
        self._joints, self._single = (
            [None if torque is None else scaled(torque - k_g, count, gamma, sign) for torque, k_g in rows]
            for count, sign in ((n, "<"), (1, "<="))
        )
        self._damping = None if limits.viscous_min is None else scaled(limits.viscous_min, n, gamma)

    def checks(self, name: str, gains: GainSet) -> list[Check]:
        """One condition, joint by joint; (10) is about all joints.

        References: (10), (19) and the tuning rule of Section 4, reyes2019family; for (10i), (6) there and
        claim ``torque.joint`` of ``proofs/scalar.py``.
        """
        if name == "10":
            places = max(map(places_of, (*gains.kp, *gains.kv)))
            return [self._check(name, None, max(gains.kp) + max(gains.kv), places, self._norm, _NO_TORQUE)]
        if name == "19":
            return [
                self._check(name, i, kv, places_of(kv), self._damping, _NO_FRICTION)
                for i, kv in enumerate(gains.kv)
            ]
        rows = zip(gains.kp, gains.kv, self._joints if name == "10p" else self._single, strict=True)
        return [
            self._check(name, i, kp + kv, max(places_of(kp), places_of(kv)), threshold, _NO_TORQUE)
            for i, (kp, kv, threshold) in enumerate(rows)
        ]

    def all(self, gains: GainSet, deciding: Sequence[str] = ()) -> tuple[Check, ...]:
        """The checks of the paper's three, and of (10i) where it decides or (10p) fails."""
        joints = self.checks("10p", gains)
        fails = any(check.verdict == REJECTED and check.limit is not None for check in joints)
        single = self.checks("10i", gains) if "10i" in deciding or fails else []
        return (*self.checks("10", gains), *joints, *single, *self.checks("19", gains))

    def _check(
        self,
        name: str,
        joint: int | None,
        value: Fraction,
        places: int,
        threshold: Threshold | None,
        missing: str,
    ) -> Check:
        if threshold is None:
            return Check(name, joint, value=value, reason=missing)
        result = threshold.judged(value, places)
        if not threshold.bounded:
            return Check(name, joint, result, value, reason=_UNBOUNDED)
        limit = threshold.apart(value, places)
        reason = _UNTOLD.format(result.reason) if result.proof is None else ""
        largest = threshold.largest(places)
        passes = None if largest is None or result.shown == "proved" else threshold.judged(largest, places)
        return Check(name, joint, result, value, limit, largest, reason, admitted=passes, threshold=threshold)
