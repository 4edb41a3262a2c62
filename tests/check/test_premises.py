"""A theorem is applied only where the claims behind its hypotheses state what these come to for its loop."""

import json
import subprocess
import sys
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest

from lyapcheck.check.certificate import digest_of
from lyapcheck.check.files import gather
from lyapcheck.check.kinds.loop_property import FACTS, Facts, LoopProperty, facts_of
from lyapcheck.check.recheck import recheck
from lyapcheck.check.refusal import Refused
from lyapcheck.check.verify import verify
from lyapcheck.claims import cosh, dh, exp, expr, h, log, loop_property, potential, run_proof, tanh, var
from lyapcheck.claims.procedures import propose
from lyapcheck.claims.script import find_script
from tests.helpers.script_cases import rewriter
from tests.helpers.shares import but, one_in

pytestmark = pytest.mark.usefixtures("in_this_process")

SCRIPT = """
from lyapcheck.claims import *
proof = Proof("tanh", "tanh in place of h_m, with no more than the theorem needs")
x = var("x")
T, SLOPE, U = tanh(x), 1 - tanh(x) ** 2, log(cosh(x))
known = FamilyBounds(2, gamma=1, rho=1, L=1)
k, b_min, b_max, kv_max, beta, kc = map(var, ("kp", "b_min", "b_max", "kv_max", "beta", "kc"))

def theta(eps, b_max=b_max):
    c, d = known.drift(beta, kc), known.cross(b_max, kv_max)
    return eps * k, -eps / 2 * (d + eps * c), b_min - eps * c

loop = known.loop((T, SLOPE, U), theta(var("eps")))
variables = positive("kp", "b_min", "beta") + nonnegative("more", "kv_max", "kc")
corner, side, low = theta(var("eps0") * var("share"), b_min + var("more"))
odd, positive_right = identity(tanh(-x), -T), for_all(expr(0) < T, 0, open_low=True)

F = (T, SLOPE, U)

proof.add("rest", "at rest only at 0", loop_property("the origin is the only equilibrium", F))
proof.add("smooth", "V is differentiable", loop_property("V is continuously differentiable", F))
proof.add("positive", "V is positive definite", loop_property("V is positive definite", F))
proof.add("unbounded", "V is radially unbounded", loop_property("V is radially unbounded", F))
proof.add("sizes", "bounds of tanh", all_of(
    odd=odd,
    right=positive_right,
    top=for_all(T <= 1),
    bottom=for_all(-expr(1) <= T),
    slope=identity(diff(T, "x"), SLOPE),
    above=for_all(SLOPE <= 1),
    below=for_all(-expr(1) <= SLOPE),
    linear=norm_bound(T, 1, 1, power=1),
))
proof.add("rate", "the bound of dV/dt", rate_bound(loop))
proof.add("small", "Θ is positive definite for small ε₀", all_of(
    corner=ForSmall("eps0", variables, (), expr(0) < corner, ("share",)),
    minor=ForSmall("eps0", variables, (), side**2 < corner * low, ("share",)),
))
names = {
    "only_equilibrium": "rest",
    "differentiable": "smooth",
    "positive_definite": "positive",
    "radially_unbounded": "unbounded",
    "bounds_of_h": "sizes",
    "rate_bounded_by_a_form": "rate",
    "form_negative_definite": "small",
}
proof.add("P", "globally asymptotically stable", theorem("Lyapunov's direct method", loop, **names),
          uses=names.values())
"""
CLAIMS = ("rest", "smooth", "positive", "unbounded", "sizes", "rate", "small")
UNRELATED = "Constant(expr(1) <= 2)"


def conclusion(tmp_path, source, name="P", only=(), proved=True):
    """The row of a claim; the claims behind it are all proved."""
    path = tmp_path / "script.py"
    path.write_text(source, encoding="utf-8")
    rows = {row.id: row for row in run_proof(path, ms=(2,), n=None if only else 2, only=only).claims}
    if proved:
        assert all(row.verdict.value == "proved" for row in rows.values() if row.id in CLAIMS)
    return rows[name]


def test_nothing_more_than_this_is_needed(tmp_path):
    assert conclusion(tmp_path, SCRIPT).verdict.value == "proved"


@pytest.mark.parametrize("claim", one_in(4, CLAIMS))
def test_a_premise_that_proves_something_unrelated_proves_nothing(tmp_path, claim):
    """The claim is true, has the right id and is used under the right hypothesis; it says something else."""
    planted = f'proof.add("{claim}", "", {UNRELATED})\nproof.add("other {claim}",'
    row = conclusion(tmp_path, SCRIPT.replace(f'proof.add("{claim}",', planted))
    assert row.verdict.value == "undecided"
    assert f"{claim} does not state" in row.decision.reason
    assert row.broken == ()


WEAKER = {
    "another function": ("T, SLOPE, U), theta", "tanh(2 * x) / 2, SLOPE, U), theta"),
    "another potential": ("loop((T, SLOPE, U)", "loop((T, SLOPE, 2 * U)"),
    "a bound of h that is not proved": ("(2, gamma=1, rho=1, L=1)", '(2, gamma="0.9", rho=1, L=1)'),
    "a bound of its slope that is not proved": ("(2, gamma=1, rho=1, L=1)", '(2, gamma=1, rho="0.9", L=1)'),
    "a bound of its secants that is not proved": ("(2, gamma=1, rho=1, L=1)", '(2, gamma=1, rho=1, L="0.9")'),
    "bounded, not linear": ("norm_bound(T, 1, 1, power=1)", "norm_bound(T, 1, 1)"),
    "steeper secants": ("norm_bound(T, 1, 1, power=1)", "norm_bound(T, 1, 2, power=1)"),
    "only right of 1": ("for_all(expr(0) < T, 0, open_low=True)", "for_all(expr(0) < T, 1)"),
    "not negative right of 0": ("for_all(expr(0) < T, 0, open_low=True)", "for_all(expr(0) <= T, 0)"),
    "up to 100 only": ("for_all(expr(0) < T, 0, open_low", "for_all(expr(0) < T, 0, 100, open_low"),
    "not odd": ("    odd=odd,\n    right", "    right"),
    "bounded on one side of 0 only": ("for_all(T <= 1)", "for_all(T <= 1, 0)"),
    "bounded from above only": ("    bottom=for_all(-expr(1) <= T),\n", ""),
    "a larger bound": ("bottom=for_all(-expr(1) <= T)", "bottom=for_all(-expr(2) <= T)"),
    "rising slope on one side of 0 only": ("for_all(SLOPE <= 1)", "for_all(SLOPE <= 1, 0)"),
    "slope bounded from above only": ("    below=for_all(-expr(1) <= SLOPE),\n", ""),
    "a slope of something": ('    slope=identity(diff(T, "x"), SLOPE),\n', ""),
    "the positive definiteness of another V": (
        'loop_property("V is positive definite", F)',
        'loop_property("V is positive definite", (T / 2, SLOPE / 2, U / 2))',
    ),
    "the smoothness of V with another slope": (
        'loop_property("V is continuously differentiable", F)',
        'loop_property("V is continuously differentiable", (T, 1 / cosh(x) ** 2, U))',
    ),
    "a property of V in place of another": (
        'loop_property("V is radially unbounded", F)',
        'loop_property("V is positive definite", F)',
    ),
    "an equilibrium, not the only one": (
        '"the origin is the only equilibrium"',
        '"the origin is an equilibrium"',
    ),
    "the equilibrium of another loop": (
        '"the origin is the only equilibrium", F)',
        '"the origin is the only equilibrium", (tanh(x) / 2, SLOPE / 2, U / 2))',
    ),
    "a weak inequality": ("(), side**2 < corner * low", "(), side**2 <= corner * low"),
    "under a condition": ("variables, (), side**2", "variables, (k < b_min,), side**2"),
    "for constants above others": (
        'positive("kp", "b_min", "beta") + nonnegative("more", "kv_max", "kc")',
        'positive("kp", "b_min", "beta", "kc") + nonnegative("more", "kv_max")',
    ),
    "another form": ("(), side**2 < corner * low", "(), side**2 < 2 * corner * low"),
    "one that does not fall with the error": (
        '"), b_min + var("more"))',
        '") * 0 + var("eps0"), b_min + var("more"))',
    ),
    "less friction": ('b_min + var("more"))', "b_min)"),
}


@pytest.mark.parametrize("name", one_in(5, WEAKER))
def test_a_premise_that_says_a_little_less_is_not_enough(tmp_path, name):
    right, wrong = WEAKER[name]
    assert right in SCRIPT
    row = conclusion(tmp_path, SCRIPT.replace(right, wrong))
    assert row.verdict.value == "undecided", row.decision
    assert "does not state" in row.decision.reason


PREMISES = ("equilibrium", "V.smooth", "V.positive", "V.unbounded", "h.bounds", "rate.form")
TIME_VARYING = (
    "21.loop",
    "V.smooth",
    "V.positive",
    "21.below",
    "21.above",
    "V.unbounded",
    "h.bounds",
    "21.form",
)


@pytest.mark.parametrize(
    ("script", "claim", "named"),
    one_in(
        14,
        [
            *(("scalar.py", "arms.all", name) for name in (*PREMISES, "arms.small")),
            ("scalar.py", "arms.stable", "arms.theta"),
            *(("scalar.py", "arm.stable", name) for name in ("h.bounds", "arm.M", "arm.C", "arm.theta")),
            *(("tracking.py", "21", name) for name in (*TIME_VARYING, "21.small")),
            *(("tracking.py", "arm.21", name) for name in ("arm.M", "arm.C", "arm.21.theta")),
            ("examples/arctan.py", "stable", "sizes"),
        ],
    ),
)
def test_planted_in_the_proofs_it_is_found_too(tmp_path, script, claim, named):
    """The claim of that name is planted before the rest is taken from the proof."""
    source = "from lyapcheck.claims import *\nproof = Proof('planted', '')\n"
    source += f"proof.add({named!r}, 'planted', {UNRELATED})\nproof.adopt({_found(script)!r}, {claim!r})\n"
    row = conclusion(tmp_path, source, claim, only=(claim,))
    assert row.verdict.value == "undecided"
    assert f"{named} does not state" in row.decision.reason


def _found(script):
    """A shipped script by name, or by its path where it lies in a folder."""
    return str(Path(find_script("published.py")).parent / script) if "/" in script else script


@pytest.mark.slow
@pytest.mark.parametrize(
    "claim",
    one_in(
        3,
        ["bounds of another M", "M not definite", "M not bounded", "C of another arm", "a larger bound of C"],
    ),
)
def test_bounds_of_another_arm_are_no_bounds_of_this_one(tmp_path, claim):
    """All of them are true; only their M, or their bound, is not that of the theorem."""
    other = "ArmBounds(load('pelican2'))"
    planted, named = {
        "bounds of another M": (f"all_of(a={other}.mass_above(), b={other}.mass_below())", "arm.M"),
        "M not definite": ("ArmBounds(robot).mass_below()", "arm.M"),
        "M not bounded": ("ArmBounds(robot).mass_above()", "arm.M"),
        "C of another arm": (f"{other}.coriolis_below()", "arm.C"),
        "a larger bound of C": (
            "replace(ArmBounds(robot).coriolis_below(), high=ArmBounds(robot).kc + 1)",
            "arm.C",
        ),
    }[claim]
    source = "from dataclasses import replace\nfrom lyapcheck.claims import *\n"
    source += "from lyapcheck.robots import load\nproof = Proof('planted', '')\n"
    source += f"@proof.claim({named!r}, 'planted')\ndef _(robot):\n    return {planted}\n"
    source += "proof.adopt('scalar.py', 'arm.stable')\n"
    path = tmp_path / "script.py"
    path.write_text(source, encoding="utf-8")
    rows = {row.id: row for row in run_proof(path, ms=(2,), only=(named, "arm.stable")).claims}
    assert rows[named].verdict.value == "proved"
    assert rows["arm.stable"].verdict.value == "undecided"
    assert f"{named} does not state" in rows["arm.stable"].decision.reason


@pytest.mark.slow
@pytest.mark.parametrize("constant", ["beta", "kc"])
def test_a_hundredth_of_a_constant_of_the_arm_proves_nothing_about_it(tmp_path, constant):
    """With β_M/100 or k_c/100 in the numbers, or where they come from, the arm is not said to be stable."""
    write = rewriter("scalar.py", tmp_path)
    numbers = write(f'"{constant}": arm.{constant}', f'"{constant}": arm.{constant} / 100')
    (row,) = run_proof(numbers, ms=(2,), only=("arm.stable",)).claims
    assert row.verdict.value == "undecided"
    assert "does not state" in row.decision.reason
    everywhere = write(
        "\nproof = Proof(",
        "\nclass ArmBounds(ArmBounds):\n"
        "    @property\n"
        f"    def {constant}(self):\n"
        f"        return super().{constant} / 100\n\n"
        "proof = Proof(",
    )
    claims = ("arm.M", "arm.C", "arm.theta", "arm.stable")
    result = {row.id: row for row in run_proof(everywhere, ms=(2,), only=claims).claims}
    stated = {"beta": "arm.M", "kc": "arm.C"}[constant]
    assert result[stated].verdict.value in ("refuted", "undecided")
    assert result["arm.theta"].verdict.value == "proved", (
        "ε₀ is then larger, and this is all that is seen of it"
    )
    assert result["arm.stable"].verdict.value == "undecided"
    assert stated in result["arm.stable"].broken


def test_an_impossible_condition_is_seen_in_the_statement(tmp_path):
    """Nothing is wrong with it; but whoever reads the verdict reads what it is worth."""
    source = SCRIPT.replace('theta(var("eps")))', 'theta(var("eps")), condition=[var("eps0") < 0])')
    source = source.replace('theta(var("eps0") * var("share"), b_min + var("more"))', 'theta(var("eps"))')
    given = 'variables, (var("eps") + var("rest") < 0,)'
    source = source.replace('ForSmall("eps0", variables, ()', f"implies({given}").replace(
        ', ("share",))', ")"
    )
    source = source.replace(
        'positive("kp", "b_min", "beta") + nonnegative("more",',
        'positive("eps", "kp", "b_min", "beta") + nonnegative("rest", "b_max",',
    )
    assert source.count(given) == 2
    row = conclusion(tmp_path, source, proved=False)
    assert "with eps0 < 0" in row.statement
    assert "condition" not in row.comment


def test_which_facts_a_property_rests_on():
    """One that were left out would make the property follow from less."""
    statement = {name: LoopProperty(name, *LINEAR) for name in FACTS}
    result = {
        name: {fact for fact, _ in facts_of(one, (Fraction(1),) * FACTS[name][0])}
        for name, one in statement.items()
    }
    slope = "h' is the derivative of h"
    sign = {slope, "h(−x) = −h(x)", "0 < h(x) for x > 0"}
    definite = {"U' = h", "U(0) = 0", *sign}
    assert result == {
        "the origin is the only equilibrium": {*sign, "the loop that the controller closes"},
        "the origin is an equilibrium": {*sign, "the loop that the controller closes"},
        "V is positive definite": definite,
        "V is bounded below by a positive definite function": definite,
        "V is bounded above by a positive definite function": definite,
        "V is radially unbounded": {
            slope,
            "U' = h",
            "h(−x) = −h(x)",
            "c ≤ h(x) from some x on",
            "h ≤ γ",
            "−γ ≤ h",
        },
        "V is continuously differentiable": {
            "U' = h",
            slope,
            "h' ≤ ρ",
            "−ρ ≤ h'",
            "|h(x)| ≤ L|x|",
        },
    }


T = tanh(var("x"))
SLOPE = 1 - T**2
U = log(cosh(var("x")))
LINEAR = (("var", "x"), ("num", "1"), ("div", ("pow", ("var", "x"), 2), ("num", "2")))
X = var("x")
FAILS = {
    "U does not belong to h": ("V is positive definite", (T, SLOPE, 2 * U)),
    "U(0) is not 0": ("V is positive definite", (T, SLOPE, U + 1)),
    "h is not odd": ("V is positive definite", (exp(X) - 1, exp(X), exp(X) - X - 1)),
    "h has the other sign": ("V is positive definite", (-T, -SLOPE, -U)),
    "h vanishes": ("V is bounded below by a positive definite function", (0 * X, 0 * X, 0 * X)),
    "h vanishes elsewhere": (
        "the origin is the only equilibrium",
        (X**3 - X, 3 * X**2 - 1, X**4 / 4 - X**2 / 2),
    ),
    "the force turns away from 0": ("the origin is an equilibrium", (-T, -SLOPE, -U)),
    "V is bounded": ("V is radially unbounded", (X / (1 + X**2) ** 2, X, -1 / (1 + X**2) / 2)),
    "h comes down to 0": ("V is radially unbounded", (X / (1 + X**2), X, log(1 + X**2) / 2)),
    "h is not bounded": ("V is radially unbounded", (X, expr(1), X**2 / 2)),
    "h rises on one side only": ("V is radially unbounded", (exp(X) / (1 + exp(X)), X, log(1 + exp(X)))),
    "h' is not bounded": ("V is continuously differentiable", (X**3, 3 * X**2, X**4 / 4)),
    "h' is something else": ("V is continuously differentiable", (T, 2 * SLOPE, U)),
    "U is something else": ("V is continuously differentiable", (T, SLOPE, 2 * U)),
}


@pytest.mark.parametrize("name", FAILS)
def test_a_property_is_not_proved_where_a_fact_fails(name):
    decision = propose(loop_property(*FAILS[name]))
    assert decision.verdict.value in ("refuted", "undecided")


@pytest.mark.parametrize("m", but((2,), (1, 2, 12)))
@pytest.mark.parametrize("name", FACTS)
def test_every_property_is_proved_for_h_m(name, m):
    """Also where h_m of large numbers is not a double any more."""
    decision = propose(loop_property(name, (h(m, X), dh(m, X), potential(m, X))))
    assert decision.verdict.value == "proved", decision.reason


def test_a_property_with_other_numbers_or_fewer_proofs_is_refused():
    statement = loop_property("V is radially unbounded", (T, SLOPE, U))
    proof = propose(statement).proof
    assert verify(statement, proof).verdict == "proved"
    forged = [replace(proof, proofs=proof.proofs[:-1]), replace(proof, numbers=proof.numbers[:-1])]
    forged += [
        replace(proof, numbers=(*proof.numbers[:k], number, *proof.numbers[k + 1 :]))
        for k, number in ((0, Fraction(2)), (0, Fraction(-1)), (0, Fraction(0)), (2, Fraction(1, 2)))
    ]
    forged.append(
        replace(proof, proofs=(*proof.proofs[:2], proof.proofs[3], proof.proofs[2], *proof.proofs[4:]))
    )
    for one in forged:
        with pytest.raises(Refused):
            verify(statement, one)


def test_only_the_equilibrium_depends_on_the_torque():
    with pytest.raises(Refused, match="for the equilibrium of"):
        verify(loop_property("V is positive definite", (T, SLOPE, U), desired=True), Facts((), ()))


# Certificates -----------------------------------------------------------------------------------------------


@pytest.fixture
def folder(tmp_path):
    script, made = tmp_path / "script.py", tmp_path / "made"
    script.write_text(SCRIPT, encoding="utf-8")
    made.mkdir()
    for name, certificate in run_proof(script, ms=(2,), n=2).certificates.items():
        (made / name).write_text(certificate.text(), encoding="utf-8")
    return made


def rewritten(path, change):
    """Change a certificate and give it the digest of what it then says."""
    data = json.loads(path.read_text(encoding="utf-8"))
    change(data)
    data["digest"] = digest_of({key: value for key, value in data.items() if key != "digest"})
    path.write_text(json.dumps(data), encoding="utf-8")
    return data["digest"]


def outcome(folder):
    return {one.file: one for one in recheck(gather([folder])).checked}


def test_certificates_of_a_theorem_are_accepted_and_the_theorem_named(folder):
    assert all(one.accepted and not one.given for one in outcome(folder).values())
    assert recheck(gather([folder])).theorems == {"Lyapunov's direct method": ("P.json",)}
    run = subprocess.run(
        [sys.executable, "-m", "lyapcheck.check", str(folder)], capture_output=True, text=True, check=True
    )
    assert "1 claim rests on Lyapunov's direct method (kelly2005control, chapter 2): P.json" in run.stdout
    granted = recheck(gather([folder])).granted["P.json"]
    assert granted
    assert all(f"  {sentence}\n" in run.stdout for sentence in granted)


@pytest.mark.parametrize("claim", one_in(3, CLAIMS))
def test_a_certificate_of_something_unrelated_under_the_name_of_a_premise_is_no_help(folder, claim):
    """Everything is sealed again; only what the premise states is another truth."""
    relation = {"left": ["num", "1"], "operator": "<=", "right": ["num", "2"]}

    def plant(data):
        data["statement"] = {"kind": "Constant", "relation": relation}
        data["proof"], data["grade"] = {"rule": "exact numbers"}, "exact"

    digest = rewritten(folder / f"{claim}.json", plant)
    rewritten(folder / "P.json", lambda data: data["uses"].update({claim: digest}))
    result = outcome(folder)
    assert result[f"{claim}.json"].accepted
    assert f"{claim} does not state" in result["P.json"].reason


def test_a_certificate_alone_is_undecided_and_names_its_premises(folder):
    result = {one.file: one for one in recheck(gather([folder / "P.json"])).checked}["P.json"]
    assert result.status == "undecided"
    assert set(result.given) == set(CLAIMS)


WEIGHED = (
    *(f"theorems/{name}" for name in ("closed_loop", "definiteness", "premises", "rate")),
    *(f"kinds/{name}" for name in ("bound_every_n", "every_n", "loop_property", "theorem")),
)
"""What an application of a theorem rests on; ``random`` draws the exact points of a second evaluation."""


def test_what_the_checker_imports_is_still_small():
    rules = Path(__file__).parents[2] / "lyapcheck" / "check"
    for name in WEIGHED:
        lines = (rules / f"{name}.py").read_text(encoding="utf-8").splitlines()
        imported = [line.split()[1] for line in lines if line.startswith(("from ", "import "))]
        assert {module.split(".")[0] for module in imported} <= {
            "__future__",
            "collections",
            "dataclasses",
            "fractions",
            "functools",
            "itertools",
            "random",
            "flint",
            "lyapcheck",
        }
        assert all(module.startswith("lyapcheck.check") for module in imported if module.startswith("lyap"))
