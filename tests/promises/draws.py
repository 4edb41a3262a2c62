"""Arms with ranges, members of them, and gains near the border of what is accepted.

Everything is drawn as text, the files that a user would write: an arm in TOML or URDF, a gain file, and the
options ``--vary``. A member of the ranges is the same arm in a file without ranges.
"""

from __future__ import annotations

import json
import os
from collections import Counter
from dataclasses import dataclass, field, replace
from fractions import Fraction

from hypothesis import settings
from hypothesis import strategies as st

from lyapcheck.files.decimals import decimal_text
from tests.helpers import command

FAMILIES = ("m = 1", "m = 2", "m = 3", 'family = "tanh"', 'family = "arctan"', 'family = "algebraic"')
MOST_JOINTS = 2 if settings.get_current_profile_name() == "fast" else 3
"""M ≻ 0 over ranges of three masses takes seconds, which the fast set has not."""
MOTOR = ("viscous", "coulomb", "torque_limit")
"""Numbers of a joint that neither form of an arm keeps in the file of its links."""


ASKED = Counter()
"""How often a test has run a command with which exit code, for the record of ``make promises``."""


def drawn(fast, thorough):
    """So many examples in the fast and in the slow set, as they cost; as many as all in ``make promises``."""
    known = {"fast": fast, "thorough": thorough}
    return settings(max_examples=known.get(settings.get_current_profile_name(), settings().max_examples))


def invoke(*words):
    """Run ``lyapcheck`` with some words, and count it."""
    done = command.invoke(*words)
    test = os.environ.get("PYTEST_CURRENT_TEST", "").partition("::")[2].partition(" ")[0].partition("[")[0]
    ASKED[test, words[0], done.exit_code] += 1
    return done


@dataclass(frozen=True)
class Ranged:
    """A number with its range; both ends are the number where it has none."""

    value: Fraction
    low: Fraction
    high: Fraction

    def at(self, share):
        """The member at a share of the range."""
        value = self.low + share * (self.high - self.low)
        return Ranged(value, value, value)

    @property
    def text(self):
        """As in an arm file."""
        if self.low == self.high:
            return decimal_text(self.value)
        ends = f"low = {decimal_text(self.low)}, high = {decimal_text(self.high)}"
        return f'{{ value = {decimal_text(self.value)}, {ends}, assumed = true, note = "drawn" }}'


@dataclass(frozen=True)
class Joint:
    """A joint with its link, of which the axis is that of all joints or turned by a quarter."""

    turned: bool
    mass: Ranged
    com: Fraction
    inertia: Fraction
    viscous: Ranged
    coulomb: Ranged
    torque_limit: Ranged


@dataclass(frozen=True)
class Arm:
    """A drawn arm: its joints, and what is not in its file but in options.

    ``payload`` is a range for ``--vary``; ``urdf`` says which file holds the links; ``printed`` are bounds of
    gravity as a data sheet has them, which the nominal arm keeps.
    """

    joints: tuple[Joint, ...]
    urdf: bool = False
    printed: tuple[Fraction, ...] = ()
    payload: Ranged = field(default_factory=lambda: Ranged(*[Fraction(0)] * 3))

    @property
    def n(self):
        """Number of joints."""
        return len(self.joints)

    @property
    def options(self):
        """What ``--vary`` says: the payload, and masses of a URDF file, which has no ranges of its own."""
        result = []
        if self.payload.high > 0:
            result += [
                "--vary",
                f"payload={decimal_text(self.payload.low)}..{decimal_text(self.payload.high)}",
            ]
        if self.urdf:
            for k, joint in enumerate(self.joints):
                if joint.mass.low < joint.mass.high:
                    ends = f"{decimal_text(joint.mass.low)}..{decimal_text(joint.mass.high)}"
                    result += ["--vary", f"j{k + 1}_mass={ends}"]
        return tuple(result)

    def at(self, shares):
        """A member: each range at one of the shares, in turn; a payload is a mass of the last link."""
        rest = iter(shares * 10)
        joints = tuple(
            replace(joint, **{key: getattr(joint, key).at(next(rest)) for key in ("mass", *MOTOR)})
            for joint in self.joints
        )
        load = self.payload.at(next(rest)).value
        last = joints[-1]
        heavy = replace(last, mass=Ranged(*[last.mass.value + load] * 3))
        return Arm((*joints[:-1], heavy), self.urdf)

    def written(self, folder, name):
        """The arm's file or files; returns the name of the arm file."""
        folder.mkdir(exist_ok=True, parents=True)
        text = self._overlay(name) if self.urdf else self._links()
        (folder / f"{name}.toml").write_text(text, encoding="utf-8")
        if self.urdf:
            (folder / f"{name}.urdf").write_text(self._urdf(), encoding="utf-8")
        return f"{name}.toml"

    def _links(self):
        lines = ['title = "Drawn"', "gravity = [0, -9.81, 0]"]
        for k, joint in enumerate(self.joints):
            about = decimal_text(joint.inertia)
            lines += [
                "[[links]]",
                f'name = "j{k + 1}"',
                f"axis = {[1, 0, 0] if joint.turned else [0, 0, 1]}",
                f"origin = [{0 if k == 0 else 0.3}, 0, 0]",
                f"mass = {joint.mass.text}",
                f"com = [{decimal_text(joint.com)}, 0, 0]",
                f"inertia = {{ ixx = {about}, iyy = {about}, izz = {about} }}",
                *self._motor(k),
            ]
        return "\n".join(lines) + "\n"

    def _overlay(self, name):
        lines = ['title = "Drawn"', f'urdf = "{name}.urdf"', "gravity = [0, -9.81, 0]"]
        for k in range(self.n):
            lines += ["[[joints]]", f'name = "j{k + 1}"', *self._motor(k)]
        return "\n".join(lines) + "\n"

    def _motor(self, k):
        """Friction and limits of a joint, which both forms of an arm file write alike."""
        joint = self.joints[k]
        lines = [
            f"{key} = {getattr(joint, key).text}" for key in MOTOR if key != "coulomb" or joint.coulomb.high
        ]
        return [*lines, *(f"gravity_bound = {decimal_text(self.printed[k])}" for _ in self.printed[:1])]

    def _urdf(self):
        parts = ['<robot name="drawn">', '<link name="l0"/>']
        for k, joint in enumerate(self.joints, 1):
            axis, reach = ("1 0 0" if joint.turned else "0 0 1"), (0 if k == 1 else 0.3)
            inertia = " ".join(
                f'{key}="{decimal_text(joint.inertia) if key[1] == key[2] else 0}"'
                for key in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
            )
            parts += [
                f'<link name="l{k}"><inertial><origin xyz="{decimal_text(joint.com)} 0 0"/>',
                f'<mass value="{decimal_text(joint.mass.value)}"/><inertia {inertia}/></inertial></link>',
                f'<joint name="j{k}" type="revolute"><parent link="l{k - 1}"/><child link="l{k}"/>',
                f'<origin xyz="{reach} 0 0"/><axis xyz="{axis}"/>',
                '<limit lower="-3" upper="3" effort="1000" velocity="9"/></joint>',
            ]
        return "".join([*parts, "</robot>"])


def decimals(low, high):
    """Decimals of three places."""
    ends = (int(Fraction(end) * 1000) for end in (low, high))
    return st.integers(*ends).map(lambda k: Fraction(k, 1000))


@st.composite
def ranged(draw, low, high):
    """A number without a range, or with one on both sides of it or on one."""
    value = draw(decimals(low, high))
    below, above = (draw(st.sampled_from([Fraction(0), Fraction(1, 10), Fraction(1, 2)])) for _ in range(2))
    return Ranged(value, value * (1 - below), value * (1 + 4 * above))


@st.composite
def arms(draw, most=MOST_JOINTS):
    """An arm of one to so many joints."""
    n = draw(st.integers(1, most))
    none = Ranged(*[Fraction(0)] * 3)
    joints = tuple(
        Joint(
            turned=k > 0 and draw(st.booleans()),
            mass=draw(ranged("0.5", "5")),
            com=draw(decimals("0.05", "0.3")),
            inertia=draw(decimals("0.01", "0.3")),
            viscous=draw(ranged("0.1", "4")),
            coulomb=draw(st.one_of(st.just(none), ranged("0.1", "2"))),
            torque_limit=draw(ranged("20", "200")),
        )
        for k in range(n)
    )
    load = draw(st.sampled_from([none, Ranged(Fraction(0), Fraction(0), Fraction(5))]))
    arm = Arm(joints, draw(st.booleans()), payload=load)
    return replace(arm, printed=nominal_gravity(joints)) if draw(st.booleans()) else arm


def nominal_gravity(joints):
    """No joint of the nominal arm bears more, N·m: all links stretched out."""
    weight, reach = Fraction(981, 100), Fraction(3, 10)
    return tuple(
        weight
        * sum((one.mass.value * (k * reach + one.com) for k, one in enumerate(joints[i:])), Fraction(0))
        for i in range(len(joints))
    )


shares = st.lists(st.sampled_from([Fraction(0), Fraction(3, 8), Fraction(1)]), min_size=13, max_size=13)
"""Where a member lies: at an end of each range, or inside."""


def gain_file(folder, arm, family, kp, kv, name="gains", more=""):
    """A gain file of one set; ``more`` are further keys of the set, and tables."""
    path = folder / f"{name}.toml"
    lists = f"kp = [{', '.join(kp)}]\nkv = [{', '.join(kv)}]\n{more}"
    path.write_text(f'robot = "{arm}"\n[[gains]]\nname = "drawn"\n{family}\n{lists}', encoding="utf-8")
    return path


def near_the_border(folder, arm, n, family, options, share, more=""):
    """Gains at a share of the largest that the gate names over the ranges, where it names some."""
    tiny = gain_file(folder, arm, family, ["0.001"] * n, ["0.001"] * n, "tiny", more)
    largest = {"10p": [], "19": []}
    for check in results(asked("gate", str(tiny), *options))[0]["checks"]:
        if check["id"] in largest:
            most = check["largest_admissible"]
            largest[check["id"]].append(Fraction(most) if most not in (None, "none") else Fraction(1, 10))
    kv = [share * most for most in largest["19"]]
    kp = [max(share * most - k, Fraction(1, 100)) for most, k in zip(largest["10p"], kv, strict=True)]
    return gain_file(folder, arm, family, *([decimal_text(x) for x in row] for row in (kp, kv)), more=more)


def asked(*words, plain=False):
    """A command, with its answer as JSON."""
    return invoke(*words, *([] if plain else ["--format", "json"]))


def results(done):
    """What its JSON says."""
    found = json.loads(done.stdout)["results"]
    return found
