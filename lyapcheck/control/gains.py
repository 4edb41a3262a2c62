"""Gain files: which gains, for which controller of the family, on which arm."""

from __future__ import annotations

import os
from fractions import Fraction

from lyapcheck.files.place import KeyPath, Place
from lyapcheck.records import Record

TYPE_CHECKING = False
if TYPE_CHECKING:
    from pathlib import Path
    from typing import Protocol

    class Placed(Protocol):
        """What knows where a key of a file stands."""

        def place(self, path: KeyPath) -> Place | None:
            """Line and column of a key, or of the nearest table or list around it."""


FAMILIES = ("hyperbolic", "tanh", "arctan", "algebraic", "linear")
LARGEST_M = 100_000


class GainSet(Record):
    """The gains of one controller τ = K_p h(e) − K_v h(q̇) + g(q).

    Args:
        name: the user's name for it.
        m: the member of the hyperbolic family; ``None`` for another family.
        kp: diagonal of K_p, N·m (N·m/rad or N·m/° where h is linear), exact.
        kv: diagonal of K_v, N·m (N·m·s/rad or N·m·s/° where h is linear), exact.
        family: name of the bounded function h; ``linear`` is PD with gravity compensation.
        angle_unit: ``deg`` where linear gains are meant per degree.
        index: its number in the file, from 0.

    References: (6) of reyes2019family.
    """

    name: str
    m: int | None
    kp: tuple[Fraction, ...]
    kv: tuple[Fraction, ...]
    family: str = "hyperbolic"
    angle_unit: str = "rad"
    index: int = 0

    @property
    def n(self) -> int:
        """Number of joints."""
        return len(self.kp)


class Bounds(Record):
    """What a gain file says about the arm itself; ``None`` where it leaves that to the arm.

    Args:
        viscous_min: λmin(B), N·m·s/rad.
        torque: torque limit of each joint, N·m.
        gravity: bound k_gi of each gravity torque, N·m.
    """

    viscous_min: Fraction | None = None
    torque: tuple[Fraction, ...] | None = None
    gravity: tuple[Fraction, ...] | None = None


class GainFile(Record):
    """A gain file as read; ``document`` knows the line and column of every number."""

    path: str
    robot: str | None
    gains: tuple[GainSet, ...]
    bounds: Bounds = Bounds()
    document: Placed | None = None

    def place(self, gain_set: GainSet, key: str = "", joint: int | None = None) -> Place | None:
        """Where a gain of a set stands; ``joint`` counts from 0."""
        if self.document is None:
            return None
        path: KeyPath = ("gains", gain_set.index, key) if key else ("gains", gain_set.index)
        return self.document.place(path if joint is None else (*path, joint))


def read_gain_file(path: str | Path) -> GainFile:
    """The gain sets of a TOML file, every decimal exact.

    Raises:
        InputError: everything that is wrong with the file, each problem with its line and repair.
    """
    from lyapcheck.control.plain import read_plain

    found = read_plain(os.fspath(path))
    if found is not None:
        return found
    from lyapcheck.control.reading import read_toml

    return read_toml(path)
