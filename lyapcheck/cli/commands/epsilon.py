"""``lyapcheck epsilon``."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

from lyapcheck._types import Progress, part
from lyapcheck.cli.show import certificate_folder, progress, show, write_certificates
from lyapcheck.cli.values import gains_on_arm, parse_m, require_joints, varies
from lyapcheck.errors import argument_error
from lyapcheck.verdicts import Exit

if TYPE_CHECKING:
    from lyapcheck.answers.epsilon import EpsilonResult
    from lyapcheck.answers.epsilon.compute import Options
    from lyapcheck.cli.parser import Parser
    from lyapcheck.control.gains import GainFile, GainSet
    from lyapcheck.robots import RobotModel

WITH_RANGES = 0.7
"""The share of the work that is about ranges, beside nominal numbers."""


def arguments(parser: Parser) -> None:
    """What the command takes."""
    parser.add_gain_file()
    parser.add_robot()
    parser.add_members(None, "Only gain sets of these orders")
    parser.add_number(
        "--max-boxes", int, "Largest number of boxes in branch and bound.", default=400_000, least=1
    )
    parser.add_number("--jobs", int, "Number of processes.", default=2, least=1, most=64)
    about = "Prove ε₀ for all values of the uncertain numbers of the arm."
    parser.add_argument("--ranges", action="store_true", help=about)
    about = "Give every number without a range this range in ± percent. Implies --ranges."
    parser.add_number("--spread", float, about)
    parser.add_vary()
    about = "Computing time of branch and bound, in s. The answer then depends on the machine."
    parser.add_number("--seconds", float, about, least=0)
    about = "Search longer for weights Λ in y = w − εΛh."
    parser.add_argument("--weights", action="store_true", help=about)
    parser.add_number(
        "--starts", int, "Number of starts of each optimised search.", default=30, least=1, most=10_000
    )
    parser.add_number("--seed", int, "Seed of the sampled states.", default=20190301, least=0)
    parser.add_certificates()
    parser.add_argument("--timings", action="store_true", help="Add the seconds of each gain set.")
    parser.add_no_store()
    parser.add_format()


def run(
    file: Path,
    robot: str | None,
    m: str | None,
    ranges: bool,
    spread: float | None,
    vary: list[str] | None,
    weights: bool,
    certificates: Path | None,
    timings: bool,
    format: str,  # noqa: A002
    **numbers: Any,
) -> Exit:
    """Bound ε₀ of the Lyapunov function from both sides, and compare with the published and the scalar ε₀.

    Published is the end of (18) and scalar follows from norms. Certified is the largest ε₀ proved at every
    state. Falsified is the smallest ε₀ that a state refutes.

    Exit code 0: each set has a certified ε₀, 2: unusable input, 3: a set has no certified ε₀.

    Examples:
      lyapcheck epsilon gains.toml --m 1 --certificates proof/
      lyapcheck epsilon gains.toml --robot pelican2 --spread 5
    """
    from lyapcheck.robots import load

    ranged, share = varies(vary), _share(spread)
    gain_file, name, own = gains_on_arm(file, robot, spread=share)
    model = load(name, spread=share, vary=ranged) if ranged else own
    chosen = _chosen(gain_file, m)
    require_joints([gain_file], model)
    folder = certificate_folder(certificates)
    from lyapcheck.answers.epsilon import EpsilonResults
    from lyapcheck.answers.epsilon.compute import Options
    from lyapcheck.answers.epsilon.kept import certificates as certificates_of

    ranges = ranges or spread is not None or bool(ranged)
    options = Options(ranges=ranges, weights=weights or None, **numbers)
    with progress("epsilon") as advance:
        results = _each(chosen, own, model, options, advance)
    if folder is not None:
        write_certificates(folder, *map(certificates_of, results))
    shown = [one if timings else replace(one, seconds=None) for one in results]
    show(EpsilonResults(tuple(shown), gain_file, name), format)
    missing = any(result.certified is None for result in results)
    return Exit.UNDECIDED if missing else Exit.PROVED


def _share(spread: float | None) -> Fraction:
    """A percentage as a share, exactly as it was written."""
    if spread is None:
        return Fraction(0)
    if not 0 < spread < 100:
        raise argument_error("--spread", spread, "must be above 0 and below 100 percent", "write --spread 5")
    return Fraction(repr(spread)) / 100


def _chosen(gain_file: GainFile, m: str | None) -> list[GainSet]:
    """The gain sets of the members asked for."""
    if m is None:
        return list(gain_file.gains)
    members = parse_m(m)
    chosen = [gain_set for gain_set in gain_file.gains if gain_set.m in members]
    if not chosen:
        known = ", ".join(str(one.m) for one in gain_file.gains if one.m is not None) or "none"
        raise argument_error("--m", m, f"{gain_file.path} has no such gain set", f"choose from {known}")
    return chosen


def _each(
    gains: list[GainSet], own: RobotModel, model: RobotModel, options: Options, advance: Progress
) -> list[EpsilonResult]:
    """The result of every gain set, with the seconds it took.

    Args:
        gains: the sets.
        own: the arm as its file describes it.
        model: the arm with the ranges that are asked for.
        options: what is asked.
        advance: receives the fraction done.
    """
    from lyapcheck.answers.epsilon.kept import kept_epsilon
    from lyapcheck.robots.vary import outside

    results: list[EpsilonResult] = []
    nominal = replace(options, ranges=False, weights=False)
    left_out = outside(own, model)
    for done, gain_set in enumerate(gains):
        about = f"{gain_set.name}: "
        low, middle, high = ((done + share) / len(gains) for share in (0.0, WITH_RANGES, 1.0))
        began = perf_counter()
        first = part(advance, low, middle if options.ranges else high, about)
        result = replace(kept_epsilon(gain_set, model, options, first), outside=left_out)
        if result.corner and not left_out:  # something ranges: what that costs is asked too
            found = kept_epsilon(gain_set, own, nominal, part(advance, middle, high, about))
            result = replace(result, unvaried=found.promise)
        results.append(replace(result, seconds=perf_counter() - began))
    return results
