"""What the gate accepts over ranges it accepts at every member of them."""

from fractions import Fraction
from pathlib import Path
from tempfile import TemporaryDirectory

from hypothesis import given
from hypothesis import strategies as st

from lyapcheck.files.decimals import decimal_text
from tests.promises.draws import FAMILIES, arms, asked, drawn, near_the_border, results, shares

SHARES = st.sampled_from([Fraction(1, 2), Fraction(1), Fraction(101, 100)])
"""Of the largest gains that pass: some pass with room, some at the border, some not."""
CONDITIONS = st.sampled_from([(), ("10i",), ("10i", "scalar"), ("10p", "lasalle"), ("10",)])


def condition_options(conditions):
    return [word for name in conditions for word in ("--condition", name)]


def more_of_the_file(arm, conditions, keyed, stated):
    """Conditions as a key of the set, and bounds of gravity of the gain file."""
    names = ", ".join(f'"{name}"' for name in conditions)
    key = f"condition = [{names}]\n" if keyed and conditions else ""
    bounds = ", ".join(map(decimal_text, arm.printed))
    return f"{key}[bounds]\ngravity = [{bounds}]\n" if stated and arm.printed else key


@drawn(2, 25)
@given(arms(), st.sampled_from(FAMILIES), SHARES, CONDITIONS, shares, st.booleans(), st.booleans())
def test_accepted_over_ranges_is_accepted_at_a_member(arm, family, share, conditions, at, keyed, stated):
    """Ranges of files and options, payloads, masses of URDF files, bounds of both files, named conditions."""
    if arm.n > 2:  # M ≻ 0 over ranges of three masses takes seconds
        conditions = tuple(one for one in conditions if one not in ("scalar", "lasalle"))
    with TemporaryDirectory() as name:
        folder = Path(name)
        more = more_of_the_file(arm, conditions, keyed, stated)
        options = [] if keyed else condition_options(conditions)
        whole = near_the_border(folder, arm.written(folder, "arm"), arm.n, family, arm.options, share, more)
        over = asked("gate", str(whole), *arm.options, *options)
        assert over.exit_code in (0, 1, 3), over.stderr
        text = whole.read_text(encoding="utf-8").partition("[bounds]")[0]
        text = text.replace("arm.toml", arm.at(at).written(folder, "member"))
        (folder / "own.toml").write_text(text, encoding="utf-8")
        alone = asked("gate", str(folder / "own.toml"), *options)
        if over.exit_code == 0:
            assert alone.exit_code == 0, (arm, at, alone.stdout)
        at_member = {(one["id"], one["joint"]): one["limit"] for one in results(alone)[0]["checks"]}
        for wide in results(over)[0]["checks"]:
            narrow = at_member.get((wide["id"], wide["joint"]))
            if wide["limit"] and narrow:
                assert Fraction(wide["limit"]["lower"]) <= Fraction(narrow["upper"]), wide
