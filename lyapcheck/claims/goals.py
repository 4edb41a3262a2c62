"""The letters of an arm under any torque: the goal, gains, functions, states and constants.

What they stand for, how they move and how large they are is the checker's: see ``check.systems``.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from lyapcheck.check.expressions.text import expression_text
from lyapcheck.check.kinds.bound_every_n import terms_of
from lyapcheck.check.letters.words import Word, Words
from lyapcheck.check.systems.system import OWN_NAMES, Entrywise, Increase, Member, Regressor, State, System
from lyapcheck.claims.expressions import Expr, diff, exact_value, var
from lyapcheck.claims.letters import AnyMatrix, AnyVector, any_matrix, any_vector, diagonal


def number_of(form: str, says: str) -> cached_property[Expr]:
    """A number that is called after the letter that it is about, such as ``Kp.min``; and what it is."""

    def number(letter: Any) -> Expr:
        return var(form.format(letter.name))

    number.__doc__ = says
    return cached_property(number)


@dataclass(frozen=True, eq=False)
class Gain(AnyMatrix):
    """A diagonal positive matrix: ``K.min``, ``K.max`` are its eigenvalues, ``K @ U`` … its products."""

    name: str = ""

    @property
    def entries(self) -> AnyVector:
        """Its diagonal."""
        return any_vector(self.name)

    min = number_of("{}_min", "The least eigenvalue.")
    max = number_of("{}_max", "The largest eigenvalue.")
    norm = number_of("{}_norm", "The norm of its diagonal.")


@dataclass(frozen=True, eq=False)
class Function(AnyVector):
    """f(x) for each entry of a state, with its size, potential and constants."""

    name: str = ""

    @property
    def U(self) -> AnyVector:
        """Its potential by entries: U' = f, U(0) = 0."""
        return any_vector(f"U{self.name}")

    sum_U = number_of("sum_U{}", "Σ U(x_i).")
    reach = number_of("{}_reach", "At least ‖f(x)‖.")
    slope = number_of("{}_slope", "At least |f'|.")
    secant = number_of("{}_secant", "At least |f(x)/x|.")
    share = number_of("{}_share", "At least ‖f(e)‖/(1 + ‖e‖), for a function of e.")
    sector = number_of("{}_sector", "1/secant: x f(x) is at least this times f(x)².")
    kg = number_of("{}_kg", "‖g(q) − g(q_d)‖ ‖e‖ is at most this times eᵀf, for a function of e.")
    load = number_of(
        "{}_load",
        "min(kg |x|, k_i) is at most this times l_i |f(x)|, k_i the most that g_i changes, for a level L.",
    )
    sum_LU = number_of("sum_LU{}", "Σ l_i U(e_i), for a level L.")

    @property
    def probe(self) -> AnyVector:
        """A vector T with Tᵀ L f = sum_T and |Tᵀ(g(q) − g(q_d))| <= load · sum_T, for a level L."""
        return any_vector(f"T{self.name}")

    sum_T = number_of("sum_T{}", "Tᵀ L f, positive unless e = 0.")


@dataclass(frozen=True, eq=False)
class Increment(AnyVector):
    """The letter d for what a function of one state gains or loses by another: see ``Goal.increase``."""

    name: str = ""
    value: AnyVector = field(default_factory=lambda: any_vector("d"))
    """The function there: f + d, or f − d."""

    reach = number_of("{}_reach", "At least ‖d‖.")
    secant = number_of("{}_secant", "At least |d_i/y_i|.")
    sector = number_of("{}_sector", "1/secant: y_i d_i is at least this times d_i².")


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
    _increases: list[Increase] = field(default_factory=list)
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
    def C_desired(self) -> AnyMatrix:
        """C(q, q̇_d), for a goal that moves."""
        return any_matrix("D")

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

    def entrywise(
        self, name: str, of: AnyVector, bounded: bool = True, level: AnyMatrix | None = None
    ) -> Function:
        """Any odd C¹ function by entries, positive for x > 0, of bounded slope, with an endless integral.

        Args:
            name: the letter.
            of: the state, or a gain times a state.
            bounded: False for functions that may have no bound.
            level: the gain beside it in the torque, for ``load``, ``sum_LU``, ``probe`` and ``sum_T``.
        """
        gain, state = self._argument(name, of)
        own = self._level(name, state, level)
        self._functions += [Entrywise(one, state, bounded, None, gain, own) for one in self._free(name)]
        return Function(("vec", name), name)

    def increase(self, name: str, function: Function, to: AnyVector) -> Increment:
        """d for a strictly increasing f at another argument: f(A x ± K y) = f(A x) ± d, ``d.value``.

        Args:
            name: the letter.
            function: f(A x).
            to: A x + K y, or A x − K y, with a gain K and another state y.

        Raises:
            ValueError: ``to`` is something else.
        """
        base = next((f for f in self._functions if f.name == function.name), None)
        parts = self._words(to) if base is not None else {}
        start = () if base is None else ((("diag", base.gain),) * bool(base.gain) + (("vec", base.of),))
        sign = parts.pop(start, 0)
        change = next(iter(parts), ())
        plain = len(change) == 2 and change[0][1] in self._gains and change[1][1] in self._moving
        if base is None or sign != 1 or len(parts) != 1 or not plain or abs(parts[change]) != 1:
            raise ValueError(
                f"{name}: an increase is of a function of this goal, by a gain times another state: "
                "for f = f(K @ e) write increase(name, f, K @ e - D @ w)"
            )
        if base.of == change[1][1]:
            raise ValueError(f"{name}: the function is of {base.of} itself; give it both gains as one")
        back, base_letter = parts[change] < 0, any_vector(base.name)
        made = [Increase(one, base.name, change[1][1], change[0][1], back) for one in self._free(name)]
        self._increases += made
        own = any_vector(name)
        return Increment(own.tree, name, base_letter - own if back else base_letter + own)

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
        steep: object | None = None,
        level: AnyMatrix | None = None,
    ) -> Function:
        """One such function of x, with its potential and numbers that show it to be one.

        Args:
            name: the letter.
            of: the state, or a gain times a state. The numbers are of f(x) without that gain.
            value: f, an expression in x; so is ``potential``, U.
            potential: U' = f, U(0) = 0.
            rho: at least |f'|.
            secant: at least |f(x)/x|.
            low: at most f(x) for x >= ``start``.
            start: a number.
            gamma: at least |f|; none for one that is not bounded.
            steep: at most f(x)/x for 0 <= x <= ``start``, for ``load`` and ``kg`` of one arm.
            level: as in :meth:`entrywise`.
        """
        slopes = exact_value(rho), exact_value(secant)
        far = exact_value(low), exact_value(start)
        most = None if gamma is None else exact_value(gamma)
        slope = None if steep is None else exact_value(steep)
        member = Member(value.tree, diff(value, "x").tree, potential.tree, most, *slopes, *far, slope)
        gain, state = self._argument(name, of)
        own = self._level(name, state, level)
        self._functions += [
            Entrywise(one, state, gamma is not None, member, gain, own) for one in self._free(name)
        ]
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
            tuple(self._increases),
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
            functions += [f"T{f.name}" for f in self._functions if f.level]
            functions += [one.name for one in self._increases]
            own = [*self._gains, *self._constants, *(state.name for state in self._states), *functions]
            own += [name for one in self._regressors for name in (one.name, one.columns) if name != "n"]
            own += dict(self._sizes).values()
            if name in OWN_NAMES or name in own or names.split().count(name) > 1:
                taken = ", ".join(sorted({*OWN_NAMES, *own}, key=lambda one: (one.casefold(), one)))
                raise ValueError(f"{name} is taken; take a name that is none of {taken}")
        return names.split()

    @property
    def _moving(self) -> list[str]:
        return ["e", "w", *(state.name for state in self._states)]

    def _words(self, of: object) -> dict[Word, int]:
        """What a combination is made of, with whole numbers before it; nothing if it is none."""
        if not isinstance(of, AnyVector):
            return {}
        numbers = {word: terms_of(factor) for word, factor in Words((), {}, {}).expand(of.tree).items()}
        plain = all(len(terms) == 1 and not terms[0][1] and terms[0][0].q == 1 for terms in numbers.values())
        return {word: int(terms[0][0].p) for word, terms in numbers.items()} if plain else {}

    def _argument(self, name: str, of: object) -> tuple[str, str]:
        """The gain and the state that a function is of; no gain for the state alone.

        Raises:
            ValueError: it is of a combination, or of what is no state.
        """
        parts = self._words(of)
        word = next(iter(parts), ())
        if len(parts) == 1 and parts[word] == 1 and word[-1][1] in self._moving:
            if len(word) == 1:
                return "", word[0][1]
            if len(word) == 2 and word[0][1] in self._gains:
                return word[0][1], word[1][1]
        shown = expression_text(of.tree) if isinstance(of, AnyVector) else repr(of)
        raise ValueError(
            f"{name}: a function by entries is of one state ({', '.join(self._moving)}) or a gain times one, "
            f"not of {shown}; write f = f(K @ e), then goal.increase(name, f, K @ e - D @ w), or give a "
            "combination a state of its own, as in goal.state(name, its derivative)"
        )

    def _level(self, name: str, state: str, level: AnyMatrix | None) -> str:
        """The name of the gain that gravity is compared with.

        Raises:
            ValueError: it is no gain, or the function is not of e.
        """
        if level is None:
            return ""
        named = level.tree[1] if isinstance(level, AnyMatrix) and level.tree[0] == "diag" else None
        if named not in self._gains or state != "e":
            raise ValueError(f"{name}: a level is a gain of this goal, beside a function of e; give it one")
        return str(named)


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
