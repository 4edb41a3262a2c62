"""Whether an arm is physical: M(q) ≻ 0 as the checker shows it, or a posture at which it is not."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from lyapcheck._types import SEED
from lyapcheck.check.kinds.inertia import MassAbove, PostureWitness
from lyapcheck.control.judgement import proves, refutes
from lyapcheck.files.decimals import decimal_text
from lyapcheck.libraries import installed

if TYPE_CHECKING:
    from lyapcheck.search.controlled_arm import ControlledArm

POSTURES = 20_000
DIGITS = 4


def unphysical(controlled: ControlledArm) -> str:
    """Why no V of this arm is a Lyapunov function, in one sentence; empty where M(q) ≻ 0 is proved."""
    loop = controlled.loop(Fraction(1))
    statement = MassAbove(loop.arm.mass, loop.parameters, Fraction(0))
    if proves(statement, controlled.inertia_proof):
        return ""
    against = _against(controlled, loop.parameters)
    if against is None or not refutes(statement, against):
        return "M(q) is not shown to be positive definite; lyapcheck robot says what is known of the arm"
    q = ", ".join(map(decimal_text, against.q))
    return f"M(q) is not positive definite at q = ({q}) rad; correct the masses and inertias"


def _against(
    controlled: ControlledArm, parameters: tuple[tuple[Fraction, Fraction], ...]
) -> PostureWitness | None:
    """The nominal arm where M(q) is the least of many postures; ``None`` where that is positive.

    None is looked for without NumPy.
    """
    if not installed("numpy"):
        return None
    import numpy as np

    q = np.random.default_rng(SEED).uniform(-np.pi, np.pi, (POSTURES, controlled.n))
    q = np.round(q, DIGITS)
    sizes, vectors = np.linalg.eigh(controlled.numeric.mass(q))
    worst = int(np.argmin(sizes[:, 0]))
    if not sizes[worst, 0] < 0:
        return None
    nominal = [number.value for number in controlled.ranged.parameters.values()]
    if len(nominal) != len(parameters):
        return None
    angles, x = (tuple(Fraction(repr(float(v))) for v in row) for row in (q[worst], vectors[worst][:, 0]))
    return PostureWitness(angles, tuple(nominal), x)
