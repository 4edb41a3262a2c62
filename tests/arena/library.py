"""Add what the library of published proofs writes: python -m tests.arena.library FOLDER, after ``plant``.

The folder has the certificates of one script:

    lyapcheck check proofs/takegaki_arimoto.py --certificates OUT/lib     (LaSalle's theorem)
    lyapcheck check proofs/slotine_li.py --certificates OUT/slo           (exponential, ISS, a cascade)
    lyapcheck check proofs/pid.py --certificates OUT/pid                  (a region, integral action)
    lyapcheck check proofs/feedforward.py --certificates OUT/fee          (a region, along a motion)

Its theorems stand in the arena with their premises, and with statements that are false while the premises are
still those of the true one.
"""

from __future__ import annotations

import copy
import json
import shutil
import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from fractions import Fraction
from importlib.metadata import version
from pathlib import Path
from typing import Any

from lyapcheck.certificate import Certificate
from lyapcheck.check.certificate import About
from lyapcheck.check.kinds.stability import ByObligations
from lyapcheck.check.statement import Proof, Statement, Witness
from lyapcheck.claims.arguments import at_arm, lasalle
from lyapcheck.claims.goals import constant_goal, norm
from lyapcheck.claims.procedures import propose
from lyapcheck.robots import load
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


def put(*place: Any) -> Change:
    """A change by which the last of these stands at the place that the others name."""
    *path, last, value = place

    def change(argument: dict[str, Any]) -> None:
        for step in path:
            argument = argument[step]
        argument[last] = value

    return change


ZERO, ONE, TWO = ["num", "0"], ["num", "1"], ["num", "2"]
CHANGES, CONTRACTION = ("changes", 0, "equals"), ("cascade", "contraction")
FALSE: dict[str, tuple[Change, str]] = {
    "damping-turned": (damping_turned, "K_v adds energy"),
    "stiffness-turned": (stiffness_turned, "K_p repels"),
    "no-gravity": (no_gravity, "gravity is not compensated: the goal is no equilibrium"),
    "moving-goal": (moving_goal, "LaSalle's theorem for a loop that depends on time"),
    "lower-too-large": (lower_too_large, "V is not above the form"),
    "rate-too-large": (rate_too_large, "dV/dt is not below the form"),
    "kinetic-alone": (kinetic_alone, "V does not grow with the error"),
}
FALSE_OF: dict[str, dict[str, tuple[Change, str]]] = {
    "lib.P": FALSE,
    "slo.P": {
        "exponential-rate": (put("rate", "entries", 2, ["var", "K_max"]), "dV/dt is not below the form"),
        "exponential-above": (put("lower", "entries", 2, ["var", "beta"]), "V is not above the form"),
        "exponential-below": (put("upper", "entries", 2, ["var", "mu"]), "V is above Φ"),
        "exponential-no-upper": (put("upper", None), "V ≤ Φ is not shown"),
        "exponential-share": (put("rate", "entries", 0, ["var", "s"]), "a rate that goes to 0 far away"),
        "exponential-linear": (put("lower", "linear", [["norm_w", ONE]]), "no quadratic form"),
        "exponential-unseen": (
            lambda it: it.update(rate={"sizes": ["norm_w"], "entries": [ONE], "linear": []}),
            "ψ does not see the errors",
        ),
        "exponential-other": (put(*CHANGES, 1, 1, ["diag", "K"]), "V is written with another letter"),
        "exponential-letter": (
            put(*CHANGES, 1, ["scale", ["var", "K_min"], ["vec", "e"]]),
            "a change of letters that is not linear with numbers",
        ),
    },
    "slo.P.disturbed": {
        "ISS-no-gain": (put("gain", None), "a torque that dV/dt does not see"),
        "ISS-gain": (put("gain", "linear", 0, 1, ZERO), "the torque acts on the errors too"),
        "ISS-gain-less": (put("gain", "linear", 1, 1, ["num", "1/2"]), "half of the torque"),
        "ISS-gain-square": (
            put("gain", {"sizes": ["norm_w"], "entries": [ONE], "linear": []}),
            "a gain that is not linear in the norms",
        ),
        "ISS-theorem": (put("theorem", "exponential"), "exponentially stable under an unknown torque"),
        "ISS-undisturbed": (put("system", "disturbed", False), "of a loop without a disturbance"),
        "ISS-local": (put("local", True), "ISS within a region"),
    },
    "slo.convergence": {
        "cascade-contraction": (
            put(*CONTRACTION, "entries", 0, ["var", "Lambda_max"]),
            "e does not contract as fast",
        ),
        "cascade-motion": (put("cascade", "motion", ["var", "norm_y_w"]), "‖M ẏ‖ is larger"),
        "cascade-rate": (put("rate", "entries", 0, ["var", "K_max"]), "dV/dt is not below the form"),
        "cascade-none": (put("cascade", None), "nothing is said of how e follows"),
        "cascade-strict": (put("theorem", "uniform"), "stability, which Barbalat's lemma does not give"),
        "cascade-share": (put("lower", "entries", 0, ["var", "s"]), "φ that goes to 0 far away"),
        "cascade-error": (put("changes", 0, "state", "e"), "the error itself is changed"),
        "cascade-rest": (
            put(
                "rest",
                {"against": ["vec", "e"], "form": {"sizes": ["norm_e"], "entries": [ONE], "linear": []}},
            ),
            "with what LaSalle's theorem asks for",
        ),
        "cascade-unseen": (
            put(*CONTRACTION, "sizes", ["norm_e", "norm_w"]),
            "in a size that does not vanish",
        ),
    },
    "pid.P": {
        "region-global": (put("local", False), "dV/dt is bounded within the region alone"),
        "region-no-condition": (put("where", []), "for all gains"),
        "region-no-damping": (lambda it: it["where"].pop(1), "for any damping"),
        "region-no-gravity": (put("gravity", False), "V without the energy of gravity"),
        "region-no-integral": (
            put("system", "states", 0, "rate", ["scale", ["num", "-1"], ["vec", "e"]]),
            "integral action turned",
        ),
        "region-no-rest": (put("rest", None), "z may stay anywhere"),
        "region-rest": (put("rest", "form", "sizes", ["norm_w"]), "what stays 0 does not see z"),
        "region-changed": (
            put("changes", 0, "equals", 1, ["scale", TWO, ["vec", "y_z"]]),
            "a change of letters that stretches",
        ),
        "region-lower": (put("lower", "entries", 5, ["var", "Ki_min"]), "V is not above the form"),
        "region-rate": (put("rate", "entries", 2, ["var", "Kv_min"]), "dV/dt is not below the form"),
    },
    "fee.P": {
        "feedforward-global": (put("local", False), "dV/dt is bounded within the region alone"),
        "feedforward-no-condition": (put("where", []), "for all gains"),
        "feedforward-no-stiffness": (lambda it: it["where"].pop(1), "for any stiffness"),
        "feedforward-goal": (put("system", "desired", False), "at a goal, under a torque for a motion"),
        "feedforward-gravity": (put("gravity", True), "gravity has no energy along a motion"),
        "feedforward-below": (put("upper", "entries", 2, ["var", "mu"]), "V is above Φ"),
        "feedforward-rate": (put("rate", "entries", 2, ["var", "Kv_min"]), "dV/dt is not below the form"),
    },
}
"""For each theorem, what makes its statement false, or one that its proof is not about."""


def altered(document: Document, change: Change, by_digest: dict[str, Document]) -> list[tuple[str, bytes]]:
    """A theorem whose statement is changed, with the premises that it had."""
    first, *rest = with_premises(document, by_digest) or []
    changed = copy.deepcopy(first)
    change(changed["statement"]["argument"])
    return [(f"{k}.json", encoded(one)) for k, one in enumerate([sealed(changed), *rest])]


def conditions_that_nothing_meets() -> Iterator[tuple[str, str, Statement, Proof]]:
    """K_v with the wrong sign, under conditions of which all follows: obligations are proved."""
    goal = constant_goal()
    e, w = goal.e, goal.w
    K_p, K_v = goal.gains("Kp Kv")
    energy = w @ goal.M @ w / 2 + e @ K_p @ e / 2
    above = goal.mu / 2 * norm(w) ** 2 + K_p.min / 2 * norm(e) ** 2
    conditions = {
        "boundary": [-K_v.min * K_v.max >= K_v.min],
        "order": [K_v.max < K_v.min, -K_v.max >= K_v.min - K_v.max],
    }
    for name, where in conditions.items():
        stable = lasalle(
            goal.under(K_p @ e + K_v @ w + goal.gravity),
            energy,
            above=above,
            rate=-K_v.max * norm(w) ** 2,
            rest=(e, K_p.min * norm(e) ** 2),
            where=where,
        )
        proofs = tuple(_proof_of(one) for _, one in stable.obligations())
        for point in (None, Witness((("Kv_max", Fraction(7)), ("Kv_min", Fraction(0))))):
            yield (
                f"{name}-{'absent' if point is None else 'false'}",
                name,
                stable,
                ByObligations(proofs, point),
            )
        on_arm = at_arm(stable, load("pelican2"), Kp="30 30", Kv="7 3")
        least = replace(on_arm, numbers=(("Kv_max", Fraction(7)), ("Kv_min", Fraction(0))))
        proofs = tuple(_proof_of(one, name) for name, one in least.obligations())
        yield f"{name}-arm", name, least, ByObligations(proofs)


def _proof_of(one: Statement, name: str = "") -> Proof:
    """Its proof, or its refutation where no proof is to be had."""
    result = propose(one).proof
    assert result is not None, name
    return result


def unmet(arena: Arena, name_of_folder: str) -> None:
    """Such theorems as certificates."""
    used = {name: version(name) for name in ("lyapcheck", "python-flint")}
    for name, why, statement, proof in conditions_that_nothing_meets():
        about = About(name, statement.text()[:200], None, None, "library")
        text = Certificate(about, statement, "proved", "exact", proof, {}, used).text()
        said = f"{type(statement).__name__}: nothing meets its conditions ({why})"
        arena.add(f"bad/unmet-{name}.{name_of_folder}.json", text.encode(), NOT_ACCEPTED, said)


def main(folder: str) -> None:
    """Write the files, and what is expected of them."""
    documents = read([Path(folder)])
    documents.sort(key=lambda item: item[1]["statement"]["kind"] not in THEOREMS)
    arena, by_digest = Added(Path(folder).name), {one["digest"]: one for _, one in documents}
    collections(arena, documents)
    for name, theorem in documents:
        for attack, (change, why) in FALSE_OF.get(name, {}).items():
            files = altered(theorem, change, by_digest)
            arena.add(f"bad/{attack}.{name}", files, NOT_ACCEPTED, f"Stable: {why}")
    if Path(folder).name == "lib":
        unmet(arena, "lib")
    arena.entries.sort(key=lambda entry: entry["path"])
    (ARENA / "expected.json").write_text(json.dumps(arena.entries, indent=1, ensure_ascii=False) + "\n")


if __name__ == "__main__":
    main(sys.argv[1])
