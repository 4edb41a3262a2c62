"""Every option of every command by itself, with values at the ends of what it may be asked."""

import re
import shlex

from lyapcheck.cli.commands import load
from lyapcheck.cli.parser import Parser
from tests.helpers.command import lyapcheck

NUMBERS = ("0", "1", "-1", "1e-300", "1e300", "nan", "inf")
WHOLE = ("0", "1", "-1", "1000000000000000000000")
RANGES = (
    "mass=+0%..+0%",
    "mass=-100%..+0%",
    "mass=+0%..+1e30%",
    "viscous=-100%..+0%",
    "viscous=0..0",
    "payload=0..0",
    "payload=0..1e30",
    "payload=-1..1",
    "mass=nan..nan",
)
MEMBERS = ("0", "1", "64", "65", "10000", "10001", "1:2", "2:1", "-1", "")
FILES = ("FILE", "FILE...", "DIR", "PROOF.py", "PLAN.toml", "CERTIFICATE...", "OLD", "NAME|FILE", "ROBOT")
"""What takes the name of a file: tests/cli/test_user_files.py is about those."""
SLOW = {"map", "appendix"}
"""Options that compute for minutes before there is anything to print."""
NO_NUMBER = re.compile(r"(?<![\w.])[-+]?(nan|NaN)(?![\w=.])")


def values(metavar, joints):
    """What an option is given that stands for one of these in its help."""
    if metavar == "NAME=LO..HI":
        return RANGES
    if metavar == "M":
        return MEMBERS
    lists = ("ANGLES", "TORQUES", "SHARES", "RATIOS", "RATES", "SPEEDS", "ERRORS")
    if metavar in lists:
        return tuple(",".join([one] * count) for one in NUMBERS for count in dict.fromkeys((1, joints)))
    return (*NUMBERS, *WHOLE)


def lines(command, base, joints):
    """The command line ``base`` with each option of a command, one at a time, at each extreme."""
    parser = Parser(prog=command)
    load(command).arguments(parser)
    for action in parser.actions:
        if not action.option_strings or action.dest in SLOW or action.metavar in FILES:
            continue
        option = action.option_strings[-1]
        if option == "--help":
            continue
        if action.nargs == 0:
            yield f"{base} {option}"
        elif action.choices is not None:
            yield from (f"{base} {option} {choice}" for choice in action.choices)
        else:
            for value in values(str(action.metavar), joints):
                yield f"{base} {option}={value}" if value else f"{base} {option} ''"


def fault(line, folder):
    """What is wrong with how a command line ends; empty where nothing is."""
    try:
        done = lyapcheck(*shlex.split(line), folder=folder)
    except AssertionError as error:
        return f"{line}: {error}"
    if done.returncode not in (0, 1, 2, 3):
        return f"{line}: exit {done.returncode}: {done.stderr.strip().splitlines()[-1:]}"
    found = NO_NUMBER.search(done.stdout)
    if found:
        start = done.stdout.rfind("\n", 0, found.start()) + 1
        return f"{line}: prints {done.stdout[start : found.end() + 20]!r}"
    if "Traceback" in done.stderr or "Warning" in done.stderr:
        return f"{line}: says {done.stderr[-200:]!r}"
    return ""
