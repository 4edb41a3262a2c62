"""Adding is adding a file: every example of ``docs/extend.md`` works, from outside of the package."""

import json
import re

import pytest

from tests.extending.page import PAGE, Call, File, Workshop, sections
from tests.helpers.shares import but

KIND, FAMILY, ARM, ANSWER, FORMAT = TITLES = (
    "A kind of claim",
    "A family",
    "An arm",
    "An answer",
    "A format",
)

FORMATS = ("csv", "html", "json", "latex", "markdown", "org", "text")


@pytest.fixture
def workshop(tmp_path):
    """With nothing added yet."""
    return Workshop(tmp_path)


@pytest.fixture
def furnished(workshop):
    """With every file of the page."""
    for items in sections().values():
        for item in items:
            if isinstance(item, File):
                workshop.put(item)
    return workshop


def test_the_page_shows_files_and_commands_for_each_of_the_five():
    assert tuple(sections())[:5] == TITLES
    for title in TITLES:
        assert {type(item) for item in sections()[title]} == {File, Call}


@pytest.mark.parametrize("title", but([FORMAT], TITLES))
def test_each_command_prints_what_the_page_says(workshop, title):
    """Each command after the files that stand before it."""
    workshop.up_to(title)
    for item in sections()[title]:
        if isinstance(item, File):
            workshop.put(item)
            continue
        done = workshop.run(item.command)
        assert done.returncode == item.code, done.stderr
        assert not item.output or is_excerpt(item.output, done.stdout), (
            f"{item.command} prints\n{done.stdout}"
        )


def is_excerpt(excerpt, whole):
    """Whether a text is that of an excerpt, with any lines at each … of it."""
    parts = [re.escape(part) for part in re.split("^…\n", excerpt, flags=re.MULTILINE)]
    return re.fullmatch("(?:.*\n)*?".join(parts), whole) is not None


def test_an_excerpt_leaves_out_whole_lines_where_it_says_so():
    assert is_excerpt("a\n…\nc\n", "a\nb\nc\n")
    assert is_excerpt("…\nc\n…\n", "a\nb\nc\n")
    assert not is_excerpt("a\nc\n", "a\nb\nc\n")
    assert not is_excerpt("a\n…\n", "b\na\n")


class TestKind:
    """A kind of claim."""

    @pytest.fixture
    def made(self, furnished):
        """With the certificates of the page."""
        assert furnished.run("lyapcheck check servo.py --certificates made").returncode == 1
        return furnished

    @pytest.mark.slow
    def test_its_certificates_are_accepted_and_rest_on_its_file(self, made):
        done = made.run("lyapcheck recheck made --trusted --format json")
        result = json.loads(done.stdout)
        rows = {row["id"]: (row["status"], row["verdict"]) for row in result["certificates"]}
        assert rows == {"k5": ("accepted", "proved"), "k7": ("accepted", "refuted")}
        for verdict in ("proved", "refuted"):
            assert "lyapcheck.check.kinds.hurwitz" in result["trusted"][verdict]["modules"]

    @pytest.mark.slow
    def test_a_forged_verdict_is_refused(self, made):
        code = (
            "import json; from pathlib import Path; from lyapcheck.check.certificate import digest_of\n"
            "file = Path('made/k7.json'); data = json.loads(file.read_text()) | {'verdict': 'proved'}\n"
            "del data['digest']; file.write_text(json.dumps(data | {'digest': digest_of(data)}))"
        )
        assert made.python(code).returncode == 0
        done = made.run("lyapcheck recheck made/k7.json")
        assert done.returncode == 1
        assert "verdict = proved: the proof gives refuted" in done.stdout

    @pytest.mark.slow
    def test_a_checker_without_the_file_does_not_look_for_it(self, made):
        """Neither beside the certificates nor where the user has files of his own."""
        source = made.copy / "lyapcheck" / "check" / "kinds" / "hurwitz.py"
        for place in (made.folder / "hurwitz.py", made.mine / "check" / "kinds" / "hurwitz.py"):
            place.parent.mkdir(parents=True, exist_ok=True)
            place.write_text("raise SystemExit('loaded')\n" + source.read_text(encoding="utf-8"))
        done = made.run("lyapcheck recheck made", copied=False)
        assert done.returncode == 1
        assert done.stdout.count("Hurwitz: is not a kind that the checker knows") == 2

    @pytest.mark.slow
    def test_its_search_names_the_rightmost_root(self, furnished):
        assert "the real part of the rightmost root, 0.0434" in PAGE.read_text(encoding="utf-8")
        assert "0.0434" in furnished.run("lyapcheck check servo.py --only k7 --failed").stdout

    @pytest.mark.slow
    def test_a_polynomial_that_is_none_is_undecided(self, furnished):
        text = (furnished.folder / "servo.py").read_text(encoding="utf-8")
        (furnished.folder / "none.py").write_text(text.replace("(1, 3, 2, k)", "(0, 3, 2, k)"))
        done = furnished.run("lyapcheck check none.py --failed")
        assert done.returncode == 3
        assert "must be positive" in done.stdout

    @pytest.mark.slow
    def test_how_it_is_decided_is_what_its_search_says_or_the_kind(self, furnished):
        explain = "lyapcheck explain k5 --proof servo.py -v"
        assert "report the rightmost root" in furnished.run(explain).stdout
        (furnished.mine / "claims" / "procedures" / "hurwitz.py").unlink()
        alone = furnished.run(explain).stdout
        assert "negative real parts, by Routh's" in alone
        assert "report the rightmost root" not in alone


class TestFamily:
    """A family with its balls."""

    def test_its_doubles_lie_in_its_balls(self, furnished):
        code = """
import numpy as np
from flint import arb
from lyapcheck.family import named
f = named("gentle")
x = np.concatenate([np.geomspace(1e-150, 1e300, 400), [0.0], -np.geomspace(1e-150, 1e300, 400)])
for form in ("h", "dh", "potential"):
    ball = getattr(f, f"ball_{form}")
    exact = np.array([float(ball(arb(float(v))).mid()) for v in x])
    assert np.allclose(getattr(f, form)(x), exact, rtol=2e-15, atol=0), form
assert f.h(np.inf) == 1
"""
        done = furnished.python(code)
        assert not done.stderr

    @pytest.mark.slow
    def test_without_balls_for_the_checker_it_runs_and_is_not_certified(self, furnished):
        run = "lyapcheck simulate gentle.toml --target 30 --time 8"
        assert furnished.run(run, copied=False).stdout == furnished.run(run).stdout != ""
        done = furnished.run("lyapcheck epsilon gentle.toml", copied=False)
        assert done.returncode == 2
        assert "no bounded function 'gentle' with m = None is known to the checker" in done.stderr
        assert "docs/extend.md" in done.stderr
        done = furnished.run("lyapcheck gate gentle.toml --condition lasalle", copied=False)
        assert done.returncode == 3, "nothing says that x h(x) > 0"

    @pytest.mark.slow
    def test_its_certificates_rest_on_its_balls(self, furnished):
        assert furnished.run("lyapcheck epsilon gentle.toml --certificates soft").returncode == 0
        result = json.loads(furnished.run("lyapcheck recheck soft --trusted --format json").stdout)
        assert "lyapcheck.check.numbers.functions.gentle" in result["trusted"]["proved"]["modules"]
        refused = furnished.run("lyapcheck recheck soft", copied=False)
        assert refused.returncode == 1
        assert "no bounded function 'gentle' with m = None is known to the checker" in refused.stdout


class TestArm:
    """An arm; the package is the one that is installed."""

    @pytest.mark.slow
    def test_it_has_its_name_and_its_path(self, furnished):
        code = "from lyapcheck.robots import load, names; print('bench' in names())\n"
        code += "for arm in ('bench', 'mine/robots/arms/bench.toml'): print(load(arm).name, load(arm).mass)"
        done = furnished.python(code, copied=False)
        listed, by_name, by_path = done.stdout.splitlines()
        assert listed == "True"
        assert by_name == by_path
        assert by_name.startswith("bench ")

    def test_gain_files_name_it(self, furnished):
        gains = '[[gains]]\nname = "a"\nm = 2\nkp = [20, 5]\nkv = [0.06, 0.05]\n'
        (furnished.folder / "gains.toml").write_text(f'robot = "bench"\n{gains}')
        done = furnished.run("lyapcheck gate gains.toml --explain", copied=False)
        assert done.returncode == 0, done.stdout + done.stderr
        assert "friction of elbow = 0.3 N·m·s/rad is assumed" in " ".join(done.stdout.split())

    @pytest.mark.slow
    def test_it_does_not_take_the_name_of_another(self, furnished):
        arms = furnished.mine / "robots" / "arms"
        (arms / "bench.toml").rename(arms / "pelican2.toml")
        done = furnished.python(
            "from lyapcheck.robots import load; print(load('pelican2').title)", copied=False
        )
        assert done.stdout.startswith("Pelican arm")


class TestAnswer:
    """An answer; the package is the one that is installed."""

    @pytest.mark.parametrize("form", but(["json"], FORMATS))
    def test_it_has_every_format(self, furnished, form):
        done = furnished.run(f"lyapcheck torque gentle.toml --format {form}", copied=False)
        assert done.returncode == 0, done.stderr
        assert "soft" in done.stdout
        assert "3.400" in done.stdout

    @pytest.mark.slow
    def test_help_names_it_and_it_takes_no_other_name(self, furnished):
        own = furnished.mine / "cli" / "commands"
        (own / "torque.py").replace(own / "gate.py")
        assert "the checker judges them" in " ".join(
            furnished.run("lyapcheck --help", copied=False).stdout.split()
        )
        furnished.put(next(item for item in sections()[ANSWER] if isinstance(item, File)))
        shown = furnished.run("lyapcheck --help", copied=False).stdout
        assert "torque Bound the torque that gains can ask for, gravity aside." in " ".join(shown.split())

    @pytest.mark.slow
    def test_an_unbounded_function_has_no_bound(self, furnished):
        path = furnished.folder / "gentle.toml"
        path.write_text(path.read_text(encoding="utf-8").replace('"gentle"', '"linear"'))
        assert "unbounded" in furnished.run("lyapcheck torque gentle.toml", copied=False).stdout


class TestFormat:
    """A format; the package is the one that is installed."""

    @pytest.mark.slow
    def test_answers_are_written_in_it(self, furnished):
        code = """
from lyapcheck.answers.gate import gate
from lyapcheck.answers.table import build_table
from lyapcheck.control.gains import read_gain_file
from lyapcheck.control.gains import paper_gain_file
print(build_table([1, 2], 4).written("org"))
print(gate(read_gain_file(paper_gain_file())).written("org"))
"""
        done = furnished.python(code, copied=False)
        assert "| 2 | 1.053 | 1.674 | 0.8673 |" in done.stdout, done.stderr
        assert done.stdout.count("\n* ") == 1

    @pytest.mark.slow
    def test_every_command_takes_it_and_names_cannot_break_it(self, furnished):
        path = furnished.folder / "gentle.toml"
        path.write_text(path.read_text(encoding="utf-8").replace('"soft"', '"so|ft"'))
        for command in ("torque gentle.toml", "gate gentle.toml", "tune pendulum1 --m 1"):
            done = furnished.run(f"lyapcheck {command} --format org", copied=False)
            assert done.stdout.startswith("* "), done.stderr
            assert "so|f" not in done.stdout
        assert r"so\vert{}ft" in furnished.run("lyapcheck torque gentle.toml --format org").stdout
