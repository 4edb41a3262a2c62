"""The layout of every text answer: a headline, one table, few remarks, a next command that works."""

import re
import shlex
from dataclasses import replace
from functools import cache
from pathlib import Path
from unicodedata import combining

import pytest

from lyapcheck.output.answer import Answer
from lyapcheck.output.document import Bullets, Document, Paragraph, Section, Table
from lyapcheck.output.text import Depth, View, render
from tests.helpers.command import invoke
from tests.helpers.shares import but, one_in

ROOT = Path(__file__).parents[2]
TABLE2, PANDA = str(ROOT / "proofs/table2.toml"), str(ROOT / "examples/panda_gains.toml")
TARGETS = "--m", "1", "--overshoot", "5", "--settle", "2", "--stability", "proof"
ASKED = {
    "gate, accepted": ("gate", "gains.toml"),
    "gate, rejected": ("gate", "saturating.toml"),
    "gate, breaks (19)": ("gate", "gains.toml", "--condition", "10p", "--condition", "19"),
    "gate, undecided": ("gate", "own.toml", "--condition", "scalar"),
    "gate, several sets": ("gate", TABLE2),
    "gate, several files": ("gate", "gains.toml", "own.toml"),
    "gate, ranges": ("gate", "gains.toml", "--vary", "viscous=-30%..+30%", "--vary", "payload=0..1"),
    "gate, as run": ("gate", "gains.toml", "--rate", "1000", "--unknown-payload", "0.2"),
    "gate, breaks (19) at nominal numbers": ("gate", "ranged.toml"),
    "gate, undecided as run": ("gate", "gains.toml", "--period", "20 ms", "--condition", "sampled"),
    "gate, falls": ("gate", "gains.toml", "--unknown-payload", "8"),
    "gate, too weak": ("gate", "weak.toml"),
    "gate, unstable as run": ("gate", "gains.toml", "--period", "100 ms", "--delay", "3"),
    "gate, unknown payload without an arm": ("gate", "own.toml", "--unknown-payload", "1"),
    "gate, too heavy": ("gate", "gains.toml", "--unknown-payload", "30"),
    "gate, seven joints": ("gate", PANDA),
    "bounds": ("bounds", "gains.toml", "--time", "1"),
    "bounds, several sets": ("bounds", TABLE2, "--time", "1"),
    "sweep": ("sweep", "plan.toml", "--jobs", "1"),
    "table": ("table", "--m", "1:3"),
    "recheck": ("recheck", str(ROOT / "tests/kernel/certificates/2.1.json")),
    "epsilon": ("epsilon", "gains.toml", "--max-boxes", "40", "--starts", "1"),
    "epsilon, ranges": (
        *("epsilon", "gains.toml", "--max-boxes", "40", "--starts", "1"),
        *("--vary", "viscous=-30%..+30%", "--vary", "payload=0..1"),
    ),
    "epsilon, another arm": (
        "epsilon",
        "free.toml",
        "--robot",
        "arm.toml",
        "--max-boxes",
        "40",
        "--starts",
        "1",
    ),
    "simulate": ("simulate", "gains.toml"),
    "simulate, another arm": ("simulate", "free.toml", "--robot", "arm.toml"),
    "bounds, another arm": ("bounds", "free.toml", "--robot", "arm.toml", "--time", "1"),
    "simulate, as run": ("simulate", "gains.toml", "--rate", "1000"),
    "simulate, over ranges": ("simulate", "gains.toml", "--rate", "400", "--vary", "payload=0..1"),
    "simulate, unknown payload": ("simulate", "gains.toml", "--rate", "400", "--unknown-payload", "0.5"),
    "simulate, random starts": ("simulate", "gains.toml", "--runs", "4", "--time", "1"),
    "simulate, at the bench": ("simulate", TABLE2, "--experiment"),
    "tune, the largest": ("tune", "buap3", "--m", "1:2"),
    "tune, seven joints": ("tune", "panda", "--m", "1"),
    "tune, targets": ("tune", "arm.toml", *TARGETS),
    "robot": ("robot", "arm.toml"),
    "robot, ranges": ("robot", "buap3", "--max-boxes", "200"),
    "robot, assumptions": ("robot", "buap3", "--assumptions"),
    "explain": ("explain", "16.6"),
    "explain, undecided": ("explain", "P"),
    "explain, the list": ("explain",),
    "explain, a script": ("explain", "--proof", "scalar.py"),
    "derive": ("derive",),
    "derive, of an arm": ("derive", "--m", "1:4", "--robot", "reyes-kelly2"),
    "export": ("export", "gains.toml", "--rate", "1000", "--out", "c"),
    "export, rejected": ("export", "saturating.toml", "--period", "3 ms", "--out", "c"),
    "export, several sets": ("export", TABLE2, "--rate", "400", "--out", "c"),
    "check": ("check", str(ROOT / "proofs/every_m.py"), "--m", "1"),
    "check, refuted": ("check", "published.py", "--m", "1", "--only", "16.6", "--only", "8b"),
}
"""A command line for each kind of answer, in a folder with the files of `init` and a gain file on buap3."""
SATURATING = """robot = "buap3"
[[gains]]
name = "a"
m = 1
kp = [60, 40, 5]
kv = [0.2, 0.2, 0.2]
"""
OWN = """[[gains]]
name = "b"
m = 1
kp = [40]
kv = [1]
[bounds]
viscous_min = 2
torque = [60]
gravity = [4.905]
"""
FREE = """[[gains]]
name = "c"
m = 1
kp = [22, 10]
kv = [12, 3]
"""
PLAN = """robots = ["reyes-kelly2"]
questions = ["gate"]
[grid]
m = [1]
kp = [[20, 5]]
kv = [0.02]
"""
RANGED = SATURATING.replace("[60, 40, 5]", "[20, 40, 5]").replace("[0.2, 0.2, 0.2]", "[3, 4, 1]")
FILES = {
    "saturating.toml": SATURATING,
    "looped.toml": SATURATING.replace("[[gains]]", "[loop]\nrate = 500\nfilter = [0.5, 0.5]\n[[gains]]"),
    "ranged.toml": RANGED,
    "own.toml": OWN,
    "free.toml": FREE,
    "plan.toml": PLAN,
}
TALL = 24
"""Lines for three joints."""
FAST = {
    *("gate, accepted", "gate, several sets", "gate, falls", "gate, too weak", "gate, unstable as run"),
    *("gate, unknown payload without an arm", "bounds", "sweep", "table", "recheck", "simulate"),
    *("tune, the largest", "tune, seven joints", "robot, assumptions", "explain", "derive", "export"),
    *("check", "gate, rejected"),
}
FAST_NEXT = {
    *("gate, accepted", "gate, rejected", "gate, too weak", "gate, unstable as run", "bounds", "sweep"),
    *("table", "recheck", "simulate", "robot, assumptions", "explain, a script", "derive", "export", "check"),
}


def columns(line):
    """Of a terminal: marks over letters take none."""
    return sum(not combining(letter) for letter in line)


@pytest.fixture(scope="module", autouse=True)
def in_a_folder_with_files(tmp_path_factory, in_this_process):
    with pytest.MonkeyPatch.context() as patch:
        folder = tmp_path_factory.mktemp("layout")
        patch.chdir(folder)
        patch.setenv("XDG_CACHE_HOME", str(folder / "cache"))
        for name, text in FILES.items():
            (folder / name).write_text(text, encoding="utf-8")
        assert invoke("init", ".").exit_code == 0
        arm = Path("arm.toml").read_text(encoding="utf-8")
        Path("weak_arm.toml").write_text(
            arm.replace("torque_limit = 80", "torque_limit = 3"), encoding="utf-8"
        )
        Path("weak.toml").write_text(f'robot = "weak_arm.toml"\n{FREE}', encoding="utf-8")
        yield


@cache
def answered(name, *more):
    """How the command ended, and the one document that it showed."""
    documents = []
    written = Answer.written

    def kept(answer, form, view):
        document = answer.document()
        documents.append(replace(document, next=view.following(document.next)))
        return written(answer, form, view)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Answer, "written", kept)
        done = invoke(*ASKED[name], *more)
    (document,) = documents
    return done, document


@pytest.mark.parametrize("name", but(FAST, ASKED))
def test_an_answer_is_short(name):
    done, document = answered(name)
    assert done.exit_code in (0, 1, 3), done.stderr
    assert done.stdout == render(document)
    assert len(document.lead) <= 2
    assert not any(isinstance(block, Section) for block in document.blocks)
    assert sum(isinstance(block, Table) for block in document.blocks) <= 1
    remarks = [block.items for block in document.blocks if isinstance(block, Bullets)]
    remarks += [(block.text,) for block in document.blocks if isinstance(block, Paragraph)]
    assert sum(map(len, remarks)) <= 3
    for width in (60, 80, 100):
        lines = render(document, View(width=width)).splitlines()
        assert len(lines) <= TALL
        assert lines.index("") <= (6 if width == 60 else 3)
        assert all(columns(line) <= width for line in lines if "lyapcheck " not in line)
        plain = render(document, View(Depth.EXPLAINED, width=width, encoding="ascii"))
        assert plain.isascii()
        assert not re.search(r"\\[ux]\d", plain)
    for sentence in (document.title, *document.lead):
        assert render(Document(sentence), View(width=60)).count("\n") <= 2


@pytest.mark.parametrize("name", but(FAST_NEXT, ASKED))
def test_its_next_command_works(name):
    _, document = answered(name)
    program, *after = shlex.split(document.next)
    assert program == "lyapcheck"
    assert sorted(after) != sorted(ASKED[name])
    assert invoke(*after).exit_code in (0, 1, 3), document.next


KEEPS = {
    "gate gains.toml --vary viscous=-30%..+30%": "simulate gains.toml --vary viscous=-30%..+30%",
    "gate saturating.toml --vary coulomb=-9%..0%": "tune buap3 --m 1 --vary coulomb=-9%..0%",
    "gate looped.toml": "tune buap3 --m 1 --rate 500 --filter 0.5,0.5",
    "gate looped.toml --period 3ms --delay 2": "tune buap3 --m 1 --period 3000us --filter 0.5,0.5 --delay 2",
    "gate gains.toml --period 3ms --condition sampled": "gate gains.toml --explain --condition sampled "
    "--period 3ms",
    "gate gains.toml --rate 500 --delay 2": "simulate gains.toml --rate 500 --delay 2",
    "bounds gains.toml --time 1 --target 9,9": "simulate gains.toml --target 9,9",
    "simulate gains.toml --rate 500 --velocity 9,9 --time 1": "gate gains.toml --rate 500",
    "check scalar.py --m 1 --only arm.theta --robot arm.toml": "check scalar.py --m 1 --failed "
    "--robot arm.toml --only arm.theta",
    "robot arm.toml --max-boxes 9": "tune arm.toml --m 1",
}
"""What a command answers about, and the next one that is about the same arm, ranges and loop."""


@pytest.mark.parametrize(("asked", "then"), one_in(2, KEEPS.items()))
def test_the_next_command_is_about_what_was_asked(asked, then):
    done = invoke(*asked.split())
    assert done.stdout.splitlines()[-1].split() == ["next:", "lyapcheck", *then.split()]
    assert invoke(*then.split()).exit_code in (0, 1, 3)


SEARCHES = {
    "gate, falls": "tune arm.toml --m 1 --overshoot 5 --settle 2 --unknown-payload 8",
    "tune, the largest": "tune buap3 --m 1 --overshoot 5 --settle 2",
}
"""Next commands that search for many seconds: their words here, the slow tests above run them."""


@pytest.mark.parametrize(("name", "then"), SEARCHES.items())
def test_a_next_command_that_searches_is_about_what_was_asked(name, then):
    _, document = answered(name)
    assert document.next == f"lyapcheck {then}"


FACTS = {
    "gate, unstable as run": "! first: accepted; unstable at 100 ms without dry friction or unknown gravity",
    "gate, unknown payload without an arm": "! b: accepted; open: holds",
    "simulate, over ranges": "! arm: no limit cycle seen in 3 runs over the ranges",
    "simulate, unknown payload": (
        "! arm: no limit cycle seen in 1 gain set, a payload of up to 0.5 kg unknown"
    ),
    "gate, too weak": "✗ c: rejected, (10p) at shoulder, (19) at shoulder and elbow",
}
"""What the first line must not leave out."""


@pytest.mark.parametrize("name", but(FAST & {*FACTS}, FACTS))
def test_the_first_line_says_the_worst(name):
    assert answered(name)[1].title == FACTS[name]


def test_a_table_of_gains_loses_no_joint():
    _, document = answered("tune, seven joints")
    for width in (80, 100):
        shown = render(document, View(width=width))
        assert all(f"panda_joint{i}" in shown for i in range(1, 8))


@pytest.mark.slow
def test_the_last_lines_of_a_report_are_short():
    done = invoke("report", "--gains", "gains.toml", "--format", "md,json", "--out", "reports")
    assert done.exit_code == 0, done.stderr
    first, where, blank, *rest = done.stdout.splitlines()
    assert (first, blank) == ("✓ first: accepted", "")
    assert where == "  open: reports/report.md, reports/report.json"
    assert len(rest) <= TALL - 3
    assert all(columns(line) <= 100 for line in rest)
    program, command, *paths = rest[-1].removeprefix("  next: ").split()
    assert (program, command) == ("lyapcheck", "recheck")
    assert invoke(command, *(str(found) for path in paths for found in Path().glob(path))).exit_code in (0, 1)
