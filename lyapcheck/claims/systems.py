"""The front end for proofs about an arm under any torque: letters, gains, functions, and theorems by name.

::

    goal = constant_goal()                      # e = q_d − q, w = q̇
    e, w = goal.e, goal.w
    Kp, Kv = goal.gains("Kp Kv")
    loop = goal.under(Kp @ e - Kv @ w + goal.gravity)
    V = w @ goal.M @ w / 2 + e @ Kp @ e / 2
    proof.add("P", "…", lasalle(loop, V, above=goal.mu * b**2 / 2 + Kp.min * r**2 / 2, …))

What the letters stand for, how they move and how large they are is the checker's: see ``check.systems``.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from difflib import get_close_matches
from fractions import Fraction
from itertools import combinations_with_replacement
from typing import TYPE_CHECKING

from lyapcheck.check.expressions.expression import Tree, derivative, substitute, variables
from lyapcheck.check.kinds.bound_every_n import terms_of
from lyapcheck.check.kinds.every_n import EveryN
from lyapcheck.check.kinds.stability import Stable
from lyapcheck.check.kinds.stable_arm import Arm, StableArm, hessian
from lyapcheck.check.letters.grammar import letters
from lyapcheck.check.loop.field import size_of
from lyapcheck.check.numbers.harmonics import by_parameters
from lyapcheck.check.statement import Monomials, Relation, Statement
from lyapcheck.check.systems.facts import constants_of
from lyapcheck.check.systems.forms import Form
from lyapcheck.check.systems.system import Entrywise, Member, State, System
from lyapcheck.check.systems.theorems import Argument, Change, Rest
from lyapcheck.claims.bounds import ArmBounds, above
from lyapcheck.claims.exact import exact_value
from lyapcheck.claims.expressions import Expr, diff, expr, sqrt, total, var
from lyapcheck.claims.letters import AnyMatrix, AnyVector, any_matrix, any_vector, diagonal
from lyapcheck.robots.trig import to_terms

if TYPE_CHECKING:
    from lyapcheck.robots import RobotModel

ZERO: Tree = ("num", "0")


@dataclass(frozen=True, eq=False)
class Gain(AnyMatrix):
    """A diagonal positive matrix: ``K.min``, ``K.max`` are its eigenvalues, ``K @ U`` … its products."""

    name: str = ""

    @property
    def entries(self) -> AnyVector:
        """Its diagonal."""
        return any_vector(self.name)

    @property
    def min(self) -> Expr:
        """The least eigenvalue."""
        return var(f"{self.name}_min")

    @property
    def max(self) -> Expr:
        """The largest eigenvalue."""
        return var(f"{self.name}_max")

    @property
    def norm(self) -> Expr:
        """The norm of its diagonal."""
        return var(f"{self.name}_norm")


@dataclass(frozen=True, eq=False)
class Function(AnyVector):
    """f(x) for each entry of a state, with its size, potential and constants."""

    name: str = ""

    @property
    def U(self) -> AnyVector:
        """Its potential by entries: U' = f, U(0) = 0."""
        return any_vector(f"U{self.name}")

    @property
    def sum_U(self) -> Expr:
        """Σ U(x_i)."""
        return var(f"sum_U{self.name}")

    @property
    def reach(self) -> Expr:
        """At least ‖f(x)‖."""
        return var(f"{self.name}_reach")

    @property
    def slope(self) -> Expr:
        """At least |f'|."""
        return var(f"{self.name}_slope")

    @property
    def secant(self) -> Expr:
        """At least |f(x)/x|."""
        return var(f"{self.name}_secant")

    @property
    def sector(self) -> Expr:
        """1/secant: x f(x) is at least this times f(x)²."""
        return var(f"{self.name}_sector")


def norm(x: AnyVector) -> Expr:
    """The size of a letter, as forms have it.

    Raises:
        ValueError: it is a sum or product; sizes are those of states and functions.
    """
    if x.tree[0] != "vec":
        raise ValueError("norm: a size is that of one letter, such as e, w or a function")
    return var(f"norm_{x.tree[1]}")


@dataclass
class Goal:
    """What an arm is asked to do, and the letters of its closed loop; ``constant_goal``, ``moving_goal``."""

    desired: bool
    friction: str
    disturbed: bool = False
    _gains: list[str] = field(default_factory=list)
    _functions: list[Entrywise] = field(default_factory=list)
    _states: list[State] = field(default_factory=list)
    _constants: list[str] = field(default_factory=list)

    e, w = any_vector("e"), any_vector("w")
    """q_d − q, and q̇ − q̇_d."""
    M = any_matrix("M")
    mu, beta, kc, kg, vd, R, eps0, s = map(var, ("mu", "beta", "kc", "kg", "vd", "R", "eps0", "s"))
    """λmin(M), ‖M‖, the Coriolis bound, ‖∂g/∂q‖, ‖q̇_d‖, the radius of a local bound; ε = ε₀ s."""

    @property
    def C(self) -> AnyMatrix:
        """C(q, q̇)."""
        return any_matrix("C") + any_matrix("D") if self.desired else any_matrix("C")

    @property
    def B(self) -> Gain:
        """The matrix of viscous friction."""
        return _gain("B")

    @property
    def gravity(self) -> AnyVector:
        """g(q)."""
        return any_vector("g") if self.desired else self.gravity_at_goal + any_vector("dg")

    @property
    def gravity_at_goal(self) -> AnyVector:
        """g(q_d), for a constant q_d."""
        return any_vector("gd")

    @property
    def velocity(self) -> AnyVector:
        """q̇_d."""
        return any_vector("dqd")

    @property
    def acceleration(self) -> AnyVector:
        """q̈_d."""
        return any_vector("ddqd")

    def gains(self, names: str) -> list[Gain]:
        """Diagonal positive matrices, by names between spaces."""
        self._gains += names.split()
        return [_gain(name) for name in names.split()]

    def constants(self, names: str) -> list[Expr]:
        """Positive numbers, by names between spaces."""
        self._constants += names.split()
        return [var(name) for name in names.split()]

    def state(self, name: str, rate: AnyVector) -> AnyVector:
        """A vector of the controller's own, with its derivative."""
        self._states.append(State(name, rate.tree))
        return any_vector(name)

    def entrywise(self, name: str, of: AnyVector, bounded: bool = True) -> Function:
        """Any odd C¹ function by entries, positive for x > 0, of bounded slope, with an endless integral."""
        self._functions.append(Entrywise(name, of.tree[1], bounded, None))
        return Function(("vec", name), name)

    def function(
        self,
        name: str,
        of: AnyVector,
        value: Expr,
        potential: Expr,
        *,
        rho: object,
        secant: object,
        low: object,
        start: object = 1,
        gamma: object | None = None,
    ) -> Function:
        """One such function of x, with its potential and numbers that show it to be one.

        Args:
            name: the letter.
            of: the state.
            value: f, an expression in x; so is ``potential``, U.
            potential: U' = f, U(0) = 0.
            rho: at least |f'|.
            secant: at least |f(x)/x|.
            low: at most f(x) for x >= ``start``.
            start: a number.
            gamma: at least |f|; none for one that is not bounded.
        """
        numbers = [exact_value(number) for number in (rho, secant, low, start)]
        most = None if gamma is None else exact_value(gamma)
        member = Member(value.tree, diff(value, "x").tree, potential.tree, most, *numbers)
        self._functions.append(Entrywise(name, of.tree[1], gamma is not None, member))
        return Function(("vec", name), name)

    def under(self, torque: AnyVector) -> System:
        """The closed loop."""
        return System(
            torque.tree,
            tuple(self._gains),
            tuple(self._functions),
            tuple(self._states),
            tuple(self._constants),
            self.desired,
            self.friction,
            self.disturbed,
        )


def constant_goal(friction: str = "any", disturbed: bool = False) -> Goal:
    """A constant q_d: e = q_d − q, w = q̇.

    Args:
        friction: ``any``, for arms with or without it; ``positive``, where a proof needs it; ``none``.
        disturbed: whether an unknown torque of at most delta acts beside that of the controller.
    """
    return Goal(False, friction, disturbed)


def moving_goal(friction: str = "any", disturbed: bool = False) -> Goal:
    """q_d(t) with bounded q̇_d: e = q_d − q, w = q̇ − q̇_d."""
    return Goal(True, friction, disturbed)


def _gain(name: str) -> Gain:
    return Gain(diagonal(any_vector(name)).tree, name)


def strict(loop: System, V: Expr, above: Expr, rate: Expr, **more: object) -> Stable:
    """dV/dt <= −rate at every state: the origin is globally asymptotically stable."""
    return _argued("strict", loop, V, above, rate, **more)  # type: ignore[arg-type]


def lasalle(loop: System, V: Expr, above: Expr, rate: Expr, **more: object) -> Stable:
    """dV/dt <= −rate, and ``rest=(x, form)``: xᵀMẇ >= form where the states of rate stay 0."""
    return _argued("LaSalle", loop, V, above, rate, **more)  # type: ignore[arg-type]


def uniform(loop: System, V: Expr, above: Expr, below: Expr, rate: Expr, **more: object) -> Stable:
    """above <= V <= below, dV/dt <= −rate: globally uniformly asymptotically stable, also for q_d(t)."""
    return _argued("uniform", loop, V, above, rate, below=below, **more)  # type: ignore[arg-type]


def exponential(loop: System, V: Expr, above: Expr, below: Expr, rate: Expr, **more: object) -> Stable:
    """As uniform, with quadratic forms in the norms of the states: globally exponentially stable."""
    return _argued("exponential", loop, V, above, rate, below=below, **more)  # type: ignore[arg-type]


def input_to_state(
    loop: System, V: Expr, above: Expr, below: Expr, rate: Expr, gain: Expr, **more: object
) -> Stable:
    """As exponential, with dV/dt <= −rate + delta·gain under any torque of at most delta beside τ."""
    return _argued("ISS", loop, V, above, rate, below=below, gain=gain, **more)  # type: ignore[arg-type]


def _argued(
    theorem: str,
    loop: System,
    V: Expr,
    above: Expr,
    rate: Expr,
    *,
    below: Expr | None = None,
    gravity: bool = False,
    changes: Mapping[str, AnyVector] | None = None,
    rest: tuple[AnyVector, Expr] | None = None,
    where: Iterable[Relation] = (),
    small: bool = False,
    local: bool = False,
    gain: Expr | None = None,
) -> Stable:
    relations, forms = (
        tuple(where),
        [one for one in (above, rate, below, rest and rest[1], gain) if one is not None],
    )
    for one in (*(form.tree for form in forms), *(relation.gap for relation in relations)):
        _require_names(loop, variables(one), [*(changes or ())])
    return Stable(
        Argument(
            theorem,
            loop,
            V.tree,
            gravity,
            form_of(above),
            None if below is None else form_of(below),
            form_of(rate),
            tuple(Change(state, equals.tree) for state, equals in (changes or {}).items()),
            None if rest is None else Rest(rest[0].tree, form_of(rest[1])),
            relations,
            small,
            local,
            None if gain is None else form_of(gain),
        )
    )


def _require_names(loop: System, used: Iterable[str], changed: Iterable[str]) -> None:
    """Refuse names of numbers that nothing in the system has.

    Raises:
        ValueError: with the nearest ones that it has.
    """
    letters_of = [*loop.moving, *(f.name for f in loop.functions), *(f"y_{state}" for state in changed)]
    known = {*constants_of(loop), "s", *(f"norm_{name}" for name in letters_of)}
    known |= {f"sum_U{f.name}" for f in loop.functions}
    for name in sorted(set(used) - known):
        near = " or ".join(get_close_matches(name, known, n=2)) or ", ".join(sorted(known))
        raise ValueError(f"{name} is no constant or size of this system; did you mean {near}?")


def along(loop: System, V: Expr, equals: Expr, gravity: bool = False) -> EveryN:
    """dV/dt along the loop equals an expression in its letters, for every n.

    Args:
        loop: the closed loop.
        V: in its letters, without the energy of gravity.
        equals: in its letters too.
        gravity: whether U_g(q) − U_g(q_d) + g(q_d)ᵀe is added to V.
    """
    left: Tree = ("rate", V.tree)
    if gravity:
        left = ("add", left, ("dot", ("vec", "dg"), ("vec", "w")))
    used = letters(V.tree)
    rates = tuple((letter, value) for letter, value in loop.rates().items() if letter in used)
    return EveryN(left, equals.tree, ("M",), rates, (loop.given,))


def rate_at_most(stable: Stable) -> Statement:
    """The bound dV/dt <= −rate of a theorem as a claim of its own."""
    return stable.argument.rate_bound()


def at_arm(stable: Stable, robot: RobotModel, **gains: str) -> StableArm:
    """The same for one arm at its nominal numbers; a keyword gives a gain or a constant, as decimals.

    Numbers of M, C and gravity are chosen here and shown by the checker, as far as the conditions need them.

    Raises:
        ValueError: a number that the conditions need is not given.
    """
    bounds, system = ArmBounds(robot), stable.argument.system
    rows = {name: tuple(map(exact_value, gains[name].split())) for name in system.gains}
    energy: Monomials = tuple(to_terms(bounds.robot.potential))
    arm = Arm(bounds.mass, bounds.viscous, energy)
    known = {name: exact_value(value) for name, value in gains.items() if name not in rows}
    known |= {"mu": bounds.guessed_floor(), "beta": bounds.beta, "kc": bounds.kc}
    known["kg"] = above(sqrt(total(expr(size) ** 2 for size in _slopes(energy, robot.n))))
    for name, values in (rows | {"B": bounds.viscous}).items():
        squares = total(expr(value) ** 2 for value in values)
        known |= {
            f"{name}_min": min(values),
            f"{name}_max": max(values),
            f"{name}_norm": above(sqrt(squares)),
        }
    for f in system.functions:
        if f.member is not None:
            known |= {f"{f.name}_slope": f.member.rho, f"{f.name}_secant": f.member.secant}
            known |= {f"{f.name}_sector": 1 / f.member.secant}
            known[f"{f.name}_reach"] = above(sqrt(robot.n) * (f.member.gamma or 1))
    wanted = sorted(set().union(*(variables(one.gap) for one in stable.argument.where)))
    if lost := [name for name in wanted if name not in known]:
        raise ValueError(f"at_arm: the conditions need numbers for {', '.join(lost)}")
    return StableArm(stable.argument, arm, tuple(rows.items()), tuple((name, known[name]) for name in wanted))


def _slopes(energy: Monomials, n: int) -> list[Fraction]:
    """For each entry of ∂g/∂q a number above its size."""
    return [size_of(by_parameters(entry, n), ()) for entry in hessian(energy, n)]


def form_of(value: Expr) -> Form:
    """An expression that is quadratic in some sizes and linear in others, as a form.

    Raises:
        ValueError: it is of another degree in its sizes.
    """
    names = sorted(name for name in variables(value.tree) if name.startswith(("norm_", "sum_")))
    at_zero = dict.fromkeys(names, ZERO)
    slopes = {name: derivative(value.tree, name) for name in names}
    linear = [(name, _plain(substitute(slopes[name], at_zero))) for name in names]
    linear = [(name, tree) for name, tree in linear if tree != ZERO]
    sizes = tuple(name for name in names if name not in dict(linear))
    entries = tuple(
        _plain(("mul", ("num", "1/2"), substitute(derivative(slopes[a], b), at_zero)))
        for a, b in combinations_with_replacement(sizes, 2)
    )
    form = Form(sizes, entries, tuple(linear))
    if _plain(("add", value.tree, ("neg", form.tree))) != ZERO:
        raise ValueError(f"a form is quadratic in norms and linear in sums of potentials, not {value.tree!r}")
    return form


def _plain(tree: Tree) -> Tree:
    """A polynomial written out, term by term."""
    terms = [
        _product(str(c), {name: power for name, power in powers.items() if power})
        for c, powers in terms_of(tree)
    ]
    if not terms:
        return ZERO
    return terms[0] if len(terms) == 1 else ("add", *terms)


def _product(c: str, powers: Mapping[str, int]) -> Tree:
    factors: list[Tree] = [
        ("var", name) if power == 1 else ("pow", ("var", name), power) for name, power in powers.items()
    ]
    number = expr(c).tree
    if not factors:
        return number
    if c == "1":
        return factors[0] if len(factors) == 1 else ("mul", *factors)
    return ("neg", _product(c[1:], powers)) if c.startswith("-") else ("mul", number, *factors)
