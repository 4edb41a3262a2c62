"""How lyapcheck says that an input cannot be used."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from importlib.util import find_spec

from lyapcheck.output.escapes import printable


@dataclass(frozen=True)
class Problem:
    """One fault of an input, with its place, value, rule and repair."""

    file: str
    line: int | None
    key: str
    value: str
    rule: str
    repair: str

    @property
    def path(self) -> str:
        """The file that it is about; empty where that is an argument, the environment or a library."""
        named = self.file in ("argument", "environment") or self.file.startswith("lyapcheck ")
        return "" if named else self.file

    @property
    def said(self) -> str:
        """What is wrong, without the place."""
        subject = f"{self.key} = {self.value}" if self.value else self.key
        return printable(f"{subject}: {self.rule}; {self.repair}")

    def data(self) -> dict[str, object]:
        """Its parts, for programs."""
        return {key: getattr(self, key) for key in ("file", "line", "key", "value", "rule", "repair")}

    def __str__(self) -> str:
        place = self.file if self.line is None else f"{self.file}:{self.line}"
        return f"{printable(place)}: {self.said}"


class InputError(Exception):
    """An input file or argument cannot be used. The error has every problem, not only the first.

    The command line prints one problem per line and returns exit code 2.
    """

    told = False
    """Whether an answer that was written has them."""

    def __init__(self, problems: Problem | list[Problem]) -> None:
        self.problems = (
            [problems]
            if isinstance(problems, Problem)
            else sorted(problems, key=lambda p: (p.file, p.line or 0, p.key, p.rule))
        )
        super().__init__("\n".join(map(str, self.problems)))

    def __reduce__(self) -> tuple[type[InputError], tuple[list[Problem]]]:
        """Its problems, not its text: so it comes back whole from another process."""
        return InputError, (self.problems,)


@contextmanager
def told_as(names: Mapping[str, str]) -> Iterator[None]:
    """Have problems that are found inside told under other names of their keys."""
    try:
        yield
    except InputError as error:
        raise InputError([replace(one, key=names.get(one.key, one.key)) for one in error.problems]) from None


def argument_error(name: str, value: object, rule: str, repair: str) -> InputError:
    """The error for a single bad argument of a command or a function."""
    return InputError(argument_problem(name, value, rule, repair))


def argument_problem(name: str, value: object, rule: str, repair: str) -> Problem:
    """What is wrong with one argument, to be said with what is wrong with others."""
    typed = str(value).removesuffix(".0") if isinstance(value, float) else str(value)
    return Problem("argument", None, name, typed, rule, repair)


def file_error(name: str, rule: str, repair: str) -> InputError:
    """The error for a file that cannot be used as a whole."""
    return InputError(Problem(name, None, "file", "", rule, repair))


def near(word: str, names: Iterable[str]) -> str:
    """The name that a word is a slip of the pen for, if need be in other letters; empty where none is.

    The dashes of an option do not count: all options have them.
    """
    from difflib import get_close_matches

    def bare(name: str) -> str:
        return name.lstrip("-") or name

    known = list(names)
    for fold in (bare, lambda name: bare(name).casefold()):
        folded = {fold(name): name for name in known}
        if close := get_close_matches(fold(word), folded, 1, 0.65):
            return folded[close[0]]
    return ""


def nearest(word: str, names: Iterable[str], otherwise: str = "") -> str:
    """The repair of a slip of the pen: a question for the name that is meant."""
    meant = near(word, names)
    return f"did you mean {meant}?" if meant else otherwise


# --- The libraries that lyapcheck asks, and what to say where one of them is not installed.


PACKAGES = {
    "casadi": "casadi",
    "clarabel": "clarabel",
    "cvxpy": "cvxpy",
    "flint": "python-flint",
    "jinja2": "jinja2",
    "latex2mathml": "latex2mathml",
    "matplotlib": "matplotlib",
    "numpy": "numpy",
    "rich": "rich",
    "scipy": "scipy",
    "shtab": "shtab",
    "sympy": "sympy",
    "yaml": "pyyaml",
}
"""What a module is called where packages are installed; python-flint alone judges gains and certificates."""
RULE = "is not installed, and this needs it"


def installed(module: str) -> bool:
    """Whether a library is there; it is not imported."""
    return find_spec(module) is not None


def repair(module: str) -> str:
    """The line that installs a library."""
    return f"pip install {PACKAGES[module]}"


def without(words: str, *modules: str) -> str:
    """After a few words the first of some libraries that is not installed, and its line; else empty."""
    lack = next((one for one in modules if not installed(one)), None)
    return "" if lack is None else f"{words} {PACKAGES[lack]}, which is not installed; {repair(lack)}"


def missing(error: ImportError) -> InputError | None:
    """What to say of an import that has failed; none where it is not of a library that may be missing."""
    module = (error.name or "").partition(".")[0]
    return lacking(module) if module in PACKAGES else None


def lacking(module: str) -> InputError:
    """The error for a library that is not installed."""
    return argument_error("library", PACKAGES[module], RULE, repair(module))
