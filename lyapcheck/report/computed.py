"""What the long computations of a report hand back."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from lyapcheck.answers.derive import Derivation
from lyapcheck.report.claim_row import ClaimRow
from lyapcheck.report.gain_rows import EpsilonRow, RunRow
from lyapcheck.report.map_cell import MapCell
from lyapcheck.report.model import WitnessRow
from lyapcheck.report.study import StudyRow


@dataclass(frozen=True)
class Computed:
    """Rows, figures by file name, certificates by their paths, and the packages that were loaded for it."""

    claims: tuple[ClaimRow, ...]
    others: tuple[ClaimRow, ...]
    small: Mapping[str, WitnessRow]
    epsilon: tuple[EpsilonRow, ...]
    runs: tuple[RunRow, ...]
    sensitivity: StudyRow | None
    derived: Derivation
    cells: tuple[MapCell, ...]
    figures: Mapping[str, str | bytes]
    certificates: Mapping[str, str]
    packages: tuple[str, ...]
