"""Any text as a strategy."""

from __future__ import annotations

from hypothesis import strategies as st


def letters(least: int = 0, most: int | None = None) -> st.SearchStrategy[str]:
    """What ``st.text`` draws: all letters but surrogates, by category: what a codec knows is slow to list."""
    return st.text(st.characters(exclude_categories=["Cs"]), min_size=least, max_size=most)
