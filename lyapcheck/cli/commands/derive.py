"""``lyapcheck derive``."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lyapcheck.cli.show import show
from lyapcheck.cli.values import parse_m
from lyapcheck.errors import argument_error, told_as
from lyapcheck.output.answer import FORMATS
from lyapcheck.verdicts import Exit

if TYPE_CHECKING:
    from lyapcheck.cli.parser import Parser


def arguments(parser: Parser) -> None:
    """What the command takes."""
    parser.add_members("2")
    parser.add_number("--n", int, "Number of joints for V and dV/dt, without --robot. Default: 2.")
    about = "Arm by name or file. Its M, C and g are printed, and it sets n."
    parser.add_robot(about)
    parser.add_format(FORMATS)


def run(m: str, n: int | None, robot: str | None, format: str) -> Exit:  # noqa: A002
    """Derive h, h', the polynomials of γ and ρ, V of (12) and (13), and dV/dt of (15) from U_m by SymPy.

    The checker verifies each derived formula, and its verdict is printed next to the formula.

    Exit code 0: SymPy and the checker agree, 1: they differ, 2: unusable input.

    Examples:
      lyapcheck derive
      lyapcheck derive --m 1:3 --n 3 --format latex
      lyapcheck derive --robot reyes-kelly2
    """
    from lyapcheck.answers.derive import MOST_JOINTS, derivation, require_up_to

    if n is not None and robot is not None:
        raise argument_error("--n", n, "cannot go with --robot, which sets it", "leave one of them out")
    n = 2 if n is None else n
    require_up_to("--n", n, MOST_JOINTS)
    with told_as({"m": "--m"}):
        answer = derivation(parse_m(m), n, robot)
    show(answer, format)
    return Exit.PROVED if answer.agreed else Exit.REFUTED
