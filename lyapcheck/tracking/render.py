"""The renderers of tracking runs by the name of their format."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from lyapcheck.tracking.json import as_json
from lyapcheck.tracking.run import TrackingRun
from lyapcheck.tracking.text import as_markdown, as_text

RENDERERS: dict[str, Callable[[Sequence[TrackingRun]], str]] = {
    "text": as_text,
    "markdown": as_markdown,
    "json": as_json,
}
