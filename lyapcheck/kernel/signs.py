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
from lyapcheck.check.kinds.for_small import ForSmall, LeadingTerm, leading_term
from lyapcheck.check.kinds.for_small import signs_of as small_signs
from lyapcheck.check.kinds.implies import Implies, SignIdentity, Signs, signs_of
from lyapcheck.check.numbers.polynomials import Enclosure, fraction
from lyapcheck.check.statement import Relation, Variable
from lyapcheck.kernel.statements import small_hypotheses
from lyapcheck.kernel.terms import NotPrinted, expression, identifier, rational


def implication(statement: Implies, proof: SignIdentity) -> str:
    """The tactics.

    Raises:
        NotPrinted: a generator of its polynomials is not a variable or a root of a number.
    """
    by = _Identity(statement.variables, statement.hypotheses, signs_of(statement))
    given = [f"V{k}" for k, v in enumerate(statement.variables) if v.low is not None]
    given += [f"H{k}" for k, _ in enumerate(statement.hypotheses)]
    names = (identifier(v.name) for v in statement.variables)
    return (
        f"intros {' '.join([*names, *given])}. {by.known}{by.gaps(proof)}"
        f"{by.concluded(statement.conclusion, by.signs.conclusion, proof)}"
    )


def for_small(statement: ForSmall, proof: LeadingTerm) -> str:
    """The tactics: with the leading term ℓ and B >= 0, the gap is at least εᵃtᵇ(ℓ − εB) as long as ε, t <= 1.

    Raises:
        NotPrinted: as of an implication.
    """
    signs = small_signs(statement)
    lead = leading_term(signs, statement)
    if lead is None:
        raise NotPrinted("a leading term that is not one")
    more = tuple(Variable(name, Fraction(0)) for name in (statement.small, *statement.bounded))
    by = _Identity((*statement.variables, *more), statement.hypotheses, signs)
    before, _ = small_hypotheses(statement)
    given = [f"V{k}" for k, v in enumerate(statement.variables) if v.low is not None]
    given += [f"H{k}" if one in before else "" for k, one in enumerate(statement.hypotheses)]
    later = " ".join(f"H{k}" for k, one in enumerate(statement.hypotheses) if one not in before)
    names = [identifier(v.name) for v in statement.variables]
    small = identifier(statement.small)
    place = signs.algebra.names.index(statement.small)
    free = [signs.algebra.names.index(n) for n in statement.bounded if n in signs.algebra.names]
    terms = {tuple(map(int, e)): c for e, c in signs.conclusion.to_dict().items()}
    lowest = {k: min(e[k] for e in terms) for k in (place, *free)}
    common = " * ".join(["1", *(f"{by.shifted[k]} ^ {low}" for k, low in lowest.items())])
    sizes, above, ones = [], [], []
    for exponents, c in terms.items():
        rest = [e - lowest.get(k, 0) for k, e in enumerate(exponents)]
        if rest[place] == 0:
            continue
        units = [f"{by.shifted[k]} ^ {e}" for k in lowest if (e := rest[k] - (k == place))]
        rest = [0 if k in lowest else e for k, e in enumerate(rest)]
        size = _text(signs.ring.from_dict({tuple(rest): abs(c)}), by.shifted)
        unit = f"({' * '.join(units) or '1'})"
        sizes.append(size)
        if c > 0:
            above.append(f"{size} * {small} * (1 + {unit})")
        elif units:
            ones.append(f"assert (0 <= 1 - {unit}) by below_one. ")
            above.append(f"{size} * {small} * (1 - {unit})")
    least, most = _text(lead, by.shifted), " + ".join(sizes) or "0"
    total = f"({common}) * ({' + '.join([f'({least} - {small} * ({most}))', *above])})"
    units_in = "".join(f" {identifier(n)} [T{k} S{k}]" for k, n in enumerate(statement.bounded))
    gap, bottom = by.gap(statement.conclusion)
    return (
        f"intros {' '.join([*names, *filter(None, given)])}. {by.known}{by.gaps(proof.identity)}"
        f"assert (Lead : 0 < {least}). {{ {by.shown(lead, proof.identity, strict=True)} }} "
        f"destruct (small_enough ({least}) ({most}) Lead ltac:(nonneg)) as (small & P & S). exists small. "
        f"split; [exact P|]. intros {small} [E0 E1]{units_in} {later}. "
        f"destruct (S {small} (conj E0 E1)) as [E2 E3]. "
        f"{''.join(dict.fromkeys(ones))}enough (0 < {gap}) by lra. "
        f"apply (gap_positive _ ({bottom}) ({total}) 1 ({total})); "
        f"[quotients {by.root}|positive|lra|apply Rmult_1_l|apply Rmult_lt_0_compat; positive]."
    )


class _Identity:
    """What Coq is given of the polynomials of an implication."""

    def __init__(self, variables: Sequence[Variable], hypotheses: Sequence[Relation], signs: Signs) -> None:
        self.signs, self.hypotheses = signs, hypotheses
        known = {variable.name: variable for variable in variables}
        # the generators without and with the shift, then what Coq has to know of roots
        self.plain, self.shifted, self.known = list[str](), list[str](), ""
        roots = []
        for name in signs.algebra.names:
            low = known[name].low
            self.plain.append(identifier(name))
            self.shifted.append(f"({identifier(name)} - {rational(low)})" if low else identifier(name))
        for (name, argument), _ in sorted(signs.algebra.uses.items(), key=lambda item: item[1]):
            if name != "sqrt" or not argument.isdigit():
                raise NotPrinted(f"an identity of signs with {name}")
            k = len(self.plain)
            low = Fraction(int(Enclosure.from_arb(signs.algebra.constants()[k]).lower * 16), 16)
            self.plain.append(f"(sqrt {argument})")
            self.shifted.append(f"(sqrt {argument} - {rational(low)})")
            self.known += (
                f"assert (Q{k} : sqrt {argument} * sqrt {argument} = {argument}) by (apply sqrt_sqrt; lra). "
                f"assert (R{k} : 0 < sqrt {argument}) by (apply sqrt_lt_R0; lra). "
                f"assert (S{k} : 0 <= sqrt {argument} - {rational(low)}) by interval. "
            )
            roots.append(f"Q{k}")
        self.root = roots[0] if roots else "I"

    def gap(self, relation: Relation) -> tuple[str, str]:
        """The gap of a relation as it stands, and its denominator as a polynomial."""
        algebra = self.signs.algebra
        values: dict[str, Ratio] = {name: algebra.variable(name) for name in algebra.names}
        bottom = algebra.reduced(evaluate(relation.gap, values, algebra).bottom)
        return f"({expression(relation.right)} - {expression(relation.left)})", _text(bottom, self.plain)

    def gaps(self, proof: SignIdentity) -> str:
        """That the polynomials of the hypotheses that an identity uses are not negative."""
        lines = []
        for k in sorted({multiple.hypothesis for multiple in proof.multiples}):
            top, strict = self.signs.hypotheses[k]
            gap, bottom = self.gap(self.hypotheses[k])
            sign, rule = ("<", "Rmult_lt_0_compat; [lra|") if strict else ("<=", "Rmult_le_pos; [lra|left; ")
            shown = _text(top, self.shifted)
            lines.append(
                f"assert (G{k} : 0 {sign} {shown}). {{ replace ({shown}) with ({gap} * ({bottom})) "
                f"by quotients {self.root}. apply {rule}positive]. }} "
            )
        return "".join(lines)

    def concluded(self, conclusion: Relation, goal: fmpq_mpoly, proof: SignIdentity) -> str:
        """A relation of which the goal has the sign of the gap."""
        gap, bottom = self.gap(conclusion)
        sign = "<" if conclusion.strict else "<="
        return f"enough (0 {sign} {gap}) by lra. {self.shown(goal, proof, conclusion.strict, bottom)}"

    def shown(self, goal: fmpq_mpoly, proof: SignIdentity, strict: bool, bottom: str = "1") -> str:
        """That a number, ``bottom`` times which is the goal, is not negative: lift · goal is a sum."""
        signs = self.signs
        lift = signs.ring.from_dict({signs.exponents(proof.lift): fmpq(1)})
        remainder, terms = goal * lift, []
        for multiple in proof.multiples:
            top = signs.hypotheses[multiple.hypothesis][0]
            weight = fmpq(multiple.weight.numerator, multiple.weight.denominator)
            over = signs.ring.from_dict({signs.exponents(multiple.monomial): weight})
            remainder -= over * top
            terms.append(f"({_text(over, self.shifted)}) * ({_text(top, self.shifted)})")
        terms += [f"({_text(remainder, self.shifted)})"] if remainder != 0 else []
        theorem, last = ("gap_positive", "positive") if strict else ("gap_nonnegative", "nonneg")
        given = f"({_text(goal, self.shifted)}) ({_text(lift, self.shifted)}) ({' + '.join(terms) or '0'})"
        return (
            f"apply ({theorem} _ ({bottom}) {given}); [quotients {self.root}|positive|positive|field|{last}]."
        )


def _text(polynomial: fmpq_mpoly, generators: Sequence[str]) -> str:
    """A polynomial in generators."""
    terms = []
    for exponents, c in polynomial.to_dict().items():
        powers = (f"{g} ^ {e}" if e > 1 else g for g, e in zip(generators, exponents, strict=False) if e)
        terms.append(" * ".join([rational(fraction(c)), *powers]))
    return f"({' + '.join(terms)})" if terms else "0"
