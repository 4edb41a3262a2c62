"""What an argument by a theorem has to prove, by name: see `check.systems` for why it is enough."""

from __future__ import annotations

from collections.abc import Iterator

from lyapcheck.check.expressions.expression import Tree, variables
from lyapcheck.check.kinds.every_n import EveryN
from lyapcheck.check.kinds.for_all import ForAll
from lyapcheck.check.kinds.implies import Implies
from lyapcheck.check.letters import letters
from lyapcheck.check.letters.words import Words
from lyapcheck.check.statement import Relation, Statement
from lyapcheck.check.systems.argument import Argument, Cascade
from lyapcheck.check.systems.facts import (
    OPPOSITE,
    P,
    at_most,
    constant,
    constants_of,
    facts,
    product,
    size,
    written_out,
)
from lyapcheck.check.systems.forms import ZERO, Form, is_positive
from lyapcheck.check.systems.system import (
    DG,
    DISTURBANCE,
    NOTHING,
    E,
    Entrywise,
    M,
    System,
    W,
    minus,
    replaced,
)

Named = Iterator[tuple[str, Statement]]
TEST: Tree = ("vec", "x")


def obligations(argument: Argument) -> Named:
    """What must be proved, by name."""
    yield from origin(argument)
    yield from energy_at_origin(argument)
    yield from functions(argument)
    yield from above(argument)
    yield from below(argument)
    yield "rate", rate_bound(argument)
    yield from _definite(argument, "rate", argument.rate)
    yield from at_rest(argument)
    if argument.cascade is not None:
        yield from _follows(argument, argument.cascade)


def rate_bound(argument: Argument) -> Statement:
    """dV/dt <= −ψ."""
    system = argument.system
    used = letters(argument.energy) | {("vec", f.name) for f in system.functions if f.of != "w"}
    rates = {letter: value for letter, value in system.rates().items() if letter in used}
    left: Tree = ("rate", argument.energy)
    if argument.gravity:
        left = ("add", left, ("dot", DG, W))
    right: Tree = ("neg", argument.rate.tree)
    if argument.gain is not None:
        right = ("add", right, ("mul", ("var", "delta"), argument.gain.tree))
    if argument.cascade is not None:
        return at_most(system, _changed(argument, left), right, changed=argument.changed)
    return at_most(system, left, right, rates, local=argument.local)


def origin(argument: Argument) -> Named:
    """That nothing moves at the origin."""
    system, every = argument.system, argument.system.moving
    force = replaced(system.at_zero(system.force, every), {DISTURBANCE: NOTHING})
    yield "origin", EveryN(("dot", TEST, force), ZERO)
    for state in system.states:
        yield f"origin of {state.name}", EveryN(("dot", TEST, system.at_zero(state.rate, every)), ZERO)


def energy_at_origin(argument: Argument) -> Named:
    """V = 0 there."""
    every = argument.system.moving
    yield "V at the origin", EveryN(argument.system.at_zero(argument.energy, every), ZERO)


def functions(argument: Argument) -> Named:
    """That those of the system are of the class."""
    for f in argument.system.functions:
        if f.member is not None:
            for name, fact in facts(f.member):
                yield f"{f.name}: {name}", fact
            if any(one.function == f.name for one in argument.system.increases):
                yield f"{f.name}: 0 < f'", ForAll(Relation(ZERO, "<", f.member.slope))


def above(argument: Argument) -> Named:
    """V >= φ, positive definite."""
    by = {("vec", change.state): change.equals for change in argument.changes}
    left = _with_gravity(argument, replaced(argument.energy, by))
    right: Tree = ("neg", argument.lower.tree)
    yield "above", at_most(argument.system, ("neg", left), right, changed=argument.changed)
    yield from _definite(argument, "above", argument.lower)


def below(argument: Argument) -> Named:
    """V <= Φ, where there is one."""
    if argument.upper is not None:
        left = _with_gravity(argument, argument.energy)
        yield "below", at_most(argument.system, left, argument.upper.tree)


def at_rest(argument: Argument) -> Named:
    """For each step Σ xᵀ(motion) >= χ, positive definite, where the states that vanish before it are 0."""
    system = argument.system
    for k, (step, zero) in enumerate(zip(argument.to_rest, argument.vanishing(), strict=False), 1):
        parts: list[Tree] = [
            ("dot", system.at_zero(x, zero), system.at_zero(system.motion(state), zero))
            for state, x in step.against
        ]
        name, total = f"rest {k}" if k > 1 else "rest", parts[0] if len(parts) == 1 else ("add", *parts)
        if system.probes:
            total = replaced(total, {DG: minus(OPPOSITE)})
        yield name, at_most(system, ("neg", total), ("neg", step.form.tree))
        yield from _definite(argument, name, step.form)


def _with_gravity(argument: Argument, energy: Tree) -> Tree:
    return ("add", energy, ("dot", E, P)) if argument.gravity else energy


def _definite(argument: Argument, subject: str, form: Form) -> Named:
    for name, tree in form.positive():
        yield f"{subject}, {name}", is_positive(argument.system, tree, argument.where, argument.small)


def _changed(argument: Argument, left: Tree) -> Tree:
    """A number along the loop without derivatives in it, in the changed letters."""
    solved = {("M", "dw"): argument.system.force}
    plain = written_out(left, Words(("M",), argument.system.rates() | {TEST: NOTHING}, solved))
    return replaced(plain, {("vec", change.state): change.equals for change in argument.changes})


def _follows(argument: Argument, cascade: Cascade) -> Named:
    """That y is uniformly continuous, and that e is bounded with it and follows it to 0.

    xᵀM ẏ is the rate of xᵀMy for a constant x, less xᵀ(C + Cᵀ)y.
    """
    system, [change] = argument.system, argument.changes
    own: Tree = ("vec", change.letter)
    rest = replaced(change.equals, {own: NOTHING})
    yield "cascade, w where e and y are 0", EveryN(("dot", TEST, system.at_zero(rest, ["e"])), ZERO)
    y: Tree = ("sum", W, minus(rest))  # or its opposite: their norms agree
    turned = ("apply", system.rates()[M], y)
    moving: Tree = ("add", ("rate", ("dot", TEST, ("apply", M, y))), ("neg", ("dot", TEST, turned)))
    most = product(size(TEST[1]), cascade.motion)
    changed = (*argument.changed, TEST[1])
    yield "cascade, motion", at_most(system, _changed(argument, moving), most, changed=changed)
    left: Tree = ("neg", ("dot", E, change.equals))
    right: Tree = ("neg", cascade.contraction.tree)
    yield "cascade, contraction", at_most(system, left, right, changed=argument.changed)
    k = cascade.contraction.sizes.index("norm_e")
    corner = cascade.contraction.rows[k][k]
    yield "cascade, contraction ‖e‖²", is_positive(system, corner, argument.where, argument.small)


# --- That the conditions of a theorem can be met: one that holds where nothing is says nothing.
#
# They are met where the claim that the last one fails wherever the others hold is false: a point refutes it.


def never_met(argument: Argument) -> Implies | None:
    """That no constants that an arm and its gains can have meet the conditions; none where none is made."""
    if not argument.where:
        return None
    *others, last = argument.where
    used = set().union(*(variables(one.gap) for one in argument.where))
    orders = [one for one in _orders(argument.system) if variables(one.gap) <= used]
    known = constants_of(argument.system)
    fails = Relation(last.right, "<" if last.operator == "<=" else "<=", last.left)
    return Implies(tuple(known[name] for name in sorted(used)), (*others, *orders), fails)


def _orders(system: System) -> Iterator[Relation]:
    """How bounds of one thing lie to each other."""
    yield Relation(constant("mu"), "<=", constant("beta"))
    for name in system.diagonal:
        least, greatest, norm = (constant(f"{name}_{end}") for end in ("min", "max", "norm"))
        yield Relation(least, "<=", greatest)
        yield Relation(least, "<=", norm)
        yield Relation(greatest, "<=", norm)
    for f in system.by_entries:
        secant, sector = constant(f"{f.name}_secant"), constant(f"{f.name}_sector")
        yield Relation(product(secant, sector), "<=", ("num", "1"))
        if isinstance(f, Entrywise) and f.member is not None and not f.gain:
            slope, reach, share = (constant(f"{f.name}_{end}") for end in ("slope", "reach", "share"))
            lowest = f.member.low / (1 + abs(f.member.start))  # of f(x)/(1 + x)
            yield Relation(("num", str(lowest)), "<=", share)
            yield Relation(("num", str(f.member.secant)), "<=", secant)
            yield Relation(("num", str(f.member.rho)), "<=", slope)
            yield Relation(product(("num", str(f.member.secant)), sector), "<=", ("num", "1"))
            if f.member.gamma is not None:
                yield Relation(("num", str(f.member.gamma)), "<=", reach)
