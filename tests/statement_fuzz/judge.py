"""One statement: what lyapcheck says of it, against what is known of it."""

import json
import signal
import traceback
import warnings
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from lyapcheck.certificate import to_json
from lyapcheck.claims.procedures import propose
from tests import oracle
from tests.statement_fuzz.generators import FALSE, NEITHER, TRUE, UNPROVABLE, Made
from tests.statement_fuzz.generators.altered import Altered

SECONDS, PATIENCE = 30, 2
"""The processor time that a decision may take, and what was altered: limits of the fuzzer."""
PROVED, REFUTED, UNDECIDED, NONE = "proved", "refuted", "undecided", "no verdict"
FALSE_REFUSED = "undecided, and not true"
DISAGREEMENT = "undecided: the checker refuses what the search found"


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
    def kind(self):
        """The kind of statement."""
        return type(self.made.statement).__name__

    def text(self):
        """The fault with the statement, in a few lines."""
        data = json.dumps(to_json(_meant(self.made)), ensure_ascii=False)
        return f"{self.kind}, {self.made.family}: {self.verdict} ({self.method}), but {self.fault}\n  {data}"


def _meant(made):
    return made.statement.statement if isinstance(made.statement, Altered) else made.statement


def decide(statement):
    """The verdict that the search proposes and the rules of the checker accept."""
    return statement.decide() if isinstance(statement, Altered) else propose(statement)


def judge(made, seed=0, by=decide):
    """The verdict on a statement, judged.

    A statement that is ``proved`` must not be false or undefined anywhere; one that is ``refuted`` must not
    be true, and the oracle must confirm the point; an exception, or no decision in time, is a fault as well.
    """
    changed = isinstance(made.statement, Altered) or made.family.startswith("planted")
    patience = PATIENCE if changed else SECONDS
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        try:
            with limit(patience):
                decision = by(made.statement)
        except TooSlow:
            slow = "" if patience < SECONDS else f"no decision within {SECONDS} s"
            return Judged(made, NONE if slow else UNDECIDED, slow)
        except Exception as error:
            return Judged(made, NONE, _place(error))
        verdict = decision.verdict.value
        if verdict == UNDECIDED and "report this as a fault" in decision.reason:
            return Judged(made, DISAGREEMENT, "", str(decision.method))
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


def _place(error):
    """An exception, and the last function of this project that it came through."""
    frames = [one for one in traceback.extract_tb(error.__traceback__) if "site-packages" not in one.filename]
    place = f"{Path(frames[-1].filename).stem}.{frames[-1].name}" if frames else ""
    return f"{type(error).__name__}: {str(error)[:120]} ({place})"


def _fault(made, verdict, decision, seed):
    if verdict in (PROVED, UNDECIDED):
        found = oracle.objection(_meant(made), seed)
        if found is not None:
            return str(found)
        return f"{made.truth} by construction" if made.truth in (FALSE, NEITHER, UNPROVABLE) else ""
    point = (decision.witness or {}).get("point")
    if made.truth in (TRUE, NEITHER):
        return f"{made.truth} by construction; witness {point}"
    if point and oracle.confirms(_meant(made), point) is False:
        return f"the witness is none: {point}"
    return ""


@contextmanager
def limit(seconds):
    """Raise :class:`TooSlow` in what takes more processor time, however busy the machine is."""

    def stop(*_):
        raise TooSlow

    before = signal.signal(signal.SIGVTALRM, stop)
    signal.setitimer(signal.ITIMER_VIRTUAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)
        signal.signal(signal.SIGVTALRM, before)
