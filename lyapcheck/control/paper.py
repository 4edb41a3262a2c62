"""The paper's own gain files, which travel with lyapcheck."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

from lyapcheck.errors import argument_error

PRINTED_GAMMA = {1: Fraction(1), 2: Fraction(105, 100), 3: Fraction(111, 100)}
"""γ_1, γ_2, γ_3 as the paper prints them after (7): the last two are below the true ones."""


def proofs_folder() -> Path:
    """Where the proof scripts and the paper's gains are: in an installed package, or at a checkout's top."""
    package = Path(__file__).parents[1]
    inside = package / "proofs"
    return inside if inside.is_dir() else package.parent / "proofs"


def paper_gain_file(name: str = "table2") -> Path:
    """The path of one of the paper's gain files: ``table2``, ``table2_pd`` or ``table2_shoulder_elbow``.

    Raises:
        InputError: no gain file of that name.
    """
    path = proofs_folder() / f"{name}.toml"
    if not path.is_file():
        known = ", ".join(sorted(file.stem for file in proofs_folder().glob("table*.toml")))
        raise argument_error("gain file", name, "is not one of the paper's", f"use one of: {known}")
    return path
