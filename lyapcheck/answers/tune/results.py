"""What tuning found: gains a member of the family, and how they compare with others."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from lyapcheck.check.numbers.enclosure import Enclosure
from lyapcheck.control.deciding import DECIDING
from lyapcheck.control.gains import GainSet

TUNED, INFEASIBLE, UNDECIDED = "tuned", "infeasible", "undecided"


@dataclass(frozen=True)
class TunedJoint:
    """The gains of one joint and what forbids larger ones.

    Args:
        name: of the joint.
        kp: N·m, exact.
        kv: N·m, exact.
        sum_limit: what (10p) keeps k_p + k_v below, N·m.
        kv_limit: what (19) keeps k_v below, N·m.
        kp_bound: ``10p`` or ``damping``: what one unit more of k_p would break.
        kv_bound: ``19`` or ``10p``: what one unit more of k_v would break.
        damping: the damping ratio from below, where one was asked for.
    """

    name: str
    kp: Fraction
    kv: Fraction
    sum_limit: Enclosure
    kv_limit: Enclosure
    kp_bound: str
    kv_bound: str
    damping: Fraction | None = None


@dataclass(frozen=True)
class ComparedJoint:
    """A joint's gains from elsewhere beside the tuned ones.

    Args:
        name: of the joint.
        kp: theirs, N·m.
        kv: theirs, N·m.
        kp_left: tuned k_p less theirs: what they left on the table, N·m.
        kp_left_share: the same as a share of the tuned k_p, from below.
        used: the share of (10p)'s limit that they use, from below.
        broken: the conditions that they break.
    """

    name: str
    kp: Fraction
    kv: Fraction
    kp_left: Fraction
    kp_left_share: Fraction
    used: Fraction
    broken: tuple[str, ...]


@dataclass(frozen=True)
class GainComparison:
    """A gain set from elsewhere beside the tuned one."""

    name: str
    source: str
    joints: tuple[ComparedJoint, ...]


@dataclass(frozen=True)
class TunedSet:
    """The gains for one member; ``reasons`` says why there are none."""

    name: str
    m: int
    status: str
    joints: tuple[TunedJoint, ...] = ()
    reasons: tuple[str, ...] = ()
    program: str = ""
    comparison: GainComparison | None = None

    @property
    def gains(self) -> GainSet | None:
        """As the gate reads them."""
        if self.status != TUNED:
            return None
        kp, kv = tuple(j.kp for j in self.joints), tuple(j.kv for j in self.joints)
        return GainSet(self.name, self.m, kp, kv, condition=DECIDING)
