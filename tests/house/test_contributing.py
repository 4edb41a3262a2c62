"""The first claim of CONTRIBUTING.md: the page's own script does what the page says of it."""

import re
import textwrap
from pathlib import Path

import pytest

from tests.helpers.command import lyapcheck

PAGE = (Path(__file__).parents[2] / "CONTRIBUTING.md").read_text(encoding="utf-8")

pytestmark = pytest.mark.usefixtures("in_this_process")


def script():
    """The one script of the page."""
    (result,) = re.findall(r"^ *```python\n(.*?)^ *```$", PAGE, re.MULTILINE | re.DOTALL)
    return textwrap.dedent(result)


def test_the_script_is_decided_and_its_certificate_accepted(tmp_path):
    (tmp_path / "mine.py").write_text(script(), encoding="utf-8")
    checked = lyapcheck(*["check", "mine.py", "--certificates", "made/"], folder=tmp_path)
    assert (checked.returncode, "✓ 1 proved" in checked.stdout) == (0, True), checked.stdout
    rechecked = lyapcheck("recheck", "made/", folder=tmp_path)
    assert (rechecked.returncode, "1 accepted (1 proved" in rechecked.stdout) == (0, True), rechecked.stdout
    for command in (checked, rechecked):
        assert f"`{' '.join(command.args)}`" in PAGE


def test_broken_on_purpose_it_is_refuted_with_an_x(tmp_path):
    assert re.search(r'`"1\.05"`.* for `"1\.06"`', PAGE)
    (tmp_path / "mine.py").write_text(script().replace("1.06", "1.05"), encoding="utf-8")
    checked = lyapcheck("check", "mine.py", "--failed", folder=tmp_path)
    assert checked.returncode == 1
    assert re.search(r"witness: at x = ", checked.stdout), checked.stdout
