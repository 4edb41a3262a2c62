"""How Coq is to see that one side exceeds another: no term of the difference is negative."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from fractions import Fraction

from lyapcheck.check.expressions.expression import CONSTANTS, Tree
from lyapcheck.check.kinds.bound_every_n import terms_of
from lyapcheck.kernel.terms import expression, identifier, rational

Monomial = tuple[tuple[str, int], ...]


def spare(upper: Tree, right: Tree) -> str:
    """That ``right`` exceeds ``upper``: they are equal, or no term of the difference is negative."""
    roots: set[str] = set()
    difference = terms_of(_plain(("add", right, ("neg", upper)), roots))
    groups: dict[Monomial, dict[Monomial, Fraction]] = {}
    for c, powers in difference:
        value = Fraction(int(c.p), int(c.q))
        constants: Counter[str] = Counter()
        monomial: Counter[str] = Counter()
        for name, k in powers.items():
            root = name.startswith("sqrt ")
            value *= Fraction(name.split()[1]) ** (k // 2) if root else 1
            (constants if " " in name else monomial)[name] += k % 2 if root else k
        place, fixed = (tuple(sorted((+some).items())) for some in (monomial, constants))
        groups.setdefault(place, {})
        groups[place][fixed] = groups[place].get(fixed, Fraction(0)) + value
    squares = "".join(
        f"assert (Q{k} : sqrt {a} * sqrt {a} = {a}) by (apply sqrt_sqrt; lra). "
        for k, a in enumerate(sorted(roots))
    )
    using = " ".join(f"Q{k}" for k, _ in enumerate(roots))
    known = f"field [{using}]" if using else "field"
    sums = []
    for place, constant in groups.items():
        parts = [" * ".join([rational(c), *_repeated(fixed, str)]) for fixed, c in constant.items() if c]
        if parts:
            sums.append(f"(({' + '.join(parts)}) * ({' * '.join(_repeated(place, identifier)) or '1'}))")
    if not sums:
        return f"{squares}right. {known}."
    steps = "".join(
        f"assert (0 <= {one}) by (apply Rmult_le_pos; [first [solve [nonneg] | lra | numbers]|nonneg]). "
        for one in sums
    )
    both = f"{expression(upper)} + ({' + '.join(sums)})"
    return f"{squares}{steps}apply Rle_trans with ({both}); [lra|right; {known}]."


def _repeated(powers: Monomial, printed: Callable[[str], str]) -> Iterator[str]:
    return (printed(name) for name, k in powers for _ in range(k))


def _plain(tree: Tree, roots: set[str]) -> Tree:
    """An expression with constants and roots as variables, whose names have a blank in them."""
    kind, *parts = tree
    if kind in CONSTANTS:
        return ("var", f"{kind} {parts[0]}")
    if kind == "sqrt" and parts[0][0] == "num":
        roots.add(str(parts[0][1]))
        return ("var", f"sqrt {parts[0][1]}")
    return (kind, *(_plain(part, roots) if isinstance(part, tuple) else part for part in parts))
