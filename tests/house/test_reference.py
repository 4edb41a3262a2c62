"""The reference pages: written from the code, complete, and true."""

import doctest
import os
import tomllib
from contextlib import suppress
from pathlib import Path

import pytest

import lyapcheck
import lyapcheck.claims
from docs import generate
from docs.file_keys import FILES
from lyapcheck.answers.sweep import read_plan
from lyapcheck.cli.commands import NAMES
from lyapcheck.errors import InputError
from lyapcheck.files.fields import Fields
from lyapcheck.robots.armfile import read_arm

REFERENCE = generate.REFERENCE
CHAIN = """title = "One"
source = "a test"
remarks = ["None."]
gravity = [0, 0, -9.81]
[[links]]
name = "pivot"
axis = [0, 1, 0]
origin = [0, 0, 0]
mass = { value = 2, unit = "kg", source = "here", assumed = true, low = 1, high = 3, note = "a guess" }
com = [0, 0, -0.1]
inertia = { ixx = 0.3, iyy = 0.3, izz = 0.2 }
rotor_inertia = { rotor = 5e-5, gear = 100 }
viscous = 2
[loop]
rate = 400
"""
PRINTED = """title = "Printed"
[numbers]
b = 0.084
[model]
M11 = [[2.351, ""]]
potential = [[-38.46501, "c1"]]
[printed]
C11 = [[1, "s1 w1"]]
g1 = [[38.46501, "s1"]]
[[joints]]
name = "shoulder"
viscous = 2.288
"""
OVERLAY = 'title = "Over"\nurdf = "missing.urdf"\n[[joints]]\nname = "one"\n'
GAINS = """robot = "pendulum1"
[[gains]]
name = "one"
m = 1
kp = [10]
kv = [0.5]
[bounds]
torque = [15]
[loop]
rate = 400
"""
PLAN = (
    'robots = ["pendulum1"]\nquestions = ["gate"]\n'
    '[[gains]]\nname = "one"\nm = 1\nkp = [10]\nkv = [0.5]\n[grid]\nm = [1]\nkp = [10]\nkv = [0.5]\n'
    + "".join(f"[{name}]\n" for name in ("gate", "epsilon", "bounds", "simulate", "robot", "check"))
)
REFERENCES = {kind: f'kind = "{kind}"\n' for kind in ("sine", "minimum-jerk")}


def asked(monkeypatch, folder, reader, *texts):
    """The keys that a reader asks for in files of these texts, by the names of their tables."""
    found = {}
    close = Fields.close

    def note(fields):
        names = [part for part in fields.path if isinstance(part, str)]
        if Path(fields.notes.file).parent == folder:  # not an arm that the file names
            found.setdefault(names[-1] if names else "", set()).update(fields._asked)
        close(fields)

    monkeypatch.setattr(Fields, "close", note)
    for number, text in enumerate(texts):
        path = folder / f"{number}.toml"
        path.write_text(text, encoding="utf-8")
        with suppress(InputError):
            reader(path)
    return found


def documented(kind):
    """The keys of the table behind the pages, by the names that readers have for their tables."""
    names = {
        "Table of a number": "mass",
        "inertia = { … }": "inertia",
        "rotor_inertia = { … }": "rotor_inertia",
    }
    return {
        names.get(table, table.strip("[]")): {key.name for key in keys} for table, keys in FILES[kind].items()
    }


def test_the_keys_of_gain_files_are_those_of_the_reader(monkeypatch, tmp_path):
    assert asked(monkeypatch, tmp_path, lyapcheck.read_gain_file, GAINS) == documented("gain")


def test_the_keys_of_arm_files_are_those_of_the_readers(monkeypatch, tmp_path):
    assert asked(monkeypatch, tmp_path, read_arm, CHAIN, PRINTED, OVERLAY) == documented("arm")


def test_the_keys_of_plan_files_are_those_of_the_reader(monkeypatch, tmp_path):
    assert asked(monkeypatch, tmp_path, read_plan, PLAN) == documented("plan")


@pytest.mark.parametrize("kind", REFERENCES)
def test_the_keys_of_reference_files_are_those_of_the_reader(monkeypatch, tmp_path, kind):
    found = asked(monkeypatch, tmp_path, lyapcheck.read_reference, REFERENCES[kind])
    assert found[""] == {key.name for key in FILES["reference"][f'kind = "{kind}"']}


def test_every_example_of_a_key_is_toml():
    keys = [key for tables in FILES.values() for keys in tables.values() for key in keys]
    for key in keys:
        assert key.example.startswith("see ") or key.name in tomllib.loads(f"{key.name} = {key.example}")
        assert key.type
        assert key.default
        assert key.about.endswith(".") or key.about.endswith("…")


def without_answers(text):
    """A page without what an answer shows."""
    return text.partition("\n\n## JSON\n")[0].rstrip() + "\n"


def test_the_pages_are_as_the_code_says():
    """After a change of options, keys or docstrings: ``python -m docs.generate``."""
    wanted = generate.pages(answers=False)
    have = {path: without_answers((REFERENCE / path).read_text(encoding="utf-8")) for path in wanted}
    assert have == wanted
    assert {path.stem for path in (REFERENCE / "commands").glob("*.md")} == set(NAMES)


@pytest.mark.slow
def test_the_keys_of_answers_are_as_the_commands_say():
    for path, section in generate.json_sections().items():
        assert section.strip() in (REFERENCE / path).read_text(encoding="utf-8")


@pytest.mark.slow
def test_the_tasks_of_python_are_done_from_the_page_alone(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setitem(os.environ, "MPLBACKEND", "Agg")
    text = (REFERENCE / "python.md").read_text(encoding="utf-8")
    test = doctest.DocTestParser().get_doctest(text, {}, "python.md", None, 0)
    assert len(test.examples) > 20
    assert doctest.DocTestRunner().run(test).failed == 0
    assert Path("run.png").stat().st_size > 1000
