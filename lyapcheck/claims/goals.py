"""The letters of an arm under any torque: the goal, gains, functions, states and constants.

What they stand for, how they move and how large they are is the checker's: see ``check.systems``.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from lyapcheck.check.expressions.text import expression_text
from lyapcheck.check.systems.system import OWN_NAMES, Entrywise, Member, Regressor, State, System
from lyapcheck.claims.expressions import Expr, diff, exact_value, var
from lyapcheck.claims.letters import AnyMatrix, AnyVector, any_matrix, any_vector, diagonal


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
    def share(self) -> Expr:
        """At least ‖f(e)‖/(1 + ‖e‖), for a function of e."""
        return var(f"{self.name}_share")

    @property
    def sector(self) -> Expr:
        """1/secant: x f(x) is at least this times f(x)²."""
        return var(f"{self.name}_sector")


def norm(x: AnyVector) -> Expr:
    """The size of a letter, as forms have it.

    Raises:
        ValueError: it is a sum or product. Only states and functions have sizes.
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
    _regressors: list[Regressor] = field(default_factory=list)
    _sizes: list[tuple[str, str]] = field(default_factory=list)
    _closed: bool = False

    e, w = any_vector("e"), any_vector("w")
    """q_d − q, and q̇ − q̇_d."""
    M = any_matrix("M")
    mu, beta, kc, kg, vd, R, eps0, s = map(var, ("mu", "beta", "kc", "kg", "vd", "R", "eps0", "s"))
    """λmin(M), ‖M‖, the Coriolis bound, ‖∂g/∂q‖, ‖q̇_d‖, the radius of a local bound; ε = ε₀ s."""
    km, kc2, ad = map(var, ("km", "kc2", "ad"))
    """‖M(q) − M(q_d)‖ ≤ km ‖e‖, ‖C(q, x) − C(q_d, x)‖ ≤ kc2 ‖x‖ ‖e‖, ‖q̈_d‖ ≤ ad, for a goal that moves."""

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
        """g(q_d)."""
        return self.gravity - any_vector("dg") if self.desired else any_vector("gd")

    @property
    def M_at_goal(self) -> AnyMatrix:
        """M(q_d), for a goal that moves."""
        return self.M - any_matrix("dM")

    @property
    def C_at_goal(self) -> AnyMatrix:
        """C(q_d, q̇_d), for a goal that moves."""
        return any_matrix("D") - any_matrix("dD")

    @property
    def velocity(self) -> AnyVector:
        """q̇_d."""
        return any_vector("dqd")

    @property
    def acceleration(self) -> AnyVector:
        """q̈_d."""
        return any_vector("ddqd")

    def gains(self, names: str, size: str = "n") -> list[Gain]:
        """Diagonal positive matrices, by names between spaces; ``size`` names another size than n."""
        self._gains += self._free(names)
        self._sizes += [(name, size) for name in names.split() if size != "n"]
        return [_gain(name) for name in names.split()]

    def constants(self, names: str) -> list[Expr]:
        """Positive numbers, by names between spaces."""
        self._constants += self._free(names)
        return [var(name) for name in names.split()]

    def known(self, name: str, columns: str, bounded: bool = False) -> AnyMatrix:
        """A regressor: any continuous n × ``columns`` matrix of the states.

        Args:
            name: the letter.
            columns: the name of a size, such as the number of unknown parameters.
            bounded: True lets it depend on time too. It is bounded where the states are.
        """
        self._regressors += [Regressor(one, columns, bounded) for one in self._free(name)]
        return any_matrix(name)

    def state(self, name: str, rate: AnyVector, size: str = "n") -> AnyVector:
        """A vector of the controller's own, with its derivative; ``size`` names another size than n."""
        if not isinstance(rate, AnyVector):
            raise TypeError(f"{name}: the derivative of a state is a vector, as in α * e; this is none")
        self._states += [State(one, rate.tree) for one in self._free(name)]
        self._sizes += [(name, size)] if size != "n" else []
        return any_vector(name)

    def entrywise(self, name: str, of: AnyVector, bounded: bool = True) -> Function:
        """Any odd C¹ function by entries, positive for x > 0, of bounded slope, with an endless integral."""
        self._functions += [
            Entrywise(one, self._state_of(name, of), bounded, None) for one in self._free(name)
        ]
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
        state, bounded = self._state_of(name, of), gamma is not None
        self._functions += [Entrywise(one, state, bounded, member) for one in self._free(name)]
        return Function(("vec", name), name)

    def under(self, torque: AnyVector) -> System:
        """The closed loop; all letters of the goal are named before it."""
        if not isinstance(torque, AnyVector):
            raise TypeError("under: a torque is a vector, as in Kp @ e + goal.gravity; this is none")
        self._closed = True
        return System(
            torque.tree,
            tuple(self._gains),
            tuple(self._functions),
            tuple(self._states),
            tuple(self._constants),
            self.desired,
            self.friction,
            self.disturbed,
            tuple(self._regressors),
            tuple(self._sizes),
        )

    def _free(self, names: str) -> list[str]:
        """The names, if nothing has them yet.

        Raises:
            ValueError: one is taken, or the loop is closed.
        """
        for name in names.split():
            if self._closed:
                raise ValueError(f"{name} is named after under(...), whose loop lacks it; name it before")
            if "_" in name:
                raise ValueError(f"{name}: sizes and bounds have an underscore; take a name without one")
            functions = [f"{kind}{f.name}" for f in self._functions for kind in ("", "d", "U")]
            own = [*self._gains, *self._constants, *(state.name for state in self._states), *functions]
            own += [name for one in self._regressors for name in (one.name, one.columns) if name != "n"]
            own += dict(self._sizes).values()
            if name in OWN_NAMES or name in own or names.split().count(name) > 1:
                taken = ", ".join(sorted({*OWN_NAMES, *own}, key=lambda one: (one.casefold(), one)))
                raise ValueError(f"{name} is taken; take a name that is none of {taken}")
        return names.split()

    def _state_of(self, name: str, of: AnyVector) -> str:
        """The name of the one state that a function is of.

        Raises:
            ValueError: it is of a combination, or of what is no state.
        """
        states = ["e", "w", *(state.name for state in self._states)]
        if isinstance(of, AnyVector) and of.tree[0] == "vec" and of.tree[1] in states:
            return str(of.tree[1])
        shown = expression_text(of.tree) if isinstance(of, AnyVector) else repr(of)
        raise ValueError(
            f"{name}: a function by entries is of one state ({', '.join(states)}), not of {shown}; "
            "give a combination a state of its own, as in goal.state(name, its derivative)"
        )


def constant_goal(friction: str = "any", disturbed: bool = False) -> Goal:
    """A constant q_d: e = q_d − q, w = q̇.

    Args:
        friction: ``any`` for arms with or without it, ``positive`` if the proof needs it, or ``none``.
        disturbed: True adds an unknown torque of at most delta.
    """
    return Goal(False, friction, disturbed)


def moving_goal(friction: str = "any", disturbed: bool = False) -> Goal:
    """q_d(t) with bounded q̇_d: e = q_d − q, w = q̇ − q̇_d."""
    return Goal(True, friction, disturbed)


def _gain(name: str) -> Gain:
    return Gain(diagonal(any_vector(name)).tree, name)
