"""``lyapcheck sweep``."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING

from lyapcheck._types import Progress
from lyapcheck.cli.show import progress, show
from lyapcheck.errors import argument_error
from lyapcheck.output.answer import FORMATS

if TYPE_CHECKING:
    from lyapcheck.answers.sweep.questions import Answered
    from lyapcheck.answers.sweep.result import Tally
    from lyapcheck.cli.parser import Parser
    from lyapcheck.verdicts import Exit

MOST = 1_024


def arguments(parser: Parser) -> None:
    """What the command takes."""
    parser.add_argument("plan", metavar="PLAN.toml", type=Path, help="Plan file (TOML).")
    about = "Folder for the rows and the certificates."
    parser.add_argument("--out", metavar="DIR", type=Path, help=about)
    parser.add_number("--jobs", int, "Number of processes. Default: one per core.", least=1, most=MOST)
    about = "Use the workers of this Dask scheduler, tcp://host:port. This needs the extra sweep."
    parser.add_argument("--scheduler", metavar="ADDRESS", help=about)
    about = "Continue the sweep in --out. Kept answers are verified again."
    parser.add_argument("--resume", action="store_true", help=about)
    parser.add_no_store()
    parser.add_format(FORMATS)


def run(
    plan: Path,
    out: Path | None,
    jobs: int | None,
    scheduler: str | None,
    resume: bool,
    format: str,  # noqa: A002
) -> Exit:
    """Ask gate, epsilon, bounds, simulate and more about every arm, variation and gain set of a plan.

    The folder --out gets rows.jsonl in the order of the plan, and certificates by their digests. With pyarrow
    it also gets rows.parquet. The same plan gives the same bytes on any workers.

    Exit code 0: all proved, accepted or observed, 1: something refuted, rejected or seen, 2: unusable input,
    3: something undecided, 4: a question failed, and its row has the reason.

    A plan:
      robots = ["reyes-kelly2"]
      questions = ["gate"]
      [grid]
      m = [1, 2, 3]
      kp = [[20, 5], [40, 8]]
      kv = { from = 0.02, to = 0.1, step = 0.02 }

    Examples:
      lyapcheck sweep plan.toml --out sweep/
      lyapcheck sweep plan.toml --out sweep/ --resume
      lyapcheck sweep plan.toml --out sweep/ --scheduler tcp://head:8786
    """
    from lyapcheck.answers.sweep import asked, read_plan
    from lyapcheck.answers.sweep.result import Folder, SweepAnswer, Tally
    from lyapcheck.lyapunov.compiler import processors

    if resume and out is None:
        raise argument_error("--resume", "", "has a meaning with --out only", "add --out DIR")
    read = read_plan(plan)
    folder = None if out is None else Folder(out, resume)
    tally = Tally()
    with progress("sweep") as advance:
        result = asked(read, processors() if jobs is None else jobs, scheduler)
        _count(result if folder is None else folder.written(result), read.count, tally, advance)
    made = out is not None and any((out / "certificates").glob("*.json"))
    answer = SweepAnswer(read.path, tally, certificates=str(out and out / "certificates") if made else "")
    show(answer, format)
    return answer.exit_code


def _count(result: Iterator[Answered], total: int, tally: Tally, advance: Progress) -> None:
    """Take all answers, and say how far they have come and how long the rest will take at that pace."""
    begun = monotonic()
    advance(0.0, f"{total} questions")
    for done, one in enumerate(result, start=1):
        tally.add(one.row)
        left = (monotonic() - begun) / done * (total - done)
        advance(done / total, f"{done} of {total}, {_span(left)} left")


def _span(seconds: float) -> str:
    """A time of which nobody wants to know more than its size."""
    for size, unit in ((3600.0, "h"), (60.0, "min")):
        if seconds >= 2 * size:
            return f"about {seconds / size:.0f} {unit}"
    return f"about {seconds:.0f} s"
