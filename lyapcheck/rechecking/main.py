"""``python -P -m lyapcheck.check CERTIFICATE…``: recheck certificates with this package alone.

The same as ``lyapcheck recheck``, for whoever has the standard library, python-flint, the checker and this.
"""

from __future__ import annotations

import argparse
import io
import sys

from lyapcheck.check.judgement import MOST, Limits
from lyapcheck.rechecking.command import FORMATS, HELP, run

INTERRUPTED = 130


def main(arguments: list[str] | None = None) -> int:
    """Parse the options of :func:`run`, and run."""
    parser = argparse.ArgumentParser(prog="python -P -m lyapcheck.check", description=__doc__)
    parser.add_argument("certificates", nargs="+", metavar="CERTIFICATE", help="files or directories")
    parser.add_argument("--format", choices=FORMATS, default="text", help=HELP["format"])
    for name in ("full", "trusted"):
        parser.add_argument(f"--{name}", action="store_true", help=HELP[name])
    for name in ("seconds", "memory"):
        least = getattr(Limits(), name)
        parser.add_argument(f"--{name}", type=_positive, default=least, help=f"{HELP[name]} [{least}]")
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(encoding="utf-8", errors="backslashreplace")
    try:
        return run(**vars(parser.parse_args(arguments)))
    except KeyboardInterrupt:
        return INTERRUPTED


def _positive(word: str) -> int:
    value = int(word)
    if not 1 <= value <= MOST:
        raise argparse.ArgumentTypeError(f"must be from 1 to {MOST}")
    return value
