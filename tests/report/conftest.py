"""One small real report for all tests of reports."""

from concurrent.futures import Executor, Future
from dataclasses import replace

import pytest

from lyapcheck.answers.check import run
from lyapcheck.answers.check.run import run_proof
from lyapcheck.control.gains import paper_gain_file, read_gain_file
from lyapcheck.report import build as building
from lyapcheck.report.build import build, render, write
from lyapcheck.report.model import Subject
from tests.helpers import small_proofs
from tests.helpers.once import once
from tests.helpers.one_process import one_process
from tests.helpers.small_proofs import small_proof


def pytest_collection_modifyitems(items):
    """A whole report takes ten seconds; what is quick is about reports put together by hand."""
    for item in items:
        if "report" in getattr(item, "fixturenames", ()):
            item.add_marker(pytest.mark.slow)


class AtOnce(Executor):
    """Does what it is handed before it returns."""

    def __init__(self, *anything):
        pass

    def submit(self, fn, /, *args, **kwargs):
        result = Future()
        result.set_result(fn(*args, **kwargs))
        return result


@pytest.fixture(scope="session")
def subject():
    """The two-joint arm, m = 1."""
    file = read_gain_file(paper_gain_file(small_proofs.GAINS))
    return Subject(small_proofs.ROBOT, (small_proofs.MEMBER,), (replace(file, gains=file.gains[:1]),))


@pytest.fixture(scope="session")
def report(subject, tmp_path_factory):
    """What is said about it, with all computations in this process; tests of processes make their own."""

    def kept(proof, ms, robot=None, n=None, gains=None, only=()):
        if n is not None:  # the study of n, about no arm
            return run_proof(proof, ms, n=n, only=only)
        assert (getattr(robot, "name", robot), tuple(ms)) == (small_proofs.ROBOT, (small_proofs.MEMBER,))
        return run_proof(proof, ms, robot, n, gains, only) if only else small_proof(tmp_path_factory, proof)

    def made():
        with one_process() as patch:
            patch.setattr(building, "pool", AtOnce)
            patch.setattr(run, "run_proof", kept)
            return build(subject)

    return once(tmp_path_factory, "report", made)


@pytest.fixture(scope="session")
def everything(report, tmp_path_factory):
    """Its files by their names."""
    return once(tmp_path_factory, "rendered", lambda: render(report))


@pytest.fixture(scope="session")
def files(everything):
    """All of it as text; what is not is known by its name only."""
    return {name: content if isinstance(content, str) else "" for name, content in everything.items()}


@pytest.fixture(scope="session")
def folder(everything, tmp_path_factory):
    """All of it on disk."""
    place = tmp_path_factory.mktemp("report")
    write(everything, place)
    return place
