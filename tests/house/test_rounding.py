"""Numbers beside words of proof are rounded to the safe side: by ``at_most`` and ``at_least`` alone."""

import ast
import re
from pathlib import Path

import pytest

import lyapcheck
from tests.helpers.words_of_proof import GUARDED

PACKAGE = Path(lyapcheck.__file__).parent
ROOMS = ("answers", "report")
STRICT = (
    "answers/epsilon",
    "answers/robot",
    "answers/simulate",
    "answers/sweep",
    "answers/tune",
    "answers/table.py",
)
NEAREST = re.compile(r"z?[.\d]*[gfeGFE%]|.*[}][gfe]")
"""Format specifications that round to nearest."""
IN_TEXT = re.compile(r"\{\w*:z?[.\d]*[gfe%]\}")
ROUNDING = ("round", "significant_text")
"""Functions that do not say to which side they round."""
TAKING = ("cell", "format")
"""Functions that take such a specification."""
BESIDE_PROOF = {
    "answers/robot/numbers.py:data": "the gap of numeric ends, for programs",
}
"""Functions with a word of proof and a number that is not proved, or is on the safe side before."""
SEEN = {
    "answers/epsilon/__init__.py:module": "seconds of computing",
    "answers/robot/numbers.py:data": "the gap of numeric ends",
    "answers/robot/numbers.py:states": "the angles of a witness, whole in the data",
    "answers/tune/trial.py:__post_init__": "the largest value that may be asked",
    "answers/simulate/__init__.py:motion": "times that the user gave or that were reached",
    "answers/simulate/__init__.py:plain": "simulated",
    "answers/simulate/__init__.py:row": "angles that the user gave",
    "answers/simulate/starts.py:quantities": "simulated",
    "answers/simulate/runs.py:module": "the band of settling, and what was simulated",
    "answers/simulate/runs.py:_falls": "simulated",
    "answers/simulate/runs.py:_beside": "as the paper prints it",
    "answers/simulate/starts.py:module": "quantiles",
    "answers/simulate/starts.py:_task": "angles and times that the user gave",
    "answers/simulate/tracking.py:module": "simulated",
    "answers/simulate/__init__.py:by_joint": "the band that the user gave",
    "answers/tune/bench.py:document": "a share that the user gave",
    "answers/tune/bench.py:_missed_in_motions": "the time of a simulated motion",
    "answers/tune/bench.py:_angles": "angles that the user gave",
    "answers/tune/bench.py:_six": "simulated",
    "answers/simulate/runs.py:far_off": "how far from the goal a run ended",
    "answers/tune/search.py:_try": "an order of candidates",
    "answers/tune/search.py:set_of": "gains, which the gate judges as they are written",
}
"""The functions of the strict rooms that may round to nearest, each with what it prints."""


def specifications(node):
    """How a piece of code rounds to nearest."""
    for inner in ast.walk(node):
        if isinstance(inner, ast.FormattedValue) and isinstance(inner.format_spec, ast.JoinedStr):
            spec = ast.unparse(inner.format_spec)[2:-1]
            yield from [f":{spec}"] if NEAREST.fullmatch(spec) else []
        elif isinstance(inner, ast.Constant) and isinstance(inner.value, str):
            yield from IN_TEXT.findall(inner.value)
            yield from [inner.value] if re.fullmatch(r"z?\.\d+[gfe]", inner.value) else []
        elif isinstance(inner, ast.Call) and isinstance(inner.func, ast.Name):
            given = [one.value for one in inner.args if isinstance(one, ast.Constant)]
            takes = inner.func.id in TAKING and any(
                isinstance(x, str) and NEAREST.fullmatch(x) for x in given
            )
            yield from [inner.func.id] if takes or inner.func.id in ROUNDING else []


def texts(node):
    """The strings in a piece of code, docstrings left out."""
    docs = set()
    for inner in ast.walk(node):
        if isinstance(inner, ast.FunctionDef | ast.ClassDef) and isinstance(inner.body[0], ast.Expr):
            docs.add(id(inner.body[0].value))
    for inner in ast.walk(node):
        if isinstance(inner, ast.Constant) and isinstance(inner.value, str) and id(inner) not in docs:
            yield inner.value


def pieces(tree):
    """Each function and method with its name, and the other statements of a module and of its classes."""
    for node in tree.body:
        for inner in node.body if isinstance(node, ast.ClassDef) else [node]:
            yield getattr(inner, "name", "module"), inner


def complaints(source, name, strict):
    """What a file rounds to nearest beside a word of proof or, in a strict room, at all."""
    found = []
    for piece, node in pieces(ast.parse(source)):
        specs, place = sorted(set(specifications(node))), f"{name}:{piece}"
        words = sorted({word.group().lower() for text in texts(node) for word in GUARDED.finditer(text)})
        if specs and words and place not in BESIDE_PROOF:
            found.append(
                f"{place} prints {', '.join(specs)} beside {', '.join(words)}; use at_most or at_least"
            )
        elif specs and strict and place not in {**SEEN, **BESIDE_PROOF}:
            found.append(
                f"{place} prints {', '.join(specs)}; use at_most or at_least, or say in SEEN what it is"
            )
    return found


@pytest.mark.parametrize("room", ROOMS)
def test_numbers_beside_words_of_proof_are_rounded_to_the_safe_side(room):
    found = []
    for path in sorted((PACKAGE / room).rglob("*.py")):
        name = path.relative_to(PACKAGE).as_posix()
        found += complaints(path.read_text(encoding="utf-8"), name, name.startswith(STRICT))
    assert found == []


@pytest.mark.parametrize(
    ("source", "beside", "at_all"),
    [
        ('def f(x):\n    return f"at most {x:.3g} is proved"', True, True),
        ('def f(x):\n    text = f"{x:.2f}"\n    return text + " is certified"', True, True),
        ('def f(x):\n    return "stable up to {:g}".format(x)', True, True),
        ('def f(x):\n    return cell(x, "g"), "at least"', True, True),
        ('def f(x):\n    return f"{round(x)} of every"', True, True),
        ('def f(x):\n    return f"{x:.{digits}g} is proved"', True, True),
        ('class A:\n    def f(self, x):\n        return f"{x:.0%} accepted"', True, True),
        ('TEXT = f"{SHARE:g} % at most"', True, True),
        ('def f(x):\n    """Not at most."""\n    return f"{x:.2f} s"', False, True),
        ('def f(x):\n    return f"at most {at_most(x)} is proved"', False, False),
        ('def f(x):\n    return f"{x:>10} is proved, {x!r}"', False, False),
    ],
)
def test_the_detector_finds_what_it_is_for(source, beside, at_all):
    assert bool(complaints(source, "a.py", strict=False)) == beside
    assert bool(complaints(source, "a.py", strict=True)) == at_all
