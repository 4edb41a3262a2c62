"""What the long computations of a report hand back."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from lyapcheck.report.claim_row import ClaimRow
from lyapcheck.report.model import Data, Witness


@dataclass(frozen=True)
class Computed:
    """Rows, figures by file name, and certificates by their paths."""

    claims: tuple[ClaimRow, ...]
    others: tuple[ClaimRow, ...]
    small: Mapping[str, Witness]
    epsilon: tuple[Data, ...]
    runs: tuple[Data, ...]
    sensitivity: Data | None
    cells: Sequence[Data]
    figures: Mapping[str, str | bytes]
    certificates: Mapping[str, str]
