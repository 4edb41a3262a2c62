"""What the language of proofs does not take is refused at the line that writes it, with what to write."""

import pytest

from lyapcheck.claims import run_proof
from lyapcheck.errors import InputError

pytestmark = pytest.mark.usefixtures("in_this_process")

HEAD = """from lyapcheck.claims import *
proof = Proof("mine", "My proof")
goal = constant_goal()
e, w = goal.e, goal.w
K, A = goal.gains("K A")
J, x, y = any_matrix("J"), any_vector("x"), any_vector("y")
"""
TAIL = '\nproof.add("one", "1 ≤ 2", Constant(expr(1) <= 2))\n'

REFUSED = [
    # what is written on line 7, what the error says of it, what to write instead
    ("K @ A", "product of two matrices", "K @ (A @ x)"),
    ("J @ J", "product of two matrices", "K @ (A @ x)"),
    ("K @ 2", "int is neither", "s * x"),
    ("x @ 2", "int is neither", "s * x"),
    ("x @ K @ 2", "int is neither", "s * x"),
    ("x @ K @ A @ var('a')", "Expr is neither", "s * x"),
    ("K + 1", "a number stands beside", "norm(x)"),
    ("goal.entrywise('f', e - w)", "or a gain times one, not of", "goal.state("),
    ("goal.entrywise('f', K @ e - w)", "or a gain times one, not of", "goal.increase("),
    ("goal.increase('c', goal.entrywise('f', e), e + w)", "by a gain times another state", "K @ e - D @ w"),
    ("goal.entrywise('f', e, level=2)", "a level is a gain of this goal", "give it one"),
    ("goal.entrywise('f', 2)", "or a gain times one, not of 2", "goal.state("),
    ("goal.entrywise('f', x)", "or a gain times one, not of x", "goal.state("),
    (
        "goal.function('f', e + w, tanh(var('x')), log(cosh(var('x'))), rho=1, secant=1, low='1/2')",
        "or a gain times one, not of",
        "goal.state(",
    ),
    ("goal.under(K @ e); goal.constants('alpha')", "alpha is named after under", "name it before"),
    ("goal.under(K @ e); goal.gains('L')", "L is named after under", "name it before"),
    ("goal.under(K @ e); goal.state('z', e)", "z is named after under", "name it before"),
    ("goal.under(K @ e); goal.entrywise('f', e)", "f is named after under", "name it before"),
    ("goal.under(K)", "a torque is a vector", "Kp @ e"),
    ("goal.under(0)", "a torque is a vector", "Kp @ e"),
    ("goal.state('z', 0)", "derivative of a state is a vector", "α * e"),
    ("goal.gains('P')", "P is taken", "none of A, ad, B, beta"),
    ("goal.gains('D')", "D is taken", "none of A, ad, B, beta"),
    ("goal.constants('R')", "R is taken", "none of A, ad, B, beta"),
    ("goal.constants('K')", "K is taken", "none of A, ad, B, beta"),
    ("goal.gains('L L')", "L is taken", "none of A, ad, B, beta"),
    ("goal.state('x', e)", "x is taken", "none of A, ad, B, beta"),
    ("goal.entrywise('u', e)", "u is taken", "none of A, ad, B, beta"),
    ("goal.entrywise('f', e); goal.state('df', e)", "df is taken", "Uf"),
    ("goal.gains('K_p')", "underscore", "without one"),
    ("proof.add('a', 'b', Constant(expr(1) <= 2), stands='theirs')", "stands='theirs' is none of", "quoted"),
]


@pytest.mark.parametrize(("written", "says", "repair"), REFUSED, ids=[case[0] for case in REFUSED])
def test_it_is_refused_at_its_line_with_the_repair(tmp_path, written, says, repair):
    path = tmp_path / "mine.py"
    path.write_text(HEAD + written + TAIL, encoding="utf-8")
    with pytest.raises(InputError) as refused:
        run_proof(path, ms=(1,), n=2)
    (problem,) = refused.value.problems
    assert problem.line == HEAD.count("\n") + 1
    assert says in problem.rule
    assert repair in f"{problem.rule} {problem.repair}"


def test_the_opposite_of_a_matrix_is_one(tmp_path):
    """A planted fault beside: −K and K are told apart."""
    path = tmp_path / "mine.py"
    path.write_text(
        HEAD
        + """
proof.add("gain", "−K", every_n(x @ (-K) @ y, -(x @ K @ y)))
proof.add("matrix", "−J", every_n(x @ (-J @ y), -(x @ J @ y)))
proof.add("difference", "K − A", every_n(x @ (K - A) @ y, x @ K @ y - x @ A @ y))
proof.add("fault", "−J is J", every_n(x @ (-J) @ y, x @ J @ y))
""",
        encoding="utf-8",
    )
    rows = {row.id: row.verdict.value for row in run_proof(path, ms=(1,), n=2).claims}
    assert rows == {"gain": "proved", "matrix": "proved", "difference": "proved", "fault": "refuted"}
