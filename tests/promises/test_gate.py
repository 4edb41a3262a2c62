"""What the gate accepts over ranges it accepts at every member of them."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from tempfile import TemporaryDirectory

from hypothesis import given
from hypothesis import strategies as st

from tests.promises.draws import FAMILIES, Arm, arms, asked, near_the_border, results, shares

SHARES = st.sampled_from([Fraction(1, 2), Fraction(1), Fraction(101, 100)])
"""Of the largest gains that pass: some pass with room, some at the border, some not."""
CONDITIONS = st.sampled_from([(), ("10i",), ("10i", "scalar"), ("10p", "lasalle"), ("10",)])


def condition_options(conditions: tuple[str, ...]) -> list[str]:
    return [word for name in conditions for word in ("--condition", name)]


@given(arms(), st.sampled_from(FAMILIES), SHARES, CONDITIONS, shares)
def test_accepted_over_ranges_is_accepted_at_a_member(
    arm: Arm, family: str, share: Fraction, conditions: tuple[str, ...], at: list[Fraction]
) -> None:
    if arm.n > 2:  # M ≻ 0 over ranges of three masses takes seconds
        conditions = tuple(one for one in conditions if one not in ("scalar", "lasalle"))
    with TemporaryDirectory() as name:
        folder = Path(name)
        whole = near_the_border(folder, arm.written(folder, "arm"), arm.n, family, arm.options, share)
        over = asked("gate", str(whole), *arm.options, *condition_options(conditions))
        assert over.exit_code in (0, 1, 3), over.stderr
        text = whole.read_text(encoding="utf-8").replace("arm.toml", arm.at(at).written(folder, "member"))
        (folder / "own.toml").write_text(text, encoding="utf-8")
        alone = asked("gate", str(folder / "own.toml"), *condition_options(conditions))
        if over.exit_code == 0:
            assert alone.exit_code == 0, (arm, at, alone.stdout)
        at_member = {(one["id"], one["joint"]): one["limit"] for one in results(alone)[0]["checks"]}
        for wide in results(over)[0]["checks"]:
            narrow = at_member.get((wide["id"], wide["joint"]))
            if wide["limit"] and narrow:
                assert Fraction(wide["limit"]["lower"]) <= Fraction(narrow["upper"]), wide
