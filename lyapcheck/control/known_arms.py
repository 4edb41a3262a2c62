"""The limits of the built-in arms, kept so that the gate need not build their models.

``known_arms_data.py`` is written by ``python -m lyapcheck.control.write_known_arms`` and holds the checksum
of each arm file. An arm whose file has changed since is unknown here, and its model is built.
"""

from __future__ import annotations

import os
from fractions import Fraction

from lyapcheck.records import Record

_ROBOTS = os.path.join(os.path.dirname(os.path.dirname(__file__)), "robots", "arms")
_PRIME = 2**61 - 1


class ArmLimits(Record):
    """What the conditions take from an arm: see ``Limits``.

    Args:
        name: of the arm.
        joints: their names.
        torque: torque limit of each joint, N·m; ``None`` where there is none.
        gravity: bound of each gravity torque, N·m.
        viscous_min: λmin(B), N·m·s/rad.
        torque_notes: which torque limits are assumed, and why.
        viscous_notes: which friction is assumed, and why.
    """

    name: str
    joints: tuple[str, ...]
    torque: tuple[Fraction | None, ...]
    gravity: tuple[Fraction, ...]
    viscous_min: Fraction
    torque_notes: tuple[str, ...] = ()
    viscous_notes: tuple[str, ...] = ()

    @property
    def n(self) -> int:
        """Number of joints."""
        return len(self.joints)


def known_arm(name: str) -> ArmLimits | None:
    """The limits of a built-in arm; ``None`` for any other arm, and for one whose file has changed."""
    from lyapcheck.control.known_arms_data import ARMS

    found = ARMS.get(name)
    if found is None or found[0] != checksum(name):
        return None
    _, joints, torque, gravity, viscous_min, torque_notes, viscous_notes = found
    return ArmLimits(
        name,
        joints,
        tuple([None if text is None else Fraction(text) for text in torque]),
        tuple(map(Fraction, gravity)),
        Fraction(viscous_min),
        torque_notes,
        viscous_notes,
    )


def checksum(name: str) -> int:
    """Of the file of a built-in arm, whatever its line ends; -1 where there is none."""
    try:
        with open(os.path.join(_ROBOTS, f"{name}.toml"), "rb") as stream:
            return int.from_bytes(stream.read().replace(b"\r\n", b"\n"), "big") % _PRIME
    except OSError:
        return -1
