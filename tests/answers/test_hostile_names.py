"""Names and notes of files that would steer a terminal, a page, a spreadsheet or a CI system."""

import csv
import io
import json
import re
import sys
import tomllib
from xml.etree import ElementTree as ET

import pytest
from markdown_it import MarkdownIt

from lyapcheck.cli.main import main
from lyapcheck.output import escapes
from lyapcheck.output.answer import FORMATS, JUDGED_FORMATS, Answer
from lyapcheck.output.escapes import document_text, printable
from tests.helpers.shares import but, one_in

pytestmark = pytest.mark.usefixtures("in_this_process")

NASTY = [
    "<script>alert(1)</script>",
    "<img src=x onerror='alert(1)'>&amp;\"",
    "a|b\\|c\\",
    "`code` *bold* _it_ ~~no~~ [x](javascript:y) ![z](w)",
    "=cmd|' /C calc'!A0",
    "+1+1",
    "-1+1",
    "@SUM(1)",
    "$\\frac$ 100% #1 {x} ^ ~ _ &",
    "::error file=x,line=1::owned",
    "]]> --> %0A %1B",
]
UNPRINTABLE = [
    "\x1b[2J",
    "\x07",
    "a\nb",
    "a\r\nb",
    "\u202egnp",
    "a\u2028b",
    "\x9b31m",
    "\x7f",
    "\u200b",
    "\ufeff",
]

URDF = """<?xml version="1.0"?>
<robot name={robot}>
  <link name="base"/>
  <link name={link}>
    <inertial><origin xyz="0 0 -0.2"/><mass value="2"/>
    <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial>
  </link>
  <joint name={joint} type="revolute">
    <parent link="base"/><child link={link}/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="20" velocity="2"/><dynamics damping="0.5" friction="0.1"/>
  </joint>
</robot>
"""
ARM = """title = {title}
urdf = "arm.urdf"
remarks = [{remark}]
[[joints]]
name = {joint}
viscous = {{ value = 0.5, assumed = true, source = {source}, note = {note} }}
"""
GAINS = "[[gains]]\nname = {name}\nm = 1\nkp = [3]\nkv = [0.2]\n"
REFERENCE = 'kind = "sine"\namplitude = [9]\nfrequency = [1]\n'


def toml(text):
    """A TOML string with everything but plain ASCII as an escape."""
    return '"' + "".join(c if c.isalnum() and c.isascii() else f"\\U{ord(c):08x}" for c in text) + '"'


def xml(text):
    """An XML attribute; what XML can write as a reference only is written so."""
    return '"' + "".join(c if c.isalnum() and c.isascii() else f"&#{ord(c)};" for c in text) + '"'


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """An arm, gains and a reference with every nasty name in every place that can hold one."""
    place = tmp_path_factory.mktemp("nasty")
    joint = "j|<script>_$&%#^~[x]`*"
    (place / "arm.urdf").write_text(URDF.format(robot=xml(NASTY[0]), link=xml(NASTY[2]), joint=xml(joint)))
    words = {"title": NASTY[0], "source": NASTY[1], "note": NASTY[3], "joint": joint}
    remarks = ", ".join(map(toml, NASTY))
    (place / "arm.toml").write_text(ARM.format(remark=remarks, **{k: toml(v) for k, v in words.items()}))
    sets = "\n".join(GAINS.format(name=toml(name)) for name in NASTY)
    (place / "gains.toml").write_text('robot = "arm.toml"\n' + sets)
    (place / "one.toml").write_text('robot = "arm.toml"\n' + GAINS.format(name=toml(" ".join(NASTY))))
    (place / "reference.toml").write_text(REFERENCE)
    return place


def run(words, folder, monkeypatch, capsys):
    """Exit code and both outputs of a command line in a folder."""
    monkeypatch.chdir(folder)
    monkeypatch.setenv("COLUMNS", "400")
    monkeypatch.setenv("NO_COLOR", "1")
    monkeypatch.setattr(sys, "argv", ["lyapcheck", *(words.split() if isinstance(words, str) else words)])
    capsys.readouterr()
    with pytest.raises(SystemExit) as left:
        main()
    seen = capsys.readouterr()
    return left.value.code, seen.out, seen.err


def check_markdown(text):
    """No tag of a name, no link, and as many cells in each row of a table as in its head."""
    assert "<script" not in text.lower()
    assert "<img" not in text.lower()
    tokens = MarkdownIt("commonmark", {"html": True}).enable("table").parse(text)
    inner = [child for token in tokens for child in token.children or [token]]
    assert not {token.type for token in inner} & {"html_block", "html_inline", "link_open", "image"}
    widths = []
    for line in [*text.splitlines(), ""]:
        if line.startswith("|"):
            widths.append(len(re.findall(r"(?<!\\)(?:\\\\)*\|", line)))
        else:
            assert len(set(widths)) <= 1, line
            widths = []


def check_csv(text):
    rows = list(csv.reader(io.StringIO(text), strict=True))
    assert len({len(row) for row in rows}) == 1
    for cell in (cell for row in rows for cell in row):
        assert not cell.startswith(("=", "+", "-", "@")) or re.fullmatch(r"-[\d.e+-]+|-inf", cell), cell


def check_latex(text):
    """No command and no special character but those of documents."""
    for line in text.splitlines():
        bare = re.sub(r"\\ensuremath\{([^{}]|\{[^{}]*\})*\}|\\text\w+\{\}|\\[&%$#_{}]", "", line)
        bare = re.sub(r"^\\(?:(?:sub)*section|paragraph)\*\{(.*)\}$", r"\1", bare)
        columns = r"\{([lr]|p\{[\d.]+\\textwidth\})+\}"
        bare = re.sub(
            rf"^\\(begin|end)\{{\w+\}}({columns}|\\ttfamily)?$|^\\hline$|^  \\item \{{\}}", "", bare
        )
        bare = re.sub(r" & |\\\\$", "", bare)
        assert not set(bare) & set("\\&%$#_{}~^"), line


def check_html(text):
    """No tag but those of documents."""
    assert not set(re.findall(r"<\s*/?\s*([^\s/>]+)", text)) - TAGS


def check_github(text):
    for line in text.splitlines():
        assert re.fullmatch(r"::(error|warning|notice) [^:]*::.*", line)


TAGS = {"h2", "h3", "h4", "p", "ul", "li", "pre", "code"}
TAGS |= {"table", "caption", "thead", "tbody", "tr", "th", "td"}
CHECKS = {
    "json": json.loads,
    "sarif": json.loads,
    "junit": ET.fromstring,
    "markdown": check_markdown,
    "csv": check_csv,
    "html": check_html,
    "latex": check_latex,
    "text": lambda text: None,
    "github": check_github,
}
SHORT = "--target 10 --time 0.1"
COMMANDS = {
    "gate gains.toml": JUDGED_FORMATS,
    "check scalar.py --m 1 --robot arm.toml --gains one.toml --only h.odd": JUDGED_FORMATS,
    f"simulate gains.toml {SHORT}": JUDGED_FORMATS,
    f"simulate gains.toml {SHORT} --runs 2": JUDGED_FORMATS,
    "simulate gains.toml --reference reference.toml": JUDGED_FORMATS,
    "epsilon one.toml --max-boxes 20 --starts 1": JUDGED_FORMATS,
    f"bounds one.toml {SHORT} --friction 0.01": JUDGED_FORMATS,
    "robot arm.toml --max-boxes 20": JUDGED_FORMATS,
    "robot arm.urdf --max-boxes 20": JUDGED_FORMATS,
    "tune arm.toml": FORMATS,
}


@pytest.mark.parametrize("words", but(list(COMMANDS)[:2], COMMANDS))
def test_no_format_obeys_a_name(words, folder, monkeypatch, capsys):
    """Asked once; what is shown in one format is then written in the others."""
    answers = []
    written = Answer.written

    def kept(answer, *form):
        answers.append(answer)
        return written(answer, *form)

    monkeypatch.setattr(Answer, "written", kept)
    code, out, err = run(words, folder, monkeypatch, capsys)
    assert code in (0, 1, 3), err
    assert (out + err).replace("\n", "").isprintable()
    for form in COMMANDS[words]:
        text = written(answers[-1], form)
        assert text.replace("\n", "").isprintable()
        CHECKS[form](text)


@pytest.mark.slow
@pytest.mark.parametrize(
    "words",
    [
        f"simulate gains.toml {SHORT} --csv -",
        f"simulate gains.toml {SHORT} --runs 2 --csv -",
        "simulate gains.toml --reference reference.toml --csv -",
        "tune arm.toml --format toml",
    ],
)
def test_no_file_for_programs_obeys_a_name(words, folder, monkeypatch, capsys):
    code, out, err = run(words, folder, monkeypatch, capsys)
    assert code in (0, 1), err
    assert (out + err).replace("\n", "").isprintable()
    if "--csv" in words:
        check_csv(out)
    else:
        tomllib.loads(out)


@pytest.mark.slow
def test_no_page_of_a_report_obeys_a_name(folder, monkeypatch, capsys):
    code, out, err = run(
        "report --m 1 --robot arm.toml --gains one.toml --out pages", folder, monkeypatch, capsys
    )
    assert code == 0, err
    assert (out + err).replace("\n", "").isprintable()
    files = [path for path in (folder / "pages").rglob("*.*") if path.suffix != ".png"]
    pages = {path.name: path.read_text() for path in files}
    for name, text in pages.items():
        assert text.replace("\n", "").replace("\u00a0", "").isprintable(), name
        if name.endswith((".html", ".md")):
            assert text.count("<script") == (1 if name == "index.html" else 0)
            assert "<img src=x" not in text
        if name.endswith(".svg"):
            ET.fromstring(text)
        if name.endswith(".csv"):
            check_csv(text)
    json.loads(pages["report.json"])
    assert "&lt;script&gt;" in pages["index.html"]


@pytest.mark.slow
def test_figures_show_a_name_with_dollars(folder, monkeypatch, capsys):
    (folder / "plots").mkdir()
    (folder / "dollars.toml").write_text('robot = "arm.toml"\n' + GAINS.format(name=toml("$\\frac$")))
    code, _, err = run(f"simulate dollars.toml {SHORT} --plot plots", folder, monkeypatch, capsys)
    assert code == 0, err
    assert any("$\\frac$" in path.read_text() for path in (folder / "plots").glob("*.svg"))


PLACES = {
    "name": ("gains.toml", GAINS.replace("{name}", "{}")),
    "robot": ("gains.toml", "robot = {}\n" + GAINS.format(name='"a"')),
    "title": ("arm.toml", 'title = {}\nurdf = "arm.urdf"\n'),
    "remarks": ("arm.toml", 'title = "a"\nremarks = ["b", {}]\nurdf = "arm.urdf"\n'),
    "source": ("arm.toml", 'title = "a"\nsource = {}\nurdf = "arm.urdf"\n'),
    "note": (
        "arm.toml",
        'title = "a"\nurdf = "arm.urdf"\n[[joints]]\nname = "j"\n'
        "viscous = {{ value = 1, assumed = true, note = {} }}\n",
    ),
    "urdf": ("arm.toml", 'title = "a"\nurdf = {}\n'),
    "kind": ("reference.toml", "kind = {}\n"),
}
READERS = {
    "gains.toml": "simulate gains.toml --robot pendulum1 --target 10",
    "arm.toml": "robot arm.toml",
    "reference.toml": "simulate good.toml --robot pendulum1 --reference reference.toml",
    "arm.urdf": "robot arm.urdf",
}


@pytest.mark.parametrize(
    ("key", "text"), [*(("name", text) for text in UNPRINTABLE), *((key, "\u202egnp") for key in PLACES)]
)
def test_what_does_not_print_is_refused_where_it_is_read(key, text, tmp_path, monkeypatch, capsys):
    name, content = PLACES[key]
    (tmp_path / "arm.urdf").write_text(URDF.format(robot='"r"', link='"l"', joint='"j"'))
    (tmp_path / "good.toml").write_text(GAINS.format(name='"a"'))
    (tmp_path / name).write_text(content.format(toml(text)))
    code, out, err = run(READERS[name], tmp_path, monkeypatch, capsys)
    assert (code, out) == (2, "")
    assert err.replace("\n", "").isprintable()
    assert re.search(rf"error: {name}:\d+: \S*{key}\S* = ", err)
    assert printable(text) in err
    assert "must be one line of text that prints" in err


@pytest.mark.parametrize(
    ("key", "text"),
    [
        *(("joint", text) for text in UNPRINTABLE if text[0] not in "\x1b\x07"),
        *((key, "\u202egnp") for key in ("robot", "link")),
    ],
)
def test_what_does_not_print_is_refused_in_urdf_files(key, text, tmp_path, monkeypatch, capsys):
    names = {"robot": '"r"', "link": '"l"', "joint": '"j"'} | {key: xml(text)}
    (tmp_path / "arm.urdf").write_text(URDF.format(**names))
    code, out, err = run(READERS["arm.urdf"], tmp_path, monkeypatch, capsys)
    assert (code, out) == (2, "")
    assert re.search(rf"error: arm.urdf:\d+: <{key}> name = ", err)
    assert printable(text) in err


@pytest.mark.parametrize("text", one_in(5, ["\x1b[2J", "a\nb\u202egnp", "\x9b31m\udcff"]))
@pytest.mark.parametrize(
    "words",
    one_in(
        6,
        [
            *(f"gate ? --format {form}" for form in ("text", "json", "markdown", "junit", "sarif", "github")),
            *(f"simulate ? {SHORT} --format {form}" for form in ("json", "sarif", "junit", "github")),
            "epsilon ? --max-boxes 20 --starts 1",
            *(f"robot ? --format {form}" for form in ("text", "sarif", "junit", "github")),
        ],
    ),
)
def test_paths_are_shown_as_escapes(words, text, tmp_path, monkeypatch, capsys):
    name = f"x{text}y.toml"
    (tmp_path / "arm.urdf").write_text(URDF.format(robot='"r"', link='"l"', joint='"j"'))
    arm = ARM.format(title='"a"', remark="", joint='"j"', source='"s"', note='"n"')
    (tmp_path / "arm.toml").write_text(arm)
    content = arm if words.startswith("robot") else 'robot = "arm.toml"\n' + GAINS.format(name='"a"')
    (tmp_path / name).write_text(content)
    line = [name if word == "?" else word for word in words.split()]
    code, out, err = run(line, tmp_path, monkeypatch, capsys)
    assert code in (0, 1, 3), err
    assert (out + err).replace("\n", "").isprintable()


@pytest.mark.parametrize("text", NASTY + UNPRINTABLE)
def test_every_escape_leaves_one_line_that_prints(text):
    for name in ("markdown_text", "html_text", "latex_text", "csv_text", "github_text", "plot_text"):
        assert getattr(escapes, name)(text).isprintable()
    assert json.loads(document_text(json.dumps(text, ensure_ascii=False))) == text
