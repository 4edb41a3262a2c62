"""What an arm's torque limits leave to k_p + k_v of each joint, for many members of the family."""

from __future__ import annotations

from lyapcheck.answers.table import Budget, Table
from lyapcheck.answers.tune.arm import arm_limits
from lyapcheck.check.numbers.balls import precision, to_arb
from lyapcheck.check.numbers.constants import Constants
from lyapcheck.check.numbers.enclosure import Enclosure
from lyapcheck.control.limits import Limits
from lyapcheck.robots import load

_GUARD_BITS = 32


def torque_budget(robot: str, table: Table) -> Budget:
    """(τmax − k_g)/(√n γ_m) of each joint and each row of a table, N·m, as tight as the table is.

    A joint without a torque limit, or whose gravity torque reaches it, has ``None``.

    Raises:
        InputError: no such arm.

    References: the tuning rule of Section 4, reyes2019family.
    """
    limits = arm_limits(robot, load(robot).n)
    bits = 4 * table.digits + _GUARD_BITS
    return Budget(robot, limits.joints, tuple(_row(row, limits, bits) for row in table.rows))


def _row(row: Constants, limits: Limits, bits: int) -> tuple[Enclosure | None, ...]:
    result: list[Enclosure | None] = []
    with precision(bits):
        scale = to_arb(limits.n).sqrt() * row.gamma.to_arb()
        for torque, gravity in zip(limits.torque, limits.gravity, strict=True):
            if torque is None or torque <= gravity:
                result.append(None)
            else:
                result.append(Enclosure.from_arb(to_arb(torque - gravity) / scale))
    return tuple(result)
