"""Where the checker refuses: every place in its source, and those that a certificate came to."""

import ast
import sys
from collections import Counter
from contextlib import contextmanager
from functools import cache
from pathlib import Path

from lyapcheck.check import refusal

CHECK = Path(refusal.__file__).parent
RAISED = ("Refused", "Undefined")
APART = (CHECK / "refusal.py", CHECK / "covers.py")
"""Files whose refusals no certificate comes to; ``covers`` compares statements that were judged."""


@cache
def places():
    """The name of each call of ``require`` and each refusal that is raised, by file and line."""
    result = {}
    for path in sorted(CHECK.rglob("*.py")):
        module = path.relative_to(CHECK).as_posix()
        if path not in APART:
            counted = Counter()
            for name, node in _refusing(ast.parse(path.read_text(encoding="utf-8")), ()):
                counted[name] += 1
                suffix = f" ({counted[name]})" if counted[name] > 1 else ""
                for line in range(node.lineno, (node.end_lineno or node.lineno) + 1):
                    result[module, line] = f"{module} {name}{suffix}"
    return result


def _refusing(node, inside):
    """The calls that refuse, each with the function that it stands in and the rule that it names."""
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.FunctionDef | ast.ClassDef):
            yield from _refusing(child, (*inside, child.name))
            continue
        raised = child.exc if isinstance(child, ast.Raise) else None
        call = raised if raised is not None else child
        known = RAISED if raised is not None else ("require",)
        if isinstance(call, ast.Call) and isinstance(call.func, ast.Name) and call.func.id in known:
            yield f"{'.'.join(inside)}: {ast.unparse(call.args[-1])}", call
        else:
            yield from _refusing(child, inside)


@contextmanager
def recorded():
    """The names of the places at which something is refused meanwhile."""
    seen = set()
    known, plain = places(), refusal.Refused.__init__

    def noting(self, *words):
        frame = sys._getframe(1)
        while (caller := frame.f_back) is not None and frame.f_code.co_name in ("__init__", "require"):
            frame = caller
        path = Path(frame.f_code.co_filename)
        if path.is_relative_to(CHECK):
            seen.add(known.get((path.relative_to(CHECK).as_posix(), frame.f_lineno), ""))
        plain(self, *words)  # type: ignore[arg-type]

    refusal.Refused.__init__ = noting  # type: ignore[method-assign, assignment]
    try:
        yield seen
    finally:
        refusal.Refused.__init__ = plain  # type: ignore[method-assign]
