"""One gain set on one arm, as doubles for the search and as exact data for the checker."""

from __future__ import annotations

import math
from contextlib import suppress
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING

from lyapcheck._types import SEED, Array
from lyapcheck.check.kinds.decreasing import BoxTree, PositiveAndDecreasing, statement_of
from lyapcheck.check.kinds.inertia import Bisection, Links, MassAbove, MassAtCorners, PostureWitness
from lyapcheck.check.kinds.link_bounds import LinkBounds
from lyapcheck.check.loop import ClosedLoop, corners_of
from lyapcheck.check.loop.states import Arm, Controller
from lyapcheck.check.numbers.members import Functions
from lyapcheck.computing import shared_between
from lyapcheck.control.judgement import JudgedStatement, judged_statement, proves, refutes
from lyapcheck.errors import argument_error, installed
from lyapcheck.family import Family, named
from lyapcheck.files.decimals import decimal_text
from lyapcheck.robots.dynamics import FEW_JOINTS, Chain, TooManyTerms
from lyapcheck.robots.plant import RobotModel

if TYPE_CHECKING:
    from collections.abc import Sequence

    from lyapcheck.check.kinds.link_bounds import ChainDecreasing
    from lyapcheck.check.statement import Ends, Mass, Proof, Statement
    from lyapcheck.control.gains import GainSet
    from lyapcheck.lyapunov.numeric import LyapunovNumeric
    from lyapcheck.robots.numeric import NumericModel

RateData = BoxTree | LinkBounds
"""What may show dV/dt < 0."""


def chains_of(arm: RobotModel, ranges: Sequence[Ends]) -> tuple[Chain, ...]:
    """The links of an arm at each corner of the ranges of its parameters; empty where they are not known."""
    if not isinstance(arm.dynamics, Chain):
        return ()
    corners = corners_of(ranges)
    arms = (arm.fixed(**dict(zip(arm.parameters, corner, strict=True))).chain for corner in corners)
    return tuple(chain for chain in arms if chain is not None)


@dataclass(frozen=True)
class DecreaseProof:
    """A closed loop, and the data by which M ≻ 0 and dV/dt < 0 are to be shown for it.

    ``judged`` is what the checker says, where it was asked.
    """

    loop: ClosedLoop
    by: RateData
    inertia: Bisection | Links | MassAtCorners
    judged: JudgedStatement | None = field(default=None, kw_only=True, compare=False)

    @property
    def eps0(self) -> Fraction:
        """ε₀."""
        return self.loop.eps0

    @property
    def coupling(self) -> tuple[Fraction, ...]:
        """Diagonal of Λ; empty for (13)."""
        return self.loop.coupling

    @property
    def boxes(self) -> int:
        """How many boxes the data consist of."""
        return self.by.tree.count(".")

    @property
    def statement(self) -> Statement:
        """What is proved."""
        return statement_of(self.loop)

    @property
    def certificate(self) -> Proof:
        """The proof as certificates bring it forward."""
        return PositiveAndDecreasing(self.inertia, self.by)

    def accepted(self, jobs: int = 1) -> DecreaseProof | None:
        """The same with the verdict of the checker, in so many processes; ``None`` where it refuses."""
        with shared_between(jobs):
            judged = judged_statement(self.statement, [self.certificate])
        return replace(self, judged=judged) if judged.shown == "proved" else None


@dataclass(frozen=True)
class ChainProof:
    """The same of links whose M(q) is too long to be written out, judged by the checker."""

    statement: ChainDecreasing
    certificate: Proof
    judged: JudgedStatement
    coupling: tuple[Fraction, ...] = ()
    boxes: int = 0

    @property
    def eps0(self) -> Fraction:
        """ε₀."""
        return self.statement.eps0


@dataclass(frozen=True, eq=False)
class ControlledArm:
    """A gain set on an arm whose uncertain parameters stand at their nominal values.

    Args:
        gains: the controller.
        model: the arm.
        ranges: prove for all values of the uncertain parameters and friction, not only the nominal ones.
    """

    gains: GainSet
    model: RobotModel
    ranges: bool = False

    def __post_init__(self) -> None:
        n = self.model.n
        if len(self.gains.kp) != n or len(self.gains.kv) != n:
            rule = f"has gains for {len(self.gains.kp)} joints, but {self.model.name} has {n}"
            repair = (
                "choose the arm the gains were made for, or write a gain file with one gain for each joint"
            )
            raise argument_error("gains", self.gains.name, rule, repair)

    @cached_property
    def family(self) -> Family:
        """The function of the controller."""
        return named(self.gains.family, self.gains.m)

    @property
    def n(self) -> int:
        """Number of joints."""
        return self.model.n

    @property
    def per_degree(self) -> bool:
        """Whether the gains are in N·m per degree."""
        return self.gains.angle_unit == "deg"

    @cached_property
    def kp(self) -> Array:
        """Diagonal of K_p, N·m (per rad where h is linear)."""
        return self._doubles(self.gains.kp)

    @cached_property
    def kv(self) -> Array:
        """Diagonal of K_v, N·m (per rad/s where h is linear)."""
        return self._doubles(self.gains.kv)

    @cached_property
    def numeric(self) -> NumericModel:
        """The arm in NumPy."""
        from lyapcheck.robots.numeric import NumericModel

        return NumericModel(self.model)

    @cached_property
    def lyapunov(self) -> LyapunovNumeric:
        """V and dV/dt in floating point, with ε₀ = 0."""
        return self.watched(0.0)

    def watched(self, eps0: float) -> LyapunovNumeric:
        """The same with another ε₀."""
        from lyapcheck.lyapunov.numeric import LyapunovNumeric

        return LyapunovNumeric(self.model, self.family, list(self.kp), list(self.kv), eps0)

    @cached_property
    def fixed(self) -> RobotModel:
        """The arm without parameters."""
        return self.model.fixed()

    @cached_property
    def viscous(self) -> Array:
        """Diagonal of B, N·m·s/rad."""
        return self.numeric.viscous

    @cached_property
    def fast_damping(self) -> Array:
        """Diagonal of B + K_v D as ‖w‖ → ∞: D → 0 for a bounded h, D = 1 for the linear one."""
        return self.viscous if self.family.bounded else self.viscous + self.kv

    @cached_property
    def arm(self) -> Arm:
        """M and B, exactly."""
        return Arm(self.fixed.mass_terms, tuple(number.value for number in self.fixed.viscous))

    @cached_property
    def controller(self) -> Controller:
        """The controller, exactly."""
        functions = Functions(self.family.ball_h, self.family.ball_dh, self.family.ball_potential)
        return Controller(functions, tuple(self.gains.kp), tuple(self.gains.kv), self.per_degree)

    @cached_property
    def ranged(self) -> RobotModel:
        """The arm that certificates are about: with its parameters if they are to range."""
        return self.model if self.ranges else self.fixed

    @cached_property
    def too_long(self) -> bool:
        """Whether M(q) has too many terms to be written out."""
        try:
            return not self.ranged.mass_terms
        except TooManyTerms:
            return True

    @cached_property
    def chains(self) -> tuple[Chain, ...]:
        """See `chains_of`; of parameters that M does not depend on there are no corners."""
        return chains_of(self.ranged, self.loop(Fraction(1)).parameters)

    @cached_property
    def inertia_proof(self) -> Bisection | Links | MassAtCorners:
        """What shows M ≻ 0."""
        if self.ranges:
            # boxes of many angles are too many
            known = tuple(Links(chain.links) for chain in self.chains) if self.n > FEW_JOINTS else ()
            if len(known) == 1:  # friction alone ranges
                return known[0]
            return MassAtCorners(known) if known else Bisection()
        remember(self.fixed)
        return mass_proof(self.fixed.mass_terms)

    def loop(self, eps0: Fraction, coupling: tuple[Fraction, ...] = ()) -> ClosedLoop:
        """What a global certificate has to prove at one ε₀: (11) with V of (13), exact.

        With a diagonal of Λ given V is that of y = w − εΛh.

        Raises:
            InputError: the checker does not know the function of the controller.
        """
        if self.family.bounded:
            _ = self.family.checked
        gains, arm = self.gains, self.ranged
        return ClosedLoop(
            arm=Arm(arm.mass_terms, tuple(number.value for number in arm.viscous)),
            family=gains.family,
            m=gains.m,
            kp=tuple(gains.kp),
            kv=tuple(gains.kv),
            eps0=eps0,
            parameters=arm.ranges_of_mass,  # what M does not depend on is no side of the boxes
            viscous=tuple(number.bounds for number in arm.viscous) if self.ranges else (),
            coupling=coupling,
        )

    def require_friction(self) -> None:
        """Refuse a bounded h on an arm without viscous friction at each joint: no ε₀ > 0 is certified.

        As ‖w‖ → ∞ dV/dt comes to −wᵀ(B + ε S)w, where S need not be positive.

        Raises:
            InputError: a joint without.
        """
        low = [number.bounds[0] if self.ranges else number.value for number in self.model.viscous]
        bare = [joint for joint, b in zip(self.model.joints, low, strict=True) if b <= 0]
        if bare and self.family.bounded:
            rule = (
                f"has no viscous friction at {', '.join(bare)}, without which no ε₀ is certified; that "
                "motions end at the goal, by LaSalle's theorem, needs none"
            )
            repair = "state it in the arm file (robot --export writes one), or ask gate --condition lasalle"
            raise argument_error("arm", self.model.name, rule, repair)

    def proof(self, loop: ClosedLoop, by: RateData) -> DecreaseProof:
        """What is to be judged, with untrusted data for dV/dt < 0."""
        return DecreaseProof(loop, by, self.inertia_proof)

    def _doubles(self, gains: tuple[Fraction, ...]) -> Array:
        import numpy as np

        unit = math.degrees(1.0) if self.per_degree else 1.0
        return np.array([float(gain) * unit for gain in gains])


# --- Whether an arm is physical: M(q) ≻ 0 as the checker shows it, or a posture at which it is not.


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


# --- What shows that M(q) is positive definite: the links of an arm where they are known, else boxes.


_LINKS: dict[Mass, Links] = {}
"""The links of arms that were looked at, by the M(q) that they make."""


def remember(robot: RobotModel) -> None:
    """Keep the links of an arm for statements that have only its M(q)."""
    fixed = robot.fixed()
    if fixed.chain is not None:
        # a mass matrix that is too long to be written out is in no statement
        with suppress(TooManyTerms):
            _LINKS[fixed.mass_terms] = Links(fixed.chain.links)


def mass_proof(mass: Mass) -> Bisection | Links:
    """How M ≻ 0 is to be shown."""
    return _LINKS.get(mass, Bisection())
