"""Numbers made of vectors and matrices, as expressions in words.

A word is xᵀ A B … y with letters for the vectors and the matrices, a number for every n. Expanded by
linearity, an expression in dot products is one in words, each of which becomes a variable. Words that are
equal for every n are made the same variable by these laws and no others:

     xᵀ A … y = yᵀ … Aᵀ x   Aᵀ = A for symmetric A   diag(x) y = diag(y) x   diag(x) diag(y) = diag(y) diag(x)

and A x = b, where that is given, from left to right.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from itertools import groupby, product

from lyapcheck.check.expressions.expression import Tree, Unsupported
from lyapcheck.check.letters import rate

Letter = tuple[str, str]
"""``vec``, ``diag``, ``mat`` or ``transposed``, and the name."""
Word = tuple[Letter, ...]
Sum = dict[Word, Tree]
"""A vector or matrix as Σ coefficient · word; a word of a vector ends in its ``vec``."""
MAX_WORDS, MAX_PAIRS = 20_000, 200_000
ONE: Tree = ("num", "1")
TURNED = {"mat": "transposed", "transposed": "mat"}


class Words:
    """Expressions in words.

    Args:
        symmetric: the names of the matrices with Aᵀ = A.
        rates: the derivatives of the letters.
        given: b for each pair (A, x) of names with A x = b; no b contains such an x.

    ``seen`` lists, for the variable of each word, all words that it stands for as they came up.
    """

    def __init__(
        self, symmetric: Iterable[str], rates: Mapping[Tree, Tree], given: Mapping[tuple[str, str], Tree]
    ) -> None:
        self.symmetric, self.rates = frozenset(symmetric), rates
        self.seen: dict[str, set[Word]] = {}
        self.given: dict[tuple[str, str], Sum] = {}
        self.given = {pair: self.expand(tree) for pair, tree in given.items()}

    def number(self, tree: Tree) -> Tree:
        """A number as an expression in variables alone, words among them.

        Soundness: every law above holds for all n, vectors and matrices. So where the results for two numbers
        are the same function of their variables, the numbers are equal.
        """
        if tree[0] == "rate":
            return self.number(rate(tree[1], self.rates))
        if tree[0] == "dot":
            left, right = self.expand(tree[1]), self.expand(tree[2])
            # one word may come from several pairs: their coefficients add up
            whole = _collected(
                ((*self.transposed(x), *y), ("mul", s, t))
                for (x, s), (y, t) in product(left.items(), right.items())
            )
            return _total(("mul", c, self._variable(word)) for word, c in self._settled(whole))
        return tuple(self.number(part) if isinstance(part, tuple) else part for part in tree)

    def expand(self, tree: Tree) -> Sum:
        """A vector or a matrix as a sum of words, unless there are too many (``Unsupported``)."""
        kind, *rest = tree
        if kind in ("vec", "diag", "mat"):
            return {((kind, rest[0]),): ONE}
        if kind == "transpose":
            return _collected((self.transposed(word), c) for word, c in self.expand(rest[0]).items())
        if kind == "sum":
            return _collected(pair for part in rest for pair in self.expand(part).items())
        if kind == "scale":
            factor = self.number(rest[0])
            return {word: ("mul", factor, c) for word, c in self.expand(rest[1]).items()}
        parts = product(self.expand(rest[0]).items(), self.expand(rest[1]).items())
        return _collected(((*a, *x), ("mul", s, t)) for (a, s), (x, t) in parts)

    def transposed(self, word: Word) -> Word:
        """The transpose: the letters in reverse order, each transposed."""
        return tuple(
            (TURNED.get(kind, kind) if name not in self.symmetric else kind, name)
            for kind, name in reversed(word)
        )

    def _settled(self, words: Sum) -> Iterator[tuple[Word, Tree]]:
        """The words after what is given has been put in."""
        waiting = list(words.items())
        while waiting:
            word, c = waiting.pop()
            for turned in (word, self.transposed(word)):
                value = self.given.get((turned[-2][1], turned[-1][1])) if turned[-2][0] == "mat" else None
                if value is not None:
                    waiting += [((*turned[:-2], *tail), ("mul", c, d)) for tail, d in value.items()]
                    break
            else:
                yield word, c

    def _variable(self, word: Word) -> Tree:
        """The variable of a word, the same for words that are equal by the laws; ``seen`` keeps them."""
        first = min(_in_order(word), _in_order(self.transposed(word)))
        name = " ".join(f"{kind}({name})" for kind, name in first)
        self.seen.setdefault(name, set()).add(word)
        return ("var", name)


def _in_order(word: Word) -> Word:
    """Neighbours that multiply entry by entry, vectors at the ends included, in the order of their names."""
    result: list[Letter] = []
    for entrywise, run in groupby(word, lambda letter: letter[0] in ("vec", "diag")):
        kinds, names = zip(*run, strict=True)
        result += zip(kinds, sorted(names) if entrywise else names, strict=True)
    return tuple(result)


def _collected(pairs: Iterable[tuple[Word, Tree]]) -> Sum:
    """The sum of the coefficients of each word."""
    result: dict[Word, list[Tree]] = {}
    for count, (word, c) in enumerate(pairs):
        result.setdefault(word, []).append(c)
        if len(result) > MAX_WORDS or count > MAX_PAIRS:
            raise Unsupported(f"more than {MAX_WORDS} words, or {MAX_PAIRS} before they are added up")
    return {word: _total(parts) for word, parts in result.items()}


def _total(parts: Iterable[Tree]) -> Tree:
    trees = list(parts)
    return ("add", *trees) if trees else ("num", "0")
