"""``recheck --trusted``: the code that each kind of verdict rests on, so that growth is noticed."""

import json
import re
import sys
from collections import Counter
from pathlib import Path

import pytest

from lyapcheck.check import judging
from lyapcheck.check.codec import members, name_of
from lyapcheck.check.statement import Piece, Proof, Statement
from lyapcheck.rechecking.trusted import code_lines, definitions, modules, reached, source, totals, tree
from tests.arena.run import ARENA
from tests.helpers.command import lyapcheck

GOLDEN = Path(__file__).parents[1] / "golden" / "trusted.txt"
OF_OBLIGATIONS = (
    *("normal form", "covered terms", "identity of signs", "one entry"),
    *("pieces of the domain", "Sturm", "Taylor boxes"),
)
"""The rules that prove the obligations of a theorem."""
HEADLINES = {
    "an identity": ("Identity", "normal form"),
    "an identity for every n": ("EveryN", "normal form"),
    "a bound for every n": ("BoundEveryN", "covered terms"),
    "an inequality in one variable": ("ForAll", "pieces of the domain", "Sturm", "Taylor boxes"),
    "a relation between numbers": ("Constant", "separate balls"),
    "a verdict of the gate": (
        *("GateAccepted", "gravity, gains and limits", "GravityBelow", "sizes of harmonics"),
        *("GravityOfPotential", "comparison of harmonics"),
    ),
    "M(q) positive by links": ("MassAbove", "links"),
    "a bound of M(q) by boxes": ("MassBelow", "bisection"),
    "a bound of M(q) along links": ("ChainBelow", "storage forms"),
    "a bound of C(q, x) along links": ("ChainCoriolisBelow", "forms of the motion"),
    "a bound of C(q, x) at control points": ("CoriolisBelow", "products of rates"),
    "ε₀ by boxes": ("Decreasing", "M positive and V decreasing", "links", "tree of boxes"),
    "ε₀ by boxes, M(q) positive by boxes": (
        "Decreasing",
        "M positive and V decreasing",
        "bisection",
        "tree of boxes",
    ),
    "ε₀ along the links": ("Decreasing", "M positive and V decreasing", "links", "bounds along the links"),
    "how near an arm comes, and when": (
        "Settling",
        "falling levels",
        "M positive and V decreasing",
        "links",
        "tree of boxes",
        "dominant diagonal",
    ),
    "when errors are small, in phases": (
        "StaysWithin",
        "falling levels in phases",
        "bisection",
        "tree of boxes",
    ),
    "how near an arm of many joints comes, and when": (
        "Settling",
        "falling levels",
        "M positive and V decreasing",
        "links",
        "bounds along the links",
        "energy along the links",
    ),
    "a property of the closed loop": ("Property", "obligations", *OF_OBLIGATIONS),
    "a theorem about a closed loop": ("Stable", "obligations", *OF_OBLIGATIONS, "leading term"),
}
MOST_CODE_OF_EPS0 = 2_500
STEP = 50
"""Lines to which the sizes in the golden file are rounded up."""


def places(*names):
    known = {**members(Statement), **members(Proof), **members(Piece)}
    return [("", " ".join(f"{known[name].__module__}:{known[name].__name__}" for name in names))]


def listed():
    """For each headline how large what it rests on may be, and in which modules it is."""
    text = ""
    for headline, names in HEADLINES.items():
        result = modules(places(*names))
        code, lines = (-(-count // STEP) * STEP for count in totals(result))
        text += f"{headline}: at most {code} lines of code, {lines} with documentation\n"
        text += "".join(f"  {name.removeprefix('lyapcheck.check.')}\n" for name in result)
    return text


SIZES = re.compile(r"at most (\d+) lines of code, (\d+) with documentation")


def test_the_trusted_code_of_headline_verdicts_has_not_grown():
    """To accept growth: ``python -m tests.check.test_recheck_trusted`` writes the file anew."""
    golden, now = GOLDEN.read_text(encoding="utf-8"), listed()
    assert SIZES.sub("", now) == SIZES.sub("", golden)
    for allowed, result in zip(SIZES.findall(golden), SIZES.findall(now), strict=True):
        assert [int(size) for size in result] <= [int(size) for size in allowed]
        assert int(result[1]) <= int(allowed[1])


def test_an_eps0_by_boxes_rests_on_few_lines():
    for headline in ("ε₀ by boxes", "ε₀ by boxes, M(q) positive by boxes"):
        code, _ = totals(modules(places(*HEADLINES[headline])))
        assert code <= MOST_CODE_OF_EPS0


def test_the_page_on_trust_says_these_sizes():
    page = (Path(__file__).parents[2] / "docs" / "trusted.md").read_text(encoding="utf-8")
    for line in GOLDEN.read_text(encoding="utf-8").splitlines():
        if result := SIZES.search(line):
            code, lines = (f"{int(size):,}" for size in result.groups())
            assert f"| {line.partition(': ')[0]} | {code} | {lines} |" in page


def test_the_page_on_trust_says_how_large_the_checker_is():
    """Files, lines, lines of code, and those that can have a say in a verdict, to a few hundred."""
    page = (Path(__file__).parents[2] / "docs" / "trusted.md").read_text(encoding="utf-8")
    said = re.search(
        r"(\d+) files of ([\d,]+) lines, of which ([\d,]+) are code.*?Some ([\d,]+) lines", page, re.S
    )
    assert said is not None
    known = {one.module for one in definitions().values()}
    every = places(*members(Statement), *members(Proof), *members(Piece))
    files = [file.read_text(encoding="utf-8") for file in source("lyapcheck.check").parent.rglob("*.py")]
    now = (len(files), sum(len(text.splitlines()) for text in files))
    now += (sum(len(code_lines(module)) for module in known), totals(modules(every))[0])
    for text, size, slack in zip(said.groups(), now, (2, 200, 200, 200), strict=True):
        assert abs(size - int(text.replace(",", ""))) <= slack


FORMULAS = (
    "agrees all_of constant for_all for_small identity implies norm_bound parts signs trigonometric kinds"
)
PURPOSES = {
    "`kinds/`, formulas": FORMULAS,
    "`kinds/`, every n": "every_n bound_every_n",
    "`kinds/`, one arm": "inertia coriolis coriolis_below gravity compared chain chain_coriolis "
    "chain_identity",
    "`kinds/`, motions": "decreasing nearby damping link_bounds settling phases stopping resting "
    "of_loop at_corners",
    "`kinds/`, theorems": "stability stable_arm property",
}


def purpose(module):
    """The row of the page in which a module is counted."""
    room, _, rest = module.removeprefix("lyapcheck.check").lstrip(".").partition(".")
    name = module.rpartition(".")[2]
    own = next((row for row, names in PURPOSES.items() if name in names.split()), "")
    return own if room == "kinds" else f"`{room}/`" if rest or room in ROOMS else "files of the folder itself"


ROOMS = ("numbers", "expressions", "letters", "systems", "loop")


def test_the_page_on_trust_says_what_the_lines_are_for():
    page = (Path(__file__).parents[2] / "docs" / "trusted.md").read_text(encoding="utf-8")
    counted = Counter()
    for module in {one.module for one in definitions().values()}:
        counted[purpose(module)] += len(code_lines(module))
    assert set(counted) == {*PURPOSES, *(f"`{room}/`" for room in ROOMS), "files of the folder itself"}
    for row, now in counted.items():
        said = re.search(rf"\| {re.escape(row)} \| ([\d,]+) \|", page)
        assert said is not None, row
        assert abs(now - int(said[1].replace(",", ""))) <= 100, (row, now)


def smallest():
    """For each kind by each rule the smallest certificate among the good ones of the arena."""
    result = {}
    for path in sorted((ARENA / "good").glob("*.json"), key=lambda path: path.stat().st_size):
        content = path.read_bytes()
        data = json.loads(content)
        result.setdefault((data["statement"]["kind"], data["proof"]["rule"]), (path.name, content))
    return result.values()


def run_by(content):
    """What judging a certificate runs of the checker, as (file, line), and what it finds."""
    run = set()

    def note(frame, event, _):
        if event == "call":
            run.add((frame.f_code.co_filename, frame.f_code.co_firstlineno))

    sys.setprofile(note)
    try:
        return judging.judged(content), run
    finally:
        sys.setprofile(None)


@pytest.mark.slow
def test_whatever_runs_is_listed():
    """The list is read off the sources; here certificates of every kind are judged, and what runs is seen."""
    at = {(str(source(one.module)), line): one for one in definitions().values() for line in one.lines}
    judging.judged(b"{}")
    seen = set()
    for name, content in smallest():
        finding, run = run_by(content)
        assert not finding.reason, name
        trusted = reached(place for _, result in finding.rules for place in result.split())
        ran = {at[place].place for place in run if place in at}
        assert ran <= trusted, name
        seen |= ran
    assert len(seen) > 500


def test_what_is_listed_of_a_certificate_is_all_of_its_kinds_and_rules():
    assert "lyapcheck.check.kinds.decreasing:by_both" in reached(
        places(*HEADLINES["ε₀ by boxes"])[0][1].split()
    )
    core = reached()
    assert "lyapcheck.check.verify:verify" in core
    assert not any(".kinds." in place and "kinds:load" not in place for place in core)
    assert all(place in definitions() for place in core)


def test_sizes_are_those_of_the_sources():
    for one in definitions().values():
        assert one.lines <= set(range(1, len(source(one.module).read_bytes().splitlines()) + 1))
    assert 1 not in code_lines("lyapcheck.check.verify")
    assert tree("lyapcheck.check.verify").body[1].lineno in code_lines("lyapcheck.check.verify")
    assert name_of(members(Proof)["tree of boxes"]) == "tree of boxes"


@pytest.fixture(scope="module")
def shown(in_this_process):
    """What recheck says of a proof with theorems, as text and as data."""
    made = ARENA / "good" / "with-premises.sca.arms.all.m1"
    text, data = (
        lyapcheck("recheck", made, "--trusted", "--format", form).stdout for form in ("text", "json")
    )
    return text, json.loads(data)


def test_a_theorem_rests_on_the_rules_of_its_obligations(shown):
    text, data = shown
    rows = {row["id"]: row["rules"] for row in data["certificates"]}
    assert "Stable by obligations" in rows["arms.all"]
    assert any(rule.startswith("BoundEveryN") or rule.startswith("ForAll") for rule in rows["arms.all"])
    trusted = data["trusted"]["proved"]
    assert set(trusted["rules"]) == {rule for rules in rows.values() for rule in rules}
    assert "lyapcheck.check.systems.obligations" in trusted["modules"]
    sizes = (sum(trusted[key].values()) for key in ("code", "modules"))
    assert "{:>7}  {:>5} of definitions in {} modules".format(*sizes, len(trusted["modules"])) in text
    assert "trusted for all that is proved" in text


def test_what_a_headline_takes_for_granted_stands_with_it(shown):
    text, data = shown
    rows = {row["id"]: row for row in data["certificates"]}
    granted = rows["arms.all"]["granted"]
    assert granted
    assert all(f"  {sentence}\n" in text for sentence in (*granted, *data["granted"]))
    about_arms = {"Stable by obligations", "Property by obligations"}
    assert all(not row["granted"] for row in rows.values() if not about_arms & {*row["rules"]})


if __name__ == "__main__":
    GOLDEN.write_text(listed(), encoding="utf-8")
