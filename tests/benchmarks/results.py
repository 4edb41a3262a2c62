"""What the benchmarks hand to the renderer."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class CommandResult:
    """One command beside its by-hand counterpart, if there is one.

    Args:
        command: the command line, for the reader.
        seconds: the median wall time of the whole process, or its processor time where ``agreement`` says so.
        runs: how many were measured.
        by_hand: what a user would do instead; empty if nothing compares.
        by_hand_seconds: its median wall time.
        agreement: how far the two results agree, and what the by-hand way leaves open.
    """

    command: str
    seconds: float
    runs: int
    by_hand: str = ""
    by_hand_seconds: float | None = None
    agreement: str = ""


@dataclass(frozen=True)
class RateResult:
    """States a second of one function on one arm, by each of several ways.

    Args:
        function: V or dV/dt.
        arm: its name.
        joints: how many.
        rates: states a second by way, the first being lyapcheck.
        difference: the largest difference between the ways, relative to the largest value.
    """

    function: str
    arm: str
    joints: int
    rates: dict[str, float]
    difference: float


@dataclass(frozen=True)
class Cost:
    """What the certificate of one ε₀ took.

    Args:
        share: ε₀ ÷ the falsified one.
        boxes: how many the search looked at.
        searched: its seconds.
        checked: seconds of the trusted checker; ``None`` where the search found no proof in its budget.
    """

    share: float
    boxes: int
    searched: float
    checked: float | None


@dataclass(frozen=True)
class CertificateResult:
    """What certificates of growing ε₀ took for one controller on one arm.

    Args:
        arm: its name.
        joints: how many.
        m: the member of the family.
        falsified: the ε₀ that a state refutes.
        costs: of growing share.
    """

    arm: str
    joints: int
    m: int
    falsified: float
    costs: tuple[Cost, ...]


@dataclass(frozen=True)
class RunsResult:
    """Runs a second by one way.

    Args:
        way: its name.
        runs: how many at once.
        rate: runs a second.
        difference: the largest difference of a final position (rad) or rate (rad/s) from a sharper solution.
    """

    way: str
    runs: int
    rate: float
    difference: float


@dataclass(frozen=True)
class ManyResult:
    """The command ``epsilon`` on an arm of many joints.

    Args:
        arm: its name.
        joints: how many.
        m: the member of the family.
        certified: the ε₀ that is proved.
        falsified: the one that a state refutes.
        seconds: processor time of the whole command.
        bytes: of the certificate.
        checked: processor time of ``recheck``.
    """

    arm: str
    joints: int
    m: int
    certified: float
    falsified: float
    seconds: float
    bytes: int
    checked: float


@dataclass(frozen=True)
class ConstantsResult:
    """The command ``robot`` on an arm of many joints.

    Args:
        arm: its name.
        joints: how many.
        gaps: of λmin(M), λmax(M), k_c and k_g: 1 less the lower end that is certified by the upper one.
        seconds: processor time of the whole command.
        bytes: of the certificate of k_c.
        checked: processor time of ``recheck`` of all certificates.
    """

    arm: str
    joints: int
    gaps: tuple[float, ...]
    seconds: float
    bytes: int
    checked: float
