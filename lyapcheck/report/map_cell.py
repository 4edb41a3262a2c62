"""A place of the map over m and k_v."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class MapCell:
    """What is proved and simulated for one m and one k_v, the same in every joint.

    Args:
        kv: N·m, as written.
        eps0: the ε₀ that is proved, 1/s; none without.
        settling: of the slowest joint, s; none where one does not settle.
        share: the largest share of a motor's torque; none where no motor has a limit.
        within_19: whether (19) holds.
    """

    m: int
    kv: str
    eps0: str | None
    settling: float | None
    share: float | None
    within_19: bool

    @property
    def path(self) -> str:
        """Where its certificate stands in a report."""
        return f"certificates/map/m{self.m}.kv{self.kv}.json"
