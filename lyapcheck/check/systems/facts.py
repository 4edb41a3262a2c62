"""How large the letters of a system are, from the properties of the arm, of gains and of functions.

For a letter x, norm_x is its size. M has mu <= λmin(M), ‖M‖ <= beta; ‖C(q,x)y‖ <= kc ‖x‖ ‖y‖, ‖q̇_d‖ <= vd and
‖q̈_d‖ <= ad; ‖M(q) − M(q_d)‖ <= km ‖e‖ and ‖C(q,x) − C(q_d,x)‖ <= kc2 ‖x‖ ‖e‖;
a gain K has K_min, K_max and the norm K_norm of its diagonal; ‖∂g/∂q‖ <= kg, so ‖dg‖ <= kg ‖e‖, and the
energy of gravity U_g(q) − U_g(q_d) + g(q_d)ᵀe is eᵀP with ‖P‖ <= ½kg ‖e‖ (Taylor). A function f has
|f(x)| <= f_secant |x|, |f'| <= f_slope, ‖f(x)‖ <= f_reach if it is bounded, and x f(x) >= f_sector f(x)² with
f_sector = 1/f_secant; of e, ‖f(e)‖ <= f_share (1 + ‖e‖), as f_secant does and smaller numbers may;
sum_Uf is Σ U(x_i), which is above the norm of the vector, as no U(x_i) is negative.

Of a function of e, f_kg is a number with ‖dg‖ ‖e‖ <= f_kg eᵀf(e) for all e and q_d. So ‖dg‖ <= f_kg ‖f(e)‖.
Along the ray to e, u = e/‖e‖, the energy of gravity changes by |uᵀdg| <= ‖dg‖ <= f_kg uᵀf, the slope of
f_kg Σ U: it is at most f_kg sum_Uf. Where f(x) >= min(steep x, low) for x >= 0, |u_i| <= 1 gives
eᵀf(e) >= ‖e‖ min(steep ‖e‖, low); and ‖dg‖ <= min(kg ‖e‖, k) with k >= ‖g(q) − g(p)‖. So the larger of
kg/steep and k/low is such a number. P is along e, so that ‖e‖ ‖P‖ is the size of the energy of gravity.

With a level L, f_load is a number with min(kg x, k_i) <= f_load l_i f(x) for x >= 0 and each joint i, where
|g_i(q) − g_i(p)| <= k_i. Then

- the energy of gravity is at most f_load sum_LUf, sum_LUf = Σ l_i U(e_i). If kg = 0, it is 0. Otherwise take
  c > f_load. W = c Σ l_i U(e_i) plus or minus this energy, which is at most Σ k_i |e_i|, grows without end:
  far away its slope c l_i f is above k_i by a constant, or k_i = 0 and U grows. So W has a least value, where
  c L f = ±dg. Suppose e ≠ 0 there. Where e_i ≠ 0, |dg_i| = c l_i |f| exceeds min(kg |e_i|, k_i), but not k_i;
  so it exceeds kg |e_i|, and elsewhere both are 0: against ‖dg‖ <= kg ‖e‖. Hence e = 0, and W >= 0 for all c;
- there is a vector Tf, ‖Tf‖ <= 1, with Tfᵀ L f = sum_Tf, positive for e ≠ 0, and |Tfᵀ dg| <= f_load sum_Tf.
  If |dg_i| <= f_load l_i |f(e_i)| for some i with e_i ≠ 0, it is the unit vector of i with the sign of e_i.
  Otherwise f_load l_i |f| >= kg |e_i| for all i as above, so ‖dg‖ <= f_load ‖L f‖, and Tf is along L f.
  This is of the number Tfᵀ dg alone, not of ‖Tf‖ ‖dg‖, nor of Tfᵀ A dg.

An increase d of f by y has |d| <= d_secant |y|, y d >= d_sector d² and, if f is bounded, ‖d‖ <= d_reach.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from fractions import Fraction
from itertools import chain

from lyapcheck.check.expressions.expression import Tree, derivative, substitute, variables
from lyapcheck.check.kinds.bound_every_n import BoundEveryN, terms_of
from lyapcheck.check.kinds.for_all import ForAll
from lyapcheck.check.kinds.identity import Identity
from lyapcheck.check.kinds.norm_bound import NormBound
from lyapcheck.check.letters.words import Word, Words
from lyapcheck.check.refusal import require
from lyapcheck.check.statement import Relation, Statement, Variable
from lyapcheck.check.systems.system import (
    DD,
    DDQD,
    DG,
    DISTURBANCE,
    DM,
    DQD,
    C,
    D,
    E,
    M,
    Member,
    S,
    System,
    U,
    vector_of,
)

ONE: Tree = ("num", "1")
BOUNDS = ("reach", "slope", "secant", "sector", "share")
"""The constants of a function."""
COMPARED = re.compile(".*_(kg|load)").fullmatch
"""Constants that compare gravity with a function; a bound of which none is asked does without."""
OPPOSITE: Tree = ("vec", "opposite_dg")
"""−dg, so that an upper bound of Tfᵀ dg is a lower one."""
P: Tree = ("vec", "P")
"""The energy of gravity is eᵀP."""


def size(name: str) -> Tree:
    """The size of a vector letter."""
    return ("var", f"norm_{name}")


def product(*factors: Tree) -> Tree:
    """The product of some numbers."""
    return ("mul", ONE, *factors)


def constant(name: str) -> Tree:
    """A constant by name."""
    return ("var", name)


def norms(system: System, changed: Iterable[str], local: bool) -> Iterator[tuple[tuple[Tree, ...], Tree]]:
    """What is known of the norms of letters; ``changed`` are new letters, ``local`` is for ‖e‖ <= R."""
    kc = constant("kc")
    for name in (*system.moving, *changed):
        yield (("vec", name),), size(name)
    yield (S, E), ONE
    yield (S,), ONE
    yield (U,), ONE
    if local:
        yield (E,), constant("R")
    for f in system.functions:
        value, secant = ("vec", f.name), constant(f"{f.name}_secant")
        yield (value,), size(f.name)
        yield (value,), product(secant, size(f.of))
        if f.bounded:
            yield (value,), constant(f"{f.name}_reach")
        if f.of == "e":
            yield (S, value), constant(f"{f.name}_share")
        yield (("diag", f"d{f.name}"),), constant(f"{f.name}_slope")
        yield (("vec", f"U{f.name}"),), constant(f"sum_U{f.name}")
    for name in system.diagonal:
        yield (("diag", name),), constant(f"{name}_max")
        yield (("vec", name),), constant(f"{name}_norm")
    yield (M,), constant("beta")
    yield (C,), product(kc, size("w"))
    yield (D,), product(kc, constant("vd"))
    yield (DQD,), constant("vd")
    yield (DDQD,), constant("ad")
    yield (DM,), product(constant("km"), size("e"))
    yield (DD,), product(constant("kc2"), constant("vd"), size("e"))
    yield (DISTURBANCE,), constant("delta")
    yield (DG,), product(constant("kg"), size("e"))
    yield (P,), product(("num", "1/2"), constant("kg"), size("e"))
    for one in system.increases:
        own: Tree = ("vec", one.name)
        yield (own,), size(one.name)
        yield (own,), product(constant(f"{one.name}_secant"), size(one.of))
        if any(f.bounded for f in system.functions if f.name == one.function):
            yield (own,), constant(f"{one.name}_reach")
    for f in system.functions:
        if f.of == "e":
            yield (DG,), product(constant(f"{f.name}_kg"), size(f.name))
            yield (E, P), product(constant(f"{f.name}_kg"), constant(f"sum_U{f.name}"))
        if f.level:
            probe: Tree = ("vec", f"T{f.name}")
            yield (E, P), product(constant(f"{f.name}_load"), constant(f"sum_LU{f.name}"))
            yield (probe,), ONE
    yield (OPPOSITE,), product(constant("kg"), size("e"))


def least(system: System, words: Words, changed: Iterable[str]) -> Iterator[tuple[Tree, Tree]]:
    """Lower bounds of the words that have one: xᵀK…x, fᵀK…x for f of x, xᵀMx, kᵀU, and TᵀLf by a level."""
    sized = {*system.moving, *changed, *(f.name for f in system.by_entries)}
    for word in sorted(chain.from_iterable(words.seen.values())):
        result = _least_of(system, word, sized)
        if result is not None:
            yield _number(word), result
        names, plain = sorted(name for _, name in word), all(kind in ("vec", "diag") for kind, _ in word)
        for f in system.functions:
            if plain and f.level and names == sorted((f.level, f"U{f.name}")):
                yield _number(word), constant(f"sum_LU{f.name}")
            if plain and f.level and names == sorted((f.level, f"T{f.name}", f.name)):
                yield _number(word), constant(f"sum_T{f.name}")
            if plain and f.level and names == sorted((f"T{f.name}", OPPOSITE[1])):
                yield _number(word), ("neg", product(constant(f"{f.name}_load"), constant(f"sum_T{f.name}")))


def _least_of(system: System, word: Word, sized: Collection[str]) -> Tree | None:
    """The lower bound of a word, if it has one."""
    (_, first), *middle, (_, last) = word
    if middle == [("mat", "M")]:
        same = first == last and first in sized
        return product(constant("mu"), size(first), size(first)) if same else None
    if any(kind not in ("vec", "diag") for kind, _ in word):
        return None
    names = sorted(name for _, name in word)
    gains = [constant(f"{name}_min") for name in names if name in system.diagonal]
    rest = [name for name in names if name not in system.diagonal]
    if len(rest) == 2 and rest[0] == rest[1] and rest[0] in sized:
        return product(*gains, size(rest[0]), size(rest[0]))
    for own in system.by_entries:
        if rest == sorted((own.name, own.of)):
            return product(*gains, constant(f"{own.name}_sector"), size(own.name), size(own.name))
    for f in system.functions:
        if rest == [f"U{f.name}"] and gains:
            return product(*gains, constant(f"sum_U{f.name}"))
    return None


def _number(word: Word) -> Tree:
    """A word as an expression."""
    return ("dot", word[0], vector_of(word[1:]))


def written_out(number: Tree, words: Words) -> Tree:
    """A number as a polynomial in its words, without derivatives and what is given."""
    total: list[Tree] = []
    for c, powers in terms_of(words.number(number)):
        factors: list[Tree] = [("num", str(c))]
        for name, power in powers.items():
            result = words.seen.get(name)
            factors += [("var", name) if result is None else _number(min(result))] * power
        total.append(product(*factors))
    return ("add", ("num", "0"), *total)


def at_most(
    system: System,
    left: Tree,
    right: Tree,
    rates: Mapping[Tree, Tree] | None = None,
    changed: Collection[str] = (),
    local: bool = False,
) -> BoundEveryN:
    """``left <= right`` for every n, with all that is known of the letters in it.

    ``right`` is in sizes and constants. With ``rates``, the derivatives of letters, M ẇ is the system's;
    ``changed`` are letters that stand for others, ``local`` is for ‖e‖ <= R.
    """
    moved = dict(rates or {})
    given = (system.given,) if moved else ()
    solved = {(one.matrix, one.vector): one.equals for one in given}
    words = Words(("M",), moved, solved)
    number = words.number(left)
    seen = {letter for word in chain.from_iterable(words.seen.values()) for letter in word}
    used = {("mat", name) if kind == "transposed" else (kind, name) for kind, name in seen}
    used |= {("var", name) for name in variables(number) if name not in words.seen}
    known = [
        (own, bound)
        for own, bound in norms(system, changed, local)
        if set(own) <= used and {*filter(COMPARED, variables(bound))} <= variables(right)
    ]
    inertia = M in used or bool(given)
    return BoundEveryN(
        left,
        right,
        ("M",) if inertia else (),
        tuple(moved.items()),
        given,
        tuple(known),
        tuple(least(system, words, changed)),
    )


def constants_of(system: System) -> dict[str, Variable]:
    """The constants with their ranges; positive, but for upper bounds that may be 0."""
    positive = ["mu", "beta", "R", "eps0", *system.constants, *(f"{name}_min" for name in system.gains)]
    for f in system.functions:
        positive += [f"{f.name}_{bound}" for bound in BOUNDS]
    upper = ["kc", "kg", "km", "kc2", "vd", "ad", "delta"]
    upper += [f"{name}_{end}" for name in system.diagonal for end in ("max", "norm")]
    upper += [f"{f.name}_kg" for f in system.functions if f.of == "e"]
    upper += [f"{f.name}_load" for f in system.functions if f.level]
    positive += [f"{d.name}_{bound}" for d in system.increases for bound in ("secant", "sector", "reach")]
    (positive if system.friction == "positive" else upper).append("B_min")
    result = {name: Variable(name, Fraction(0)) for name in positive}
    return result | {name: Variable(name, Fraction(0), strict=False) for name in upper}


# --- What makes a function a member of the class of :class:`Entrywise`: facts in one variable.

X: Tree = ("var", "x")
ZERO: Tree = ("num", "0")


def facts(member: Member) -> Iterator[tuple[str, Statement]]:
    """f odd and positive right of 0, U' = f, U(0) = 0, f' its slope, and its bounds.

    Soundness: so U(x) > 0 for x ≠ 0, and as f >= low > 0 from some x on, U grows without end; f' has a value
    everywhere, so f is differentiable, and as a quotient, product or smooth function its slope is continuous.
    """
    f, slope = member.value, member.slope
    for name in ("gamma", "rho", "secant", "low", "steep"):
        number = getattr(member, name)
        require(number is None or number > 0, name, number, "must be positive")
    yield "f(−x) = −f(x)", Identity(substitute(f, {"x": ("neg", X)}), ("neg", f))
    yield "0 < f(x) for x > 0", ForAll(Relation(ZERO, "<", f), Fraction(0), None, open_low=True)
    yield "f' is the derivative of f", Identity(derivative(f, "x"), slope)
    yield "U' = f", Identity(derivative(member.potential, "x"), f)
    yield "U(0) = 0", Identity(substitute(member.potential, {"x": ZERO}), ZERO)
    bounds = [("f'", slope, member.rho)]
    bounds += [("f", f, member.gamma)] if member.gamma is not None else []
    for name, tree, number in bounds:
        bound: Tree = ("num", str(number))
        yield f"{name} ≤ {number}", ForAll(Relation(tree, "<=", bound))
        yield f"−{number} ≤ {name}", ForAll(Relation(("neg", bound), "<=", tree))
    yield f"|f(x)| ≤ {member.secant}|x|", NormBound(f, 1, ("num", str(member.secant)), 1)
    low: Tree = ("num", str(member.low))
    yield f"{member.low} ≤ f(x) for x ≥ {member.start}", ForAll(Relation(low, "<=", f), member.start)
    if member.steep is not None:
        line: Tree = ("mul", ("num", str(member.steep)), X)
        name = f"{member.steep}x ≤ f(x) for 0 ≤ x ≤ {member.start}"
        yield name, ForAll(Relation(line, "<=", f), Fraction(0), member.start)
