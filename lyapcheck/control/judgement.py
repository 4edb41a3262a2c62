"""What the checker says of a statement about gains, by the first of some proofs that it accepts."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import TYPE_CHECKING

from lyapcheck.certificate import Certificate
from lyapcheck.check.covers import require_covered
from lyapcheck.check.refusal import Refused
from lyapcheck.check.statement import Proof, Statement
from lyapcheck.check.verify import verify
from lyapcheck.files.decimals import decimal_text, significant_up
from lyapcheck.promise import Promise, promised

if TYPE_CHECKING:
    from lyapcheck.check.certificate import About
    from lyapcheck.check.certificate import Certificate as Read
    from lyapcheck.robots import RobotModel


ACCEPTED, REJECTED, UNDECIDED = "accepted", "rejected", "undecided"
VERDICTS = {"proved": ACCEPTED, "refuted": REJECTED}


@dataclass(frozen=True)
class JudgedStatement:
    """A statement with the verdict of ``lyapcheck.check.verify``; no proof where none was accepted.

    Args:
        statement: what is claimed.
        proof: that was accepted, of the statement or against it.
        shown: ``proved``, ``refuted`` or ``undecided``.
        grade: of the proof.
        reason: why the last proof was refused.
    """

    statement: Statement
    proof: Proof | None
    shown: str
    grade: str = ""
    reason: str = ""

    @property
    def verdict(self) -> str:
        return VERDICTS.get(self.shown, UNDECIDED)

    def certificate(self, about: About) -> Certificate | None:
        """The certificate of it; ``None`` where no proof was accepted."""
        if self.proof is None:
            return None
        return Certificate(about, self.statement, self.shown, self.grade, self.proof)


def judged_statement(statement: Statement, proofs: Iterable[Proof]) -> JudgedStatement:
    """The verdict on a statement.

    Soundness: that of ``lyapcheck.check.verify``.
    """
    reason = "no proof was tried"
    for proof in proofs:
        try:
            result = verify(statement, proof)
        except Refused as refused:
            reason = str(refused)
        else:
            return JudgedStatement(statement, proof, result.verdict, result.grade, "")
    return JudgedStatement(statement, None, UNDECIDED, "", reason)


def shown_by(
    kept: Iterable[Read], question: Callable[[Statement], Statement | None]
) -> Iterator[tuple[Promise, JudgedStatement]]:
    """The promises of certificates that answer a question, each judged again.

    Args:
        kept: certificates, not judged.
        question: what a statement would have to answer, such as with its own ε₀; ``None``: another kind.

    Soundness: that of ``lyapcheck.check.verify`` and ``lyapcheck.check.covers``; names and verdicts in the
        certificates are not used.
    """
    for one in kept:
        asked = question(one.statement)
        if asked is None:
            continue
        try:
            require_covered(one.statement, asked)
        except Refused:
            continue
        judged = judged_statement(one.statement, [one.proof])
        promise, _ = promised(asked, judged)
        if promise is not None:
            yield promise, judged


def proves(statement: Statement, proof: Proof) -> bool:
    """Whether the checker accepts a proof of a statement."""
    return judged_statement(statement, [proof]).shown == "proved"


def refutes(statement: Statement, proof: Proof) -> bool:
    """Whether the checker accepts a refutation of a statement."""
    return judged_statement(statement, [proof]).shown == "refuted"


# --- How far from the goal dry friction may leave a joint: k_p |h(e)| ≤ f, tight to six digits.
#
# References: (6), (7), (11) of reyes2019family.


HALVINGS = 26
"""Of an error that is known to a factor of 2: finer than the six digits that are kept."""
FARTHEST = 2**10
"""rad: larger bounds are as good as none."""
DEGREES = Fraction("57.295779513082321")
"""A little more than 180/π."""


def dry_friction(model: RobotModel) -> tuple[Fraction, ...]:
    """The largest Coulomb torques in the ranges of an arm, N·m; 0 where nothing is known."""
    return tuple(Fraction(0) if number is None else number.bounds[1] for number in model.coulomb)


@lru_cache(maxsize=4096)
def rest_error(family: str, m: int | None, ratio: Fraction) -> Fraction | None:
    """The least error, rad, that |h| ≤ ratio is shown to imply, nearly; ``None`` where it bounds none.

    Soundness: the checker's :func:`lyapcheck.check.kinds.resting.rests_within` accepts it.
    """
    from lyapcheck.check.kinds.resting import rests_within
    from lyapcheck.check.numbers.members import member

    h, low, high = member(family, m), Fraction(0), Fraction(1)
    if rests_within(h, ratio, low):
        return low
    while not rests_within(h, ratio, high):
        low, high = high, 2 * high
        if high > FARTHEST:
            return None
    while not low and rests_within(h, ratio, high / 2):
        high /= 2
    low = high / 2
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        low, high = (low, middle) if rests_within(h, ratio, middle) else (middle, high)
    rounded = significant_up(high, 6)
    return rounded if rests_within(h, ratio, rounded) else None


def degrees_above(error: Fraction) -> str:
    """An angle of rad in degrees, in four digits and never rounded down."""
    return f"{decimal_text(significant_up(error * DEGREES, 4))}°" if error else "0°"


Room = tuple[Fraction | None, ...]
"""What the motor of each joint can do beyond gravity, N·m; ``None`` where its limit is not known."""


def stalls(load: Fraction, room: Fraction | None) -> bool:
    """Whether a load may hold a joint, together with gravity, while its motor is at its limit.

    Soundness: there τmax ≤ |g_i| + |d_i|. So each state of rest is one of (11) if the load is below the room.
    """
    return room is not None and load >= room
