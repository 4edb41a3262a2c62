"""The robot model: exact dynamics, and what is known of every number."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from lyapcheck.robots.number import Number
from lyapcheck.robots.plant import Plant
from lyapcheck.robots.printed_torques import PrintedTorques


@dataclass(frozen=True, eq=False, kw_only=True)
class RobotModel(Plant):
    """An arm that a file describes: what moves, and what is known of every number.

    Args:
        title: one line for reports.
        coulomb: Coulomb friction torques, N·m; ``None`` where nothing is known.
        torque_limit: largest torque of each motor, N·m; ``None`` where nothing is known.
        encoder: counts per turn; ``None`` where nothing is known.
        gravity_bound: k_gi where the source prints them, N·m.
        numbers: every number of the arm with its provenance.
        remarks: what is taken for granted beyond assumed numbers, in sentences.
        printed: C and g as the source prints them, where it does; nothing is derived from them.

    Soundness: M is that of the physical arm only as far as ``numbers`` are; ``assumptions`` lists those
    that no source prints.

    References: (1) and properties 2.1–2.8 of reyes2019family.
    """

    title: str
    coulomb: tuple[Number | None, ...]
    torque_limit: tuple[Number | None, ...]
    encoder: tuple[int | None, ...]
    gravity_bound: tuple[Number | None, ...]
    numbers: dict[str, Number]
    remarks: tuple[str, ...] = ()
    printed: PrintedTorques | None = None

    @property
    def dry(self) -> bool:
        """Whether the file gives dry friction to a joint."""
        return any(number is not None and number.bounds[1] > 0 for number in self.coulomb)

    @cached_property
    def assumptions(self) -> tuple[str, ...]:
        """What is taken for granted about this arm, one sentence each."""
        assumed = [number.sentence(name) for name, number in self.numbers.items() if number.assumed]
        return (*self.remarks, *assumed)
