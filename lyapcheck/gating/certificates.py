"""Certificates as conditions of the gate: gains are accepted where some ε₀ > 0 is proved for the arm.

    scalar   Θ'(ε) ≻ 0 for all ε in (0, ε₀], from norms and certified constants of the arm
    global   dV/dt < 0 at every state but the origin, shown by the small checker on a tree of boxes

A search that finds nothing refutes nothing: there is no ``rejected`` here.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from functools import cached_property

from lyapcheck.check.kinds.decreasing import BoxTree
from lyapcheck.constants import robot_bounds
from lyapcheck.control.conditions import ACCEPTED, UNDECIDED, Check
from lyapcheck.control.gains import GainSet
from lyapcheck.lyapunov.scalar import RobotBounds, scalar_form, sharp_form
from lyapcheck.robots import RobotModel, load
from lyapcheck.search.certified import certified_epsilon
from lyapcheck.search.proof import Proof
from lyapcheck.search.radial import radial_epsilon
from lyapcheck.search.scalar_program import scalar_epsilon
from lyapcheck.search.setting import Setting

MAX_BOXES = 5_000
"""For each attempt: any ε₀ will do, so the boxes of a second or two are enough."""
CEILINGS = (64, 16, 8, 4, 2)
"""Times the scalar ε₀: where branch and bound begins, from above."""

_NOMINAL = "certificates are about the arm at its nominal numbers"
_NO_ARM = "needs the arm itself, and not only its limits; name one with robot = …"
_OTHER_FRICTION = (
    "[bounds] viscous_min replaces λmin(B), but the friction of every joint is needed; remove it"
)


class Prover:
    """The certificates of gain sets on one arm at its nominal numbers.

    Args:
        robot: name or path of the arm; empty where there is none.
        viscous_min: λmin(B) that replaces the arm's, N·m·s/rad.
    """

    def __init__(self, robot: str, viscous_min: Fraction | None = None) -> None:
        self.robot, self.viscous_min = robot, viscous_min

    def check(self, name: str, gains: GainSet) -> Check:
        """The check of one certificate: its value is the ε₀ proved.

        Soundness: the scalar form is decided in rational arithmetic, with constants that are bounds from
            outside; global ones have been accepted by ``lyapcheck.check.loop``.
        """
        if not self.robot:
            return Check(name, None, UNDECIDED, None, None, None, _NO_ARM)
        eps0, reason = self._scalar(gains) if name == "scalar" else self._global(gains)
        verdict = UNDECIDED if eps0 is None else ACCEPTED
        return Check(name, None, verdict, eps0, None, None, reason)

    @cached_property
    def model(self) -> RobotModel:
        """The arm."""
        return load(self.robot)

    @property
    def assumptions(self) -> tuple[str, ...]:
        """What is taken for granted about the arm, and that its numbers are nominal."""
        return (_NOMINAL, *self.model.assumptions) if self.robot else ()

    @cached_property
    def bounds(self) -> RobotBounds:
        """Its constants from outside, with the λmin(B) that was given."""
        found = robot_bounds(self.model)
        if self.viscous_min is None:
            return found
        largest = max(found.viscous_max, self.viscous_min)
        return replace(found, viscous_min=self.viscous_min, viscous_max=largest)

    def _scalar(self, gains: GainSet) -> tuple[Fraction | None, str]:
        constants = Setting(gains, self.model).family.constants()
        form = scalar_form(gains, constants, self.bounds) or sharp_form(gains, constants, self.bounds)
        found = scalar_epsilon(form)
        return found.eps0, found.reason

    def _global(self, gains: GainSet) -> tuple[Fraction | None, str]:
        setting = Setting(gains, self.model)
        if self.viscous_min not in (None, min(number.value for number in self.model.viscous)):
            return None, _OTHER_FRICTION
        if not setting.family.bounded:
            return None, "h is unbounded, and the checker needs its bound γ"
        coarse = scalar_epsilon(setting.closure(Fraction(1)).tail)
        if coarse.eps0 is None:
            return None, coarse.reason
        proved = next(_proofs(setting, coarse.eps0), None)
        return proved, "" if proved else "the checker accepted no proof"


def _proofs(setting: Setting, coarse: Fraction) -> Iterator[Fraction]:
    """ε₀ that the checker has accepted, the largest that can be hoped for first.

    Args:
        coarse: ε₀ of the checker's own scalar form.
    """
    for ceiling in CEILINGS:
        found = certified_epsilon(setting, ceiling * coarse, MAX_BOXES)
        if found.eps0 is not None:
            yield found.eps0
    radial = radial_epsilon(setting)
    if radial is not None:
        yield radial.closure.eps0
    closure = setting.closure(coarse)
    if Proof(closure, BoxTree("."), setting.inertia_proof).accepted():
        yield closure.eps0
