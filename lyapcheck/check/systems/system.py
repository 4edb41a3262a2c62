"""An arm under a torque that is data, for every n: which letters there are and how they move.

    M(q)q̈ + C(q,q̇)q̇ + Bq̇ + g(q) = τ,   e = q_d − q,   w = q̇ − q̇_d,   ė = −w

M ẇ is derived from the torque. The letters: vectors e, w and further states; f, df and Uf for the values of
an entrywise function, its slopes and its potential; gains, whose diagonal matrices multiply; s = 1/(1 + ‖e‖)
and u = e/‖e‖. For a constant q_d, g(q) = gd + dg with gd = g(q_d). For q_d(t), dqd and ddqd are its
derivatives, C(q, q̇) = C + D with C = C(q, w), D = C(q, q̇_d), and what differs between q and q_d is
dM = M(q) − M(q_d), dD = C(q, q̇_d) − C(q_d, q̇_d) and dg = g(q) − g(q_d).

References: ``reyes2019family`` (1), (11), Properties 2.1 to 2.8.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, field
from fractions import Fraction

from lyapcheck.check.expressions.expression import Tree, variables
from lyapcheck.check.kinds.bound_every_n import terms_of
from lyapcheck.check.kinds.every_n import Given
from lyapcheck.check.letters import letters, require_sort
from lyapcheck.check.letters.words import Word, Words
from lyapcheck.check.refusal import require

E, W, DW, G, GD, DG, U = (("vec", name) for name in ("e", "w", "dw", "g", "gd", "dg", "u"))
DISTURBANCE: Tree = ("vec", "d")
DQD, DDQD = ("vec", "dqd"), ("vec", "ddqd")
M, C, D, DM, DD = (("mat", name) for name in ("M", "C", "D", "dM", "dD"))
S: Tree = ("var", "s")
B: Tree = ("diag", "B")
NOTHING: Tree = ("sum",)
OWN_NAMES = frozenset(
    {"e", "w", "dw", "g", "gd", "dg", "u", "x", "d", "dqd", "ddqd", "P", "M", "C", "D", "B", "s", "n", "R"}
) | {"eps0", "mu", "beta", "kc", "kg", "vd", "delta", "norm", "sum", "dM", "dD", "km", "kc2", "ad"}
"""What an author can name nothing else; norm_min is the size of a state min, and no gain norm has it."""
FRICTION = ("none", "any", "positive")


@dataclass(frozen=True)
class Member:
    """One function of the class, in x: its value, slope and potential, and numbers that show it to be one.

    |f| <= gamma, where it is bounded; |f'| <= rho; |f(x)| <= secant |x|; f(x) >= low for x >= start;
    f(x) >= steep x for 0 <= x <= start, where gravity is compared with it.
    """

    value: Tree
    slope: Tree
    potential: Tree
    gamma: Fraction | None
    rho: Fraction
    secant: Fraction
    low: Fraction
    start: Fraction
    steep: Fraction | None = field(default=None, metadata={"left_out": True})


@dataclass(frozen=True)
class Entrywise:
    """f(x_i) for each entry of a state: f odd, C¹, positive right of 0, with bounded slope, U → ∞.

    Without a ``member`` the conclusion is for every such function, bounded ones alone if ``bounded``. With a
    ``gain`` A it is f(a_i x_i), a function of the class for each joint, and all bounds and U are of that.
    ``level`` names the gain L beside f in the torque, where gravity is compared with L f joint by joint.
    """

    name: str
    of: str
    bounded: bool
    member: Member | None
    gain: str = field(default="", metadata={"left_out": True})
    level: str = field(default="", metadata={"left_out": True})


@dataclass(frozen=True)
class Increase:
    """d = f(A x + K y) − f(A x) by entries, or f(A x) − f(A x − K y) if ``back``; A x is what f is of.

    f increases strictly; so d_i has the sign of y_i, and is 0 where that is.
    """

    name: str
    function: str
    of: str
    gain: str
    back: bool


@dataclass(frozen=True)
class State:
    """A further vector with its derivative, such as an integral of the error."""

    name: str
    rate: Tree


@dataclass(frozen=True)
class Regressor:
    """An n × columns matrix that a controller knows: any continuous function of the states.

    If ``bounded``, of time too, and bounded wherever the states are.
    """

    name: str
    columns: str
    bounded: bool


@dataclass(frozen=True)
class System:
    """The arm (1) under a torque.

    Attributes:
        torque: τ, a vector in the letters.
        gains: names of diagonal positive matrices.
        functions: entrywise functions of states.
        states: what the controller has of its own.
        constants: names of positive numbers of the author.
        desired: whether q_d depends on time; it is constant otherwise.
        friction: what the arm has: ``positive`` for a diagonal positive B, ``any`` for one that may vanish,
            ``none`` for B = 0.
        disturbed: whether an unknown torque d, ‖d‖ <= delta, acts beside τ.
        regressors: matrices of which nothing more is known.
        sizes: of gains and states that are not of size n, each with the name of its size.
        increases: of functions, from one argument to another.
    """

    torque: Tree
    gains: tuple[str, ...]
    functions: tuple[Entrywise, ...]
    states: tuple[State, ...]
    constants: tuple[str, ...]
    desired: bool
    friction: str
    disturbed: bool = False
    regressors: tuple[Regressor, ...] = field(default=(), metadata={"left_out": True})
    sizes: tuple[tuple[str, str], ...] = field(default=(), metadata={"left_out": True})
    increases: tuple[Increase, ...] = field(default=(), metadata={"left_out": True})

    def require_well_formed(self) -> None:
        """Refuse names given twice, letters that nothing is known of, and functions of what is no state."""
        names = [*self.gains, *self.constants, *(state.name for state in self.states)]
        names += [f"{prefix}{f.name}" for f in self.functions for prefix in ("", "d", "U")]
        names += [one.name for one in self.regressors] + [one.name for one in self.increases]
        names += [name for _, name in self.probes]
        of_own = dict(self.sizes)
        own = {*of_own.values(), *(one.columns for one in self.regressors)} - {"n"}
        names += sorted(own)
        for name in names:
            require(names.count(name) == 1 and name not in OWN_NAMES, "name", name, "is taken")
            require("_" not in name, "name", name, "must have no underscore: sizes and bounds have one")
            require_sort(("vec", name), "vector")  # also one that no expression has: the text shows it
        require(self.friction in FRICTION, "friction", self.friction, f"must be one of {', '.join(FRICTION)}")
        for f in self.functions:
            require(f.of in self.moving, "function", f.name, f"is of {f.of!r}, which is no state")
            fits = f.member is None or f.bounded == (f.member.gamma is not None)
            require(fits, "function", f.name, "is said to be bounded, or not, against its numbers")
            require(not f.level or f.of == "e", "level", f.level, "is for a function of e")
            self._require_gains(f.name, f.of, [name for name in (f.gain, f.level) if name])
        for one in self.increases:
            require(one.of in self.moving, "increase", one.name, f"is by {one.of!r}, which is no state")
            base = next((f.of for f in self.functions if f.name == one.function), one.of)
            require(base != one.of, "increase", one.name, "must be of a function of another state")
            require(self.size(base) == self.size(one.of), "increase", one.name, "is of two sizes")
            self._require_gains(one.name, one.of, [one.gain])
        sized = {*self.gains, *(state.name for state in self.states)}
        fits = len(of_own) == len(self.sizes) and of_own.keys() <= sized and "n" not in of_own.values()
        require(fits, "sizes", ", ".join(of_own), "must be of gains and states, once each, and not n")
        for tree, size in ((self.torque, "n"), *((one.rate, self.size(one.name)) for one in self.states)):
            require_sort(tree, "vector")
            self.require_letters(tree, self.known, "the torque and the states")
            require(self.shape(tree) == (size,), "size", size, "must be that of the torque or the rate")

    def _require_gains(self, name: str, of: str, gains: Collection[str]) -> None:
        """Refuse a gain that the system lacks, or of another size than the state that it multiplies."""
        for gain in gains:
            fits = gain in self.gains and self.size(gain) == self.size(of)
            require(fits, "function", name, f"has {gain!r}, which is no gain of its size")

    def require_letters(self, tree: Tree, known: Collection[Tree], where: str) -> None:
        """Refuse a letter that is not known."""
        for letter in sorted(letters(tree)):
            require(letter in known, "letter", letter[1], f"has no meaning in {where} of this system")

    def size(self, name: str) -> str:
        """That of a vector: of a function, a potential or a changed letter that of its state."""
        owner = {name: f.of for f in self.functions for name in (f.name, f"d{f.name}", f"U{f.name}")}
        owner |= {one.name: one.of for one in self.increases}
        name = name.removeprefix("y_")
        return dict(self.sizes).get(owner.get(name, name), "n")

    def shape(self, tree: Tree) -> tuple[str, ...]:
        """Rows, and columns if it is a matrix; none of a number. Refused where parts do not fit together.

        Soundness: what is proved for square matrices and all n holds for sizes that fit. With zeros put in up
        to the largest size, products, sums, norms, forms and functions that are 0 at 0 stay as they are.
        """
        kind, *rest = tree
        if kind in ("vec", "diag"):
            return (self.size(rest[0]),) * (1 if kind == "vec" else 2)
        if kind == "mat":
            return ("n", {one.name: one.columns for one in self.regressors}.get(rest[0], "n"))
        parts = [self.shape(part) for part in rest if isinstance(part, tuple)]
        fits = parts[0][1:] == parts[1] if kind == "apply" else kind == "scale" or len(set(parts)) <= 1
        require(fits, "size", kind, "is of parts whose sizes do not fit")
        if kind == "scale":
            return parts[1]
        whole = {"transpose": slice(None, None, -1), "apply": slice(1), "sum": slice(None)}
        return (*parts, ("n",))[0][whole[kind]] if kind in whole else ()

    @property
    def moving(self) -> tuple[str, ...]:
        """The names of the states."""
        return ("e", "w", *(state.name for state in self.states))

    @property
    def by_entries(self) -> tuple[Entrywise | Increase, ...]:
        """Functions of states, and increases by states."""
        return (*self.functions, *self.increases)

    @property
    def diagonal(self) -> tuple[str, ...]:
        """The names of the diagonal positive matrices."""
        return self.gains if self.friction == "none" else (*self.gains, "B")

    @property
    def known(self) -> frozenset[Tree]:
        """The letters that a controller may have."""
        vectors = {*self.moving, *self.diagonal, *(f.name for f in self.by_entries)}
        vectors |= {"g", "dg", "dqd", "ddqd"} if self.desired else {"gd", "dg"}
        matrices = {"M", "C", "D", "dM", "dD"} if self.desired else {"M", "C"}
        matrices |= {one.name for one in self.regressors}
        result = {("vec", name) for name in vectors} | {("mat", name) for name in matrices} | {S}
        return frozenset(result | {("var", name) for name in self.constants})

    @property
    def probes(self) -> frozenset[Tree]:
        """A vector for each function with a level, to multiply M ẇ with at rest; see ``facts``."""
        return frozenset({("vec", f"T{f.name}") for f in self.functions if f.level})

    @property
    def energies(self) -> frozenset[Tree]:
        """The letters that V may have: those that have a derivative, and no time in them."""
        vectors = {*self.moving, *self.diagonal} | {
            name for f in self.functions if f.of != "w" for name in (f.name, f"U{f.name}")
        }
        result = {("vec", name) for name in vectors} | {M, S, ("var", "eps0")}
        return frozenset(result | {("var", name) for name in self.constants})

    @property
    def force(self) -> Tree:
        """What M ẇ equals: τ less the left side of (1) at ẇ = 0."""
        speed: Tree = W
        needed: list[Tree] = []
        if self.desired:
            speed = ("sum", DQD, W)
            needed.append(("apply", M, DDQD))
        needed += [("apply", self.coriolis, speed), self.gravity]
        needed += [] if self.friction == "none" else [("apply", B, speed)]
        acting = (DISTURBANCE,) if self.disturbed else ()
        return ("sum", self.torque, *acting, *(minus(part) for part in needed))

    def motion(self, state: str) -> Tree:
        """The derivative of a state, of w times M."""
        return {"e": minus(W), "w": self.force, **{one.name: one.rate for one in self.states}}[state]

    @property
    def coriolis(self) -> Tree:
        """C(q, q̇)."""
        return ("sum", C, D) if self.desired else C

    @property
    def gravity(self) -> Tree:
        """g(q)."""
        return G if self.desired else ("sum", GD, DG)

    @property
    def given(self) -> Given:
        """M ẇ = force."""
        return Given("M", "dw", self.force)

    @property
    def acceleration(self) -> Tree:
        """ẇ: b if its force is M b, as M is invertible; else a letter of its own."""
        words, parts = Words(("M",), {}, {}), list[Tree]()
        for word, factor in words.expand(self.force).items():
            if terms_of(factor):
                if word[0] != M or variables(factor) & words.seen.keys():
                    return DW
                parts.append(("scale", factor, vector_of(word[1:])))
        return ("sum", *parts)

    def rates(self) -> dict[Tree, Tree]:
        """The derivative of each letter that may stand in V.

        s = 1/(1 + ‖e‖) has ṡ = s² uᵀw; where e = 0 it has none, see `check.systems` on why that does no harm.
        """
        moved = {"e": minus(W), "w": self.acceleration} | {state.name: state.rate for state in self.states}
        result = {("vec", name): rate for name, rate in moved.items()}
        result |= {("vec", name): NOTHING for name in self.diagonal}
        result |= {("var", name): ("num", "0") for name in (*self.constants, "eps0")}
        result[M] = ("sum", self.coriolis, ("transpose", self.coriolis))
        result[S] = ("mul", S, S, ("dot", U, W))
        for f in self.functions:
            if f.of != "w":
                result[("vec", f.name)] = ("apply", ("diag", f"d{f.name}"), moved[f.of])
                result[("vec", f"U{f.name}")] = ("apply", ("diag", f.name), moved[f.of])
        return result

    def at_zero(self, tree: Tree, states: Collection[str]) -> Tree:
        """An expression where some states are 0: functions of them are, C with w, differences with e."""
        gone = {("vec", name) for name in states}
        gone |= {("vec", n) for f in self.functions if f.of in states for n in (f.name, f"U{f.name}")}
        gone |= {("vec", one.name) for one in self.increases if one.of in states}
        gone |= ({C} if "w" in states else set()) | ({DG, DM, DD} if "e" in states else set())
        return replaced(tree, dict.fromkeys(gone, NOTHING))


def vector_of(word: Word) -> Tree:
    """A word that ends in a vector, as an expression."""
    *middle, last = word
    value: Tree = last
    for kind, name in reversed(middle):
        matrix: Tree = ("transpose", ("mat", name)) if kind == "transposed" else (kind, name)
        value = ("apply", matrix, value)
    return value


def minus(x: Tree) -> Tree:
    """The opposite of a vector or matrix."""
    return ("scale", ("num", "-1"), x)


def replaced(tree: Tree, by: dict[Tree, Tree]) -> Tree:
    """An expression with others for some letters; where a vector becomes 0, its diagonal matrix does too."""
    if tree[0] == "diag":
        new = by.get(("vec", tree[1]))
        require(new in (None, NOTHING), "diag", tree[1], "stands for another vector here")
        return tree if new is None else NOTHING
    if tree in by:
        return by[tree]
    return tuple(replaced(part, by) if isinstance(part, tuple) else part for part in tree)
