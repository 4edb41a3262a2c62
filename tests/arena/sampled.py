"""Gains on a computer: what (S) shows, and at its border what it does not.

    python -m tests.arena.sampled

adds them to the arena as it stands. What is expected of the border is worked out by hand beside it.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction as F
from typing import Any

from lyapcheck.check.kinds.chain import NoTorque, OwnLevers
from lyapcheck.check.kinds.inertia import HarmonicSizes
from lyapcheck.check.kinds.sampled import SampledStable, ShortPeriod
from lyapcheck.check.verify import verify
from tests.arena.attacks import edited, encoded
from tests.arena.extra import LINKS, vector
from tests.arena.library import Added
from tests.arena.plant import ARENA
from tests.arena.truths import certified

PRINTED = SampledStable(
    *("hyperbolic", 1, (F(28), F(60), F(5)), (F("0.233"),) * 3, (F("0.406"),) * 3),
    k_g=(F(0), F("40.28"), F("1.81")),
    links=(),
    fall=(),
    mass=(),
    potential=(),
    parameters=(),
    period=F("0.0025"),
    stretch=F(1),
    delay=0,
    taps=(F(1),),
    conclusion="goal",
)
"""The paper's, from printed numbers: b_2 > 0.233 + T/2·(60 + 40.28 + 1.81)."""
NOTHING = ShortPeriod((), ())
ONE = replace(
    PRINTED,
    **{"family": "tanh", "m": None, "kp": (F(6),), "kv": (F(1),), "viscous_min": (F(5),), "k_g": ()},
    mass=((((((0, 0, 0), F(1)),),),)),
    potential=(((0, 1, 1), F(-1)),),
    parameters=((F(1), F(2)),),
    period=F(37, 100),
    stretch=F(2),
    taps=(F(3, 4), F(-1, 4)),
)
"""g = p sin q, p in [1, 2], read with jitter: 5 > 2·(1 + ½·T·(6 + 2)), so that T < 3/8 is enough."""
SHOWN = ShortPeriod((F(2),), (HarmonicSizes(),))
TWO = replace(
    PRINTED,
    **{"family": "tanh", "m": None, "kp": (F(6), F(1)), "kv": (F(1), F(1)), "viscous_min": (F(12), F(12))},
    **{
        "k_g": (),
        "links": LINKS,
        "fall": vector(1, 0, 0),
        "period": F(1, 2),
        "delay": 1,
        "conclusion": "rest",
    },
)
"""|g_1| ≤ 3 and |g_2| ≤ 1: 12 > 1 + 3/2·T·(6 + 3 + 1), so that T < 11/15 is enough."""
BOTH = ShortPeriod((F(3), F(1)), (OwnLevers((1,)), OwnLevers(())))
NEAR = F(1, 10**9)


def good() -> Iterator[tuple[str, SampledStable, ShortPeriod]]:
    yield "printed", PRINTED, NOTHING
    yield "printed-border", replace(PRINTED, period=F("0.346") / F("102.09") - NEAR), NOTHING
    yield "printed-rest", replace(PRINTED, conclusion="rest"), NOTHING
    yield "potential", ONE, SHOWN
    yield "links", TWO, BOTH
    upright = replace(TWO, fall=vector(0, 0, 1), period=F(1))
    yield "links-upright", upright, ShortPeriod((F(0), F(0)), (NoTorque(), NoTorque()))


def not_shown() -> Iterator[tuple[str, SampledStable, ShortPeriod]]:
    """(S) does not hold, or not with what is shown."""
    yield "equality", replace(PRINTED, period=F("0.346") / F("102.09")), NOTHING
    yield "late", replace(PRINTED, delay=1), NOTHING
    yield "jitter", replace(PRINTED, stretch=F("1.13")), NOTHING
    yield "own-bound-alone", replace(PRINTED, period=F("0.346") / F("100.28") - NEAR), NOTHING
    yield "printed-secant", replace(PRINTED, m=3), NOTHING
    yield "no-slope", replace(PRINTED, m=60), NOTHING
    yield "one-joint", replace(PRINTED, viscous_min=(F("0.406"), F("0.36"), F("0.406"))), NOTHING
    yield "taps-that-cancel", replace(ONE, taps=(F(2), F(-1))), SHOWN
    yield "stiffer", replace(ONE, kp=(F(7),)), SHOWN
    yield "equality-with-jitter", replace(ONE, period=F(3, 8)), SHOWN
    yield "range", replace(ONE, parameters=((F(1), F(3)),)), SHOWN
    yield "low-k_g", ONE, replace(SHOWN, k_g=(F(2) - NEAR,))
    twice = (((0, 2, 1), F(-1)),)
    yield "an-angle-twice", replace(ONE, potential=twice), replace(SHOWN, k_g=(F(2),))
    yield "no-bound", ONE, NOTHING
    yield "bound-beside-premise", PRINTED, ShortPeriod((F(0),) * 3, (HarmonicSizes(),) * 3)
    yield "low-lever", TWO, replace(BOTH, k_g=(F(3) - NEAR, F(1)))
    yield "heavy-fall", replace(TWO, fall=vector(9, 0, 0)), BOTH
    yield "no-torque", TWO, ShortPeriod((F(0), F(0)), (NoTorque(), NoTorque()))


MALFORMED: dict[str, tuple[str, Any]] = {
    "half-a-sample": ("delay", "1/2"),
    "early": ("delay", -1),
    "no-taps": ("taps", []),
    "endless-filter": ("taps", "lowpass"),
    "no-time": ("period", "0"),
    "backwards": ("period", "-1/400"),
    "shorter": ("stretch", "9/10"),
    "speeds-up": ("viscous_min", ["-1", "1", "1"]),
    "few-joints": ("viscous_min", ["1", "1"]),
    "many-joints": ("kp", ["1"] * 10),
    "no-damping": ("kv", ["0", "1", "1"]),
    "no-arm": ("k_g", []),
    "two-arms": ("links", [{}]),
    "unknown-end": ("conclusion", "stable"),
    "unknown-function": ("family", "linear"),
    "negative-bound": ("k_g", ["-1", "1", "1"]),
    "fall-alone": ("fall", ["0", "0", "-9"]),
    "measured": ("velocity", "measured"),
    "wrapped": ("angles", "wrapped"),
}
"""A field of the first good one, or one that there is not."""


def main() -> None:
    """Write the files, and what is expected of them."""
    arena = Added("sam")
    for name, statement, proof in good():
        accepted = verify(statement, proof)
        content = certified(name, statement, proof, accepted.verdict, accepted.grade)
        arena.add(f"good/{name}.sam.json", content, ["accepted"], "")
    for name, statement, proof in not_shown():
        content = certified(name, statement, proof, "proved", "enclosure")
        arena.add(f"bad/{name}.sam.json", content, ["refused"], f"(S) does not show it: {name}")
    whole = json.loads(certified("printed", PRINTED, NOTHING, "proved", "enclosure"))
    for name, (field, value) in MALFORMED.items():
        content = encoded(edited(whole, [(("statement", field), value)]))
        arena.add(f"bad/form-{name}.sam.json", content, ["refused"], f"no such loop: {name}")
    arena.entries.sort(key=lambda entry: entry["path"])
    (ARENA / "expected.json").write_text(json.dumps(arena.entries, indent=1, ensure_ascii=False) + "\n")


if __name__ == "__main__":
    main()
