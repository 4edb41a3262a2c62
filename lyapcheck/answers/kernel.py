"""Are these certificates right, and what does Coq's kernel say of each: the outcome of both checkers."""

from __future__ import annotations

import json
import shutil
from collections import Counter
from collections.abc import Callable
from pathlib import Path

from lyapcheck.answers.recheck import Recheck
from lyapcheck.check.recheck import Outcome
from lyapcheck.errors import argument_error
from lyapcheck.kernel.coq import Kernel, require_coq
from lyapcheck.kernel.judge import graded, judged
from lyapcheck.rechecking.command import Writer
from lyapcheck.rechecking.render import as_json, text
from lyapcheck.temporary import temporary_folder

WIDTH = 11
MEANING = (
    "kernel: Coq's kernel accepted a theorem whose statement is printed from the certificate's own data, and "
    "whose axioms are on the golden list named: real has those of classical real numbers, float also the "
    "specifications of 63-bit integers and binary64 numbers"
)


def writer(name: str, seconds: int, folder: Path | None, progress: Callable[[str], None]) -> Writer:
    """What writes the outcome of the small checker in a format, once Coq's kernel has judged it as well.

    Args:
        name: of the format.
        seconds: the most that one theorem may take.
        folder: where the files for Coq are copied to in the end; ``None``: nowhere. Nothing is read there: a
            compiled file may be of other definitions than its source.
        progress: receives a note on what is going on.

    Raises:
        InputError: there is no Coq, or the folder cannot take the files.
    """
    require_coq()

    def written(outcome: Outcome, trusted: bool) -> str:
        with temporary_folder() as place:
            result = judged(outcome, Path(place), seconds, progress)
            if folder is not None:
                _copied(place, folder)
        both = graded(outcome, result)
        if name == "text":
            return text(both, trusted) + kernel_text(result)
        if name == "json":
            return kernel_json(as_json(both, trusted), result)
        return Recheck(both, trusted, tuple(result)).written(name)

    return written


def _copied(place: str, folder: Path) -> None:
    """Copy the files for Coq.

    Raises:
        InputError: something else has one of their names.
    """
    try:
        shutil.copytree(place, folder, dirs_exist_ok=True)
    except OSError:
        rule = "has something else under a name of Coq's files"
        raise argument_error("--kernel-files", folder, rule, "name an empty directory") from None


def kernel_text(result: list[Kernel]) -> str:
    """A line a certificate, what the grade means, and how many have it."""
    lines = [
        "",
        *(f"{'kernel' if one.accepted else 'no kernel':<{WIDTH}}{one.file}: {said(one)}" for one in result),
    ]
    counted = Counter(one.accepted for one in result)
    return "\n".join([*lines, MEANING, f"{counted[True]} kernel, {counted[False]} without"]) + "\n"


def kernel_json(written: str, result: list[Kernel]) -> str:
    """The JSON of the small checker with ``kernel`` in the row of each certificate."""
    data = json.loads(written)
    for row, one in zip(data["certificates"], result, strict=True):
        row["kernel"] = {
            "accepted": one.accepted,
            "reason": one.reason,
            "theorem": one.theorem or None,
            "axioms": one.axioms or None,
        }
    return json.dumps(data, indent=2, ensure_ascii=False) + "\n"


def said(one: Kernel) -> str:
    """The golden list, or why there is no kernel verdict."""
    return f"axioms {one.axioms}" if one.accepted else one.reason
