"""The indices of many runs, one row a quantity and joint."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from lyapcheck.simulate.starts import Sweep


@dataclass(frozen=True, eq=False)
class Quantity:
    """One index of every run.

    Args:
        name: with the joint and the unit.
        values: (R,), NaN where a run has none.
        form: how a number of it is shown.
    """

    name: str
    values: NDArray[np.float64]
    form: str

    @property
    def without(self) -> int:
        """How many runs have no such number."""
        return int(np.count_nonzero(~np.isfinite(self.values)))


def quantities(result: Sweep) -> list[Quantity]:
    """L2, then each index joint by joint."""
    runs = result.runs
    tables = (
        ("settling [s]", runs.settling, "z.3f"),
        ("overshoot [%]", runs.overshoot, "z.2f"),
        ("peak torque [N·m]", runs.peak_torque, "z.2f"),
        ("final error [°]", runs.final_error, "z.4f"),
    )
    return [
        Quantity("L2 [°]", runs.L2, ".4f"),
        *(
            Quantity(f"{joint} {name}", table[:, i], form)
            for name, table, form in tables
            for i, joint in enumerate(result.joints)
        ),
    ]
