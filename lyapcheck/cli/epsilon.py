"""``lyapcheck epsilon``."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Annotated

import typer

from lyapcheck.cli.arm import require_joints, robot_name
from lyapcheck.cli.output import open_folder, write_whole
from lyapcheck.cli.progress import Advance, progress
from lyapcheck.cli.show import show
from lyapcheck.errors import argument_error
from lyapcheck.output.formats import JudgedFormat
from lyapcheck.verdicts import Exit

if TYPE_CHECKING:
    from fractions import Fraction

    from lyapcheck.answers.epsilon import EpsilonResult
    from lyapcheck.control.gains import GainFile, GainSet
    from lyapcheck.robots import RobotModel


@dataclass(frozen=True)
class Budget:
    """How hard to search, and for which arms."""

    max_boxes: int
    jobs: int
    ranges: bool
    weights: bool
    seconds: float | None
    starts: int
    seed: int


def command(
    file: Annotated[Path, typer.Argument(help="A gain file.", metavar="FILE")],
    robot: Annotated[
        str | None,
        typer.Option(help="A built-in arm or an arm file, instead of the one the gain file names."),
    ] = None,
    m: Annotated[
        str | None, typer.Option("--m", help="Only the gain sets of these members: 3, 1,2,5 or 1:12.")
    ] = None,
    max_boxes: Annotated[int, typer.Option(help="Budget of branch and bound.", min=1)] = 400_000,
    jobs: Annotated[int, typer.Option(help="Processes for checking the boxes.", min=1, max=64)] = 2,
    ranges: Annotated[
        bool, typer.Option("--ranges", help="For all values of what is uncertain about the arm.")
    ] = False,
    spread: Annotated[
        float | None,
        typer.Option(help="Percent: every number of the arm without a range gets ± that; implies --ranges."),
    ] = None,
    seconds: Annotated[
        float | None,
        typer.Option(help="Time for branch and bound; the answer then depends on the machine.", min=0),
    ] = None,
    weights: Annotated[
        bool, typer.Option("--weights", help="Also search weights Λ in y = w − εΛh, joint by joint.")
    ] = False,
    starts: Annotated[int, typer.Option(help="Starts of each optimised search.", min=1)] = 30,
    seed: Annotated[int, typer.Option(help="Seed of the sampled states.", min=0)] = 20190301,
    format: Annotated[JudgedFormat, typer.Option(help="How to write it.")] = JudgedFormat.TEXT,  # noqa: A002
    certificates: Annotated[
        Path | None, typer.Option(help="Write the certificates of each gain set there; see recheck.")
    ] = None,
    timings: Annotated[bool, typer.Option("--timings", help="Add the seconds each gain set took.")] = False,
) -> None:
    """How large ε₀ of the Lyapunov function may be: published, scalar, certified, falsified.

    For each gain set: the end of (18), the ε₀ of norms, the largest ε₀ proved at every state, and the
    smallest that a state refutes. Exit code 0: each set has a certified ε₀, 2: unusable input, 3: one has
    none.
    """
    from lyapcheck.control.gains import read_gain_file
    from lyapcheck.robots import load

    gain_file = read_gain_file(file)
    model = load(robot_name(robot, [gain_file]), spread=_share(spread))
    chosen = _chosen(gain_file, m)
    require_joints([gain_file], model)
    folder = None if certificates is None else open_folder("--certificates", certificates)
    budget = Budget(max_boxes, jobs, ranges or spread is not None, weights, seconds, starts, seed)
    with progress("epsilon") as advance:
        results, times = _run(chosen, model, budget, advance)
    if folder is not None:
        _write_certificates(folder, results)
    from lyapcheck.answers.epsilon import EpsilonResults

    show(EpsilonResults(tuple(results), gain_file, times if timings else None), format)
    missing = any(result.certified is None for result in results)
    raise typer.Exit(int(Exit.UNDECIDED if missing else Exit.PROVED))


def _share(spread: float | None) -> Fraction:
    """A percentage as a share, exactly as it was written."""
    from fractions import Fraction

    if spread is None:
        return Fraction(0)
    if not 0 < spread < 100:
        raise argument_error("--spread", spread, "must be above 0 and below 100 percent", "write --spread 5")
    return Fraction(repr(spread)) / 100


def _write_certificates(folder: Path, results: list[EpsilonResult]) -> None:
    from lyapcheck.answers.epsilon.certificates import certificates

    for result in results:
        for name, certificate in certificates(result).items():
            write_whole(folder / name, certificate.text())


def _chosen(gain_file: GainFile, m: str | None) -> list[GainSet]:
    """The gain sets of the members asked for."""
    if m is None:
        return list(gain_file.gains)
    from lyapcheck.cli.m_range import parse_m

    members = parse_m(m)
    chosen = [gain_set for gain_set in gain_file.gains if gain_set.m in members]
    if not chosen:
        known = ", ".join(str(gain_set.m) for gain_set in gain_file.gains if gain_set.m is not None)
        raise argument_error(
            "--m", m, f"{gain_file.path} has no such gain set", f"choose from {known or 'none'}"
        )
    return chosen


def _run(
    gains: list[GainSet], model: RobotModel, budget: Budget, advance: Advance
) -> tuple[list[EpsilonResult], list[float]]:
    """The result of every gain set and the seconds it took."""
    from lyapcheck.answers.epsilon import epsilon

    results: list[EpsilonResult] = []
    seconds: list[float] = []
    for done, gain_set in enumerate(gains):

        def tell(fraction: float, note: str, done: int = done, name: str = gain_set.name) -> None:
            advance((done + fraction) / len(gains), f"{name}: {note}")

        began = perf_counter()
        results.append(epsilon(gain_set, model, **asdict(budget), on_progress=tell))
        seconds.append(perf_counter() - began)
    return results, seconds
