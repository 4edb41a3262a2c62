"""Gains on a computer that are not stable: goals with growing motions, and what shows none.

    python -m tests.arena.unstable

adds them to the arena as it stands.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction as F

from lyapcheck.check.kinds.inertia import Bisection
from lyapcheck.check.kinds.sampled import SampledStable
from lyapcheck.check.kinds.sampled_unstable import GrowingMotion
from lyapcheck.check.verify import verify
from lyapcheck.search.sampled import refuted_at
from tests.arena.extra import LINKS, vector
from tests.arena.library import Added
from tests.arena.plant import ARENA
from tests.arena.truths import certified

ONE = SampledStable(
    *("tanh", None, (F(1),), (F(5),), (F(1),), ()),
    *((), (), ((((((0, 0, 1), F(1)),),),)), (((0, 1, 0), F(-1)),), ((F(1, 100), F(1)),)),
    *(F(1, 10), F(1), 0, (F(1),), "goal"),
)
"""U = −cos q and k_v = 5 > b = 1: of light arms z² + (k_v/b + …)z − k_v/b has a root below −1."""
TWO = SampledStable(
    *("tanh", None, (F(6), F(1)), (F(40), F(4)), (F(1), F(1)), ()),
    *(LINKS, vector(1, 0, 0), (), (), ()),
    *(F(1, 5), F(3, 2), 1, (F(1, 2), F(1, 2)), "goal"),
)
"""The links of length 1, with the mean of two differences."""
UPRIGHT = SampledStable(
    *("hyperbolic", 2, (F(1),), (F(1),), (F(1, 10),), ()),
    *((), (), ((((((0, 0), F(1)),),),)), (((0, 1), F(1)),), ()),
    *(F(1, 10), F(1), 1, (F(1),), "goal"),
)
"""h'(0) = 0, and g = −sin q comes 3/2 samples late on average: 0.1 < 3/2·T."""


def found(statement: SampledStable) -> GrowingMotion:
    proof = refuted_at(statement, statement.period)
    assert proof is not None
    return proof


def not_shown(statement: SampledStable) -> Iterator[tuple[str, SampledStable, GrowingMotion]]:
    """What follows from the change: a stable loop, another one, or a proof that is none."""
    proof = found(statement)
    flipped = tuple(tuple(-x for x in row) for row in proof.form)
    yield "form-negated", statement, replace(proof, form=flipped)
    yield "form-zero", statement, replace(proof, form=tuple(tuple(0 * x for x in row) for row in proof.form))
    yield "form-short", statement, replace(proof, form=proof.form[:-1])
    yield "no-growth", statement, replace(proof, growth=F(1))
    yield "growth-negative", statement, replace(proof, growth=-proof.growth)
    yield "too-fast", statement, replace(proof, growth=100 * proof.growth)
    yield "at-the-goal", statement, replace(proof, start=tuple(0 * x for x in proof.start))
    yield "start-short", statement, replace(proof, start=proof.start[:-1])
    yield "goal-short", statement, replace(proof, goal=proof.goal[:-1])
    yield "longer-period", statement, replace(proof, period=2 * proof.period)
    yield "other-period", statement, replace(proof, period=proof.period / 100)
    yield "no-period", statement, replace(proof, period=F(0))
    yield "shorter-asked", replace(statement, period=proof.period * F(99, 100)), proof
    yield "friction", replace(statement, viscous_min=tuple(1000 * b for b in statement.viscous_min)), proof
    yield "rest-alone", replace(statement, conclusion="rest"), proof
    yield "other-parameters", statement, replace(proof, parameters=(*proof.parameters, F(1)))
    yield "long-delay", replace(statement, delay=999), proof


def main() -> None:
    """Write the files, and what is expected of them."""
    arena = Added("uns")
    for name, statement in {"one": ONE, "two": TWO, "upright": UPRIGHT}.items():
        content = certified(name, statement, found(statement), "refuted", "enclosure")
        arena.add(f"good/{name}.uns.json", content, ["accepted"], "")
        for fault, asked, proof in not_shown(statement):
            content = certified(name, asked, proof, "refuted", "enclosure")
            arena.add(f"bad/{name}-{fault}.uns.json", content, ["refused"], f"no motion grows: {fault}")
    heavy = replace(ONE, parameters=((F(1, 2), F(1)),))
    unproved = replace(found(ONE), inertia=Bisection(), parameters=(F(0),))
    bare = replace(ONE, mass=(), potential=(), parameters=(), k_g=(F(1),))
    for fault, asked, proof in (
        ("heavy", heavy, found(ONE)),
        ("no-mass", replace(ONE, parameters=((F(0), F(1)),)), unproved),
        ("no-arm", bare, found(ONE)),
        ("smooth", replace(ONE, family="hyperbolic", m=2), found(ONE)),
        ("steep", replace(UPRIGHT, family="tanh", m=None), found(UPRIGHT)),
    ):
        content = certified(fault, asked, proof, "refuted", "enclosure")
        arena.add(f"bad/{fault}.uns.json", content, ["refused"], f"no motion of this loop grows: {fault}")
    stated = certified("one", ONE, found(ONE), "proved", "enclosure")
    arena.add("bad/opposite.uns.json", stated, ["refused"], "a proof of the opposite verdict")
    for name, statement in (("one", ONE), ("two", TWO), ("upright", UPRIGHT)):
        assert verify(statement, found(statement)).verdict == "refuted", name
    arena.entries.sort(key=lambda entry: entry["path"])
    (ARENA / "expected.json").write_text(json.dumps(arena.entries, indent=1, ensure_ascii=False) + "\n")


if __name__ == "__main__":
    main()
