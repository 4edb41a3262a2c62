"""A document as a piece of HTML, for a notebook or a page, with its formulas as MathML.

A reader of ``‖h(x)‖ ≤ √n γ_m for all x in Rⁿ`` knows what is a formula in it and what is not; so does this.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cache
from itertools import groupby
from unicodedata import normalize
from urllib.parse import quote

from lyapcheck.output import document as doc
from lyapcheck.output.escapes import html_text

# --- Elements of HTML, SVG and MathML: markup is made here alone, and text inside it is escaped.


VOID = frozenset({"br", "hr", "img", "input", "link", "meta"})


class Markup(str):
    """Text that is markup already, and is not escaped again."""

    __slots__ = ()

    def __html__(self) -> str:
        """The same: templates ask for it."""
        return self


Child = str | None | Iterable["Child"]


def element(name: str, /, *children: Child, **attributes: str | int | float | bool | None) -> Markup:
    """An element, its text and attributes escaped.

    Args:
        children: text, markup, or any nesting of both; ``None`` is nothing.
        attributes: ``class_`` is class, ``data_m`` is data-m; ``True`` stands without a value, ``None`` and
            ``False`` not at all.
    """
    head = ""
    for key, value in attributes.items():
        called = key.rstrip("_").replace("_", "-")
        if value is True:
            head += f" {called}"
        elif value is not None and value is not False:
            head += f' {called}="{html_text(str(value))}"'
    if name in VOID:
        return Markup(f"<{name}{head}>")
    return Markup(f"<{name}{head}>{joined(children)}</{name}>")


def joined(children: Child) -> Markup:
    """All children one after the other."""
    if children is None:
        return Markup()
    if hasattr(children, "__html__"):
        return Markup(children)
    if isinstance(children, str):
        return Markup(html_text(children))
    return Markup("".join(map(joined, children)))


# --- Documents.


_SIDES = {"l": "left", "r": "right"}
Drawn = Callable[[doc.Figure], Markup | None]


def linked(figure: doc.Figure) -> Markup:
    """A figure as a link to its file."""
    image = element("img", src=quote(figure.path), alt=figure.caption)
    return element("figure", image, element("figcaption", figure.caption))


def render(document: doc.Document, level: int = 2) -> str:
    """The whole document, its title a heading of a level; no script, no style sheet needed."""
    lines = [element(f"h{level}", document.title), *blocks(document.body, level + 1)]
    return "\n".join(lines) + "\n"


def blocks(result: Iterable[doc.Block], level: int, drawn: Drawn = linked) -> Iterator[Markup]:
    """Blocks one after the other.

    Args:
        drawn: what becomes of a figure.
    """
    for block in result:
        match block:
            case doc.Paragraph(text):
                yield element("p", text)
            case doc.Bullets(items):
                yield Markup("<ul>")
                yield from (element("li", item) for item in items)
                yield Markup("</ul>")
            case doc.Equation(_, formula):
                yield latex(formula)
            case doc.Code(text):
                shown = Markup("\n".join(map(html_text, text.splitlines())))
                yield element("pre", element("code", shown))
            case doc.Figure():
                if (shape := drawn(block)) is not None:
                    yield shape
            case doc.Section(title, inner):
                yield element(f"h{min(level, 6)}", title)
                yield from blocks(inner, level + 1, drawn)
            case doc.Table():
                yield Markup("<table>")
                if block.caption:
                    yield element("caption", block.caption)
                styles = [f"text-align:{_SIDES[side]}" for side in block.align]
                heads = [  # a column of signs has no head, and an empty one confuses screen readers
                    element("th", head, style=style, scope="col") if head.strip() else element("td")
                    for head, style in zip(block.heads, styles, strict=True)
                ]
                yield element("thead", element("tr", heads))
                yield Markup("<tbody>")
                for row in block.rows:
                    cells = zip(row, block.heads, styles, strict=True)
                    yield element("tr", [element("td", x, style=y, data_label=head) for x, head, y in cells])
                yield from (Markup("</tbody>"), Markup("</table>"))


# --- Formulas: LaTeX, and sentences in which formulas are written in letters and signs.


ACCENTS = {"\u0303": "~", "\u0307": "˙", "\u0308": "¨", "\u0302": "^", "\u0304": "¯"}
RAISED = dict(zip("⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻⁽⁾ⁿᵀ′", "0123456789+−()nT′", strict=True))
LOWERED = dict(zip("₀₁₂₃₄₅₆₇₈₉₊₋ᵢⱼₘₙ", "0123456789+−ijmn", strict=True))
NAMES = ("sinh", "cosh", "tanh", "asinh", "diag", "sup", "inf", "det", "ln", "exp", "max", "min", "sym")
SHARES = {"½": ("1", "2"), "¼": ("1", "4")}
FENCES = "()[]{}‖|"
_GREEK = "α-ωΑ-Ω"
_SIGNS = re.compile(rf"[{_GREEK}‖√≤≥≠≈≻⪰⇔⇒→∈∀∂∞·×°½¼−=<>+^_′ᵀ⁻⁰¹²³⁴-⁹ⁿ₀-₉ᵢ|]|[A-Za-z][{''.join(ACCENTS)}]")
_LETTER = re.compile(r"[B-HJ-Zb-z](['’])?[.,;:]?")
_NO_FORMULA = re.compile(r"^([A-Za-z]{2,}_|N·m|rad|\d+(\.\d+)?°)|\.(py|toml|json)\b")
_OPERAND = re.compile(
    r"[\[(]?-?\d[\d.]*[.,;:]?|dV/dt|det|sup|[A-Za-z]\(\S*|\S{0,2}[\])]|[\[(]\S|[A-Za-z][.,;:]?"
)
OPEN_RIGHT = "=<>≤≥≈≠≻⪰⇔⇒→∈+−·,([√_" + "ⁿ²³"
OPEN_LEFT = "=<>≤≥≈≠≻⪰⇔⇒→∈+−·√Θ)²"
_BLANK = "\N{SIX-PER-EM SPACE}"


@cache
def latex(formula: str) -> Markup:
    """A formula on a line of its own, from LaTeX; a wide one is scrolled by keys when it has the focus."""
    from latex2mathml.converter import convert

    return Markup(convert(formula, display="block").replace("<math ", '<math tabindex="0" ', 1))


@cache
def sentence(text: str) -> Markup:
    """A sentence with every formula in it as MathML, the words between them escaped."""
    words = normalize("NFC", " ".join(text.split())).split(" ")
    parts: list[str] = []
    for is_formula, group in groupby(zip(words, _formulas(words), strict=True), lambda pair: pair[1]):
        result = [word for word, _ in group]
        parts += map(formula, _clauses(result)) if is_formula else map(_word, result)
    return Markup(" ".join(parts))


def _word(word: str) -> Markup:
    """A word outside all formulas; an option of a command is code, which no line ends inside."""
    return element("code", word, style="white-space:nowrap") if word.startswith("--") else joined(word)


def _clauses(words: Sequence[str]) -> Iterator[list[str]]:
    """A list of formulas one by one: a line may end after a comma that stands in no bracket."""
    clause: list[str] = []
    for word in words:
        clause.append(word)
        text = " ".join(clause)
        if text.endswith((",", ";", ":")) and sum(map(text.count, "([{")) == sum(map(text.count, ")]}")):
            yield clause
            clause = []
    if clause:
        yield clause


def _formulas(words: Sequence[str]) -> list[bool]:
    """Which words belong to a formula: also numbers, calls and letters beside a sign that needs them."""
    sure = [_is_formula(word) for word in words]
    for places in (range(len(words)), reversed(range(len(words)))):
        for k in places:
            before = k > 0 and sure[k - 1] and words[k - 1][-1] in OPEN_RIGHT
            after = k + 1 < len(words) and sure[k + 1] and words[k + 1][0] in OPEN_LEFT
            sure[k] = sure[k] or ((before or after) and bool(_OPERAND.fullmatch(words[k])))
    return sure


def _is_formula(word: str) -> bool:
    decomposed = normalize("NFD", word)
    if _LETTER.fullmatch(decomposed):
        return True
    if _NO_FORMULA.search(word) or re.fullmatch(r"[a-z]+-[a-z-]+[.,;:]?", word):
        return False
    return bool(_SIGNS.search(decomposed)) and not re.fullmatch(r"\(?\d+[a-z]?\)?[.,;:]?", word)


def formula(words: Sequence[str]) -> Markup:
    """A formula in letters and signs; a stop after it is text in it, as no line may begin with the stop."""
    text = " ".join(words)
    body = text.rstrip(".,;:")
    nodes = list(_Reader(body).nodes())
    stop = element("mtext", text[len(body) :]) if text != body else None
    return element("math", element("mrow", nodes, stop))


class _Reader:
    """Reads a formula from left to right."""

    def __init__(self, text: str) -> None:
        self.rest = normalize("NFD", text)

    def nodes(self, until: str = "") -> Iterator[Markup]:
        """All nodes up to a closing bracket, which is taken off."""
        while self.rest:
            if until and self.rest.startswith(until):
                self.rest = self.rest[1:]
                return
            node = self.node()
            if node is not None:
                yield node

    def node(self) -> Markup | None:
        """One letter, number or sign with all that stands above and below it."""
        base = self._base()
        if base is None:
            return None
        low, high = self._lowered(), self._raised()
        low = low or self._lowered()
        if low and high:
            return element("msubsup", base, low, high)
        if low:
            return element("msub", base, low)
        return element("msup", base, high) if high else base

    def _take(self, pattern: str) -> str:
        result = re.match(pattern, self.rest)
        if not result:
            return ""
        self.rest = self.rest[result.end() :]
        return result[0]

    def _base(self) -> Markup | None:  # noqa: PLR0911 (a case a line)
        if self._take(r"\s+"):
            return element("mspace", width="0.22em") if self.rest else None
        if number := self._take(r"\d+(\.\d+)?"):
            return element("mn", number)
        if self._take("√"):
            return element("msqrt", self._group())
        if self.rest[0] in SHARES:
            low, high = SHARES[self._take(".")]
            return element("mfrac", element("mn", low), element("mn", high))
        for name in NAMES:
            if re.match(rf"{name}(?![a-z])", self.rest):
                return element("mi", self._take(name))
        if long := self._take(rf"[{_GREEK}k](max|min)"):
            return element("msub", element("mi", long[0]), element("mtext", long[1:]))
        if word := self._take(r"(implies|for|and|all|in|every|is|the|of)(?![A-Za-z])"):
            return element("mtext", f"{_BLANK}{word}{_BLANK}")
        if letter := self._take(rf"[A-Za-z{_GREEK}]"):
            node = element("mi", letter)
            while self.rest and self.rest[0] in ACCENTS:
                node = element("mover", node, element("mo", ACCENTS[self._take(".")]), accent="true")
            return node
        sign = self._take(r"(?s).")
        stretchy = "false" if sign in FENCES else None
        return element("mo", "−" if sign == "-" else sign, stretchy=stretchy)

    def _group(self) -> Markup:
        """What a root or an exponent is about: one node, or what stands in brackets."""
        if self._take(r"\("):
            return element("mrow", list(self.nodes(until=")")))
        return (self._base() if self.rest else None) or Markup()

    def _lowered(self) -> Markup | None:
        if signs := self._take(f"[{''.join(LOWERED)}]+"):
            return element("mn", "".join(LOWERED[c] for c in signs))
        if below := self._take(rf"_(\{{[^}}]*\}}|[A-Za-z0-9{_GREEK}]+)"):
            return element("mi", below[1:].strip("{}"))
        return None

    def _raised(self) -> Markup | None:
        if signs := self._take(f"[{''.join(RAISED)}']+"):
            return element("mi", "".join(RAISED.get(c, "′") for c in signs))
        if self._take(r"\^"):
            return element("mrow", self._group())
        return None
