"""A theorem is applied only where the claims behind its hypotheses state what these come to for its loop."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from lyapcheck.check.certificate import digest_of
from lyapcheck.check.files import gather
from lyapcheck.check.recheck import recheck
from lyapcheck.claims import run_proof

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
    bottom=for_all(expr(-1) <= T),
    slope=identity(diff(T, "x"), SLOPE),
    above=for_all(SLOPE <= 1),
    below=for_all(expr(-1) <= SLOPE),
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


def conclusion(tmp_path, source, name="P"):
    path = tmp_path / "script.py"
    path.write_text(source, encoding="utf-8")
    rows = {row.id: row for row in run_proof(path, ms=(2,), n=2).claims}
    assert all(row.verdict.value == "proved" for row in rows.values() if row.id in CLAIMS)
    return rows[name]


def test_nothing_more_than_this_is_needed(tmp_path):
    assert conclusion(tmp_path, SCRIPT).verdict.value == "proved"


@pytest.mark.parametrize("claim", CLAIMS)
def test_a_premise_that_proves_something_unrelated_proves_nothing(tmp_path, claim):
    """The claim is true, has the right id and is used under the right hypothesis; it says something else."""
    planted = f'proof.add("{claim}", "", {UNRELATED})\nproof.add("other {claim}",'
    row = conclusion(tmp_path, SCRIPT.replace(f'proof.add("{claim}",', planted))
    assert row.verdict.value == "undecided"
    assert f"{claim} does not state" in row.decision.reason
    assert row.broken == ()


WEAKER = {
    "another function": ("T, SLOPE, U), theta", "tanh(2 * x) / 2, SLOPE, U), theta"),
    "another potential": ("(T, SLOPE, U)", "(T, SLOPE, 2 * U)"),
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
    "bounded from above only": ("    bottom=for_all(expr(-1) <= T),\n", ""),
    "a larger bound": ("bottom=for_all(expr(-1) <= T)", "bottom=for_all(expr(-2) <= T)"),
    "rising slope on one side of 0 only": ("for_all(SLOPE <= 1)", "for_all(SLOPE <= 1, 0)"),
    "slope bounded from above only": ("    below=for_all(expr(-1) <= SLOPE),\n", ""),
    "a slope of something": ('    slope=identity(diff(T, "x"), SLOPE),\n', ""),
    "the positive definiteness of another V": (
        'loop_property("V is positive definite", F)',
        'loop_property("V is positive definite", (T, SLOPE, 2 * U))',
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
        'positive("kp", "b_min", "beta")',
        'positive("kp", "b_min", "beta", "kc")',
    ),
    "another form": ("(), side**2 < corner * low", "(), side**2 < 2 * corner * low"),
    "one that does not fall with the error": (
        '"), b_min + var("more"))',
        '") * 0 + var("eps0"), b_min + var("more"))',
    ),
    "less friction": ('b_min + var("more"))', "b_min)"),
}


@pytest.mark.parametrize("name", WEAKER)
def test_a_premise_that_says_a_little_less_is_not_enough(tmp_path, name):
    right, wrong = WEAKER[name]
    assert right in SCRIPT
    path = tmp_path / "script.py"
    path.write_text(SCRIPT.replace(right, wrong), encoding="utf-8")
    row = next(row for row in run_proof(path, ms=(2,), n=2).claims if row.id == "P")
    assert row.verdict.value == "undecided", row.decision


@pytest.mark.parametrize(
    ("script", "claim", "named"),
    [
        ("scalar.py", "arms.all", "V.positive"),
        ("scalar.py", "arms.all", "rate.form"),
        ("scalar.py", "arms.stable", "arms.theta"),
        ("tracking.py", "21", "21.below"),
        ("tracking.py", "21", "21.form"),
    ],
)
def test_planted_in_the_proofs_it_is_found_too(tmp_path, script, claim, named):
    """The claim of that name is planted before the rest is taken from the proof."""
    source = "from lyapcheck.claims import *\nproof = Proof('planted', '')\n"
    source += f"proof.add({named!r}, 'planted', {UNRELATED})\nproof.adopt({script!r}, {claim!r})\n"
    row = conclusion(tmp_path, source, claim)
    assert row.verdict.value == "undecided"
    assert f"{named} does not state" in row.decision.reason


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


@pytest.mark.parametrize("claim", CLAIMS)
def test_a_certificate_of_something_unrelated_under_the_name_of_a_premise_is_no_help(folder, claim):
    """Everything is sealed again; only what the premise states is another truth."""
    relation = {"left": ["num", "1"], "operator": "<=", "right": ["num", "2"]}

    def plant(data):
        data["statement"] = {"kind": "Constant", "relation": relation}
        data["proof"], data["grade"] = {"rule": "exact numbers"}, "exact"

    digest = rewritten(folder / f"{claim}.json", plant)
    rewritten(folder / "P.json", lambda data: data["uses"].update({claim: digest}))
    found = outcome(folder)
    assert found[f"{claim}.json"].accepted
    assert f"{claim} does not state" in found["P.json"].reason


def test_a_certificate_alone_is_undecided_and_names_its_premises(folder):
    found = {one.file: one for one in recheck(gather([folder / "P.json"])).checked}["P.json"]
    assert found.status == "undecided"
    assert set(found.given) == set(CLAIMS)


def test_what_the_checker_imports_is_still_small():
    rules = Path(__file__).parents[1] / "lyapcheck" / "check"
    for name in ("theorems/premises", "theorems/definiteness", "theorems/rate", "kinds/bound_every_n"):
        lines = (rules / f"{name}.py").read_text(encoding="utf-8").splitlines()
        imported = [line.split()[1] for line in lines if line.startswith(("from ", "import "))]
        assert {module.split(".")[0] for module in imported} <= {
            "__future__",
            "collections",
            "dataclasses",
            "fractions",
            "functools",
            "itertools",
            "flint",
            "lyapcheck",
        }
        assert all(module.startswith("lyapcheck.check") for module in imported if module.startswith("lyap"))
