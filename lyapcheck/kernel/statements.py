"""The statement of a certificate as a proposition of Coq, printed from its data, one function a kind.

A printed proposition says what ``Statement.text`` says, or more; where it says more, that is written
beside the function. Kinds that are not listed are not printed, and their certificates have no kernel verdict.
"""

from __future__ import annotations

from fractions import Fraction
from functools import singledispatch

from lyapcheck.check.expressions.expression import variables
from lyapcheck.check.kinds.all_of import AllOf, OnePart
from lyapcheck.check.kinds.bound_every_n import BoundEveryN
from lyapcheck.check.kinds.constant import Agrees, Constant, printed_range
from lyapcheck.check.kinds.coriolis import (
    CoriolisAtRest,
    CoriolisBelow,
    MassSymmetric,
    RateLessTwiceCoriolis,
    RateOfMass,
)
from lyapcheck.check.kinds.decreasing import DampingBelow, Decreasing, StateWitness
from lyapcheck.check.kinds.every_n import EveryN
from lyapcheck.check.kinds.for_all import ForAll
from lyapcheck.check.kinds.for_small import ForSmall
from lyapcheck.check.kinds.gate_accepted import GateAccepted
from lyapcheck.check.kinds.identity import Identity
from lyapcheck.check.kinds.implies import Implies
from lyapcheck.check.kinds.inertia import MassAbove, MassBelow
from lyapcheck.check.kinds.norm_bound import NormBound
from lyapcheck.check.kinds.sampled import SampledStable
from lyapcheck.check.kinds.stability import (
    AN_EQUILIBRIUM,
    DECRESCENT,
    EQUILIBRIUM,
    POSITIVE,
    UNBOUNDED,
    Property,
    Stable,
)
from lyapcheck.check.kinds.stable_arm import StableArm
from lyapcheck.check.statement import Proof, Relation, Statement
from lyapcheck.kernel.gate import gate_proposition, gate_refuted, sampled_proposition
from lyapcheck.kernel.terms import (
    NotPrinted,
    any_arm,
    arm,
    bound,
    every_n,
    exact,
    exact_list,
    expression,
    identifier,
    member_of,
    member_of_energy,
    on_one_arm,
    quantified,
    rational,
    relation,
)

PROPERTIES = {
    (EQUILIBRIUM, False): ("only_equilibrium", "origin_is_only_equilibrium"),
    (AN_EQUILIBRIUM, False): ("only_equilibrium", "origin_is_only_equilibrium"),
    (AN_EQUILIBRIUM, True): ("equilibrium_of_tracking", "origin_is_equilibrium_of_tracking"),
    (POSITIVE, False): ("V_positive_definite", "V_is_positive_definite"),
    (POSITIVE, True): ("V_bounded_below", "V_is_bounded_below"),
    (UNBOUNDED, False): ("V_radially_unbounded", "V_is_radially_unbounded"),
    (DECRESCENT, False): ("V_bounded_above", "V_is_bounded_above"),
    (DECRESCENT, True): ("V_bounded_above", "V_is_bounded_above"),
}
"""By properties of the loop and of V, and whether the goal moves: what the page of definitions calls it, and
the theorem that shows it."""
OF_ARM: dict[type, tuple[str, str]] = {
    MassAbove: ("M_above", "M_above_by_boxes"),
    MassBelow: ("M_below", "M_below_by_rows"),
    CoriolisBelow: ("C_below", "C_below_by_squares"),
    MassSymmetric: ("M_symmetric", "M_symmetric_by_entries"),
    CoriolisAtRest: ("C_at_rest", "C_is_0_at_rest"),
    RateOfMass: ("M_rate_by_C", "M_rate_by_entries"),
    RateLessTwiceCoriolis: ("M_rate_less_2C", "M_rate_less_2C_by_entries"),
}
"""The same of the properties of one arm."""


def shown(statement: Statement, proof: Proof, verdict: str) -> str:
    """What a certificate shows: its statement, or what refutes it.

    Of a conjunction that one part refutes it is the negation of that part, and of an ε₀ that a state refutes
    that there is such a state: both say more than that the statement is false.

    Raises:
        NotPrinted: naming what has no form in Coq.
    """
    if verdict == "proved":
        return proposition(statement)
    if isinstance(statement, AllOf) and isinstance(proof, OnePart):
        return shown(statement.parts[proof.part][1], proof.proof, verdict)
    if isinstance(statement, Decreasing) and isinstance(proof, StateWitness):
        return _of_arm("falsified", statement)
    if isinstance(statement, GateAccepted):
        return gate_refuted(statement, proof)
    return f"~ ({proposition(statement)})"


@singledispatch
def proposition(statement: Statement) -> str:
    """The statement itself.

    Raises:
        NotPrinted: naming what has no form in Coq.
    """
    raise NotPrinted(f"statements of the kind {type(statement).__name__}")


proposition.register(SampledStable, sampled_proposition)
proposition.register(EveryN | BoundEveryN, every_n)  # also for n = 0, which says more


@proposition.register
def _(statement: AllOf) -> str:
    return " /\\ ".join(f"({proposition(part)})" for _, part in statement.parts)


@proposition.register
def _(statement: GateAccepted) -> str:
    parts = [gate_proposition(statement), *map(proposition, statement.stability)]
    return " /\\ ".join(f"({part})" for part in parts)


@proposition.register
def _(statement: Constant) -> str:
    return relation(statement.relation)


@proposition.register
def _(statement: ForAll) -> str:
    name = identifier(statement.variable)
    low, high = statement.low, statement.high
    given = [] if low is None else [f"{rational(low)} {'<' if statement.open_low else '<='} {name}"]
    given += [] if high is None else [f"{name} {'<' if statement.open_high else '<='} {rational(high)}"]
    return quantified([statement.variable], given, relation(statement.relation))


@proposition.register
def _(statement: Identity) -> str:
    given = [line for variable in statement.variables for line in bound(variable)]
    sides = f"{expression(statement.left)} = {expression(statement.right)}"
    return quantified(sorted(statement.names), given, sides)


@proposition.register
def _(statement: Implies) -> str:
    given = [line for variable in statement.variables for line in bound(variable)]
    given += map(relation, statement.hypotheses)
    return quantified([v.name for v in statement.variables], given, relation(statement.conclusion))


@proposition.register
def _(statement: ForSmall) -> str:
    """Hypotheses without the small variable come before the threshold, which may depend on them."""
    small, unit = identifier(statement.small), [identifier(name) for name in statement.bounded]
    before, later = small_hypotheses(statement)
    given = [line for variable in statement.variables for line in bound(variable)]
    given += map(relation, before)
    over = "".join(f"forall {t} : R, 0 < {t} <= 1 -> " for t in unit)
    conclusion = quantified([], map(relation, later), relation(statement.conclusion))
    threshold = (
        f"exists small : R, 0 < small /\\ forall {small} : R, 0 < {small} < small -> {over}{conclusion}"
    )
    return quantified([v.name for v in statement.variables], given, threshold)


@proposition.register
def _(statement: Agrees) -> str:
    """That some inputs within half a unit give a result within half a unit."""
    rows = [(identifier(name), printed_range(text)) for name, text in statement.inputs]
    rows.append((expression(statement.formula), printed_range(statement.printed)))
    within = (f"{rational(ends.lower)} <= {value} <= {rational(ends.upper)}" for value, ends in rows)
    some = "".join(f"exists {identifier(name)} : R, " for name, _ in statement.inputs)
    return some + " /\\ ".join(within)


@proposition.register
def _(statement: NormBound) -> str:
    x, n = identifier("x"), statement.n
    size = expression(statement.bound) + (f" * norm {n} x" if statement.power else "")
    entries = f"fun i => (fun {x} => {expression(statement.component)}) (x i)"
    return f"forall x : vec, norm {n} ({entries}) <= {size}"


@proposition.register
def _(statement: Property) -> str:
    """Of the loop (11) or V of (13), for every ε₀ > 0; the bounds that it follows from are not part of it."""
    name, _ = property_of(statement)
    of = member_of if statement.name in (EQUILIBRIUM, AN_EQUILIBRIUM) else member_of_energy
    return f"{name} {of(statement.argument)}"


def property_of(statement: Property) -> tuple[str, str]:
    """What Coq calls a property, and the theorem that shows it.

    Raises:
        NotPrinted: it calls it nothing.
    """
    names = PROPERTIES.get((statement.name, statement.argument.system.desired))
    if names is None:
        raise NotPrinted(f"the property “{statement.name}”")
    return names


@proposition.register
def _(statement: Stable) -> str:
    """Stability, uniform where the goal moves; conditions on constants are dropped, which says more."""
    said = "tracks" if statement.argument.system.desired else "is_stable"
    return f"forall n : nat, every_robot_{said} n {member_of(statement.argument)}"


@proposition.register
def _(statement: StableArm) -> str:
    if statement.argument.system.desired:
        numbers = dict(statement.numbers)
        if "vd" not in numbers:
            raise NotPrinted("a goal of any velocity")
        return f"{_of_arm('certified_tracking', on_one_arm(statement))} {exact(numbers['vd'])}"
    return _of_arm("certified", on_one_arm(statement))


@proposition.register
def _(statement: Decreasing) -> str:
    return _of_arm("certified", statement)


@proposition.register
def _(statement: DampingBelow) -> str:
    gains = statement.with_damping(Fraction(1), Fraction(1))
    return f"damping_below {_loop(gains)} {exact(max(statement.kv))} ({expression(statement.bound)})"


@proposition.register
def _(statement: MassAbove | MassBelow | CoriolisBelow) -> str:
    if statement.parameters:
        raise NotPrinted("a bound for an arm with uncertain numbers")
    end = statement.low if isinstance(statement, MassAbove) else statement.high
    return f"{OF_ARM[type(statement)][0]} {arm(statement.mass, ())} {exact(end)}"


@proposition.register
def _(statement: MassSymmetric | CoriolisAtRest | RateOfMass | RateLessTwiceCoriolis) -> str:
    if not isinstance(statement, MassSymmetric) and statement.printed:
        raise NotPrinted("a printed Coriolis matrix")
    return f"{OF_ARM[type(statement)][0]} {any_arm(statement.mass, statement.parameters)}"


def _of_arm(name: str, statement: Decreasing) -> str:
    return f"{name} {_loop(statement)} {exact(statement.eps0)}"


def _loop(statement: Decreasing) -> str:
    """Arm, m, K_p and K_v."""
    if statement.coupling:
        raise NotPrinted("V with weights Λ")
    if statement.family != "hyperbolic" or statement.m is None:
        raise NotPrinted(f"the function {statement.family}")
    if any(low != high for low, high in statement.viscous) or statement.parameters:
        raise NotPrinted("an arm with uncertain numbers")
    data = arm(statement.mass, [low for low, _ in statement.viscous])
    return f"{data} {statement.m} {exact_list(statement.kp)} {exact_list(statement.kv)}"


def small_hypotheses(statement: ForSmall) -> tuple[list[Relation], list[Relation]]:
    """Those that are given before the threshold, and those with the small or a bounded variable in them."""
    free = {statement.small, *statement.bounded}
    within = [bool(variables(one.gap) & free) for one in statement.hypotheses]
    pairs = list(zip(statement.hypotheses, within, strict=True))
    return [one for one, inside in pairs if not inside], [one for one, inside in pairs if inside]
