"""What moves: the dynamics of an arm and its friction, with the ranges of what is uncertain about them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from math import sqrt
from typing import TYPE_CHECKING

from flint import fmpq_mpoly, fmpq_mpoly_ctx

from lyapcheck.check.numbers.vectors import is_positive_semidefinite
from lyapcheck.errors import argument_error
from lyapcheck.files.loop import NOTHING, LoopEntry
from lyapcheck.robots.dynamics import Chain
from lyapcheck.robots.fields import Number
from lyapcheck.robots.printed import PrintedTorques
from lyapcheck.robots.trig import ArmAtAngles, Dynamics, Lift, T, Tidy, to_terms

if TYPE_CHECKING:
    from lyapcheck.check.statement import Monomials
    from lyapcheck.robots.fields import Vary


@dataclass(frozen=True, eq=False, kw_only=True)
class RobotModel:
    """n revolute joints that obey M(q)q̈ + C(q,q̇)q̇ + g(q) + Bq̇ = τ, every number with its source.

    C_ij = Σ_k c_ijk q̇_k with the Christoffel symbols of M, and g = ∂potential/∂q, so that Ṁ = C + Cᵀ.

    Args:
        name: in messages (``"buap3"``).
        joints: names of the joints, base first.
        dynamics: M, C, g and the potential energy.
        viscous: diagonal of B, (n,), N·m·s/rad.
        parameters: the numbers with a range that enter M or the potential, in the order of ``dynamics``.
        title: one line for reports.
        coulomb: Coulomb friction torques, N·m. None if unknown.
        torque_limit: largest torque of each motor, N·m. None if unknown.
        encoder: counts per turn. None if unknown.
        gravity_bound: k_gi that the source prints, N·m.
        numbers: every number of the arm with its provenance.
        remarks: further assumptions, in sentences.
        printed: C and g that the source prints. Nothing is derived from them.
        loop: the sampled loop in the file.
        source: the name or path that ``load_robot`` was given, empty for an arm made in Python.
        varies: the ranges that ``load_robot`` was given. The gate judges gains for all of them.

    Soundness: M belongs to the physical arm only if ``numbers`` do. ``assumptions`` lists the numbers that no
    source prints.

    References: (1) and properties 2.1–2.8 of reyes2019family.
    """

    name: str
    joints: tuple[str, ...]
    dynamics: Dynamics
    viscous: tuple[Number, ...]
    parameters: dict[str, Number] = field(default_factory=dict)
    title: str = ""
    coulomb: tuple[Number | None, ...] = ()
    torque_limit: tuple[Number | None, ...] = ()
    encoder: tuple[int | None, ...] = ()
    gravity_bound: tuple[Number | None, ...] = ()
    numbers: dict[str, Number] = field(default_factory=dict)
    remarks: tuple[str, ...] = ()
    printed: PrintedTorques | None = None
    loop: LoopEntry = NOTHING
    source: str = field(default="", repr=False)  # two paths of one file are one arm to the store
    varies: tuple[Vary, ...] = field(default=(), repr=False)

    @property
    def address(self) -> str:
        """What commands and gain files call the arm."""
        return self.source or self.name

    @property
    def n(self) -> int:
        return self.dynamics.n

    @property
    def mass(self) -> tuple[tuple[fmpq_mpoly, ...], ...]:
        """M(q), rows of polynomials in normal form, kg·m²; raises `TooLong` where those are not worth it."""
        return self.dynamics.polynomials.mass

    @cached_property
    def mass_terms(self) -> tuple[tuple[Monomials, ...], ...]:
        """M(q) as statements have it."""
        return tuple(tuple(tuple(to_terms(entry)) for entry in row) for row in self.mass)

    @property
    def potential(self) -> fmpq_mpoly:
        return self.dynamics.polynomials.potential

    @property
    def christoffel(self) -> tuple[tuple[tuple[fmpq_mpoly, ...], ...], ...]:
        """c_ijk = ½(∂M_ij/∂q_k + ∂M_ik/∂q_j − ∂M_jk/∂q_i), so that C(q,x)_ij = Σ_k c_ijk x_k."""
        return self.dynamics.polynomials.christoffel

    @property
    def gravity(self) -> tuple[fmpq_mpoly, ...]:
        """g(q) = ∂potential/∂q as polynomials, N·m."""
        return self.dynamics.polynomials.gravity

    @property
    def ring(self) -> fmpq_mpoly_ctx:
        """Generators s1…sn, c1…cn and one for each entry of ``parameters``."""
        return self.potential.context()

    @property
    def ranges(self) -> tuple[tuple[Fraction, Fraction], ...]:
        """The range of each parameter, in their order."""
        return tuple(number.bounds for number in self.parameters.values())

    @property
    def ranges_of_mass(self) -> tuple[tuple[Fraction, Fraction], ...]:
        """The same; a parameter that M does not depend on, such as one of gravity, is held at its value."""
        terms = (powers for row in self.mass_terms for entry in row for powers, _ in entry)
        used = {place for powers in terms for place, power in enumerate(powers[2 * self.n :]) if power}
        return tuple(
            number.bounds if place in used else (number.value, number.value)
            for place, number in enumerate(self.parameters.values())
        )

    @property
    def chain(self) -> Chain | None:
        """The links where they are known and exact."""
        return self.dynamics if isinstance(self.dynamics, Chain) and not self.parameters else None

    @cached_property
    def heaviest(self) -> Chain | None:
        """The links with their largest masses, where those are known and g depends on nothing else."""
        if not isinstance(self.dynamics, Chain) or not self.parameters:
            return self.chain
        light, heavy = (
            self.dynamics.fixed({key: number.bounds[end] for key, number in self.parameters.items()})
            for end in (0, 1)
        )
        masses_alone = light.fall == heavy.fall and all(
            replace(a, mass=b.mass, inertia=b.inertia, rotor=b.rotor) == b
            for a, b in zip(light.links, heavy.links, strict=True)
        )
        return heavy if masses_alone else None

    def at(
        self,
        sin: Sequence[T],
        cos: Sequence[T],
        lift: Lift[T],
        parameters: Mapping[str, T] | None = None,
        tidy: Tidy = None,
    ) -> ArmAtAngles:
        """The arm at some angles in any arithmetic, see `Dynamics`; parameters not given are nominal."""
        nominal = {name: lift(number.value) for name, number in self.parameters.items()}
        return self.dynamics.at(sin, cos, nominal | dict(parameters or {}), lift, tidy)

    def with_motors(self, limits: Sequence[Fraction] | None) -> RobotModel:
        """The same arm with other torque limits, N·m, if there are some."""
        given = tuple(Number(limit, "N·m", "[bounds]") for limit in limits or ())
        return replace(self, torque_limit=given or self.torque_limit)

    def fixed(self, **parameters: Fraction | int) -> RobotModel:
        """The same arm with every uncertain parameter of M and the potential at one exact value.

        Args:
            parameters: values by name; a parameter that is not named keeps its nominal value.

        Raises:
            InputError: a name that is not a parameter of this arm.
        """
        for name in parameters:
            if name not in self.parameters:
                known = ", ".join(self.parameters) or "none"
                raise argument_error(
                    "parameter", name, f"{self.name} has no such parameter", f"use one of: {known}"
                )
        if not parameters:
            return self._nominal
        nominal = {name: number.value for name, number in self.parameters.items()}
        values = {name: Fraction(value) for name, value in (nominal | parameters).items()}
        return replace(self, dynamics=self.dynamics.fixed(values), parameters={}, varies=())

    @cached_property
    def _nominal(self) -> RobotModel:
        """Each question about the arm asks for it."""
        nominal = {name: number.value for name, number in self.parameters.items()}
        return self.fixed(**nominal) if nominal else self

    def __repr__(self) -> str:
        assumed = sum(number.assumed for number in self.numbers.values())
        return f"<RobotModel: {self.name}, {self.n} joints, {assumed} of {len(self.numbers)} numbers assumed>"

    @property
    def dry(self) -> bool:
        """Whether the file gives dry friction to a joint."""
        return any(number is not None and number.bounds[1] > 0 for number in self.coulomb)

    @property
    def of_unknown_friction(self) -> tuple[str, ...]:
        """The joints to which the file gives no dry friction."""
        return tuple(joint for joint, f in zip(self.joints, self.coulomb, strict=True) if f is None)

    @cached_property
    def assumptions(self) -> tuple[str, ...]:
        """What is taken for granted about this arm, one sentence each."""
        assumed = [number.sentence(name) for name, number in self.numbers.items() if number.assumed]
        return (*self.remarks, *self.doubts, *assumed)

    @cached_property
    def doubts(self) -> tuple[str, ...]:
        """What looks like a template or another unit; no verdict rests on it."""
        return (*_templates(self), *_units(self))


# --- What makes the numbers of an arm doubtful: templates and wrong units; no verdict rests on it.


HEAVIEST, LONGEST = 1000, 5
"""kg of one body, and m from joint to joint: of arms nobody bolts to a floor."""
LIGHTEST, STEEPEST = 1, 30
"""m/s² of free fall, from the moon to a large planet."""
SAME = 2
"""So many joints with the same limit and friction are doubted; either alone with twice as many."""


def _templates(model: RobotModel) -> Iterator[str]:
    friction = _values(model.viscous)
    limits = _values(model.torque_limit)
    if friction and not any(friction):
        yield "Viscous friction is 0 for every joint, as files say that do not know it"
        friction = None
    same = [
        words
        for words, values in (("viscous friction", friction), ("torque limit", limits))
        if values is not None and len(values) >= SAME and len(set(values)) == 1
    ]
    if len(same) == 2 or (same and model.n >= 2 * SAME):
        verb = "are" if len(same) == 2 else "is"
        words = " and ".join(same).capitalize()
        yield f"{words} {verb} the same for every joint, as in templates; measured ones differ"


def _values(numbers: Sequence[Number | None]) -> list[Fraction] | None:
    """Exact numbers of every joint; ``None`` where one is missing, assumed or a range."""
    known = [x.value for x in numbers if x is not None and not x.assumed and not x.ranged]
    return known if len(known) == len(numbers) else None


def _units(model: RobotModel) -> Iterator[str]:
    chain = model.fixed().chain
    if chain is None:
        return
    for name, link in zip(model.joints, chain.links, strict=True):
        far = max(sqrt(sum(float(x) ** 2 for x in vector)) for vector in (link.origin, link.com))
        if link.mass > HEAVIEST:
            yield f"What {name} moves has a mass of {float(link.mass):.6g} kg: is that in grams?"
        if far > LONGEST:
            yield f"{name} or its body is {far:.6g} m away from the joint before: is that in mm?"
        spread = (
            sqrt(float(sum(link.inertia[i][i] for i in range(3))) / (2 * float(link.mass)))
            if link.mass
            else 0
        )
        if spread > LONGEST:
            yield f"The inertia behind {name} is that of a body of {spread:.6g} m: is it in kg·mm² or g·m²?"
        # an inertia about one axis alone is a planar one, where nothing more is said of the body
        flat = sum(bool(link.inertia[i][i]) for i in range(3)) < 2
        if not flat and not of_a_body(link.inertia):
            yield f"No body has the inertia behind {name}: one principal moment exceeds the sum of the others"
    size = sqrt(sum(float(x) ** 2 for x in chain.fall))
    if chain.fall[2] > 0 and chain.fall[2] >= max(map(abs, chain.fall[:2])):
        yield f"Gravity points upwards: g_z = {float(chain.fall[2]):.6g} m/s²"
    if size and not LIGHTEST < size < STEEPEST:
        yield f"Free fall of {size:.6g} m/s² is that of no place where arms stand"


def of_a_body(inertia: Sequence[Sequence[Fraction]]) -> bool:
    """Whether some body has this inertia: ∫ x xᵀ dm = tr(I)/2 − I is positive semidefinite.

    It is so exactly when no principal moment is above the sum of the others.
    """
    half = sum((inertia[i][i] for i in range(3)), Fraction(0)) / 2
    return is_positive_semidefinite([[half * (i == j) - inertia[i][j] for j in range(3)] for i in range(3)])
