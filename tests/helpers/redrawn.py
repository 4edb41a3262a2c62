"""Other results in the place of those of an answer: zeros, infinities, nothing, equal and hostile values."""

import math
from collections.abc import Callable, Sequence
from dataclasses import fields, is_dataclass, replace
from fractions import Fraction
from pathlib import PurePath
from typing import Any

import numpy as np

from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.control.gains import GainFile
from lyapcheck.promise import Promise
from lyapcheck.robots import RobotModel

Draw = Callable[[Sequence[Any]], Any]
"""One of some values."""
NAMES = ("", "<b>&\"'`", "a|b\\", "two\nlines", "=1+1", "$x_1^{2}$ %", "]]>", "x" * 200, "名前 θ̈")
FLOATS = (0.0, -0.0, 1e-300, 1e300, -1e300, 1 / 3, -1 / 3, 100.0, math.inf, -math.inf, math.nan)
FRACTIONS = tuple(Fraction(x) for x in (0, 1, "1/3", "-1/3", "1e-300", "1e300", "-1e300"))
POSITIVE = tuple(Fraction(x) for x in (1, "1/3", "1e-30", "1e30"))
COUNTS = (0, 1, 300, 10**12)
WORDS = {"name", "robot", "title", "path", "source", "comment", "place", "section", "word", "label"}
"""Fields with a text that anybody may have chosen, and no word that the program reads again."""
LISTS = {"joints", "assumptions", "notes", "reasons", "varies", "missing", "remarks"}
GAINS = {"kp", "kv"}
LEFT = {"m", "n", "ms", "index", "digits", "schema", "task", "tasks", "bench", "targets", "wishes", "q", "w"}
LEFT |= {"t", "state", "joint", "seed", "starts", "spread", "delta", "band", "T", "settling_band"}
"""What is asked, not found; and samples of motions, whose figures are not words."""
ROWS = {"results", "sets", "claims"}
MOST_DRAWN = 12
KEPT = (RobotModel, GainFile, Promise, PurePath)


def redrawn(answer, draw, most):
    """The answer with other numbers, names and gaps, and with none or up to ``most`` of its results."""
    if isinstance(answer, tuple):
        return type(answer)(_several([_value(one, "", "", draw) for one in answer], draw, most))
    if not is_dataclass(answer):
        return answer
    changed = {}
    for one in fields(answer):
        value = _value(getattr(answer, one.name), one.name, str(one.type), draw)
        if one.name in ROWS and value and is_dataclass(value[0]):
            value = tuple(_several(list(value), draw, most))
        changed[one.name] = value
    return replace(answer, **changed)


def other(row, draw):
    """A row of an answer with other numbers, names and gaps."""
    return _value(row, "", "", draw)


def _several(results, draw, most):
    count = draw((0, 1, len(results), most))
    return [results[k % len(results)] for k in range(count)] if results else []


def _value(value, name, hint, draw):
    if isinstance(value, KEPT) or name in LEFT or (callable(value) and not is_dataclass(value)):
        return value
    if value is not None and hint.endswith("| None") and draw((False, False, True)):
        return None
    others = _others(value, name)
    if others:
        return draw((value, *others))
    return _enclosure(draw) if isinstance(value, Enclosure) else _whole(value, name, hint, draw)


def _others(value, name):
    """What else a number or a text might be; nothing for what the program reads again."""
    if type(value) is Fraction:
        return POSITIVE if name in GAINS else FRACTIONS
    if isinstance(value, str):
        return NAMES if name in WORDS | LISTS else ()
    return {float: FLOATS, int: COUNTS}.get(type(value), ())


def _whole(value, name, hint, draw):
    if isinstance(value, np.ndarray):
        small = value.size <= MOST_DRAWN and value.dtype.kind == "f"
        drawn = [draw((float(x), *FLOATS)) for x in value.flat] if small else value
        return np.array(drawn).reshape(value.shape)
    if type(value) is tuple:
        inner = "x | None" if "| None," in hint or "| None]" in hint else ""
        return tuple(_value(one, name, hint if type(one) is tuple else inner, draw) for one in value)
    if type(value) is dict:
        return {key: _value(one, name, "", draw) for key, one in value.items()}
    if not is_dataclass(value) or type(value).__module__.startswith("lyapcheck.check."):
        return value
    own = [one for one in fields(value) if one.init]
    changed = {one.name: _value(getattr(value, one.name), one.name, str(one.type), draw) for one in own}
    try:
        return replace(value, **changed)  # type: ignore[type-var]
    except ValueError:  # what the class itself refuses is no result
        return value


def _enclosure(draw):
    low = draw(FRACTIONS)
    return Enclosure(low, low + draw((Fraction(0), Fraction(1, 10**40), Fraction(1), Fraction(10**30))))
