"""Many questions at once: a plan of arms, variations and gains, asked on this machine or on a cluster."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lyapcheck.answers.sweep.plan import Plan, read_plan
from lyapcheck.answers.sweep.question import Answered, Row
from lyapcheck.answers.sweep.workers import answers_here, answers_of_cluster, batches
from lyapcheck.compiled.compiler import processors

if TYPE_CHECKING:
    from pandas import DataFrame

__all__ = ["Plan", "Rows", "asked", "read_plan", "sweep"]


def asked(plan: Plan, workers: int, scheduler: str | None = None) -> Iterator[Answered]:
    """What comes of each question of a plan, in its order; never more than a few at once are in memory.

    Args:
        plan: what is asked.
        workers: processes of this machine.
        scheduler: the address of a Dask scheduler, whose workers are asked instead.
    """
    work = batches(plan.questions())
    if scheduler is not None:
        results = answers_of_cluster(work, scheduler)
    else:
        fewer = min(workers, plan.count)  # cores that are left share what the checker judges
        results = answers_here(work, fewer, jobs=workers // max(1, fewer))
    for result in results:
        yield from result


class Rows(Iterator[Row]):
    """The rows of a sweep as they come, in the order of the plan."""

    def __init__(self, result: Iterator[Answered]) -> None:
        self._found = result

    def __next__(self) -> Row:
        return next(self._found).row

    def frame(self) -> DataFrame:
        """The rows that are left as a pandas DataFrame.

        Raises:
            ImportError: pandas is not installed.
        """
        import pandas

        return pandas.DataFrame(list(self))


def sweep(
    plan: Plan | str | Path,
    workers: int | None = None,
    scheduler: str | None = None,
    out: str | Path | None = None,
    resume: bool = False,
) -> Rows:
    """Ask all questions of a plan: rows as they come, and with ``.frame()`` a pandas DataFrame.

    A row has the question (its digest, arm, variation, gains), the verdict, numbers, the digests of the
    certificates behind it, and the whole answer as the command of that question writes it as JSON.

    Args:
        plan: what ``read_plan`` returned, or the path of a plan file.
        workers: processes; as many as there are cores by default, and none but this one with 1.
        scheduler: the address of a Dask scheduler whose workers are asked instead (extra ``sweep``).
        out: a folder for rows and certificates, written as the rows are taken; none by default.
        resume: whether the folder may hold a sweep already.

    Raises:
        InputError: the plan cannot be read, the folder not be written, or no scheduler answers.

    Soundness: the command of each question makes the verdict, in the process that answered it.

    Example:
        >>> import lyapcheck
        >>> rows = lyapcheck.sweep("examples/sweep_plan.toml", workers=1)
        >>> next(rows)["verdict"]
        'accepted'
    """
    read: Any = plan if isinstance(plan, Plan) else read_plan(plan)
    result = asked(read, processors() if workers is None else workers, scheduler)
    if out is not None:
        from lyapcheck.answers.sweep.folder import Folder

        result = Folder(Path(out), resume).written(result)
    return Rows(result)
