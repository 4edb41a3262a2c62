"""``lyapcheck`` without a command: help, version, completion in shells, and what the first word is not."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from lyapcheck.cli.commands import NAMES, load
from lyapcheck.cli.parser import Parser
from lyapcheck.errors import argument_error, nearest
from lyapcheck.verdicts import Exit

if TYPE_CHECKING:
    from collections.abc import Sequence

ABOUT = """Check the Lyapunov proof of bounded hyperbolic controllers for robot manipulators.

    Exit codes: 0 all proved or accepted, 1 something refuted or rejected, 2 unusable input, 3 undecided,
    4 internal error.

    Examples:
      lyapcheck gate gains.toml              accept or reject gains
      lyapcheck check published.py           the paper's proof, claim by claim
      lyapcheck robot buap3                  the properties of an arm
      lyapcheck gate --help                  what a command takes
    """
SHELLS = ("bash", "zsh", "fish")


def run_program(words: Sequence[str]) -> Exit:
    """Do what a command line without a command asks for.

    Raises:
        InputError: nothing, or nothing that lyapcheck knows.
    """
    parser = Parser(prog="lyapcheck", description=ABOUT)
    parser.usage = "%(prog)s COMMAND ..."
    parser.add_argument("--version", action="store_true", help="Print the version and leave.")
    about = "Print a script that completes command lines in a shell."
    parser.add_choice("--completion", SHELLS, about, metavar="SHELL")
    if not words:
        _add_commands(parser)
        sys.stderr.write(parser.format_help())
        return Exit.USAGE
    if not words[0].startswith("-"):
        repair = nearest(words[0], NAMES) or f"choose from {', '.join(NAMES)}"
        raise argument_error("COMMAND", words[0], "is not a command of lyapcheck", repair)
    if "-h" in words or "--help" in words:
        _add_commands(parser)
        parser.print_help()
        return Exit.PROVED
    wanted = parser.parse(words)
    if wanted["version"]:
        from importlib.metadata import version

        print(f"lyapcheck {version('lyapcheck')}")
    elif wanted["completion"]:
        sys.stdout.write(_completion(parser, wanted["completion"]))
    return Exit.PROVED


def _add_commands(parser: Parser) -> list[Parser]:
    """Give a parser those of all commands."""
    commands = parser.add_subparsers(title="commands", metavar="COMMAND")
    parsers = []
    for name in NAMES:
        module = load(name)
        summary = module.run.__doc__.partition("\n")[0]
        parsers.append(commands.add_parser(name, help=summary, description=module.run.__doc__))
        module.arguments(parsers[-1])
    return parsers


def _completion(parser: Parser, shell: str) -> str:
    """What the shell reads, by shtab."""
    import shtab

    places = {
        "FILE": shtab.FILE,
        "FILE...": shtab.FILE,
        "PROOF.py": shtab.FILE,
        "PLAN.toml": shtab.FILE,
        "DIR": shtab.DIRECTORY,
    }
    for each in _add_commands(parser):
        for action in each.actions:
            if action.metavar in places:
                action.complete = places[action.metavar]  # type: ignore[attr-defined]
    text: str = shtab.complete(parser, shell)
    return text
