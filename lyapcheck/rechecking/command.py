"""``recheck`` as a command, the same behind ``lyapcheck recheck`` and ``python -P -m lyapcheck.check``."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping, Sequence

from lyapcheck.check.files import Unreadable, gather
from lyapcheck.check.guard import CannotStart
from lyapcheck.check.limits import Limits
from lyapcheck.check.recheck import Outcome, recheck
from lyapcheck.rechecking.render import as_json, text

UNUSABLE = 2
Writer = Callable[[Outcome, bool], str]
FORMATS: Mapping[str, Writer] = {"text": text, "json": as_json}
HELP = {
    "format": "How to write it.",
    "full": "Write long statements, and what their authors say of them, whole.",
    "trusted": "Also list the rules and modules that each verdict rests on.",
    "seconds": "The most computing time, in s, for one certificate; past it, it is undecided.",
    "memory": "The most memory, in MiB, for one certificate; past it, it is undecided.",
}
REPAIR = "give files written with --certificates, or their folders; those of a report: certificates/*/"


def run(
    certificates: Sequence[str],
    format: str,  # noqa: A002
    full: bool,
    trusted: bool,
    seconds: int,
    memory: int,
    formats: Mapping[str, Writer] = FORMATS,
) -> int:
    """Print the outcome; 0: all accepted, 1: some refused, 2: unusable, 3: some undecided, 4: an alarm."""
    try:
        outcome = recheck(gather(certificates), Limits(seconds, memory), full)
    except Unreadable as error:
        for name, rule in error.problems:
            print(f"error: {name}: CERTIFICATE: {rule}; {REPAIR}", file=sys.stderr)
        return UNUSABLE
    except CannotStart as error:
        print(f"error: --memory = {memory}: {error}; allow more", file=sys.stderr)
        return UNUSABLE
    sys.stdout.write(formats[format](outcome, trusted))
    return outcome.code
