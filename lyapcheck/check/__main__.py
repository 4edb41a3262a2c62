"""``python -m lyapcheck.check CERTIFICATE…``: recheck certificates with this package alone.

The same as ``lyapcheck recheck``, for whoever has the standard library, python-flint and this folder only.
"""

from __future__ import annotations

import argparse
import sys

from lyapcheck.check.files import Unreadable, gather
from lyapcheck.check.recheck import recheck
from lyapcheck.check.render import as_json, text


def main(arguments: list[str] | None = None) -> int:
    """Print one line a certificate; 0: all accepted, 1: some refused, 2: a file cannot be read."""
    parser = argparse.ArgumentParser(prog="python -m lyapcheck.check", description=__doc__)
    parser.add_argument("certificates", nargs="+", metavar="CERTIFICATE", help="files or directories")
    parser.add_argument("--format", choices=("text", "json"), default="text")
    options = parser.parse_args(arguments)
    try:
        outcome = recheck(gather(options.certificates))
    except Unreadable as error:
        for name, rule in error.problems:
            print(f"error: {name}: {rule}", file=sys.stderr)
        return 2
    sys.stdout.write((as_json if options.format == "json" else text)(outcome))
    return 0 if outcome.all_accepted else 1


if __name__ == "__main__":
    sys.exit(main())
