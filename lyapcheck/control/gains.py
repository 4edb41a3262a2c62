"""Gain files: which gains, for which controller of the family, on which arm."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lyapcheck.errors import InputError, Problem, argument_error, nearest
from lyapcheck.extensions import shipped
from lyapcheck.family.base import LARGEST_M, names
from lyapcheck.files.decimals import decimal_text
from lyapcheck.files.fields import Fields, Notes
from lyapcheck.files.loop import NOTHING, LoopEntry, read_loop
from lyapcheck.files.toml import GAINS, KeyPath, Place, TomlFile, open_document, require_kind
from lyapcheck.output.escapes import printable
from lyapcheck.robots.choice import named, placed, split

if TYPE_CHECKING:
    from lyapcheck.robots import ArmLike

# --- Which conditions decide about a gain set: those asked for, else its own, else the paper's two.


DECIDING = ("10p", "19")
"""The paper's tuning rules, for a gain set that names no conditions."""
CERTIFICATES = ("scalar", "global", "lasalle")
"""Proofs of stability for one arm and one gain set."""
RUNNING = ("sampled", "holds")
"""What is judged of the loop as a computer runs it, where a record of it is there; see `LoopRecord`."""
KNOWN = ("10", "10p", "10i", "19", *CERTIFICATES, *RUNNING)
"""Every condition that may decide."""


def deciding_for(gains: GainSet, asked: Sequence[str] | None = None) -> tuple[str, ...]:
    """Return the conditions that decide about a gain set.

    Args:
        gains: the set; ``condition`` of its file is part of it.
        asked: conditions of the command line, which go before those of the set; ``None`` without any.
    """
    return tuple(dict.fromkeys(gains.condition or DECIDING if asked is None else asked))


Gains = tuple[Fraction, ...]


@dataclass(frozen=True)
class GainSet:
    """The gains of one controller τ = K_p h(e) − K_v h(q̇) + g(q).

    Args:
        name: its name in the file.
        m: the order of the hyperbolic family. None for another family.
        kp: diagonal of K_p, N·m (N·m/rad or N·m/° where h is linear), exact.
        kv: diagonal of K_v, N·m (N·m·s/rad or N·m·s/° where h is linear), exact.
        family: name of the function h. ``linear`` is PD with gravity compensation.
        angle_unit: ``deg`` if linear gains are per degree.
        index: its number in the file, from 0.
        condition: the conditions that decide about it. Empty if the file names none.

    References: (6) of reyes2019family.
    """

    name: str
    m: int | None
    kp: tuple[Fraction, ...]
    kv: tuple[Fraction, ...]
    family: str = "hyperbolic"
    angle_unit: str = "rad"
    index: int = 0
    condition: tuple[str, ...] = ()

    def __repr__(self) -> str:
        kp, kv = (", ".join(map(decimal_text, row)) for row in (self.kp, self.kv))
        member = self.family if self.m is None else f"m = {self.m}"
        return f"<GainSet: {self.name}, {member}, kp = [{kp}], kv = [{kv}]>"

    @property
    def n(self) -> int:
        return len(self.kp)


@dataclass(frozen=True)
class Bounds:
    """Numbers of the arm in a gain file. None means that the arm file gives the number.

    Args:
        viscous_min: λmin(B), N·m·s/rad.
        torque: torque limit of each joint, N·m.
        gravity: bound k_gi of each gravity torque, N·m.
    """

    viscous_min: Fraction | None = None
    torque: tuple[Fraction, ...] | None = None
    gravity: tuple[Fraction, ...] | None = None

    @property
    def said(self) -> str:
        """Words for the end of a clause; empty where the arm file gives every number."""
        return "" if self == Bounds() else " under [bounds]"


@dataclass(frozen=True)
class GainFile:
    """A gain file as read; ``document`` knows the line and column of every number.

    ``certificates`` is the folder whose proofs the gate rechecks before it searches for any.
    """

    path: str
    robot: str | None
    gains: tuple[GainSet, ...]
    bounds: Bounds = Bounds()
    document: TomlFile | None = None
    loop: LoopEntry = NOTHING
    certificates: str | None = None

    def __repr__(self) -> str:
        return f"<GainFile: {self.path}, {', '.join(one.name for one in self.gains)}>"

    def place(self, gain_set: GainSet, key: str = "", joint: int | None = None) -> Place | None:
        """Where a gain of a set stands; ``joint`` counts from 0."""
        if self.document is None:
            return None
        path: KeyPath = ("gains", gain_set.index, key) if key else ("gains", gain_set.index)
        return self.document.place(path if joint is None else (*path, joint))

    def spot(self, gain_set: GainSet, key: str = "", joint: int | None = None) -> dict[str, Any]:
        """The place of a gain set, or of one of its gains, as annotations have it."""
        place = self.place(gain_set, key, joint)
        return {"path": self.path} | ({} if place is None else {"line": place.line, "column": place.column})


def gain_file_of(file: GainFile | str | Path) -> GainFile:
    """A gain file as read, or the one at a path."""
    return file if isinstance(file, GainFile) else read_gain_file(file)


def one_gain_set(gains: GainSet | str | Path) -> GainSet:
    """A gain set as it is, or the only one of the gain file at a path.

    Raises:
        InputError: the file cannot be used, or has several gain sets.
    """
    if isinstance(gains, GainSet):
        return gains
    file = read_gain_file(gains)
    if len(file.gains) > 1:
        names = ", ".join(one.name for one in file.gains)
        rule, repair = f"has several gain sets: {names}", "take one of read_gain_file(path).gains"
        raise argument_error("gain file", str(gains), rule, repair)
    return file.gains[0]


def read_gain_file(path: str | Path, robot: ArmLike | None = None, *, undamped: bool = False) -> GainFile:
    """The gain sets of a TOML file, every decimal exact.

    Args:
        path: of the file.
        robot: an arm, or a choice of the file's, whose joints gains by name are for instead of the file's.
        undamped: take k_v = 0, which is a verdict of the gate and a mistake elsewhere.

    Raises:
        InputError: everything that is wrong with the file, each problem with its line and repair.
    """
    document = open_document(Path(path), str(path))
    require_kind(document.name, document.data, GAINS)
    notes = Notes(document.name, document.line)
    top = Fields(document.data, (), notes)
    own = beside(top.text("robot") or None, Path(path))
    condition = conditions_of(top)
    tables = top.tables("gains", required=True)
    by_name = any(isinstance(table.data.get(key), dict) for table in tables for key in ("kp", "kv"))
    joints = None
    if by_name:
        from lyapcheck.robots import RobotModel, arm_of

        arm = robot if isinstance(robot, RobotModel) else named(robot, own)
        joints = () if arm is None else arm_of(arm).joints
    sets = [gain_set_of(table, index, condition, joints, undamped) for index, table in enumerate(tables)]
    gains = tuple(gain_set for gain_set in sets if gain_set is not None)
    bounds, table = Bounds(), top.table("bounds")
    if table is not None:
        gravity = table.numbers("gravity", positive=False)
        bounds = Bounds(table.number("viscous_min"), table.numbers("torque"), gravity)
        table.close()
    loop, folder = read_loop(top.table("loop")), top.text("certificates")
    top.close()
    named_before: set[str] = set()
    for table in tables:
        name = table.data.get("name")
        if isinstance(name, str):
            if name in named_before:
                table.fail("name", "is used twice", "give each set its own name")
            named_before.add(name)
    if gains:
        n = gains[0].n
        for gain_set in gains[1:]:
            if gain_set.n != n:
                rule = f"has {gain_set.n} joints where the first set has {n}"
                notes.fail(("gains", gain_set.index, "kp"), None, rule, "keep one arm to a file")
        for key, values in (("torque", bounds.torque), ("gravity", bounds.gravity)):
            if values is not None and len(values) != n:
                rule = f"has {len(values)} entries for {n} joints"
                notes.fail(("bounds", key), None, rule, f"give {n} numbers, one a joint")
    if notes.problems:
        raise InputError(notes.problems)
    certificates = str(Path(path).parent / folder) if folder else None
    return GainFile(document.name, own, gains, bounds, document, loop, certificates)


def conditions_of(table: Fields) -> tuple[str, ...]:
    """Read ``condition``, a list of conditions; empty where the key is absent or wrong, which is noted."""
    value = table.raw("condition")
    if value is None:
        return ()
    repair = 'write condition = ["10p", "19"]'
    if not isinstance(value, list) or not value:
        table.fail("condition", "must be a list of conditions", repair)
        return ()
    wrong = [name for name in value if name not in KNOWN]
    if wrong:
        table.fail("condition", f"must be of {', '.join(KNOWN)}", repair)
    elif len(set(value)) < len(value):
        table.fail("condition", "has a condition twice", "give each once")
    return () if wrong else tuple(dict.fromkeys(value))


def gain_set_of(
    table: Fields,
    index: int,
    condition: tuple[str, ...] = (),
    joints: tuple[str, ...] | None = None,
    undamped: bool = False,
) -> GainSet | None:
    """The gain set of one table of a file; nothing where something is wrong with it, which is noted.

    Args:
        table: of the file.
        index: its number, from 0.
        condition: of the whole file; that of the set goes before it.
        joints: of the arm, for gains by name.
        undamped: whether k_v = 0 may stand.
    """
    name = table.text("name", required=True)
    family = table.choice("family", names(), "hyperbolic")
    m = table.integer("m", 1, LARGEST_M, required=family == "hyperbolic")
    if m is not None and family != "hyperbolic":
        table.fail("m", f"belongs to the hyperbolic family, not to {family}", "remove m, or the key family")
    angle = table.choice("angle", ("rad", "deg"), "rad")
    if angle == "deg" and family != "linear":
        table.fail("angle", f"the gains of {family} are torques, not torques per angle", "remove angle")
    others = [key for key in table.data if key.lower() in _OTHERS and key not in ("kp", "kv")]
    for key in others:
        table.raw(key)
        table.fail(key, *_OTHERS[key.lower()])
    kp = _gains(table, "kp", joints, True, not others)
    kv = _gains(table, "kv", joints, not undamped, not others)
    condition = conditions_of(table) or condition
    table.close()
    if kp is None or kv is None:
        return None
    if len(kp) != len(kv):
        rule = f"has {len(kv)} gain{'s' if len(kv) > 1 else ''} where kp has {len(kp)}"
        table.fail("kv", rule, "give both as many gains as the arm has joints")
    return GainSet(name, m, kp, kv, family, angle, index, condition)


_KP = ("is not a key here: the gain of the error is kp", "write kp = …")
_KV = ("is not a key here: the gain of the speed is kv", "write kv = …")
_KI = (
    "is an integral, and outside of the theory: its state is not in the Lyapunov function",
    "remove it; the gates judge the proportional and derivative part with g(q) in the loop",
)
_OTHERS = {"kd": _KV, "d": _KV, "p": _KP, "kp": _KP, "kv": _KV, "ki": _KI, "i": _KI}
"""What other programs call gains."""


def _gains(
    table: Fields, key: str, joints: tuple[str, ...] | None, positive: bool, required: bool
) -> Gains | None:
    """A list of gains, one a joint, or a table of them by joint."""
    value = table.data.get(key)
    if isinstance(value, list) and any(isinstance(item, list) for item in value):
        table.raw(key)
        table.fail(key, "is a full matrix, and the gains of the theory are diagonal", "write its diagonal")
        return None
    numbers = value if isinstance(value, list) and len(value) % 2 == 0 else []
    if 0 in numbers[::2] and all(type(item) is int for item in numbers):  # [0,2, 0,2]
        table.raw(key)
        table.fail(
            key,
            f"has {len(numbers)} whole numbers, some of them 0, and no gain is 0",
            "write 0.2 with a point, not 0,2",
        )
        return None
    if not isinstance(value, dict):
        return table.numbers(key, required, positive)
    table.raw(key)
    if not joints:
        table.fail(key, "is by joint, and the file names no arm", 'add robot = "arm.urdf", or give a list')
        return None
    inner = Fields(value, (*table.path, key), table.notes)
    found = [inner.number(joint, positive) if joint in value else None for joint in joints]
    for joint in value:
        if joint not in joints:
            inner.raw(joint)
            inner.fail(joint, "is no joint of this arm", nearest(joint, joints, f"use {', '.join(joints)}"))
    missing = [joint for joint in joints if joint not in value]
    if missing:
        table.fail(key, f"has no gain for {', '.join(missing)}", "give each joint of the arm its gain")
    known = tuple(gain for gain in found if gain is not None)
    return known if len(known) == len(joints) and len(value) == len(joints) else None


def beside(robot: str | None, file: Path) -> str | None:
    """A robot named by a path is meant relative to the gain file."""
    return None if robot is None else placed(robot, lambda path: str(file.parent / path))


@contextmanager
def arm_named_in(file: GainFile, replaced: object = None) -> Iterator[None]:
    """Reading the arm that a gain file names: where there is none such, that line of the gain file is told.

    Other problems are those of the arm file.

    Args:
        file: the gain file.
        replaced: what is read instead of the arm in the file, which then is not at fault.
    """
    try:
        yield
    except InputError as error:
        if replaced or file.robot is None:
            raise
        own, place, problems = file.robot, None, []
        if file.document is not None:
            own, place = file.document.data["robot"], file.document.place(("robot",))
        line = None if place is None else place.line
        for one in error.problems:
            whole = one.key == "file" and one.line is None and one.file == split(file.robot)[0]
            rule = f"{file.robot} {one.rule}" if whole and file.robot != own else one.rule
            told = Problem(file.path, line, "robot", printable(str(own)), rule, one.repair)
            problems.append(told if whole or one.key == "robot" else one)
        raise InputError(problems) from None


# --- The paper's own gain files, which travel with lyapcheck.


PRINTED_GAMMA = {1: Fraction(1), 2: Fraction(105, 100), 3: Fraction(111, 100)}
"""γ_1, γ_2, γ_3 as the paper prints them after (7): the last two are below the true ones."""


def paper_gain_file(name: str = "table2") -> Path:
    """The path of one of the paper's gain files: ``table2``, ``table2_pd`` or ``table2_shoulder_elbow``.

    Raises:
        InputError: no gain file of that name.
    """
    path = shipped("proofs") / f"{name}.toml"
    if not path.is_file():
        known = ", ".join(sorted(file.stem for file in shipped("proofs").glob("table*.toml")))
        raise argument_error("gain file", name, "is not one of the paper's", f"use one of: {known}")
    return path
