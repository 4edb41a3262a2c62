"""The documents: their commands are ones that lyapcheck takes; tests/cli/test_wheel.py runs them."""

import os
import re
import shlex
import subprocess
import tomllib
from pathlib import Path

import pytest

from lyapcheck import load_robot, read_plan
from lyapcheck.cli.commands import NAMES, load
from lyapcheck.cli.parser import Parser
from tests.extending.page import exit_code

ROOT = Path(__file__).parents[2]
PUBLISH = ROOT / ".github" / "workflows" / "publish.yml"
README = ROOT / "README.md"
DOCS = sorted([README, *(ROOT / "docs").glob("*.md")])
EXTENDED = "extend.md"
"""Its commands are run as they stand by tests/extending, with the files that it adds."""
SCREEN = 60
"""Lines of a README that fits one screen."""


def lines(page):
    """The command lines of a page with the exit code that their comment names."""
    result = []
    for block in re.findall(r"```console\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL):
        for line in re.findall(r"^\$ (.*)$", block, re.MULTILINE):
            parts = re.split(r"&&|>", line.split(" #")[0])
            result += [(part.strip(), exit_code(line)) for part in parts]
    return [(line, code) for line, code in result if line.startswith("lyapcheck ")]


def commands(page):
    """The command lines of a page, without comments."""
    return [line for line, _ in lines(page)]


EVERY = [(page.name, line) for page in DOCS if page.name != EXTENDED for line in commands(page)]


@pytest.mark.parametrize(("page", "line"), EVERY)
def test_every_command_in_the_documents_is_one(page, line):
    name, *words = shlex.split(line)[1:]
    if not name.startswith("-"):
        assert name in NAMES
        parser = Parser(prog=name)
        load(name).arguments(parser)
        parser.parse(words)


def test_there_are_commands_in_the_documents():
    assert len(EVERY) > 25


def tables(page):
    """The TOML of a page that is no file of its own."""
    return re.findall(r"(?<!`:\n\n)```toml\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL)


TABLES = [(page.name, text) for page in DOCS for text in tables(page)]


def completed(text):
    """An arm file with a table of a page: its last link, or its joints in a URDF file, has these entries."""
    if text.startswith("[[joints]]"):
        return f'title = "a"\nurdf = "{ROOT / "examples" / "ur5.urdf"}"\n{text}'
    arm = (ROOT / "examples" / "init" / "arm.toml").read_text(encoding="utf-8")
    before, mark, last = arm.rpartition("[[links]]")
    keys = re.findall(r"^(?:\[links\.)?(\w+)(?: =|\])", text, re.MULTILINE)
    rest = re.sub(rf"^(?:{'|'.join(keys)}) =.*\n", "", last, flags=re.MULTILINE)
    if text.startswith("[[links]]"):
        return before + text + rest
    return before + mark + rest + text


@pytest.mark.parametrize(("page", "text"), TABLES)
def test_every_table_in_the_documents_can_be_read(page, text, tmp_path):
    file = tmp_path / "file.toml"
    if text.startswith("robots ="):
        file.write_text(text.replace('"my_arm.toml"', '"pelican2"'), encoding="utf-8")
        assert read_plan(file).questions
    else:
        file.write_text(completed(text), encoding="utf-8")
        assert load_robot(file).n >= 2, page


@pytest.mark.parametrize("page", DOCS, ids=lambda page: page.name)
def test_links_lead_somewhere(page):
    targets = re.findall(r"\]\(([^)#\s]+)(?:#[^)]*)?\)", page.read_text(encoding="utf-8"))
    local = [target for target in targets if not re.match(r"[a-z]+:", target)]
    assert [target for target in local if not (page.parent / target).exists()] == []


def test_every_page_has_its_place_in_the_site():
    text = (ROOT / "docs" / "conf.py").read_text(encoding="utf-8")
    kinds = text.partition("KINDS = {")[2].partition("\n}")[0]
    listed = set(re.findall(r'"([a-z_]+)"', kinds))
    assert {page.stem for page in (ROOT / "docs").glob("*.md")} - {"index"} <= listed


def test_the_readme_fits_a_screen():
    """Its picture is a file beside it, or has the address that the workflow writes."""
    text = README.read_text(encoding="utf-8")
    assert len(text.splitlines()) <= SCREEN
    assert set(re.findall(r"\]\((?![a-z]+:|#)([^)]+)\)", text)) <= {"docs/response.png"}
    assert all((ROOT / name).exists() for name in re.findall(r"`([\w/]+\.(?:md|cff))`", text))


@pytest.mark.skipif("](docs/" not in README.read_text(encoding="utf-8"), reason="the workflow has run")
def test_a_published_readme_has_absolute_links(tmp_path):
    """The steps of the workflow before it builds, run on copies."""
    for name in ("README.md", "pyproject.toml"):
        (tmp_path / name).write_bytes((ROOT / name).read_bytes())
    for step in re.findall(r"- run: ((?:sed|printf) .*)", PUBLISH.read_text(encoding="utf-8")):
        env = {"PATH": os.environ["PATH"], "GITHUB_REPOSITORY": "who/where", "GITHUB_SHA": "abc"}
        subprocess.run(step, shell=True, check=True, cwd=tmp_path, env=env)
    text = (tmp_path / "README.md").read_text(encoding="utf-8")
    assert "](https://raw.githubusercontent.com/who/where/abc/docs/response.png)" in text
    assert re.findall(r"\]\((?!https:)", text) == []
    project = tomllib.loads((tmp_path / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert project["urls"] == {"Repository": "https://github.com/who/where"}


def test_scripts_that_are_named_are_there():
    text = (ROOT / "docs" / "own_proof.md").read_text(encoding="utf-8")
    shipped = re.findall(r"^\| `(\w+\.py)` \|", text, re.MULTILINE)
    assert len(shipped) > 8
    assert [name for name in shipped if not (ROOT / "proofs" / name).is_file()] == []


def test_the_citation_is_of_this_version():
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert f"\nversion: {project['version']}\n" in citation
    assert f"\nlicense: [{project['license'].replace(' AND ', ', ')}]\n" in citation
