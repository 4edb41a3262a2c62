"""PID gains in the files of other programs: YAML of ros2_control and effort_controllers, JSON, CSV.

A place that has a p gain belongs to the joint that its keys name, or that stands beside it as ``joint``;
lists belong to the list ``joints`` beside or above them. Decimals are exact.
"""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any

from lyapcheck.errors import InputError, Problem, file_error, nearest
from lyapcheck.files.decimals import decimal_text
from lyapcheck.files.reader import TOML, read_text
from lyapcheck.files.toml import other_format
from lyapcheck.robots.fields import decimal

WORDS = {
    "p": ("p", "kp", "k_p", "p_gain", "p_gains", "kps", "k_gains", "stiffness", "proportional"),
    "d": ("d", "kd", "k_d", "kv", "k_v", "d_gain", "d_gains", "kds", "damping", "derivative"),
    "i": ("i", "ki", "k_i", "i_gain", "i_gains", "kis", "integral"),
}
"""How programs call the three gains."""
_JOINTS = ("joint", "joint_name", "name", "joints", "dof_names", "joint_names")
_UNITS = ("", "nm", "nmrad", "nms", "nmsrad", "nmrads")
_DEPTH, _MOST = 20, 100_000
_LAW = "the theory judges proportional and derivative gains, one a joint, with g(q) in the loop"


@dataclass(frozen=True)
class Pid:
    """The gains of one joint, N·m/rad and N·m·s/rad, as a file has them, with their line."""

    joint: str
    p: Fraction
    d: Fraction
    line: int


@dataclass(frozen=True)
class _Node:
    """A value of a file: a text, a list or a table of others."""

    value: str | list[_Node] | dict[str, _Node]
    line: int


def read_foreign(path: Path, joints: Sequence[str]) -> tuple[Pid, ...]:
    """The gains for the joints of an arm, in their order.

    Raises:
        InputError: another format, no gains for a joint or several, an integral, or a full matrix.
    """
    text, name = read_text(path, TOML), str(path)
    kind = other_format(name, text)
    if kind not in ("CSV", "YAML", "JSON"):
        repair = "give YAML, JSON, or CSV with the columns joint, kp, kd"
        raise file_error(name, f"is {kind or 'no file of gains that is known'}", repair)
    return _Reading(name, joints).run(_csv(text, name) if kind == "CSV" else _yaml(text, name))


def _csv(text: str, name: str) -> _Node:
    """Each row as a table by the header, in which units may stand in brackets."""
    lines = [line for line in text.splitlines() if line.strip() and not line.startswith("#")] or [""]
    mark = max(",;\t", key=lines[0].count)
    heads = [re.split(r"[\[(]", word, maxsplit=1) for word in lines[0].split(mark)]
    header = [word.strip(" \"'").lower() for word, *_ in heads]
    for key, (_, *unit) in zip(header, heads, strict=True):
        if re.sub("[^a-zµ°]", "", "".join(unit).lower()) not in _UNITS and key in sum(WORDS.values(), ()):
            text, repair = "".join(unit).strip("])\"' "), "convert its gains to N·m/rad or N·m·s/rad"
            raise InputError(Problem(name, 1, key, text, "is not the unit of gains here", repair))
    if not {"joint", *WORDS["p"]} & {*header}:
        rule = "has no header that names the columns"
        raise InputError(Problem(name, 1, "header", lines[0][:60], rule, "begin with joint,kp,kd"))
    rows: list[_Node] = []
    for row in csv.reader(io.StringIO("\n".join(lines[1:])), delimiter=mark):
        line = text.splitlines().index(lines[1 + len(rows)]) + 1
        cells = {key: _Node(cell.strip(), line) for key, cell in zip(header, row, strict=False)}
        rows.append(_Node(cells, line))
    return _Node(rows, 1)


def _yaml(text: str, name: str) -> _Node:
    import yaml

    try:
        return _plain(yaml.compose(text, Loader=yaml.SafeLoader), [_MOST])
    except (yaml.YAMLError, RecursionError) as error:
        mark = getattr(error, "problem_mark", None)
        line = None if mark is None else mark.line + 1
        rule = f"is no YAML ({getattr(error, 'problem', None) or 'nested too deeply'})"
        raise InputError(Problem(name, line, "file", "", rule, "correct the syntax there")) from None


def _plain(node: Any, left: list[int], depth: int = 0) -> _Node:
    """The nodes of a YAML text; aliases count each time, so that they cannot grow beyond bounds."""
    left[0] -= 1
    if node is None or left[0] < 0 or depth > _DEPTH:
        return _Node("", 1)
    line, value = node.start_mark.line + 1, node.value
    if isinstance(value, str):
        return _Node(value, line)
    if node.id == "sequence":
        return _Node([_plain(item, left, depth + 1) for item in value], line)
    return _Node({str(key.value): _plain(item, left, depth + 1) for key, item in value}, line)


class _Reading:
    def __init__(self, name: str, joints: Sequence[str]) -> None:
        self.name, self.joints = name, joints
        self.problems: list[Problem] = []
        self.found: dict[str, list[Pid]] = {}
        self.others: list[str] = []

    def fail(self, line: int | None, key: str, value: str, rule: str, repair: str) -> None:
        self.problems.append(Problem(self.name, line, key, value[:60], rule, repair))

    def run(self, root: _Node) -> tuple[Pid, ...]:
        self._look(root, (), ())
        broken = bool(self.problems)
        for joint in self.joints:
            sets = self.found.get(joint, [])
            if not sets and not broken:
                repair = f"{nearest(joint, self.others, '')} add it".strip()
                self.fail(None, f"joint {joint}", "", "has no p gain in this file", repair)
            if len({(one.p, one.d) for one in sets}) > 1:
                rule = f"has several sets of gains, in lines {', '.join(str(one.line) for one in sets)}"
                self.fail(sets[0].line, f"joint {joint}", "", rule, "keep those of one controller")
        if self.problems:
            raise InputError(self.problems)
        return tuple(self.found[joint][0] for joint in self.joints)

    def _look(self, node: _Node, keys: tuple[str, ...], listed: tuple[str, ...]) -> None:
        if isinstance(node.value, list):
            for item in node.value:
                self._look(item, keys, listed)
        elif isinstance(node.value, dict):
            table = {key.lower(): child for key, child in node.value.items()}
            listed = next((_names(table[key]) for key in _JOINTS if key in table), ()) or listed
            gains = {
                kind: next((table[word] for word in words if word in table), None)
                for kind, words in WORDS.items()
            }
            p = gains["p"]
            if p is not None and isinstance(p.value, (str, list)):
                self._gains(gains, keys, listed)
                return
            for key, child in node.value.items():
                self._look(child, (*keys, key), listed)

    def _gains(
        self, gains: Mapping[str, _Node | None], keys: tuple[str, ...], listed: tuple[str, ...]
    ) -> None:
        p = gains["p"] or _Node("", 1)
        if isinstance(p.value, list):
            lists = {
                k: x.value if isinstance(x.value, list) else [x] * len(p.value) for k, x in gains.items() if x
            }
            if any(isinstance(item.value, list) for items in lists.values() for item in items):
                self.fail(p.line, "p", "", f"is a full matrix; {_LAW}", "write its diagonal")
                return
            names = listed or (tuple(self.joints) if len(p.value) == len(self.joints) else ())
            if any(len(items) != len(names) for items in lists.values()):
                rule = f"is a list of {len(p.value)} gains for {len(names)} joints"
                self.fail(p.line, "p", "", rule, "add a list of joints beside it")
                return
            for i, joint in enumerate(names):
                self._one(joint, {kind: items[i] for kind, items in lists.items()})
            return
        named = [key for key in (*keys, *(listed if len(listed) == 1 else ())) if key in self.joints]
        joint = named[-1] if named else (listed[0] if len(listed) == 1 else (keys or ("",))[-1])
        self._one(joint, {kind: node for kind, node in gains.items() if node is not None})

    def _one(self, joint: str, gains: Mapping[str, _Node]) -> None:
        if joint not in self.joints:
            self.others.append(joint)
            return
        values = {}
        for kind, node in gains.items():
            value = decimal(node.value.strip()) if isinstance(node.value, str) else None
            if value is None or value < 0:
                text = node.value if isinstance(node.value, str) else ""
                rule = "must be a number that is not negative"
                self.fail(node.line, f"{joint}: {kind}", text, rule, "write a decimal like 60.0")
            values[kind] = value or Fraction(0)
        line = gains["p"].line
        if values.get("i"):
            rule = f"is an integral, and outside of the theory: {_LAW}"
            repair = "set it to 0; where g(q) is in the loop, nothing is left for it but friction"
            self.fail(gains["i"].line, f"{joint}: i", decimal_text(values["i"]), rule, repair)
        elif not values["p"] and not self.problems:
            self.fail(line, f"{joint}: p", "0", "must be positive", "give it a gain")
        self.found.setdefault(joint, []).append(Pid(joint, values["p"], values.get("d", Fraction(0)), line))


def _names(node: _Node) -> tuple[str, ...]:
    items = node.value if isinstance(node.value, list) else [node]
    return tuple(item.value for item in items if isinstance(item.value, str) and item.value)
