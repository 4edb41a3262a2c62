"""The formats by name."""

from __future__ import annotations

from enum import StrEnum
from typing import TYPE_CHECKING

from lyapcheck import output
from lyapcheck.extensions import defining

OF_JUDGEMENTS = ("github", "junit", "sarif")
"""What only systems read that run checks."""
NAMES = defining("render", output.__path__)

if TYPE_CHECKING:

    class Format(StrEnum):
        """What every answer can be written in: all that ``output`` has, but those for judgements."""

        TEXT = "text"

    class JudgedFormat(StrEnum):
        """The same, and what systems read that run checks."""

        TEXT = "text"

else:
    JudgedFormat = StrEnum("JudgedFormat", {name.upper(): name for name in NAMES}, module=__name__)
    Format = StrEnum(
        "Format", {name.upper(): name for name in NAMES if name not in OF_JUDGEMENTS}, module=__name__
    )
