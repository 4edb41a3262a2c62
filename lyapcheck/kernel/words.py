"""How Coq is to prove a statement for every n: dot products become sums of words, each with a bound.

``formal/Words.v`` has the theorems; where a cover in a certificate says which norms bound a term, Coq gets
the product of these.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from fractions import Fraction

from lyapcheck.check.expressions.expression import CONSTANTS, Tree
from lyapcheck.check.kinds.bound_every_n import BoundEveryN, CoveredTerms, terms_in_words, terms_of
from lyapcheck.check.kinds.every_n import EveryN
from lyapcheck.check.letters.words import Word, Words
from lyapcheck.check.numbers.polynomials import fraction
from lyapcheck.check.statement import Proof
from lyapcheck.kernel.terms import NotPrinted, expression, identifier, letters_of, rational


class Unmerged(Words):
    """Expressions in words, each by itself: that two are equal is for Coq to see."""

    def _variable(self, word: Word) -> Tree:
        name = " ".join(f"{kind}({name})" for kind, name in word)
        self.seen[name] = {word}
        return ("var", name)


def every_n_script(statement: EveryN | BoundEveryN, proof: Proof) -> str:
    """The tactics.

    Raises:
        NotPrinted: the statement or its proof has no form in Coq.
    """
    if isinstance(statement, EveryN):
        return _Lines(statement).identity()
    if not isinstance(proof, CoveredTerms):
        raise NotPrinted(f"a bound for every n by {proof.rule}")
    return _Lines(statement).bound(statement, proof)


class _Lines:
    """The tactics for one statement; places of letters are those in its lists."""

    def __init__(self, statement: EveryN | BoundEveryN) -> None:
        names = letters_of(statement)
        self.statement = statement
        self.symmetric = (
            statement.symmetric if isinstance(statement, EveryN) else statement.identity.symmetric
        )
        self.vectors, self.matrices = names["vec"], names["mat"]
        lists = (" ; ".join(map(identifier, some)) for some in (self.vectors, self.matrices))
        self.place = "n [{}] [{}]".format(*lists)
        self.words = Unmerged((), {}, {})
        self.intros = (
            f"intros n {' '.join(identifier(name) for kind in names for name in names[kind])}; intros"
        )

    def identity(self) -> str:
        """Both sides in words are the same."""
        statement = self.statement
        lines = [f"{self.intros}. ", self.in_words(statement.left, statement.right)]
        self.words.number(statement.left)
        self.words.number(statement.right)
        merged = Words(self.symmetric, {}, {})
        first: dict[str, Word] = {}
        for [word] in self.words.seen.values():
            other = first.setdefault(str(merged._variable(word)[1]), word)
            if other != word:
                lines.append(self.same(word, other))
        return "".join(lines) + "identical."

    def same(self, word: Word, other: Word) -> str:
        """Put a word in the place of an equal one."""
        first, last = (self.vectors.index(name) for _, name in (other[0], other[-1]))
        own, others = ("; ".join(map(self.factor, one[1:-1])) for one in (word, other))
        straight = f"apply (word_same {self.place} {first} [{own}] [{others}] {last}); all_same"
        back = f"(rev (map Words.turned [{own}]))"
        turned = f"apply (word_same {self.place} {first} {back} [{others}] {last}); cbn; all_same"
        turned = f"etransitivity; [exact (word_turned {self.place} {last} [{own}] {first})|{turned}]"
        entries = "unfold dot; apply Loop.sum_ext; intros; ring"
        steps = f"first [{turned} | {straight} | {entries}]"
        return f"try replace ({self.word(word)}) with ({self.word(other)}) by (symmetry; {steps}). "

    def in_words(self, *trees: Tree) -> str:
        """Put words in the place of dot products in the goal."""
        dots = dict.fromkeys(dot for tree in trees for dot in _dots(tree))
        return "".join(
            f"in_words (dot_words {self.place} {self.reified(x)} {self.reified(y)}). " for _, x, y in dots
        )

    def reified(self, tree: Tree) -> str:
        """A vector as ``formal/Words.v`` writes it."""
        kind, *parts = tree
        if kind == "vec":
            return f"(Entry {self.vectors.index(parts[0])})"
        if kind == "sum":
            whole = "Zero" if not parts else self.reified(parts[0])
            for part in parts[1:]:
                whole = f"(Plus {whole} {self.reified(part)})"
            return whole
        if kind == "scale":
            return f"(Times {expression(parts[0])} {self.reified(parts[1])})"
        if parts[0][0] == "diag":
            return f"(Diagonal {self.vectors.index(parts[0][1])} {self.reified(parts[1])})"
        return f"(Applied {self.reified_matrix(parts[0])} {self.reified(parts[1])})"

    def reified_matrix(self, tree: Tree) -> str:
        """A matrix as ``formal/Words.v`` writes it."""
        kind, *parts = tree
        if kind == "mat":
            return f"(Letter {self.matrices.index(parts[0])})"
        if kind == "scale":
            return f"(Scaled {expression(parts[0])} {self.reified_matrix(parts[1])})"
        if kind == "transpose":
            return f"(Turned {self.reified_matrix(parts[0])})"
        whole = "Nothing" if not parts else self.reified_matrix(parts[0])
        for part in parts[1:]:
            whole = f"(Sum {whole} {self.reified_matrix(part)})"
        return whole

    def bound(self, statement: BoundEveryN, proof: CoveredTerms) -> str:
        """Each term is at most its bound, and the right side their sum."""
        terms, merged = terms_in_words(statement)
        whole = (tuple(sorted(powers.items())) for _, powers in terms)
        covers = dict(zip(whole, proof.covers, strict=True))
        names = [f"P{k}" for k, _ in enumerate(statement.numbers)]
        names = [f"S{k}" for k, _ in enumerate(statement.symmetric)] + names
        names += [f"N{k}" for k, _ in enumerate(statement.norms)] + [
            f"K{k}" for k, _ in enumerate(statement.least)
        ]
        lines = [f"{self.intros} {' '.join(names)}. plain_sizes. "]
        sums: list[str] = []
        sizes: list[tuple[Fraction, Tree]] = []
        for k, (c, powers) in enumerate(terms_of(self.words.number(statement.left))):
            place: Counter[str] = Counter()
            for name, power in powers.items():  # under the name that the certificate has for an unmerged word
                words = self.words.seen.get(name, ())
                place[next((str(merged._variable(word)[1]) for word in words), name)] += power
            cover = covers.get(tuple(sorted(place.items())))
            if cover is None:
                raise NotPrinted("terms that cancel once diagonal matrices change places")
            value = fraction(c)
            if cover.least is None:
                line, term, size = self.by_norms(k, statement, powers, cover.norms)
            else:
                line, term, size = self.by_least(k, statement, powers, cover.least)
            lines.append(line)
            sums.append(f"{rational(value)} * ({term})")
            sizes.append((abs(value) if cover.least is None else value, size))
        left = " + ".join(sums) or "0"
        upper = ("add", ("num", "0"), *(("mul", ("num", str(c)), size) for c, size in sizes))
        lines.append(f"apply Rle_trans with {expression(upper)}. ")
        lines.append(
            f"{{ apply Rle_trans with ({left}). {{ right. {self.in_words(statement.left)}field. }} lra. }} "
        )
        return "".join(lines) + spare(upper, statement.right)

    def parted(self, powers: dict[str, int]) -> tuple[list[Tree], list[Word]]:
        """The numbers and the words of a term."""
        each = [name for name, power in powers.items() for _ in range(power)]
        numbers: list[Tree] = [("var", name) for name in each if name not in self.words.seen]
        return numbers, [word for name in each for word in self.words.seen.get(name, ())]

    def by_least(
        self, k: int, statement: BoundEveryN, powers: dict[str, int], index: int
    ) -> tuple[str, str, Tree]:
        """That one term, without its coefficient, is at least a multiple of a lower bound."""
        numbers, words = self.parted(powers)
        number, least = statement.least[index]
        rest = _product(numbers)
        printed = " * ".join([expression(rest), *map(self.word, words)])
        line = (
            f"assert (T{k} : {expression(rest)} * {expression(least)} <= {printed}). "
            f"{{ apply Rmult_le_compat_l; [nonneg|]. revert K{index}. {self.in_words(number)}lra. }} "
        )
        return line, printed, ("mul", rest, least)

    def by_norms(
        self, k: int, statement: BoundEveryN, powers: dict[str, int], norms: Iterable[int]
    ) -> tuple[str, str, Tree]:
        """That one term, without its coefficient, is at most a product: tactics, the term, the product."""
        numbers, words = self.parted(powers)
        groups: list[str] = []
        sizes: list[Tree] = []
        by_matrix: dict[Tree, str] = {}
        spent: Counter[Tree] = Counter()
        for index in norms:
            letters, size = statement.norms[index]
            spent.update(letters)
            sizes.append(size)
            if letters[0][0] in ("mat", "diag"):
                by_matrix[letters[0]] = expression(size)
                groups.append(expression(size))
            else:
                groups.append(" * ".join(map(_norm, letters)))
        rest = _product(list((Counter(numbers) - spent).elements()))
        bounds, proofs = [], []
        for word in words:
            _, first = word[0]
            _, last = word[-1]
            factors = "; ".join(map(self.factor, word[1:-1]))
            letters_of_word = (("mat" if kind == "transposed" else kind, name) for kind, name in word[1:-1])
            own = [by_matrix.get(letter, "0") for letter in letters_of_word]
            places = f"{self.vectors.index(first)} [{factors}] {self.vectors.index(last)} [{'; '.join(own)}]"
            inner = "".join(f"{size} * (" for size in own) + "1" + ")" * len(own)
            bounds.append(f"norm n {identifier(first)} * ({inner} * norm n {identifier(last)})")
            proofs.append(f"exact (word_at_most {self.place} {places} ltac:(all_sized))")
        term = bounded = expression(_product(numbers))
        steps = "rewrite Rabs_pos_eq by nonneg; apply Rle_refl"
        for word, bound, own_proof in zip(words, bounds, proofs, strict=True):
            term, bounded = f"{term} * {self.word(word)}", f"{bounded} * ({bound})"
            steps = f"apply within_product; [{steps}|{own_proof}]"
        grouped = " * ".join(f"({group})" for group in [*groups, expression(rest)])
        product = " * ".join(f"({text})" for text in [*map(expression, sizes), expression(rest)])
        line = (
            f"assert (T{k} : Rabs ({term}) <= {product}) by (apply Rle_trans with ({bounded}); "
            f"[{steps}|replace ({bounded}) with ({grouped}) by ring; products]). "
            f"apply Rabs_le_between in T{k}. "
        )
        return line, term, _product([*sizes, rest])

    def factor(self, letter: tuple[str, str]) -> str:
        """A factor of a word as ``formal/Words.v`` writes it."""
        kind, name = letter
        where = self.vectors if kind in ("diag", "vec") else self.matrices
        return {"diag": "D", "mat": "A", "transposed": "T"}[kind] + f" {where.index(name)}"

    def word(self, word: Word) -> str:
        """A word in the form that Coq's computing gives it."""
        (_, first), *middle, (_, last) = word
        value, atom = identifier(last), True
        for kind, name in reversed(middle):
            if kind == "diag":
                value, atom = f"{identifier(name)} i * {value + ' i' if atom else value}", False
                continue
            own = identifier(name) if kind == "mat" else f"(fun i j => {identifier(name)} j i)"
            value, atom = f"(apply_ n {own} {value if atom else f'(fun i => {value})'})", True
        return f"dot n {identifier(first)} {value if atom else f'(fun i => {value})'}"


def _norm(letter: Tree) -> str:
    return identifier(letter[1]) if letter[0] == "var" else f"norm n {identifier(letter[1])}"


def _product(trees: list[Tree]) -> Tree:
    if not trees:
        return ("num", "1")
    first, *rest = trees
    return ("mul", first, *rest) if rest else first


def _dots(tree: Tree) -> Iterator[Tree]:
    if tree[0] == "dot":
        yield tree
    for part in tree[1:]:
        if isinstance(part, tuple):
            yield from _dots(part)


# --- How Coq is to see that one side exceeds another: no term of the difference is negative.


Monomial = tuple[tuple[str, int], ...]


def spare(upper: Tree, right: Tree) -> str:
    """That ``right`` exceeds ``upper``: they are equal, or no term of the difference is negative."""
    roots: set[str] = set()
    difference = terms_of(_plain(("add", right, ("neg", upper)), roots))
    groups: dict[Monomial, dict[Monomial, Fraction]] = {}
    for c, powers in difference:
        value = fraction(c)
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
