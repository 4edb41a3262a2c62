"""Stability of a closed loop that is data, by a theorem whose obligations are each proved.

The checker derives the obligations from the system (``check.systems``); a certificate has their proofs.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

from lyapcheck.check.expressions.expression import variables
from lyapcheck.check.expressions.text import expression_text
from lyapcheck.check.letters import letters
from lyapcheck.check.refusal import require
from lyapcheck.check.replay import relation_text
from lyapcheck.check.statement import Proof, Statement, Total, Witness
from lyapcheck.check.systems import THEOREMS
from lyapcheck.check.systems import obligations as parts
from lyapcheck.check.systems.argument import Argument
from lyapcheck.check.systems.forms import EPS0
from lyapcheck.check.systems.obligations import never_met, obligations
from lyapcheck.check.systems.system import Entrywise, Increase
from lyapcheck.check.verify import Accepted, all_proved, rule, verify

FRICTION = {
    "none": "without friction",
    "any": "with or without viscous friction",
    "positive": "with viscous friction at every joint",
}


@dataclass(frozen=True)
class Stable(Total):
    """The origin of a system is stable, as an argument by a theorem says."""

    argument: Argument

    def require_well_formed(self) -> None:
        """Refuse an argument that is not of the form of its theorem."""
        self.argument.require_well_formed()

    def obligations(self) -> Iterator[tuple[str, Statement]]:
        """What the theorem asks for, by name."""
        return obligations(self.argument)

    @property
    def theorems(self) -> tuple[tuple[str, str], ...]:
        known = THEOREMS[self.argument.theorem]
        return ((known.name, known.reference),)

    @property
    def granted(self) -> tuple[str, ...]:
        return tuple(_granted(self.argument))

    @property
    def conclusion(self) -> str:
        """What is stable, and how."""
        argument, known = self.argument, THEOREMS[self.argument.theorem]
        moving = argument.system.moving if argument.cascade is None else ("e", "w")
        origin = ", ".join(f"{name} = 0" for name in moving)
        conclusion = known.conclusion
        if argument.local:
            least = "Φ" if argument.upper is not None else "V"
            conclusion = known.conclusion.removeprefix("globally ")
            conclusion += f", and attracts where ‖e‖ ≤ R and {least} is below the least φ on ‖e‖ = R,"
        if argument.theorem == "convergence":
            seen = argument.seen(argument.rate)
            left = ", ".join(name for name in moving if name not in seen)
            conclusion += f", and {', '.join(name for name in moving if name in seen)} → 0"
            conclusion += f" (nothing is said of where {left} goes)" if left else ""
        return f"{origin} is {conclusion}"

    def text(self) -> str:
        """The theorem in one sentence."""
        argument, known = self.argument, THEOREMS[self.argument.theorem]
        lower, rate = (expression_text(form.tree) for form in (argument.lower, argument.rate))
        beside = f" + delta·({expression_text(argument.gain.tree)})" if argument.gain is not None else ""
        if argument.cascade is not None:
            [change], cascade = argument.changes, argument.cascade
            motion, contraction = (expression_text(t) for t in (cascade.motion, cascade.contraction.tree))
            beside = (
                f", w = {expression_text(change.equals)}, ‖M d({change.letter})/dt‖ ≤ {motion}, "
                f"eᵀw ≥ {contraction}"
            )
        upper = f", V ≤ Φ = {expression_text(argument.upper.tree)}" if argument.upper is not None else ""
        return (
            f"{self.conclusion} {loop_text(argument)}: by {known.name} ({known.reference}) with "
            f"{energy_text(argument)}, V ≥ φ = {lower}{upper}, dV/dt ≤ −({rate}){beside}"
        )


BOUNDS = {
    "slope": "≥ |{slope}|",
    "secant": "≥ |{at_x}/x|",
    "reach": "≥ ‖{at_state}‖",
    "share": "≥ ‖{at_state}‖/(1 + ‖{of}‖)",
    "sector": "≤ 1/{name}_secant",
    "kg": "with ‖g(q) − g(p)‖ ‖x‖ ≤ {name}_kg x·{at_x}, x = q − p",
    "load": "with min(kg |x|, k_i) ≤ {name}_load {level}_i |{at_x}|, k_i ≥ |g_i(q) − g_i(p)|, for each joint",
}
INCREASED = {"secant": "≥ |{0}/{1}| by entries", "reach": "≥ ‖{0}‖", "sector": "≤ 1/{0}_secant"}
"""What the constants of a function bound, by the ends of their names."""


def loop_text(argument: Argument) -> str:
    """Under which torque, and for what."""
    system = argument.system
    about = [f"d{state.name}/dt = {expression_text(state.rate)}" for state in system.states]
    grow = {one.function for one in system.increases}
    about += [_function_text(f, f.name in grow) for f in system.functions]
    about += [_increase_text(one, argument) for one in system.increases]
    under = "; ".join([expression_text(system.torque), *about])
    where = " and ".join(relation_text(one) for one in argument.where)
    return f"under τ = {under}, for {', '.join(_over(argument))}{f' with {where}' if where else ''}"


def energy_text(argument: Argument) -> str:
    """V."""
    gravity = " + U_g(q) − U_g(q_d) + g(q_d)·e" if argument.gravity else ""
    small = " for some eps0 > 0" if argument.small else ""
    return f"V = {expression_text(argument.energy)}{gravity}{small}"


def _over(argument: Argument) -> Iterator[str]:
    """Over what a conclusion runs."""
    system = argument.system
    sizes = {size: None for _, size in system.sizes} | {one.columns: None for one in system.regressors}
    yield ", ".join(["every n", *(size for size in sizes if size != "n")])
    for one in system.regressors:
        of = "time and the states, bounded where they are" if one.bounded else "the states"
        yield f"every continuous n × {one.columns} matrix {one.name} of {of}"
    yield f"every arm {FRICTION[system.friction]}"
    if system.gains:
        yield f"all diagonal {', '.join(system.gains)} > 0"
    for name, size in system.sizes:
        yield f"{name} of size {size}"
    if system.constants:
        yield f"all {', '.join(system.constants)} > 0"
    used = set().union(*(variables(relation.gap) for relation in argument.where))
    for f in system.functions:
        at_x, at_state = (f"{f.name}({f'{f.gain} ' * bool(f.gain)}{of})" for of in ("x", f.of))
        slope = f"d/dx {at_x}" if f.gain else f"{f.name}'"
        shown = {"name": f.name, "of": f.of, "level": f.level, "at_x": at_x, "at_state": at_state}
        known = {f"{f.name}_{end}": says.format(slope=slope, **shown) for end, says in BOUNDS.items()}
        everywhere = {f"{f.name}_kg", f"{f.name}_load"} & argument.constants
        bounds = [f"{name} {says}" for name, says in known.items() if name in used | everywhere]
        if bounds:
            yield f"all {', '.join(bounds)}"
    for d in system.increases:
        known = {f"{d.name}_{end}": says.format(d.name, d.of) for end, says in INCREASED.items()}
        bounds = [f"{name} {says}" for name, says in known.items() if name in used]
        if bounds:
            yield f"all {', '.join(bounds)}"
    free = not argument.small and ("var", EPS0) in letters(argument.energy)
    if free or EPS0 in used:
        yield "all eps0 > 0"
    if system.desired:
        yield "every q_d(t) with bounded dq_d/dt" + (" and d²q_d/dt²" if "ad" in argument.constants else "")


def _function_text(f: Entrywise, increases: bool) -> str:
    by = f"{f.name} = {f.name}({_argument_text(f)}) by entries"
    if f.member is not None:
        return f"{by}, {f.name}(x) = {expression_text(f.member.value)}"
    bounded = ("bounded, " if f.bounded else "") + ("increasing with a positive slope, " if increases else "")
    return f"{by}, {bounded}odd and C¹, positive for x > 0, of bounded slope, its integral without end"


def _argument_text(f: Entrywise) -> str:
    return f"{f.gain} {f.of}" if f.gain else f.of


def _increase_text(one: Increase, argument: Argument) -> str:
    """d = f(A x) − f(A x − K y)."""
    [f] = [f for f in argument.system.functions if f.name == one.function]
    start, change = _argument_text(f), f"{one.gain} {one.of}"
    low, high = (f"{start} − {change}", start) if one.back else (start, f"{start} + {change}")
    return f"{one.name} = {f.name}({high}) − {f.name}({low}) by entries"


DIFFERENCES = {
    "km": "‖M(q) − M(p)‖ ≤ km ‖q − p‖ for all q and p",
    "kc2": "‖C(q,x) − C(p,x)‖ ≤ kc2 ‖x‖ ‖q − p‖ for all q and p",
    "kg": "‖g(q) − g(p)‖ ≤ kg ‖q − p‖ for all q and p",
    "ad": "‖q̈_d‖ ≤ ad",
}
"""What is granted where a bound has the constant, for q_d(t)."""


def _granted(argument: Argument) -> Iterator[str]:
    """The model of the arm, what the letters are, and the properties of the arm that they have."""
    system, used = argument.system, argument.constants
    friction = "" if system.friction == "none" else " + Bq̇"
    disturbance = " + d with ‖d‖ ≤ delta" if system.disturbed else ""
    yield (
        f"the robot is M(q)q̈ + C(q,q̇)q̇{friction} + g(q) = τ{disturbance}, and 0 < mu ≤ λmin(M(q)), "
        "‖M(q)‖ ≤ beta, ‖C(q,x)y‖ ≤ kc ‖x‖ ‖y‖ for all q, with Ṁ = C + Cᵀ; the torque is applied as it is"
        + ("" if system.regressors else ", and all in it is known exactly")
    )
    yield f"the letters are {', '.join(_meanings(argument))}"
    if system.friction != "none":
        yield f"B is diagonal with λmin(B) = B_min {'>' if system.friction == 'positive' else '≥'} 0"
    if system.desired:
        yield "q_d(t) is twice continuously differentiable with ‖q̇_d‖ ≤ vd"
        yield from (says for name, says in DIFFERENCES.items() if name in used)
    else:
        yield "g is the gradient of U_g, and ‖∂g/∂q‖ ≤ kg for all q"


RESTING = {"gd": "g(q_d)", "dg": "g(q) − g(q_d)", "C": "C(q,q̇)"}
MOVING = {
    "g": "g(q)",
    "dg": "g(q) − g(q_d)",
    "C": "C(q,w)",
    "D": "C(q,q̇_d)",
    "dM": "M(q) − M(q_d)",
    "dD": "C(q,q̇_d) − C(q_d,q̇_d)",
    "dqd": "q̇_d",
    "ddqd": "q̈_d",
}
"""What the letters of an arm with its goal stand for, where q_d is constant and where it moves."""


def _meanings(argument: Argument) -> Iterator[str]:
    """What each letter stands for, of those that the statement has."""
    system, forms = argument.system, argument.forms
    trees = [system.torque, *(state.rate for state in system.states), argument.energy]
    trees += [form.tree for form in forms] + [change.equals for change in argument.changes]
    trees += [argument.cascade.motion] if argument.cascade is not None else []
    used = {name for tree in trees for _, name in letters(tree)} | argument.constants
    yield f"e = q_d − q, w = q̇{' − q̇_d' if system.desired else ''}"
    known = MOVING if system.desired else RESTING
    yield from (f"{name} = {says}" for name, says in known.items() if name in used)
    if "s" in used:
        yield "s = 1/(1 + ‖e‖)"
    yield from (f"{c.letter} by {c.state} = {expression_text(c.equals)}" for c in argument.changes)
    for size in sorted(name for name in used if name.startswith(("norm_", "sum_"))):
        kind, name = size.split("_", 1)
        yield f"norm_{name} = ‖{name}‖" if kind == "norm" else f"{size} the sum of the entries of {name}"
    for f in system.functions:
        if used & {f"U{f.name}", f"sum_U{f.name}", f"sum_LU{f.name}"}:
            inner = f"{f.gain} x" if f.gain else "x"
            yield f"U{f.name} = ∫{f.name}({inner}) dx from 0 to {f.of} by entries"
        if used & {f"sum_LU{f.name}", f"sum_T{f.name}"}:
            yield f"sum_LU{f.name} = {f.level}·U{f.name}"
            yield f"T{f.name} a vector with |T{f.name}·dg| ≤ {f.name}_load sum_T{f.name}"
            yield f"sum_T{f.name} = T{f.name}·{f.level} {f.name}, positive unless e = 0"
    for name in system.diagonal:
        if used & {f"{name}_min", f"{name}_max"}:
            yield f"{name}_min and {name}_max the least and the greatest entry of {name}"


@dataclass(frozen=True)
class ByObligations(Proof):
    """A proof of each obligation of the theorem, in its order, and constants that meet its conditions."""

    rule = "obligations"
    proofs: tuple[Proof, ...]
    met: Witness | None = None


@rule(Stable, ByObligations)
def by_obligations(statement: Stable, proof: ByObligations) -> Accepted:
    """Soundness: see ``check.systems.obligations``."""
    return by_argument(statement.argument, statement.obligations(), proof)


def by_argument(
    argument: Argument, obligations: Iterable[tuple[str, Statement]], proof: ByObligations
) -> Accepted:
    """Each obligation by its own proof, and constants that meet the conditions: it is not about nothing."""
    never = never_met(argument)
    require((never is None) == (proof.met is None), "met", "", "must be given where there are conditions")
    if never is not None and proof.met is not None:
        met = verify(never, proof.met).verdict == "refuted"
        require(met, "met", "", "must be a point at which all conditions hold")
    return all_proved(obligations, proof.proofs, "proofs")


# --- What Lyapunov's method asks of a closed loop and of V, each property by itself.
#
# - an equilibrium: nothing moves at the origin;
# - the only one: ė = −w, so w = 0 at rest; there xᵀ(M ẇ) >= χ for some x, with χ positive definite in sizes
#   that see all other states, so that M ẇ = 0 nowhere else;
# - positive definite, radially unbounded: V = 0 at the origin, and V >= φ, positive definite in sizes that
#   see every state and grow with it without end;
# - decrescent: V <= Φ, a form in sizes without time, which all vanish at the origin;
# - continuously differentiable: V is made of letters that are, with s only beside what vanishes with e.
#
# References: ``khalil2002nonlinear``, chapter 4; ``kelly2005control``, chapters 2 and 4.


EQUILIBRIUM = "the origin is the only equilibrium"
AN_EQUILIBRIUM = "the origin is an equilibrium"
POSITIVE = "V is positive definite"
UNBOUNDED = "V is radially unbounded"
DECRESCENT = "V is decrescent"
SMOOTH = "V is continuously differentiable"
DEFINITE = (parts.energy_at_origin, parts.functions, parts.above)
PROPERTIES: dict[str, tuple[Callable[[Argument], parts.Named], ...]] = {
    EQUILIBRIUM: (parts.origin, parts.functions, parts.at_rest),
    AN_EQUILIBRIUM: (parts.origin, parts.functions),
    POSITIVE: DEFINITE,
    UNBOUNDED: DEFINITE,
    DECRESCENT: (parts.functions, parts.below),
    SMOOTH: (parts.functions,),
}
"""For each property the obligations of the argument that it follows from."""


@dataclass(frozen=True)
class Property(Total):
    """A property of the system, or of V, of an argument; what else the argument says is not said here."""

    name: str
    argument: Argument

    def require_well_formed(self) -> None:
        """Refuse a property that the argument has no form for."""
        argument = self.argument
        require(self.name in PROPERTIES, "property", self.name, "is not one that the checker knows")
        argument.require_well_formed()
        fits = {
            EQUILIBRIUM: argument.rest is not None and argument.seen(argument.rate) == {"w"},
            DECRESCENT: argument.upper is not None,
        }.get(self.name, True)
        require(fits, "argument", argument.theorem, f"has no form from which “{self.name}” follows")
        definite = self.name not in (POSITIVE, UNBOUNDED) or argument.cascade is None
        require(definite, "argument", argument.theorem, "has a V that need not see e")
        still = self.name not in (EQUILIBRIUM, AN_EQUILIBRIUM) or not argument.system.disturbed
        require(still, "argument", argument.theorem, "has an unknown torque, under which nothing is at rest")

    def obligations(self) -> Iterator[tuple[str, Statement]]:
        """What the property follows from, by name."""
        for part in PROPERTIES[self.name]:
            yield from part(self.argument)

    @property
    def granted(self) -> tuple[str, ...]:
        return tuple(_granted(self.argument))

    def text(self) -> str:
        """The property, of which system and of which V."""
        argument = self.argument
        energy, says = energy_text(argument), ""
        if self.name == EQUILIBRIUM and argument.rest is not None:
            against, form = argument.rest.against, argument.rest.form.tree
            says = f", as ({expression_text(against)})·M dw/dt ≥ {expression_text(form)} where w = 0,"
        elif self.name in (POSITIVE, UNBOUNDED):
            says = f": {energy}, by V ≥ φ = {expression_text(argument.lower.tree)},"
        elif self.name == DECRESCENT and argument.upper is not None:
            says = f": {energy}, by V ≤ Φ = {expression_text(argument.upper.tree)},"
        elif self.name == SMOOTH:
            says = f": {energy},"
        return f"{self.name}{says} {loop_text(argument)}"


@rule(Property, ByObligations)
def by_parts(statement: Property, proof: ByObligations) -> Accepted:
    """Soundness: see above :class:`Property`."""
    return by_argument(statement.argument, statement.obligations(), proof)
