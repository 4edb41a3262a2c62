"""Plans: what they ask, in which order, and what is wrong with them."""

import re
import tracemalloc
from itertools import islice

import pytest

from lyapcheck import InputError, read_plan
from lyapcheck.answers.sweep import MANY, batches

HEAD = 'robots = ["reyes-kelly2"]\nquestions = ["gate"]\n'
GRID = "[grid]\nm = [1]\nkp = [20]\nkv = [0.1]\n"


@pytest.fixture
def plan(tmp_path):
    def read(text):
        path = tmp_path / "plan.toml"
        path.write_text(text, encoding="utf-8")
        return read_plan(path)

    return read


def test_a_grid_is_asked_row_by_row(plan):
    text = (
        HEAD.replace('["gate"]', '["gate", "robot", "epsilon"]') + 'variations = [[], ["viscous=-5%..+5%"]]\n'
    )
    read = plan(text + "[grid]\nm = [2, 1]\nkp = [20, [20, 5]]\nkv = {from = 0.1, to = 0.3, step = 0.1}\n")
    asked = list(read.questions())
    assert len(asked) == read.count == 2 * (1 + 2 * 2 * 3 * 2)
    assert [one.index for one in asked] == list(range(read.count))
    first = [(one.ask, one.gains and one.gains.m, one.gains and one.gains.kv) for one in asked[:4]]
    assert [ask for ask, _, _ in first] == ["robot", "gate", "epsilon", "gate"]
    assert [m for _, m, _ in first] == [None, 2, 2, 2]
    assert str(asked[3].gains.kv[1]) == "1/5"
    assert [one.variation for one in asked[:: read.count // 2]] == [(), ("viscous=-5%..+5%",)]
    assert len({one.digest for one in asked}) == read.count


def test_the_same_question_has_the_same_digest_whatever_it_is_called(plan):
    sets = '[[gains]]\nname = "{}"\nm = 1\nkp = [20, 5]\nkv = [0.1, 0.1]\n'
    one, other = (next(plan(HEAD + sets.format(name)).questions()) for name in "ab")
    assert one.digest == other.digest
    more = plan(HEAD + sets.format("a") + '[gate]\ncondition = ["19"]\n')
    assert next(more.questions()).digest != one.digest


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "robots: is missing"),
        (HEAD.replace("gate", "gates") + GRID, "there is no question gates"),
        (HEAD, "gains: is missing"),
        (HEAD + GRID.replace("[1]", "[0]"), "grid.m"),
        (HEAD + GRID.replace("[20]", "[-1]"), "grid.kp"),
        (HEAD + GRID.replace("[20]", "[[1, 2, 3]]"), "has 3 gains, but"),
        (HEAD + GRID.replace("[0.1]", "{from = 1, to = 0.5, step = 0.1}"), "from ≤ to"),
        (HEAD + GRID.replace("[0.1]", "{from = 1, to = 5}"), "from ≤ to"),
        (HEAD + GRID.replace("[0.1]", "[0.1, 0.1]"), "has a value twice"),
        (HEAD + "variations = [1]\n" + GRID, "list of lists of ranges"),
        (HEAD + 'variations = [["mass"]]\n' + GRID, "NAME=LO..HI"),
        (HEAD.replace("reyes-kelly2", "nobody") + GRID, "plan.toml:1: robots"),
        (HEAD + GRID + "[gate]\ncondition = 1\n", "gate.condition"),
        (HEAD + GRID + "[gate]\nconditions = []\n", "did you mean condition?"),
        (HEAD + GRID + "[gate]\ncondition = ['foo']\n", "gate.condition"),
        (HEAD + GRID + "[gate]\nloop = ['rat=100']\n", "did you mean rate?"),
        (HEAD + GRID + "[gate]\nloop = ['rate=1', 'rate=2']\n", "says something twice"),
        (HEAD + GRID + "[epsilon]\nmax_boxes = 0\n", "whole number from 1"),
        (
            HEAD.replace("gate", "simulate") + GRID + "[simulate]\ntarget = [30, 45, 60]\n",
            "plan.toml:8: simulate.target: has 3 angles, but the arm reyes-kelly2 has 2 joints",
        ),
        (HEAD.replace("gate", "bounds") + GRID + "[bounds]\nstart = [30]\n", "start: has 1 angle, but"),
        (HEAD + "more = 1\n" + GRID, "is not a known key here"),
    ],
)
def test_what_is_wrong_is_said(plan, text, words):
    with pytest.raises(InputError, match=re.escape(words)):
        plan(text)


@pytest.mark.slow
def test_a_long_plan_is_never_in_memory(plan):
    read = plan(HEAD + GRID.replace("[1]", "[1, 2, 3]").replace("[0.1]", "{from = 1, to = 9000, step = 0.1}"))
    assert read.count > 100_000
    tracemalloc.start()
    rest = batches(read.questions())
    assert all(len(batch) == MANY for batch in islice(rest, 20))
    before, _ = tracemalloc.get_traced_memory()
    assert sum(len(batch) for batch in islice(rest, 180)) == 180 * MANY
    after, _ = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert after - before < 2_000_000
