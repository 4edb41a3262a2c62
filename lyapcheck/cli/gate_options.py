"""What ``lyapcheck gate`` may be asked: one source for the command line's help and for its quick start."""

from __future__ import annotations

from enum import StrEnum

from lyapcheck.records import Record


class GateFormat(StrEnum):
    """How the results are written."""

    TEXT = "text"
    JSON = "json"
    JUNIT = "junit"
    SARIF = "sarif"
    GITHUB = "github"
    MARKDOWN = "markdown"


class Condition(StrEnum):
    """The conditions that can decide."""

    NORM = "10"
    JOINT = "10p"
    DAMPING = "19"
    SCALAR = "scalar"
    GLOBAL = "global"


class Gamma(StrEnum):
    """Which γ the conditions use."""

    TRUE = "true"
    PRINTED = "printed"


class GateCall(Record):
    """One call of the command; no conditions mean the default ones."""

    files: tuple[str, ...]
    format: str = GateFormat.TEXT.value
    conditions: tuple[str, ...] = ()
    robot: str | None = None
    gamma: str = Gamma.TRUE.value
    strict: bool = False
    certificates: str | None = None


CHOICES: dict[str, type[StrEnum] | None] = {
    "--format": GateFormat,
    "--condition": Condition,
    "--robot": None,
    "--gamma": Gamma,
    "--certificates": None,
}
"""The options that take a value, and the values that they take."""


def quick_call(words: list[str]) -> GateCall | None:
    """The call that the words after ``gate`` make, where they are plain; ``None`` for anything else.

    A mistake or a wish for help is not plain: Typer, which takes longer to load than the gate to decide, has
    the words for it.
    """
    files: list[str] = []
    given: dict[str, list[str]] = {option: [] for option in CHOICES}
    strict, rest = False, iter(words)
    for word in rest:
        option, equals, value = word.partition("=")
        if word == "--":
            files += rest
        elif word == "--strict":
            strict = True
        elif option in CHOICES:
            found = value if equals else next(rest, None)
            choice = CHOICES[option]
            if found is None or (choice is not None and found not in [item.value for item in choice]):
                return None
            given[option].append(found)
        elif word.startswith("-"):
            return None
        else:
            files.append(word)
    if not files:
        return None
    last = {option: values[-1] for option, values in given.items() if values}
    return GateCall(
        files=tuple(files),
        format=last.get("--format", GateFormat.TEXT.value),
        conditions=tuple(given["--condition"]),
        robot=last.get("--robot"),
        gamma=last.get("--gamma", Gamma.TRUE.value),
        strict=strict,
        certificates=last.get("--certificates"),
    )
