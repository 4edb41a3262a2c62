"""How Coq is to prove an implication between inequalities: by the identity of signs of its certificate.

With gaps g = t/b, t and b polynomials and b > 0: lift · t = Σ weight · monomial · t_k + R, where no term of R
is negative.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from flint import fmpq, fmpq_mpoly

from lyapcheck.check.expressions.expression import evaluate
from lyapcheck.check.expressions.normal_form import Ratio
from lyapcheck.check.kinds.implies import Implies, signs_of
from lyapcheck.check.kinds.signs import SignIdentity, Signs
from lyapcheck.check.kinds.signs import _below as below
from lyapcheck.check.numbers.enclosure import Enclosure
from lyapcheck.check.statement import Relation
from lyapcheck.kernel.terms import NotPrinted, expression, identifier, rational


def implication(statement: Implies, proof: SignIdentity) -> str:
    """The tactics.

    Raises:
        NotPrinted: a generator of its polynomials is not a variable or a root of a number.
    """
    signs = signs_of(statement)
    plain, shifted, known, roots = _generators(statement, signs)
    root = roots[0] if roots else "I"
    given = [variable for variable in statement.variables if variable.low is not None]
    names = [f"V{k}" for k, _ in enumerate(given)] + [f"H{k}" for k, _ in enumerate(statement.hypotheses)]
    lines = [f"intros {' '.join([*(identifier(v.name) for v in statement.variables), *names])}. {known}"]
    used = sorted({multiple.hypothesis for multiple in proof.multiples})
    for k in used:
        top, strict = signs.hypotheses[k]
        gap, bottom = _gap(statement.hypotheses[k], signs, plain)
        sign, rule = ("<", "Rmult_lt_0_compat; [lra|") if strict else ("<=", "Rmult_le_pos; [lra|left; ")
        shown = _text(top, shifted)
        lines.append(
            f"assert (G{k} : 0 {sign} {shown}). {{ replace ({shown}) with ({gap} * ({bottom})) "
            f"by quotients {root}. apply {rule}positive]. }} "
        )
    goal = signs.conclusion
    lift = signs.ring.from_dict({signs.exponents(proof.lift): fmpq(1)})
    remainder = goal * lift
    terms = []
    for multiple in proof.multiples:
        top = signs.hypotheses[multiple.hypothesis][0]
        over = signs.ring.from_dict(
            {signs.exponents(multiple.monomial): fmpq(multiple.weight.numerator, multiple.weight.denominator)}
        )
        remainder -= over * top
        terms.append(f"({_text(over, shifted)}) * ({_text(top, shifted)})")
    total = " + ".join([*terms, *([f"({_text(remainder, shifted)})"] if remainder != 0 else [])]) or "0"
    gap, bottom = _gap(statement.conclusion, signs, plain)
    strict = statement.conclusion.strict
    theorem, sign, last = ("gap_positive", "<", "positive") if strict else ("gap_nonnegative", "<=", "nonneg")
    lines.append(
        f"enough (0 {sign} {gap}) by lra. apply ({theorem} _ ({bottom}) ({_text(goal, shifted)}) "
        f"({_text(lift, shifted)}) ({total})); [quotients {root}|positive|positive|field|{last}]."
    )
    return "".join(lines)


def _generators(statement: Implies, signs: Signs) -> tuple[list[str], list[str], str, list[str]]:
    """The generators, without and with the shift, and what Coq has to know of roots."""
    known = {variable.name: variable for variable in statement.variables}
    plain, shifted = [], []
    for name in signs.algebra.names:
        low = known[name].low
        plain.append(identifier(name))
        shifted.append(f"({identifier(name)} - {rational(low)})" if low else identifier(name))
    lines, roots = [], []
    for (name, argument), _ in sorted(signs.algebra.uses.items(), key=lambda item: item[1]):
        if name != "sqrt" or not argument.isdigit():
            raise NotPrinted(f"an identity of signs with {name}")
        k = len(plain)
        low = _below(signs, k)
        plain.append(f"(sqrt {argument})")
        shifted.append(f"(sqrt {argument} - {rational(low)})")
        lines.append(
            f"assert (Q{k} : sqrt {argument} * sqrt {argument} = {argument}) by (apply sqrt_sqrt; lra). "
            f"assert (R{k} : 0 < sqrt {argument}) by (apply sqrt_lt_R0; lra). "
            f"assert (S{k} : 0 <= sqrt {argument} - {rational(low)}) by interval. "
        )
        roots.append(f"Q{k}")
    return plain, shifted, "".join(lines), roots


def _below(signs: Signs, index: int) -> Fraction:
    """The number by which a root was shifted."""
    value = below(Enclosure.from_arb(signs.algebra.constants()[index]).lower)
    return Fraction(int(value.p), int(value.q))


def _gap(relation: Relation, signs: Signs, plain: Sequence[str]) -> tuple[str, str]:
    """The gap of a relation as it stands, and its denominator as a polynomial."""
    values: dict[str, Ratio] = {name: signs.algebra.variable(name) for name in signs.algebra.names}
    ratio = evaluate(relation.gap, values, signs.algebra)
    return (
        f"({expression(relation.right)} - {expression(relation.left)})",
        _text(signs.algebra.reduced(ratio.bottom), plain),
    )


def _text(polynomial: fmpq_mpoly, generators: Sequence[str]) -> str:
    """A polynomial in generators."""
    terms = []
    for exponents, c in polynomial.to_dict().items():
        powers = (f"{g} ^ {e}" if e > 1 else g for g, e in zip(generators, exponents, strict=False) if e)
        terms.append(" * ".join([rational(Fraction(int(c.p), int(c.q))), *powers]))
    return f"({' + '.join(terms)})" if terms else "0"
