"""What text in a file must be, and the repair where it is not."""

from __future__ import annotations

UNPRINTABLE = "must be one line of text that prints"
"""What a name or note breaks that holds a line end, a control character, or one that turns the writing."""
RETYPE = "type it anew, without what is shown as an escape"
