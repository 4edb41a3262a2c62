"""How Coq is to prove what a certificate shows: hints only, which it follows or refuses.

Everything here may be wrong without harm: a script that does not prove its statement is refused by ``coqc``.
"""

from __future__ import annotations

import math
from fractions import Fraction
from functools import singledispatch

from lyapcheck.check.expressions.expression import Tree, nodes
from lyapcheck.check.kinds.all_of import AllOf, EveryPart, OnePart
from lyapcheck.check.kinds.bound_every_n import BoundEveryN
from lyapcheck.check.kinds.constant import (
    Agrees,
    Constant,
    Corners,
    OutsideRounding,
    at_printed,
    printed_range,
)
from lyapcheck.check.kinds.decreasing import DampingAbove, DampingBelow, Decreasing, StateWitness
from lyapcheck.check.kinds.every_n import EveryN
from lyapcheck.check.kinds.for_all import ForAll
from lyapcheck.check.kinds.for_small import ForSmall, LeadingTerm
from lyapcheck.check.kinds.gate_accepted import GateAccepted, GateParts
from lyapcheck.check.kinds.identity import Identity
from lyapcheck.check.kinds.implies import Implies, SignIdentity
from lyapcheck.check.kinds.inertia import OfArm
from lyapcheck.check.kinds.norm_bound import NormBound
from lyapcheck.check.kinds.sampled import SampledStable
from lyapcheck.check.kinds.stability import Property, Stable
from lyapcheck.check.kinds.stable_arm import StableArm
from lyapcheck.check.numbers.members import member
from lyapcheck.check.statement import Proof, Statement, Witness
from lyapcheck.kernel.arms import arm_script, by_norms, property_script
from lyapcheck.kernel.gate import facts, gate_refutation_script, gate_script, sampled_script
from lyapcheck.kernel.signs import for_small, implication
from lyapcheck.kernel.statements import property_of
from lyapcheck.kernel.terms import (
    NotPrinted,
    bound,
    exact,
    exact_list,
    expression,
    identifier,
    on_one_arm,
    rational,
)
from lyapcheck.kernel.words import every_n_script

X: Tree = ("var", "x")


def script(statement: Statement, proof: Proof, verdict: str) -> str:
    """The tactics for what :func:`lyapcheck.kernel.statements.shown` prints.

    Raises:
        NotPrinted: there is no way to prove it yet.
    """
    if isinstance(statement, Decreasing) and (verdict == "proved" or isinstance(proof, StateWitness)):
        return arm_script(statement, proof)
    if isinstance(statement, DampingBelow) and isinstance(proof, DampingAbove):
        # gains that break the bound, for which dV/dt < 0 is proved
        decreasing = arm_script(statement.with_damping(proof.factor, proof.eps0), proof.decreasing)
        numbers = f"{exact(proof.factor)} {exact(proof.eps0)}"
        return (
            f"{facts(statement)}apply (damping_above _ _ _ _ _ _ {numbers}); "
            f"[reflexivity|reflexivity|{decreasing.rstrip('.')}|open_rationals; numbers]."
        )
    if verdict == "proved":
        return facts(statement) + proved(statement, proof)
    if isinstance(statement, AllOf) and isinstance(proof, OnePart):
        return script(statement.parts[proof.part][1], proof.proof, verdict)
    if isinstance(statement, GateAccepted):
        return gate_refutation_script(statement, proof)
    return facts(statement) + _refuted(statement, proof)


@singledispatch
def proved(statement: Statement, proof: Proof) -> str:
    """The proof of a statement.

    Raises:
        NotPrinted: there is none yet.
    """
    raise NotPrinted(f"a proof of the kind {type(statement).__name__}")


proved.register(Decreasing, arm_script)
proved.register(SampledStable, sampled_script)
proved.register(EveryN | BoundEveryN, every_n_script)
proved.register(OfArm, property_script)


@proved.register
def _(statement: AllOf, proof: Proof) -> str:
    if not isinstance(proof, EveryPart):
        raise NotPrinted(f"a conjunction by {proof.rule}")
    each = zip(statement.parts, proof.parts, strict=True)
    parts = [f"{{ {proved(part, own)} }}" for (_, part), own in each]
    return (
        "".join(f"split; [|]. {part} " for part in parts[:-1]).replace("split; [|]. ", "split. ") + parts[-1]
    )


@proved.register
def _(statement: GateAccepted, proof: Proof) -> str:
    stability = proof.stability if isinstance(proof, GateParts) else ()
    each = zip(statement.stability, stability, strict=True)
    parts = [gate_script(statement, proof), *(proved(part, own) for part, own in each)]
    return "".join(f"split. {{ {part} }} " for part in parts[:-1]) + parts[-1]


@proved.register
def _(statement: Constant, proof: Proof) -> str:
    return "numbers."


@proved.register
def _(statement: Identity, proof: Proof) -> str:
    return "identity."


@proved.register
def _(statement: Implies, proof: Proof) -> str:
    if not isinstance(proof, SignIdentity):
        raise NotPrinted(f"an implication by {proof.rule}")
    return implication(statement, proof)


@proved.register
def _(statement: ForSmall, proof: Proof) -> str:
    if not isinstance(proof, LeadingTerm):
        raise NotPrinted(f"a threshold by {proof.rule}")
    return for_small(statement, proof)


@proved.register
def _(statement: Agrees, proof: Proof) -> str:
    if isinstance(proof, Corners):
        raise NotPrinted("an agreement that needs the roundings of the inputs")
    inputs = "".join(f"exists {rational(Fraction(text))}. " for _, text in statement.inputs)
    return f"{inputs}repeat split; numbers."


@proved.register
def _(statement: Property, proof: Proof) -> str:
    _, theorem = property_of(statement)
    return f"apply {theorem}; lia."


@proved.register
def _(statement: Stable, proof: Proof) -> str:
    theorem = "tracking" if statement.argument.system.desired else "proposition"
    return f"intros n; apply {theorem}_of_the_paper; lia."


@proved.register
def _(statement: StableArm, proof: Proof) -> str:
    return by_norms(on_one_arm(statement).closed_loop, statement.argument.system.desired)


@proved.register
def _(statement: ForAll, proof: Proof) -> str:
    x, one = identifier(statement.variable), statement.relation
    for side, other, above in ((one.left, one.right, True), (one.right, one.left, False)):
        if side[0] in BOUNDED and side[2] == ("var", statement.variable) and (c := number(other)) is not None:
            m, tactic = side[1], BOUNDED[side[0]]
            most = rational(c if above else -c)
            if c == 0 and not above:
                continue
            name = side[0]
            return (
                f"intros {x}. assert (B : Rabs ({name} {m} {x}) <= {most}) by (revert {x}; {tactic}). "
                "apply Rabs_le_between in B. lra."
            )
    if any(node[0] == "abs" for node in nodes(one.gap)):
        raise NotPrinted("an absolute value")
    return f"intros {x}; intros; signs {x}."


BOUNDED = {"h": "prove_h_at_most", "dh": "prove_dh_at_most"}


def number(tree: Tree) -> Fraction | None:
    """The value of a numeral or of one with a minus."""
    if tree[0] == "num":
        return Fraction(tree[1])
    if tree[0] == "neg" and tree[1][0] == "num":
        return -Fraction(tree[1][1])
    return None


@proved.register
def _(statement: NormBound, proof: Proof) -> str:
    kind = statement.component[0]
    if kind not in BOUNDED or statement.component[2] != X:
        raise NotPrinted("a bound of the norm of another function")
    m = statement.component[1]
    known = member("hyperbolic", m)
    if statement.power == 0:
        own = {"h": (f"gamma {m}", "abs_h_le_gamma"), "dh": (f"rho {m}", "dh_le_rho")}[kind]
        return (
            f"intros x. apply (norm_of_bounded {statement.n} ({kind} {m}) ({own[0]})); "
            f"[apply {own[1]}; lia|replace (INR {statement.n}) with {statement.n} by (simpl; ring); "
            "first [lra | numbers]]."
        )
    if kind != "h":
        raise NotPrinted("a bound of ‖h'(x)‖ by ‖x‖")
    c = number(statement.bound)
    c = known.L if c is None and m == 1 else Fraction(math.ceil(known.L * 1000 + 1), 1000) if c is None else c
    return (
        f"intros x. apply (norm_of_linear {statement.n} (h {m}) {rational(c)}); "
        f"[{secant(m, c)}|lra|first [lra | numbers]]."
    )


def secant(m: int, c: Fraction) -> str:
    """|h_m(x)| <= c |x| for all x."""
    if m == 1:
        return "intros y; pose proof (secant_1 y); pose proof (Rabs_pos y); nra"
    far = rational(Fraction(round(64 * Fraction(3, 2) / c) + 1, 64))
    middle = f"apply (secant_at_most {m} ltac:(lia) {rational(c)} (1 / 2) {far} (3 / 2))"
    return f"{middle}; [lra|lra|prove_h_at_most|lra|prove_near_zero|prove_between]"


def _refuted(statement: Statement, proof: Proof) -> str:
    """That a statement does not hold, as it fails at the point of a witness."""
    if isinstance(statement, Constant):
        return "intros H. fails H."
    if isinstance(statement, Agrees) and isinstance(proof, OutsideRounding):
        # over all roundings of the inputs the formula is on one side of what is printed
        ends, formula = printed_range(statement.printed), expression(statement.formula)
        below = at_printed(statement, proof.bits).upper < ends.lower
        side = f"{formula} < {rational(ends.lower)}" if below else f"{rational(ends.upper)} < {formula}"
        names = [identifier(name) for name, _ in statement.inputs]
        pattern = " & ".join([*names, *(f"K{k}" for k, _ in enumerate(names)), "K"])
        return f"intros ({pattern}). assert ({side}) by numbers. lra."
    if not isinstance(proof, Witness):
        raise NotPrinted(f"a refutation by {type(proof).__name__}")
    point = dict(proof.point)
    if isinstance(statement, NormBound):
        values = exact_list(point[f"x{i + 1}"] for i in range(statement.n))
        return f"intros H. specialize (H (entries {values})). fails H."
    if isinstance(statement, ForAll):
        names, given = [statement.variable], sum(end is not None for end in (statement.low, statement.high))
    elif isinstance(statement, Implies):
        names = [v.name for v in statement.variables]
        given = sum(len(bound(v)) for v in statement.variables) + len(statement.hypotheses)
    elif isinstance(statement, Identity):
        names, given = sorted(statement.names), sum(len(bound(v)) for v in statement.variables)
    else:
        raise NotPrinted(f"a refutation of the kind {type(statement).__name__}")
    values = " ".join(rational(Fraction(point[name])) if name in point else "0" for name in names)
    steps = "".join(" specialize (H ltac:(numbers))." for _ in range(given))
    return f"intros H. specialize (H {values}).{steps} fails H."
