"""The certificate of a state of a run at which V rises: a state against its ε₀."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from lyapcheck.certificate import Certificate
from lyapcheck.check.certificate import About
from lyapcheck.check.kinds.decreasing import StateWitness, statement_of
from lyapcheck.check.refusal import Refused
from lyapcheck.check.verify import verify
from lyapcheck.search.controlled_arm import ControlledArm

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import RobotModel
    from lyapcheck.simulate.run import Run


def breach_certificate(run: Run, gains: GainSet, model: RobotModel) -> Certificate | None:
    """That dV/dt < 0 fails for the run's ε₀, at the state where the run was seen to break it.

    Args:
        run: by the equations, to a set point.
        gains: of the run.
        model: the arm, at whose nominal numbers it ran.

    Returns:
        ``None`` where the run broke nothing, or a promise that is no statement: limits of torque.

    Soundness: the checker accepted it; that a motion comes to the state is simulated, and not said.
    """
    controlled = ControlledArm(gains, model)
    breach, eps0 = run.breach, Fraction(run.eps0)
    if breach is None or not breach.confirmed or eps0 <= 0 or not controlled.family.bounded:
        return None
    statement = statement_of(controlled.loop(eps0))
    q, e, w = (tuple(map(Fraction, row)) for row in (breach.at.q, breach.at.e, breach.at.w))
    against = StateWitness(controlled.arm.viscous, (), q, e, w)
    try:
        accepted = verify(statement, against)
    except Refused:
        return None
    says = f"not dV/dt < 0 at every state: {gains.name} on {model.name}, at a state of a run"
    about = About(f"{gains.name}.breach", says, gains.m, controlled.n, "simulate")
    return Certificate(about, statement, accepted.verdict, accepted.grade, against)
