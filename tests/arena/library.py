"""Add what the library of published proofs writes: python -m tests.arena.library FOLDER, after ``plant``.

The folder has the certificates of ``lyapcheck check proofs/takegaki_arimoto.py --certificates OUT/lib``. Its
theorems stand in the arena with their premises, and with statements that are false while the premises are
still those of the true one.
"""

from __future__ import annotations

import copy
import json
import shutil
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from tests.arena.attacks import encoded, sealed
from tests.arena.plant import ARENA, NOT_ACCEPTED, Arena, Document, collections, read, with_premises

Change = Callable[[dict[str, Any]], None]
THEOREMS = ("Stable", "StableArm")
TURNED = ["num", "-1"]


class Added(Arena):
    """The arena as it stands, without what an earlier run added."""

    def __init__(self, name: str) -> None:
        entries = json.loads((ARENA / "expected.json").read_text(encoding="utf-8"))
        self.entries = [entry for entry in entries if f".{name}." not in entry["path"]]
        for path in ARENA.glob(f"*/*.{name}.*"):
            shutil.rmtree(path) if path.is_dir() else path.unlink()


def damping_turned(argument: dict[str, Any]) -> None:
    argument["system"]["torque"][1][2][1] = ["num", "1"]


def stiffness_turned(argument: dict[str, Any]) -> None:
    torque = argument["system"]["torque"]
    torque[1][1] = ["scale", TURNED, torque[1][1]]


def no_gravity(argument: dict[str, Any]) -> None:
    argument["system"]["torque"] = argument["system"]["torque"][1]


def moving_goal(argument: dict[str, Any]) -> None:
    argument["system"]["desired"] = True


def lower_too_large(argument: dict[str, Any]) -> None:
    argument["lower"]["entries"][0][1] = ["num", "1"]


def rate_too_large(argument: dict[str, Any]) -> None:
    argument["rate"]["entries"] = [["mul", ["num", "2"], ["var", "Kv_min"]]]


def kinetic_alone(argument: dict[str, Any]) -> None:
    argument["energy"] = argument["energy"][1]


FALSE: dict[str, tuple[Change, str]] = {
    "damping-turned": (damping_turned, "K_v adds energy"),
    "stiffness-turned": (stiffness_turned, "K_p repels"),
    "no-gravity": (no_gravity, "gravity is not compensated: the goal is no equilibrium"),
    "moving-goal": (moving_goal, "LaSalle's theorem for a loop that depends on time"),
    "lower-too-large": (lower_too_large, "V is not above the form"),
    "rate-too-large": (rate_too_large, "dV/dt is not below the form"),
    "kinetic-alone": (kinetic_alone, "V does not grow with the error"),
}


def altered(document: Document, change: Change, by_digest: dict[str, Document]) -> list[tuple[str, bytes]]:
    """A theorem whose statement is changed, with the premises that it had."""
    first, *rest = with_premises(document, by_digest) or []
    changed = copy.deepcopy(first)
    change(changed["statement"]["argument"])
    return [(f"{k}.json", encoded(one)) for k, one in enumerate([sealed(changed), *rest])]


def main(folder: str) -> None:
    """Write the files, and what is expected of them."""
    documents = read([Path(folder)])
    documents.sort(key=lambda item: item[1]["statement"]["kind"] not in THEOREMS)
    arena, by_digest = Added(Path(folder).name), {one["digest"]: one for _, one in documents}
    collections(arena, documents)
    name, theorem = next(item for item in documents if item[1]["statement"]["kind"] == "Stable")
    for attack, (change, why) in FALSE.items():
        files = altered(theorem, change, by_digest)
        arena.add(f"bad/{attack}.{name}", files, NOT_ACCEPTED, f"Stable: {why}")
    arena.entries.sort(key=lambda entry: entry["path"])
    (ARENA / "expected.json").write_text(json.dumps(arena.entries, indent=1, ensure_ascii=False) + "\n")


if __name__ == "__main__":
    main(sys.argv[1])
