"""Ways to garble a file: by bytes, by words, by lines, and by the values behind its keys."""

from __future__ import annotations

import random
import re
from collections.abc import Callable
from pathlib import Path

SEEDS = {path.name: path.read_bytes() for path in sorted((Path(__file__).parent / "seeds").iterdir())}
"""Small files that are read without a complaint."""

HOSTILE = [
    *("0", "-1", "1e-300", "1e300", "1e99999999", "nan", "inf", "-inf", "0x10", "1_000", "1/3", "٣", "-0.0"),
    *("9" * 400, "1" + "0" * 5000, "1e" + "9" * 50, "true", "''", '""', '"' * 3, "''''''", "é\x00\x1b[31m"),
    *("[]", "[[]]", "{}", "[1, 2, 3]", "{ value = 1 }", "[" * 200, "{ a = " * 60, "1979-05-27", "07:32:00"),
    *("&lt;", "&a;", "<!DOCTYPE a>", '<!ENTITY a "&b;&b;">', "<![CDATA[", "<!--", "<?xml?>", "</robot>"),
    *(
        "<link/>",
        "<a>" * 60,
        "${pi}",
        "__import__('os')",
        "../../etc/passwd",
        "/dev/zero",
        "s12^9",
        "c1 " * 30,
    ),
]

Rng = random.Random
_WORD = re.compile(rb"[^\s\"'<>=\[\]{},]+")
_VALUE = re.compile(rb'"[^"\n]*"|(?<== )[^\n]+')


def garbled(rng: Rng) -> tuple[str, bytes]:
    """The name of a seed, whose suffix says which reader takes it, and a garbled content."""
    name = rng.choice(sorted(SEEDS))
    content = SEEDS[name]
    for _ in range(rng.choice((1, 1, 1, 2, 3, 6))):
        content = rng.choice(_WAYS)(content, rng)
    return name, content[:200_000]


def _flip(content: bytes, rng: Rng) -> bytes:
    at = rng.randrange(len(content) + 1)
    return content[:at] + bytes([rng.randrange(256)]) + content[at + 1 :]


def _cut(content: bytes, rng: Rng) -> bytes:
    at = rng.randrange(len(content) + 1)
    return content[:at] + content[at + rng.randint(0, 40) :]


def _truncate(content: bytes, rng: Rng) -> bytes:
    return content[: rng.randrange(len(content) + 1)]


def _splice(content: bytes, rng: Rng) -> bytes:
    """Up to a hundred bytes of any seed somewhere."""
    other = SEEDS[rng.choice(sorted(SEEDS))]
    begin, at = rng.randrange(len(other)), rng.randrange(len(content) + 1)
    return content[:at] + other[begin : begin + rng.randint(1, 100)] + content[at:]


def _repeat(content: bytes, rng: Rng) -> bytes:
    at = rng.randrange(len(content) + 1)
    piece = content[at : at + rng.randint(1, 60)]
    return content[:at] + piece * rng.choice((2, 3, 50)) + content[at:]


def _lines(content: bytes, rng: Rng) -> bytes:
    """A line is lost, doubled or moved."""
    lines = content.split(b"\n")
    line = lines.pop(rng.randrange(len(lines)))
    for _ in range(rng.choice((0, 1, 1, 2))):
        lines.insert(rng.randint(0, len(lines)), line)
    return b"\n".join(lines)


def _replacement(pattern: re.Pattern[bytes]) -> Callable[[bytes, Rng], bytes]:
    """One match becomes something hostile, or another match of the same file."""

    def way(content: bytes, rng: Rng) -> bytes:
        result = list(pattern.finditer(content))
        if not result:
            return content
        place = rng.choice(result)
        piece = rng.choice(HOSTILE).encode() if rng.random() < 0.6 else rng.choice(result)[0]
        if place[0].startswith(b'"') and not piece.startswith(b'"') and rng.random() < 0.7:
            piece = b'"' + piece + b'"'
        return content[: place.start()] + piece + content[place.end() :]

    return way


_WAYS = (_flip, _cut, _truncate, _splice, _repeat, _lines, _replacement(_WORD), *[_replacement(_VALUE)] * 3)
