"""Proofs about an arm under any torque: theorems by name, for all arms and for one.

::

    goal = constant_goal()                      # e = q_d − q, w = q̇
    e, w = goal.e, goal.w
    Kp, Kv = goal.gains("Kp Kv")
    loop = goal.under(Kp @ e - Kv @ w + goal.gravity)
    V = w @ goal.M @ w / 2 + e @ Kp @ e / 2
    proof.add("P", "…", lasalle(loop, V, above=goal.mu * b**2 / 2 + Kp.min * r**2 / 2, …))

What each theorem asks for is derived by the checker: see ``check.systems``.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping
from difflib import get_close_matches
from fractions import Fraction
from functools import partial
from itertools import combinations_with_replacement
from operator import mul
from typing import TYPE_CHECKING

from lyapcheck.check.expressions.expression import Tree, variables
from lyapcheck.check.expressions.text import expression_text
from lyapcheck.check.kinds.all_of import AllOf
from lyapcheck.check.kinds.bound_every_n import Term, terms_of
from lyapcheck.check.kinds.every_n import EveryN
from lyapcheck.check.kinds.stability import Property, Stable
from lyapcheck.check.kinds.stable_arm import (
    Arm,
    StableArm,
    hessian,
    slope,
    slopes_of_mass,
    slopes_of_symbols,
)
from lyapcheck.check.letters import letters
from lyapcheck.check.loop.field import size_of
from lyapcheck.check.numbers.harmonics import by_parameters
from lyapcheck.check.statement import Monomials, Relation, Statement
from lyapcheck.check.systems.argument import Argument, Cascade, Change, Rest, Step
from lyapcheck.check.systems.facts import constants_of
from lyapcheck.check.systems.forms import Form
from lyapcheck.check.systems.obligations import obligations, rate_bound
from lyapcheck.check.systems.system import Entrywise, Member, System
from lyapcheck.claims.bounds import ArmBounds, above
from lyapcheck.claims.expressions import Expr, exact_value, expr, sqrt, total
from lyapcheck.claims.letters import AnyVector
from lyapcheck.robots.trig import to_terms

if TYPE_CHECKING:
    from lyapcheck.robots import RobotModel

ZERO: Tree = ("num", "0")


def strict(loop: System, V: Expr, above: Expr, rate: Expr, **more: object) -> Stable:
    """Claim that the origin is globally asymptotically stable, with dV/dt <= −rate at every state."""
    return _argued("strict", loop, V, above, rate, **more)  # type: ignore[arg-type]


def lasalle(loop: System, V: Expr, above: Expr, rate: Expr, **more: object) -> Stable:
    """Claim stability by LaSalle, with dV/dt <= −rate.

    ``rest=(x, form)``: xᵀMẇ >= form while rate is 0. Where more is needed, ``rest`` is a list of steps.
    """
    return _argued("LaSalle", loop, V, above, rate, **more)  # type: ignore[arg-type]


def step(form: Expr, still: Iterable[AnyVector] = (), **against: AnyVector) -> Step:
    """A step of LaSalle's theorem: while earlier states are 0, the sum of xᵀ(motion of s) is at least a form.

    Args:
        form: positive definite in sizes of states, which are then 0 too.
        still: states that stand still, as their own motion or another's shows.
        against: x for each state s that stands still, as in ``w=e``. The motion of w is Mẇ.

    Raises:
        ValueError: ``still`` has a sum or product.
    """
    for letter in still:
        if letter.tree[0] != "vec":
            raise ValueError(f"still: {expression_text(letter.tree)} is no letter of a state")
    names = tuple(str(letter.tree[1]) for letter in still)
    return Step(names, tuple((state, x.tree) for state, x in against.items()), form_of(form))


def uniform(loop: System, V: Expr, above: Expr, below: Expr, rate: Expr, **more: object) -> Stable:
    """Claim global uniform asymptotic stability, also for q_d(t): above <= V <= below, dV/dt <= −rate."""
    return _argued("uniform", loop, V, above, rate, below=below, **more)  # type: ignore[arg-type]


def exponential(loop: System, V: Expr, above: Expr, below: Expr, rate: Expr, **more: object) -> Stable:
    """Claim global exponential stability. As `uniform`, with quadratic forms in the norms of the states."""
    return _argued("exponential", loop, V, above, rate, below=below, **more)  # type: ignore[arg-type]


def input_to_state(
    loop: System, V: Expr, above: Expr, below: Expr, rate: Expr, gain: Expr, **more: object
) -> Stable:
    """Claim stability under a torque of at most delta. As `exponential`, with dV/dt <= −rate + delta·gain."""
    return _argued("ISS", loop, V, above, rate, below=below, gain=gain, **more)  # type: ignore[arg-type]


def converges(
    loop: System,
    V: Expr,
    above: Expr,
    below: Expr,
    rate: Expr,
    to_zero: Iterable[AnyVector],
    **more: object,
) -> Stable:
    """Claim that the origin is stable, motions are bounded, and some states tend to 0: those that rate sees.

    As `uniform`, but ``rate`` may see some states only.

    Raises:
        ValueError: a state of ``to_zero`` is not in ``rate``.
    """
    stable = _argued("convergence", loop, V, above, rate, below=below, **more)  # type: ignore[arg-type]
    for letter in to_zero:
        if letter.tree[1] not in stable.argument.seen(stable.argument.rate):
            raise ValueError(f"to_zero: {expression_text(letter.tree)} is not in rate, so it may stay away")
    return stable


def cascade(
    loop: System, V: Expr, above: Expr, rate: Expr, motion: Expr, contraction: Expr, **more: object
) -> Stable:
    """Claim that y, e and w tend to 0, with dV/dt <= −rate in y, ‖M ẏ‖ <= motion and eᵀw >= contraction."""
    return _argued("cascade", loop, V, above, rate, motion=motion, contraction=contraction, **more)  # type: ignore[arg-type]


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
    rest: tuple[AnyVector, Expr] | list[Step] | None = None,
    where: Iterable[Relation] = (),
    small: bool = False,
    local: bool = False,
    gain: Expr | None = None,
    motion: Expr | None = None,
    contraction: Expr | None = None,
) -> Stable:
    steps = tuple(rest) if isinstance(rest, list) else ()
    single = rest if isinstance(rest, tuple) else None
    relations, given = tuple(where), (above, rate, below, single and single[1], gain, motion, contraction)
    trees = [one.tree for one in given if one is not None] + [one.form.tree for one in steps]
    for one in (*trees, *(relation.gap for relation in relations)):
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
            None if single is None else Rest(single[0].tree, form_of(single[1])),
            relations,
            small,
            local,
            None if gain is None else form_of(gain),
            None if motion is None or contraction is None else Cascade(motion.tree, form_of(contraction)),
            steps,
        )
    )


def _require_names(loop: System, used: Iterable[str], changed: Iterable[str]) -> None:
    """Refuse names of numbers that nothing in the system has.

    Raises:
        ValueError: with the nearest ones that it has.
    """
    letters_of = [*loop.moving, *(f.name for f in loop.by_entries)]
    letters_of += [f"y_{state}" for state in changed]
    known = {*constants_of(loop), "s", *(f"norm_{name}" for name in letters_of)}
    known |= {f"sum_U{f.name}" for f in loop.functions}
    known |= {f"sum_{kind}{f.name}" for f in loop.functions if f.level for kind in ("LU", "T")}
    for name in sorted(set(used) - known):
        near = " or ".join(get_close_matches(name, known, n=2)) or ", ".join(sorted(known))
        raise ValueError(f"{name} is no constant or size of this system; did you mean {near}?")


def along(loop: System, V: Expr, equals: Expr, gravity: bool = False) -> EveryN:
    """Claim that dV/dt along the loop equals an expression in its symbols, for every n.

    Args:
        V: the function, without the energy of gravity.
        equals: an expression in the same symbols.
        gravity: True adds U_g(q) − U_g(q_d) + g(q_d)ᵀe to V.
    """
    left: Tree = ("rate", V.tree)
    if gravity:
        left = ("add", left, ("dot", ("vec", "dg"), ("vec", "w")))
    used = letters(V.tree)
    rates = tuple((letter, value) for letter, value in loop.rates().items() if letter in used)
    return EveryN(left, equals.tree, ("M",), rates, (loop.given,))


def rate_at_most(stable: Stable) -> Statement:
    """The bound dV/dt <= −rate of a theorem as a claim of its own."""
    return rate_bound(stable.argument)


def rate_definite(stable: Stable) -> AllOf:
    """That the form in the bound of dV/dt is positive definite, as a claim of its own."""
    return AllOf(tuple(one for one in obligations(stable.argument) if one[0].startswith("rate, ")))


def property_of(name: str, stable: Stable) -> Property:
    """Claim a property of the system of a theorem, or of its V.

    Args:
        name: a property in ``check.kinds.stability``, for example ``V is positive definite``.
        stable: the theorem. Only the forms that the property needs are used.
    """
    return Property(name, stable.argument)


def at_arm(stable: Stable, robot: RobotModel, **gains: object) -> StableArm:
    """Claim a theorem for one arm at its nominal numbers. A keyword gives a gain, as decimals, or a constant.

    Bounds of M, C and gravity are chosen here if the conditions need them. The checker proves them.

    Raises:
        ValueError: a number that the conditions need is not given.
    """
    bounds, system = ArmBounds(robot), stable.argument.system
    rows = {name: tuple(map(exact_value, _entries(gains[name]))) for name in system.gains}
    energy: Monomials = tuple(to_terms(bounds.robot.potential))
    arm = Arm(bounds.mass, bounds.viscous, energy)
    known = {name: exact_value(value) for name, value in gains.items() if name not in rows}
    known |= {"mu": bounds.guessed_floor(), "beta": bounds.beta, "kc": bounds.kc}
    wanted = sorted(set().union(*(variables(one.gap) for one in stable.argument.where)))
    for name, slopes in (
        ("kg", partial(hessian, energy, robot.n)),
        ("km", partial(slopes_of_mass, bounds.mass)),
        ("kc2", partial(slopes_of_symbols, bounds.mass)),
    ):
        if name not in wanted:  # of seven joints they take minutes
            continue
        known[name] = _size_of(slopes(), robot.n)
    for name, values in (rows | {"B": bounds.viscous}).items():
        squares = total(expr(value) ** 2 for value in values)
        known |= {
            f"{name}_min": min(values),
            f"{name}_max": max(values),
            f"{name}_norm": above(sqrt(squares)),
        }
    for f in system.functions:
        if f.member is not None:
            most = max(rows[f.gain]) if f.gain else Fraction(1)
            reach, secant = above(sqrt(robot.n)) * (f.member.gamma or 1), f.member.secant * most
            known |= {f"{f.name}_slope": f.member.rho * most, f"{f.name}_secant": secant}
            known |= {f"{f.name}_sector": 1 / secant, f"{f.name}_reach": reach}
            known[f"{f.name}_share"] = reach * secant / (reach + secant) if f.bounded else secant
            if f.member.steep is not None and {f"{f.name}_kg", f"{f.name}_load"} & {*wanted}:
                known |= _compared(f, f.member, rows, energy, robot.n)
            for one in (one for one in system.increases if one.function == f.name):
                secant = f.member.rho * max(rows[one.gain])
                known |= {f"{one.name}_secant": secant, f"{one.name}_sector": 1 / secant}
                known[f"{one.name}_reach"] = 2 * reach
    if lost := [name for name in wanted if name not in known]:
        raise ValueError(f"at_arm: the conditions need numbers for {', '.join(lost)}")
    return StableArm(stable.argument, arm, tuple(rows.items()), tuple((name, known[name]) for name in wanted))


def _size_of(polynomials: Iterable[Monomials], n: int) -> Fraction:
    """At least the root of the sum of their squares."""
    sizes = (size_of(by_parameters(one, n), ()) for one in polynomials)
    return above(sqrt(total(expr(size) ** 2 for size in sizes)))


def _compared(
    f: Entrywise, member: Member, rows: Mapping[str, tuple[Fraction, ...]], energy: Monomials, n: int
) -> dict[str, Fraction]:
    """How large gravity is beside a function, and beside L f joint by joint: see ``check.systems.facts``."""
    assert member.steep is not None
    steep = [member.steep * a for a in (rows[f.gain] if f.gain else (1,) * n)]
    slopes, torque = _size_of(hessian(energy, n), n), [slope(energy, i, n) for i in range(n)]
    result = {f"{f.name}_kg": max(slopes / min(steep), 2 * _size_of(torque, n) / member.low)}
    if f.level:
        level = rows[f.level]
        far = (2 * _size_of([one], n) / (k * member.low) for one, k in zip(torque, level, strict=True))
        result[f"{f.name}_load"] = max(slopes / min(map(mul, level, steep)), *far)
    return result


def _entries(gain: object) -> Iterable[object]:
    return gain.split() if isinstance(gain, str) else gain  # type: ignore[return-value]


def form_of(value: Expr) -> Form:
    """An expression that is quadratic in some sizes and linear in others, as a form.

    Raises:
        ValueError: it is of another degree in its sizes.
    """
    parts: defaultdict[tuple[str, ...], list[Term]] = defaultdict(list)
    for c, powers in terms_of(value.tree):
        size = tuple(name for name in sorted(powers) if _is_size(name) for _ in range(powers[name]))
        parts[size].append((c, {name: power for name, power in powers.items() if not _is_size(name)}))
    linear = tuple((size[0], _plain(terms)) for size, terms in sorted(parts.items()) if len(size) == 1)
    sizes = tuple(sorted(set(filter(_is_size, variables(value.tree))) - {name for name, _ in linear}))
    pairs = tuple(combinations_with_replacement(sizes, 2))
    if not {key for key in parts if len(key) != 1} <= set(pairs):
        raise ValueError(f"a form is quadratic in norms and linear in sums of potentials, not {value.tree!r}")
    entries = (_plain([(c if a == b else c / 2, powers) for c, powers in parts[a, b]]) for a, b in pairs)
    return Form(sizes, tuple(entries), linear)


def _is_size(name: str) -> bool:
    return name.startswith(("norm_", "sum_"))


def _plain(terms: Iterable[Term]) -> Tree:
    """A sum of terms."""
    written = [_product(str(c), powers) for c, powers in terms]
    if not written:
        return ZERO
    return written[0] if len(written) == 1 else ("add", *written)


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
