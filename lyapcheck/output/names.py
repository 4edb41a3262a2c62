"""Names in ASCII for signs that a terminal cannot show: ``eps0`` and ``gamma_m`` for ε₀ and γ_m.

An encoding with all signs of formulas is not touched. Another one keeps the signs that it has, and gets names
for the rest.
"""

from __future__ import annotations

import codecs
from functools import lru_cache
from unicodedata import combining, decomposition, name, normalize

SPELLED = "lyapcheck.names"
"""The handler of this module, as the ``errors`` of a stream or of an encoder."""
ALL_SIGNS = "ε₀ᵀγ̇‖√≤−✓"
"""What an encoding shows that needs no names."""
_SIGNS = {
    **{"✓": "[ok]", "✗": "[x]", "…": "...", "“": '"', "”": '"', "‘": "'", "’": "'", "′": "'", "″": "''"},
    **{"≤": "<=", "≥": ">=", "≠": "!=", "≈": "~", "≻": ">", "≺": "<", "⪰": ">=", "≽": ">=", "⪯": "<="},
    **{"≼": "<=", "→": "->", "↦": "|->", "⇒": "=>", "⇔": "<=>", "↗": "/", "↓": "v", "‖": "||", "∞": "inf"},
    **{"·": "*", "×": "x", "÷": "/", "∘": "o", "±": "+-", "∓": "-+", "−": "-", "–": "-", "—": "-"},
    **{"½": "1/2", "¼": "1/4", "¾": "3/4", "∂": "d", "ø": "o", "Ø": "O", "ß": "ss", "¨": '"', "˙": "'"},
}
_WORDS = {"√": "sqrt", "∫": "int", "∀": "for all", "∈": "in", "ᵀ": "^T"}
"""With a space before a letter or digit."""
_GREEK = {"ε": "eps", "ϵ": "eps", "λ": "lambda", "Λ": "Lambda", "Σ": "sum", "ς": "sigma", "µ": "mu"}
"""What is not called as Unicode has it."""
_ACCENTS = {"\u0307": "_dot", "\u0308": "_ddot", "\u0303": "_tilde", "\u0302": "_hat", "\u0304": "_bar"}
"""Over symbols; on a letter of a name, as in é, they are left out."""
_OF_SYMBOLS = ("\u0307", "\u0302")
"""Accents that also make a symbol of a letter that Unicode has with them: ẇ, ê."""


@lru_cache(maxsize=8)
def has_all_signs(encoding: str) -> bool:
    """Whether an encoding needs no names."""
    try:
        ALL_SIGNS.encode(encoding)
    except UnicodeEncodeError:
        return False
    return True


def spelled(text: str, encoding: str) -> str:
    """The text as an encoding can show it."""
    if text.isascii() or has_all_signs(encoding):
        return text
    return text.encode(encoding, SPELLED).decode(encoding)


def _handler(error: UnicodeError) -> tuple[str, int]:
    if not isinstance(error, UnicodeEncodeError):
        raise error
    around = f" {error.object} "
    places = range(error.start + 1, error.end + 1)
    return "".join(_named(around[i], around[i - 1], around[i + 1]) for i in places), error.end


def _named(sign: str, before: str, after: str) -> str:
    """A sign in ASCII, between the characters around it."""
    letter, known = _greek(sign), _SIGNS.get(sign) or _ACCENTS.get(sign)
    if sign == "°":
        known = " deg" if before.isalnum() or before == ")" else "deg"
    elif sign in _WORDS:
        known = _WORDS[sign] + " " * after.isalnum()
    elif letter:
        known = letter + ("_" if after.isascii() and after.isalpha() else " " * bool(_greek(after)))
    return _by_parts(sign, before) if known is None else known


def _by_parts(sign: str, before: str) -> str:
    """A raised, lowered or accented character by its parts; as an escape if it has none in ASCII."""
    base, *accents = list(normalize("NFKD", sign).replace("\u2212", "-"))
    if (kind := _kind(sign)) in ("<super>", "<sub>"):
        follows = kind == (before != "ᵀ" and _kind(before)) or (kind == "<sub>" and _greek(before))
        return base if follows else f"{'^' if kind == '<super>' else '_'}{base}"
    if base.isascii():
        return base + "".join(_ACCENTS[one] for one in accents if one in _OF_SYMBOLS)
    return "" if combining(sign) else sign.encode("ascii", "backslashreplace").decode("ascii")


def _kind(sign: str) -> str:
    return decomposition(sign).partition(" ")[0]


def _greek(sign: str) -> str | None:
    """The name of a Greek letter."""
    if sign in _GREEK:
        return _GREEK[sign]
    words = name(sign, "").split()
    if words[:1] != ["GREEK"] or words[2:3] != ["LETTER"] or len(words) != 4:
        return None
    return words[3].lower() if words[1] == "SMALL" else words[3].capitalize()


codecs.register_error(SPELLED, _handler)
