"""One statement: what lyapcheck says of it, against what is known of it."""

from __future__ import annotations

import json
import signal
import traceback
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from tests.statement_fuzz.generators import FALSE, NEITHER, TRUE, UNPROVABLE, Made
from tests.statement_fuzz.oracle.kinds import confirms, objection
from tests.statement_fuzz.subject import decide, to_json

SECONDS = 30
"""The processor time that a decision may take; a limit of the fuzzer, not a promise of lyapcheck."""

PROVED, REFUTED, UNDECIDED, NONE = "proved", "refuted", "undecided", "no verdict"
DISAGREEMENT = "undecided: the checker refuses what the search found"
FALSE_REFUSED = "undecided, and not true"
VERDICTS = (PROVED, REFUTED, UNDECIDED, FALSE_REFUSED, DISAGREEMENT, NONE)


class TooSlow(BaseException):
    """A decision took longer than the limit; no ``Exception``, so that nothing takes it for a failed try."""


@dataclass(frozen=True)
class Judged:
    """A verdict, and what is wrong with it (nothing, if ``fault`` is empty)."""

    made: Made
    verdict: str
    fault: str = ""
    method: str = ""

    @property
    def signature(self) -> tuple[str, str, str]:
        """What faults of the same sort have in common."""
        what = self.fault.partition(" at ")[0].partition("; witness")[0].partition(": {")[0]
        return self.kind, self.verdict, what if self.verdict != NONE else self.fault.rpartition("(")[2]

    @property
    def kind(self) -> str:
        """The kind of statement."""
        return type(self.made.statement).__name__

    def text(self) -> str:
        """The fault with the statement, in a few lines."""
        data = json.dumps(to_json(self.made.statement), ensure_ascii=False)
        return f"{self.kind}, {self.made.family}: {self.verdict} ({self.method}), but {self.fault}\n  {data}"


def judge(made: Made, seed: int = 0, by: Callable[[Any], Any] = decide) -> Judged:
    """The verdict on a statement, judged.

    A statement that is ``proved`` must not be false or undefined anywhere; one that is ``refuted`` must not
    be true, and the oracle must confirm the point; an exception, or no decision in time, is a fault as well.
    """
    patience = getattr(made.statement, "patience", SECONDS)
    try:
        with limit(patience), np.errstate(all="ignore"), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            decision = by(made.statement)
    except TooSlow:
        if patience < SECONDS:
            return Judged(made, UNDECIDED)
        return Judged(made, NONE, f"no decision within {SECONDS} s")
    except Exception as error:
        return Judged(made, NONE, _place(error))
    verdict = str(decision.verdict.value)
    if verdict == UNDECIDED and "report this as a fault" in decision.reason:
        return Judged(made, DISAGREEMENT, "", str(decision.method))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            with limit(patience):
                fault = _fault(made, verdict, decision, seed)
        except TooSlow:
            fault = ""
        except Exception as error:
            fault = f"the oracle itself fails: {_place(error)}" if verdict != UNDECIDED else ""
    if verdict == UNDECIDED and fault:
        verdict, fault = FALSE_REFUSED, ""
    return Judged(made, verdict, fault, str(decision.method))


def _place(error: Exception) -> str:
    """An exception, and the last function of this project that it came through."""
    frames = [
        frame for frame in traceback.extract_tb(error.__traceback__) if "site-packages" not in frame.filename
    ]
    place = f"{Path(frames[-1].filename).stem}.{frames[-1].name}" if frames else ""
    return f"{type(error).__name__}: {str(error)[:120]} ({place})"


def _fault(made: Made, verdict: str, decision: Any, seed: int) -> str:
    if verdict in (PROVED, UNDECIDED):
        result = objection(made.statement, seed)
        if result is not None:
            return str(result)
        if made.truth in (FALSE, NEITHER, UNPROVABLE):
            return f"{made.truth} by construction"
    if verdict == REFUTED:
        if made.truth in (TRUE, NEITHER):
            return f"{made.truth} by construction; witness {decision.witness}"
        if confirms(made.statement, decision.witness or {}) is False:
            return f"the witness is none: {decision.witness}"
    return ""


@contextmanager
def limit(seconds: float) -> Iterator[None]:
    """Raise :class:`TooSlow` in what takes more processor time, however busy the machine is."""

    def stop(*_: object) -> None:
        raise TooSlow

    before = signal.signal(signal.SIGVTALRM, stop)
    signal.setitimer(signal.ITIMER_VIRTUAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)
        signal.signal(signal.SIGVTALRM, before)
