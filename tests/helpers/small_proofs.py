"""Proofs of the paper for the two-joint arm, its gains and m = 1, decided once for all tests of a run."""

from lyapcheck.answers.check.run import run_proof
from lyapcheck.control.gains import paper_gain_file
from tests.helpers.once import once
from tests.helpers.one_process import one_process

ROBOT, MEMBER, GAINS = "reyes-kelly2", 1, "table2_shoulder_elbow"


def small_proof(tmp_path_factory, script):
    """All claims of a script that comes with lyapcheck."""

    def made():
        with one_process():
            return run_proof(script, (MEMBER,), ROBOT, None, paper_gain_file(GAINS))

    return once(tmp_path_factory, script, made)
