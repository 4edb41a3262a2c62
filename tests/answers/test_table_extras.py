"""What the table shows beside the constants: leading terms, slopes, plots, HTML for notebooks."""

import csv
import io
import json
import re
from fractions import Fraction

import mpmath
import pytest

from lyapcheck.answers.table import build_table, slope_at_zero
from lyapcheck.errors import InputError
from lyapcheck.output.formats import Format
from tests.helpers.command import invoke

MEMBERS = (1, 2, 3, 40, 1000)


def run(*arguments):
    return invoke("table", *arguments)


@pytest.fixture(scope="module")
def tails():
    return build_table(MEMBERS, 25, with_asymptotes=True)


def leading(m):
    """As the notes under the table print them."""
    root, log = mpmath.sqrt(2), mpmath.log
    limit = root / mpmath.asinh(1)
    kappa = (1 + limit) / 4
    return {
        "gamma": root * (1 - (1 + log(4 * m)) / (4 * m)),
        "rho": m - mpmath.mpf(1) / 2 + mpmath.mpf(9) / (16 * m),
        "L": limit * (1 - kappa * (1 + log(m / kappa)) / m),
    }


def test_leading_terms_and_rests_are_enclosed(tails):
    rows = json.loads(tails.written("json"))["rows"]
    with mpmath.workdps(45):
        for row in rows:
            for name, value in leading(row["m"]).items():
                low, high = (
                    mpmath.mpf(row["asymptotics"][name]["leading"][end]) for end in ("lower", "upper")
                )
                assert low <= value <= high
                assert high - low < mpmath.mpf(10) ** -21
                least, most = (
                    mpmath.mpf(row["asymptotics"][name]["rest"][end]) for end in ("lower", "upper")
                )
                assert least <= mpmath.mpf(row[name]["upper"]) - value
                assert mpmath.mpf(row[name]["lower"]) - value <= most


def test_the_rests_shrink_as_fast_as_is_said():
    """Ten times m: that of ρ a hundredth, those of γ and L a hundredth but for the logarithms."""
    one, ten = build_table((1000, 10_000), 30, with_asymptotes=True).asymptotes
    for name, most in (("gamma_rest", 60), ("rho_rest", 99), ("L_rest", 60)):
        ratio = float(getattr(one, name).mid / getattr(ten, name).mid)
        assert most < ratio < 101


def test_a_leading_term_of_another_rate_would_be_noticed(tails):
    """Without 9/(16m) the rest of ρ at m = 1000 would be 750 times as large."""
    rest = tails.asymptotes[-1].rho_rest
    assert abs(float(rest.mid)) < 1e-6 < 9 / 16_000 - 1e-6


def test_the_slope_at_0_is_that_of_the_symbolic_derivative():
    import sympy as sp

    x = sp.Symbol("x")
    for m in (1, 2, 3):
        assert symbolic_slope(sp, m, x) == slope_at_zero(m)
    rows = json.loads(run("--m", "1:4", "--format", "json").stdout)["rows"]
    assert [row["slope_at_0"] for row in rows] == ["1", "0", "0", "0"]


def symbolic_slope(sp, m, x):
    s = sp.sinh(x)
    return sp.diff(s ** (2 * m - 1) * sp.cosh(x) / (1 + s ** (2 * m)), x).subs(x, 0)


@pytest.mark.parametrize("name", Format)
def test_every_format_shows_the_leading_terms(name, tails):
    plain, full = build_table(MEMBERS, 25).written(name), tails.written(name)
    assert len(full) > 1.3 * len(plain)
    assert "39.5140625" in full
    assert "39.5140625" not in plain


def test_csv_has_both_ends_of_every_rest(tails):
    rows = list(csv.DictReader(io.StringIO(tails.written("csv"))))
    for row in rows:
        assert Fraction(row["gamma_rest_lower"]) <= Fraction(row["gamma_rest_upper"])
        assert Fraction(row["rho_rest_upper"]) < 0 < Fraction(row["L_rest_lower"])


def test_printing_a_table_prints_what_the_command_prints():
    assert f"{build_table((1, 2), 12)}\n" == run("--m", "1,2", "--digits", "12").stdout


def test_the_plot_shows_every_member(tmp_path):
    run("--m", "2:9", "--digits", "8", "--plot", str(tmp_path))
    text = (tmp_path / "constants.svg").read_text(encoding="utf-8")
    assert (
        len(re.findall(r'<use xlink:href="#m\w+" x="[\d.]+" y="[\d.]+" style="fill: #0072b2', text)) >= 3 * 8
    )


def test_a_folder_that_cannot_be_is_refused(tmp_path):
    (tmp_path / "file").write_text("", encoding="utf-8")
    with pytest.raises(InputError, match="--plot"):
        raise run("--plot", str(tmp_path / "file")).exception


def test_certificates_bound_gamma_and_rho_as_they_are_shown(tmp_path):
    found = run("--m", "1:2", "--digits", "12", "--certificates", str(tmp_path), "--format", "json")
    assert found.exit_code == 0
    assert {path.name for path in tmp_path.iterdir()} == {
        f"m{m}.{name}.json" for m in (1, 2) for name in ("gamma", "rho")
    }
    upper = json.loads(found.stdout)["rows"][1]["gamma"]["upper"]
    statement = json.loads((tmp_path / "m2.gamma.json").read_text(encoding="utf-8"))["statement"]
    assert statement["bound"] == ["num", str(Fraction(upper))]
    assert "4 accepted (4 proved" in invoke("recheck", str(tmp_path)).stdout
