"""The built wheel, installed away from the checkout, does what the checkout does."""

from __future__ import annotations

import os
import subprocess
import sys
import sysconfig
import venv
import zipfile
from pathlib import Path

import pytest

CHECKOUT = Path(__file__).resolve().parents[2]
HERE = Path(sys.executable).parent

pytestmark = pytest.mark.slow


def run(*command, cwd):
    """Run a program with nothing of the checkout in its environment."""
    environment = {key: value for key, value in os.environ.items() if not key.startswith("PYTHON")}
    return subprocess.run(
        [str(word) for word in command],
        cwd=cwd,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
        timeout=300,
    )


@pytest.fixture(scope="module")
def wheel(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("wheel")
    done = run(sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", folder, cwd=CHECKOUT)
    assert done.returncode == 0, done.stderr
    (built,) = folder.glob("*.whl")
    return built


@pytest.fixture(scope="module")
def installed(wheel, tmp_path_factory) -> Path:
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
    (site / "dependencies.pth").write_text(sysconfig.get_paths()["purelib"] + "\n", encoding="utf-8")
    return python.parent


@pytest.fixture
def elsewhere(tmp_path) -> Path:
    return tmp_path


def ask(installed, elsewhere, code):
    done = run(installed / "python", "-c", code, cwd=elsewhere)
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


def test_the_wheel_carries_everything_that_is_read_at_run_time(wheel):
    held = set(zipfile.ZipFile(wheel).namelist())
    package = {
        f"lyapcheck/{path.relative_to(CHECKOUT / 'lyapcheck').as_posix()}"
        for path in (CHECKOUT / "lyapcheck").rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }
    proofs = {f"lyapcheck/proofs/{path.name}" for path in (CHECKOUT / "proofs").iterdir() if path.is_file()}
    assert package <= held
    assert proofs <= held
    for ending in (".py", ".toml", "/references.bib", "/published.py"):
        assert any(name.startswith("lyapcheck/proofs/") and name.endswith(ending) for name in held)
    for needed in ("py.typed", "robots/arms/buap3.toml", "report/page/style.css", "report/page/page.js"):
        assert f"lyapcheck/{needed}" in held
    assert not [name for name in held if name.startswith(("tests/", "proofs/"))]


def test_python_finds_the_wheel_and_not_the_checkout(installed, elsewhere):
    place = Path(ask(installed, elsewhere, "import lyapcheck; print(lyapcheck.__file__)"))
    assert place.is_relative_to(installed.parent)
    path = ask(installed, elsewhere, "import sys; print(*sys.path, sep='\\n')").splitlines()
    assert str(CHECKOUT) not in path


def test_every_public_name_resolves(installed, elsewhere):
    code = "import lyapcheck; print(*(type(getattr(lyapcheck, name)) for name in lyapcheck.__all__))"
    assert "class" in ask(installed, elsewhere, code)


def paper_gains(installed, elsewhere):
    gains = ask(installed, elsewhere, "import lyapcheck; print(lyapcheck.paper_gain_file('table2'))")
    assert Path(gains).is_relative_to(installed.parent)
    return gains


def same(installed, elsewhere, *arguments):
    """What the wheel prints, which must be what the checkout prints."""
    theirs = run(installed / "lyapcheck", *arguments, cwd=elsewhere)
    ours = run(HERE / "lyapcheck", *arguments, cwd=elsewhere)
    assert "Traceback" not in theirs.stderr
    assert (theirs.returncode, theirs.stdout) == (ours.returncode, ours.stdout)
    assert theirs.stdout
    return theirs


def test_table(installed, elsewhere):
    assert same(installed, elsewhere, "table", "--m", "1:5", "--format", "json").returncode == 0


def test_gate_on_the_papers_gains(installed, elsewhere):
    done = same(installed, elsewhere, "gate", paper_gains(installed, elsewhere))
    assert done.returncode == 1
    assert "tau_m1: accepted" in done.stdout


def test_check_finds_the_papers_proof(installed, elsewhere):
    done = same(installed, elsewhere, "check", "published.py", "--only", "7b")
    assert done.returncode == 0
    assert done.stdout.count("✓  7b ") == 3


def test_explain(installed, elsewhere):
    assert same(installed, elsewhere, "explain", "7b").returncode == 0


def test_certificates_of_the_wheel_pass_the_checker_of_the_wheel(installed, elsewhere):
    lyapcheck = installed / "lyapcheck"
    wanted = ("check", "published.py", "--only", "7b", "--m", "2", "--certificates", "found")
    assert run(lyapcheck, *wanted, cwd=elsewhere).returncode == 0
    done = run(lyapcheck, "recheck", "found", cwd=elsewhere)
    assert (done.returncode, done.stderr) == (0, "")


def test_report_has_its_style_and_script(installed, elsewhere):
    gains = Path(paper_gains(installed, elsewhere)).with_name("table2_shoulder_elbow.toml")
    lyapcheck = installed / "lyapcheck"
    wanted = ("report", "--m", "1", "--robot", "reyes-kelly2", "--gains", gains, "--out", "report")
    done = run(lyapcheck, *wanted, cwd=elsewhere)
    assert done.returncode == 0, done.stderr
    assert {"index.html", "report.md", "report.json"} <= {
        path.name for path in (elsewhere / "report").iterdir()
    }
