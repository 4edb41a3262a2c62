"""Which part of a robot is the arm, and how the name of an arm says so: ``arm.urdf#tip=hand&fixed.lift=0.2``.

The options ``--base``, ``--tip``, ``--fixed`` and ``--xacro`` of every command become such a name, so that a
gain file, a plan or an answer that names the arm has all of it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from urllib.parse import quote, unquote

from lyapcheck.errors import argument_error
from lyapcheck.files.decimals import decimal_text
from lyapcheck.files.toml import key_of, quoted
from lyapcheck.robots.fields import decimal

FILES = (".toml", ".urdf", ".xacro", ".xml", ".mjcf", ".sdf")
"""How names of files of arms and robots end."""


@dataclass(frozen=True)
class Choice:
    """A chain of a robot.

    Args:
        base: the link where it starts; what is above is held. The longest run of revolute joints if empty.
        tip: the link where it ends.
        fixed: joints held at a value, rad or m.
        xacro: arguments of a xacro file.
    """

    base: str = ""
    tip: str = ""
    fixed: Mapping[str, Fraction] = field(default_factory=dict)
    xacro: Mapping[str, str] = field(default_factory=dict)

    def __bool__(self) -> bool:
        return bool(self.base or self.tip or self.fixed or self.xacro)

    def over(self, other: Choice) -> Choice:
        """This choice, and of another what it leaves open."""
        fixed, xacro = {**other.fixed, **self.fixed}, {**other.xacro, **self.xacro}
        return Choice(self.base or other.base, self.tip or other.tip, fixed, xacro)

    @property
    def lines(self) -> list[str]:
        """The lines of an arm file that say the same."""
        links = (("base", self.base), ("tip", self.tip))
        fixed = {joint: decimal_text(value) for joint, value in self.fixed.items()}
        tables = (("fixed", fixed), ("xacro", {name: quoted(value) for name, value in self.xacro.items()}))
        pairs = ((key, ", ".join(f"{key_of(x)} = {y}" for x, y in table.items())) for key, table in tables)
        named = [f"{key} = {quoted(link)}" for key, link in links if link]
        return [*named, *(f"{key} = {{ {text} }}" for key, text in pairs if text)]

    def of(self, arm: str) -> str:
        """The name of the arm of a robot that is chosen, which `split` takes apart."""
        path, before = split(arm)
        chosen = self.over(before)
        words = [("base", chosen.base), ("tip", chosen.tip)]
        words += [(f"fixed.{joint}", decimal_text(value)) for joint, value in chosen.fixed.items()]
        words += [(f"xacro.{name}", value) for name, value in chosen.xacro.items()]
        said = "&".join(f"{quote(key, safe='')}={quote(value, safe='')}" for key, value in words if value)
        return f"{path}#{said}" if said else path


def split(arm: str) -> tuple[str, Choice]:
    """A name of an arm as name or path, and what is chosen of it.

    Raises:
        InputError: a choice that says something else.
    """
    path, mark, said = arm.rpartition("#")
    if not mark or "=" not in said or Path(arm).exists():
        return arm, Choice()
    fixed, xacro, links = {}, {}, {}
    for word in said.split("&"):
        key, _, value = (unquote(part) for part in word.partition("="))
        kind, _, name = key.partition(".")
        if kind == "fixed" and name:
            fixed[name] = held_at(value, arm)
        elif kind == "xacro" and name:
            xacro[name] = value
        elif key in ("base", "tip"):
            links[key] = value
        else:
            repair = f"write {path}#tip=LINK, #base=LINK, #fixed.JOINT=VALUE or #xacro.NAME=VALUE"
            raise argument_error("robot", arm, f"chooses {key}, which means nothing", repair)
    return path, Choice(links.get("base", ""), links.get("tip", ""), fixed, xacro)


def named(given: str | Path | None, own: str | None) -> str | None:
    """The arm that ``--robot`` gives, else the one that a file names, with what is chosen of it.

    Args:
        given: an arm, or only a choice such as ``#tip=hand``.
        own: the arm of the file.
    """
    text = str(given or "")
    if not text.startswith("#"):
        return text or own
    return None if own is None else split(text)[1].of(own)


def placed(robot: str, place: Callable[[str], str]) -> str:
    """An arm whose path is changed if it is one, with what is chosen of it; a built-in arm stays."""
    path, choice = split(robot)
    return choice.of(place(path)) if path.lower().endswith(FILES) else robot


def held_at(text: str, subject: str, key: str = "fixed") -> Fraction:
    """The exact value at which a joint is held.

    Args:
        text: the value.
        subject: what it is said of.
        key: what says it.

    Raises:
        InputError: it is no decimal.
    """
    value = decimal(text.strip())
    if value is None:
        raise argument_error(key, subject, f"{text} is no decimal number", "write --fixed lift=0.2")
    return value
