"""The built wheel, installed away from the checkout, does what the checkout and the documents say."""

import os
import shlex
import shutil
import subprocess
import sys
import venv
import zipfile
from pathlib import Path

import pytest

from lyapcheck.cli.commands import NAMES
from tests.cli.test_every_command import CALLS, GAINS, PLAN
from tests.extending.page import FILE
from tests.house.test_docs import DOCS, EXTENDED, lines

CHECKOUT = Path(__file__).resolve().parents[2]
HERE = Path(sys.executable).parent

pytestmark = pytest.mark.slow


def run(*command, cwd):
    """Run a program with nothing of the checkout in its environment, and a store of its own."""
    given = ("PYTHON", "LYAPCHECK")
    environment = {key: value for key, value in os.environ.items() if not key.startswith(given)}
    environment["XDG_CACHE_HOME"] = str(cwd / ".cache")
    return subprocess.run(
        [str(word) for word in command],
        cwd=cwd,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
        timeout=3000,
    )


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    folder = tmp_path_factory.mktemp("wheel")
    done = run(sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", folder, cwd=CHECKOUT)
    assert done.returncode == 0, done.stderr
    (built,) = folder.glob("*.whl")
    return built


@pytest.fixture(scope="module")
def installed(wheel, tmp_path_factory):
    """The bin folder of a new environment with the wheel, and with the dependencies of this one.

    The dependencies come by a path file, and path files inside that path are not followed: the editable
    install of the checkout, which is one, stays out.
    """
    home = tmp_path_factory.mktemp("environment")
    venv.create(home, symlinks=True, with_pip=False)
    python = home / "bin" / "python"
    pip = (sys.executable, "-m", "pip", "--disable-pip-version-check", "--python", python)
    done = run(*pip, "install", "--quiet", "--no-index", "--no-deps", wheel, cwd=home)
    assert done.returncode == 0, done.stderr
    (site,) = home.glob("lib/python*/site-packages")
    places = [path for path in sys.path if path.endswith(("site-packages", "dist-packages"))]
    (site / "dependencies.pth").write_text("\n".join(places) + "\n", encoding="utf-8")
    return python.parent


@pytest.fixture
def elsewhere(tmp_path):
    return tmp_path


def ask(installed, elsewhere, code):
    done = run(installed / "python", "-c", code, cwd=elsewhere)
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


def test_the_wheel_carries_everything_that_is_read_at_run_time(wheel):
    held = set(zipfile.ZipFile(wheel).namelist())
    places = {
        "lyapcheck": "lyapcheck",
        **{name: f"lyapcheck/{name}" for name in ("proofs", "examples", "formal")},
    }
    for folder, place in places.items():
        listed = run("git", "ls-files", "-z", folder, cwd=CHECKOUT).stdout.split("\0")
        there = [name for name in listed if name]
        assert there
        assert {place + name.removeprefix(folder) for name in there} <= held
    assert not [name for name in held if name.startswith(("tests/", "proofs/", "examples/", "formal/"))]
    assert not [name for name in held if name.endswith((".vo", ".glob", ".pyc"))]


def test_python_finds_the_wheel_and_not_the_checkout(installed, elsewhere):
    place = Path(ask(installed, elsewhere, "import lyapcheck; print(lyapcheck.__file__)"))
    assert place.is_relative_to(installed.parent)
    path = ask(installed, elsewhere, "import sys; print(*sys.path, sep='\\n')").splitlines()
    assert str(CHECKOUT) not in path


def test_every_public_name_resolves(installed, elsewhere):
    code = "import lyapcheck; print(*(type(getattr(lyapcheck, name)) for name in lyapcheck.__all__))"
    assert "class" in ask(installed, elsewhere, code)


def same(installed, elsewhere, *arguments):
    """What the wheel prints, which must be what the checkout prints."""
    theirs = run(installed / "lyapcheck", *arguments, cwd=elsewhere)
    ours = run(HERE / "lyapcheck", *arguments, cwd=elsewhere)
    assert "Traceback" not in theirs.stderr
    assert (theirs.returncode, theirs.stdout) == (ours.returncode, ours.stdout)
    assert theirs.stdout
    return theirs


@pytest.mark.parametrize("name", NAMES)
def test_every_command_does_its_work(installed, elsewhere, name):
    (elsewhere / "one.toml").write_text(GAINS, encoding="utf-8")
    (elsewhere / "plan.toml").write_text(PLAN, encoding="utf-8")
    words, code = CALLS[name]
    done = run(installed / "lyapcheck", name, *words.split(), cwd=elsewhere)
    assert done.returncode == code, done.stderr


def test_gate_on_the_papers_gains(installed, elsewhere):
    gains = ask(installed, elsewhere, "import lyapcheck; print(lyapcheck.paper_gain_file('table2'))")
    assert Path(gains).is_relative_to(installed.parent)
    done = same(installed, elsewhere, "gate", gains)
    assert done.returncode == 1
    assert "1 accepted" in done.stdout


FEWER = ("--max-boxes", "200", "--starts", "2")
"""For what takes minutes otherwise: what is found is less, and how it is written the same."""
PAGES = [page for page in DOCS if page.name != EXTENDED and lines(page)]
"""extend.md adds rules to the checker, which an installed one does not take: tests/extending."""
ELSEWHERE = "tcp://head:8786"


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_the_documents_hold_in_an_empty_folder(installed, elsewhere, page):
    """The files of a page, then every line of it, in its order: each ends as the page says."""
    for match in FILE.finditer(page.read_text(encoding="utf-8")):
        (elsewhere / match["path"]).write_text(match["text"], encoding="utf-8")
    for line, code in lines(page):
        if ELSEWHERE in line:
            continue
        words = shlex.split(line)[1:]
        fewer = FEWER if words[0] == "epsilon" else ()
        done = run(installed / "lyapcheck", *words, *fewer, cwd=elsewhere)
        assert done.returncode in ((0, 3) if fewer else (code,)), (line, done.stderr)
        assert "Traceback" not in done.stderr


def test_report_has_its_style_and_script(installed, elsewhere):
    gains = ask(
        installed, elsewhere, "import lyapcheck; print(lyapcheck.paper_gain_file('table2_shoulder_elbow'))"
    )
    wanted = ("report", "--m", "1", "--robot", "reyes-kelly2", "--gains", gains, "--out", "report")
    done = run(installed / "lyapcheck", *wanted, cwd=elsewhere)
    assert done.returncode == 0, done.stderr
    assert {"index.html", "report.md", "report.json"} <= {
        path.name for path in (elsewhere / "report").iterdir()
    }


@pytest.mark.skipif(shutil.which("coqc") is None, reason="needs coqc")
def test_coqs_kernel_judges_certificates(installed, elsewhere):
    own = CHECKOUT / "tests" / "kernel" / "certificates"
    names = [own / name for name in ("h.odd.m2.json", "7g.m2.json", "reyes-kelly2.m1.falsified.json")]
    done = run(installed / "lyapcheck", "recheck", "--kernel", *names, cwd=elsewhere)
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("kernel") >= len(names)
