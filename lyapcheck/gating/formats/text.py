"""The gate in a terminal."""

from __future__ import annotations

from lyapcheck.gating.formats.rows import HEADS, legend, row, sentences, summary, title
from lyapcheck.output.escapes import printable

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Sequence

    from lyapcheck.gating.gate import GateResult


def render(results: Sequence[GateResult]) -> str:
    """One block a gain set, what to change under it, and a last line that counts."""
    blocks = [_block(result) for result in results]
    return "\n".join([*blocks, *map(printable, legend(results)), "", summary(results)]) + "\n"


def _block(result: GateResult) -> str:
    rows = [HEADS, *[tuple(map(printable, row(result, check))) for check in result.checks]]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = ["  " + "   ".join(map(str.ljust, cells, widths)).rstrip() for cells in rows]
    said = [f"  {printable(sentence)}" for sentence in sentences(result)]
    return "\n".join([printable(title(result)), *lines, *said, ""])
