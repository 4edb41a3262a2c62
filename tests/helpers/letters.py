"""Any text as a strategy."""

from hypothesis import strategies as st


def letters(least=0, most=None):
    """What ``st.text`` draws: all letters but surrogates, by category: what a codec knows is slow to list."""
    return st.text(st.characters(exclude_categories=["Cs"]), min_size=least, max_size=most)
