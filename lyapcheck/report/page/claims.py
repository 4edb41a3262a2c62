"""Every claim: the graph of what rests on what, and tables with its equation, certificate and trust."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from itertools import groupby

from lyapcheck.output.html import fold
from lyapcheck.output.mathml import Markup, element, latex, sentence
from lyapcheck.report.claim_row import ClaimRow
from lyapcheck.report.model import Report, anchor, behind
from lyapcheck.report.text import SYMBOLS, plural
from lyapcheck.verdicts import Verdict

# --- The claims and what they rest on, as a picture whose boxes are links.


WIDE, HIGH = 138, 34
ACROSS, DOWN = 184, 42
MARGIN = 8
LETTERS = 22
"""The longest title that fits a box."""
Place = tuple[float, float]


def graph(rows: Sequence[ClaimRow], words: str, titles: Mapping[str, str]) -> Markup:
    """Each claim that uses another or is used, right of all it uses; a thick line is a link that breaks.

    Args:
        rows: the claims of one proof for one m.
        words: what it shows, for who cannot see it.
        titles: of claims, in at most ``LETTERS`` letters.
    """
    chosen = tied(rows)
    places = layout(chosen)
    at = {name: (MARGIN + x * ACROSS, MARGIN + (y + 0.5) * DOWN) for name, (x, y) in places.items()}
    width = max((x for x, _ in at.values()), default=0.0) + WIDE + MARGIN
    height = max((y for _, y in at.values()), default=0.0) + HIGH + MARGIN
    lines = [_line_graph(at[used], at[row.id], used, row) for row in chosen for used in row.uses]
    boxes = [_box(at[row.id], row, titles.get(row.id, "")) for row in chosen]
    view = f"0 0 {width:g} {height:g}"
    return element(
        "svg",
        lines,
        boxes,
        viewBox=view,
        class_="claim-graph",
        role="group",
        aria_label=words,
        style=f"min-width:{width:g}px",
    )


def _line_graph(start: Place, end: Place, used: str, row: ClaimRow) -> Markup:
    (x0, y0), (x1, y1) = (start[0] + WIDE, start[1]), end
    bend = (x1 - x0) / 2
    path = f"M{x0:g} {y0:g}C{x0 + bend:g} {y0:g} {x1 - bend:g} {y1:g} {x1:g} {y1:g}"
    broken = " broken" if used in row.broken else ""
    return element("path", d=path, class_=f"edge{broken}", data_from=used, data_to=row.id)


def _box(place: Place, row: ClaimRow, short: str) -> Markup:
    x, y = place
    rests = f"Rests on {', '.join(row.uses)}." if row.uses else "Rests on no other claim."
    title = element("title", f"{row.id}, {row.decision.word} [{row.grade}]: {row.comment} {rests}")
    shape = element("rect", x=f"{x:g}", y=f"{y - HIGH / 2:g}", width=WIDE, height=HIGH, rx=4)
    middle = f"{x + WIDE / 2:g}"
    words = [
        element("text", f"{SYMBOLS[row.verdict]} {row.id}", x=middle, y=f"{y - (3 if short else -4):g}"),
        element("text", short, x=middle, y=f"{y + 11:g}", class_="short") if short else None,
    ]
    return element(
        "a",
        title,
        shape,
        words,
        href=f"#{row.id}",
        class_=f"box {row.verdict} {row.grade}",
        data_claim=row.id,
    )


def tied(rows: Sequence[ClaimRow]) -> list[ClaimRow]:
    """The claims that use another one of the list, or are used by one."""
    known = {row.id for row in rows}
    used = {name for row in rows for name in row.uses if name in known}
    result = [row for row in rows if row.id in used or set(row.uses) & known]
    return [replace(row, uses=tuple(name for name in row.uses if name in known)) for row in result]


def layout(rows: Sequence[ClaimRow]) -> dict[str, Place]:
    """Columns by the longest way to a claim that uses nothing, rows near the claims that are used."""
    uses = {row.id: row.uses for row in rows}
    columns: dict[int, list[str]] = {}
    for name in uses:
        columns.setdefault(depth(name, uses), []).append(name)
    tallest = max(map(len, columns.values()), default=0)
    places: dict[str, Place] = {}
    for column in sorted(columns):
        names = sorted(columns[column], key=lambda name: _height(name, uses, places))
        step = tallest / len(names)
        places |= {name: (float(column), (k + 0.5) * step - 0.5) for k, name in enumerate(names)}
    return places


def depth(name: str, uses: Mapping[str, Sequence[str]]) -> int:
    """The length of the longest chain of uses below a claim."""
    return 1 + max((depth(used, uses) for used in uses[name]), default=-1)


def _height(name: str, uses: Mapping[str, Sequence[str]], places: Mapping[str, Place]) -> float:
    """The middle of the claims that it uses; those that use nothing keep their order."""
    heights = [places[used][1] for used in uses[name]]
    return sum(heights) / len(heights) if heights else 0.0


GRADES = {
    "kernel": "a theorem of Coq's kernel",
    "exact": "rational numbers and symbolic normal forms",
    "enclosure": "balls that enclose the exact numbers",
    "numeric": "floating point, which decides nothing",
}


WHOSE = {
    "quoted": "The paper's own.",
    "implied": "Implied: the paper's argument or its tables rely on it.",
    "ours": "Ours: a further question or a repair. It can be no error of the paper.",
}


def claims_section(report: Report) -> Markup:
    """The claims of the paper and of the proofs that go round it, each with all its members."""
    rows = report.every_claim
    used_by: dict[str, list[str]] = {}
    groups: dict[str, list[ClaimRow]] = {}
    for row in rows:
        groups.setdefault(row.heading, []).append(row)
    for row in {(r.proof, r.id): r for r in rows}.values():
        for name in row.uses:
            used_by.setdefault(anchor(row.proof, name), []).append(anchor(row.proof, row.id))
    return element(
        "section",
        element("h2", "Claims"),
        _switch(report) if len(report.ms) > 1 or not report.own else None,
        _filters(rows),
        None if report.own else _graph(report),
        [_group(report, title, group, used_by) for title, group in groups.items()],
        _equations(report),
        id="claims",
    )


def _switch(report: Report) -> Markup:
    """One member or all, without any script."""
    choices = [("all", "all m"), *((str(m), f"m = {m}") for m in report.ms)]
    buttons = [
        element(
            "label",
            element("input", type="radio", name="m", id=f"m{value}", value=value, checked=value == "all"),
            words,
        )
        for value, words in choices
    ]
    return element("fieldset", element("legend", "Members"), buttons, class_="switch")


def _filters(rows: Iterable[ClaimRow]) -> Markup:
    result = list(rows)
    return element(
        "form",
        element("label", "Find", element("input", type="search", id="find", placeholder="id or words")),
        _select("verdict", [row.verdict for row in result]),
        _select("grade", [row.grade for row in result]),
        element("output", id="shown"),
        class_="filters script-only",
        onsubmit="return false",
    )


def _select(name: str, values: Iterable[str]) -> Markup:
    known = dict.fromkeys(sorted(values))
    options = [element("option", f"any {name}", value=""), *(element("option", v, value=v) for v in known)]
    return element("label", name.capitalize(), element("select", options, id=f"by-{name}"))


def _graph(report: Report) -> Markup:
    m = report.ms[0]
    chosen = [row for row in report.claims if row.m in (m, None)]
    words = (
        f"What rests on what in the paper, for m = {m}: each claim stands right of those it uses; "
        "click one to read it. Point at a refuted one to see what falls with it."
    )
    folded = element(
        "div",
        graph(chosen, words, report.notes.titles),
        class_="scroll",
        tabindex="0",
        role="region",
        aria_label="Graph",
    )
    return fold(
        "The graph of claims", folded, element("p", words), _falls(chosen), classes="fold graph", opened=True
    )


def _falls(rows: Sequence[ClaimRow]) -> Markup | None:
    """The refuted claims that others rest on, each with all that falls with it, directly or not."""
    lines = []
    for row in rows:
        fallen = [one for one in rows if one.id != row.id and row.id in behind(one.id, rows)]
        if row.verdict == "refuted" and fallen:
            links = _joined([_link(one.proof, one.id) for one in fallen])
            head = element("th", _link(row.proof, row.id), scope="row")
            lines.append(element("tr", head, element("td", links)))
    if not lines:
        return None
    heads = [
        element("th", words, scope="col") for words in ("refuted", "what falls with it, as it is printed")
    ]
    return element("table", element("thead", element("tr", heads)), element("tbody", lines))


def _group(report: Report, title: str, rows: Sequence[ClaimRow], used_by: dict[str, list[str]]) -> Markup:
    claims = [(key, list(group)) for key, group in groupby(rows, key=lambda row: (row.proof, row.id))]
    verdicts = [row.verdict for row in rows]
    counts = ", ".join(
        element("span", f"{verdicts.count(word)} {word}", class_=word) for word in Verdict if word in verdicts
    )
    heads = [
        element("th", element("button", words, type="button", class_="sort"), scope="col")
        for words in ("claim", "statement", "verdict", "grade")
    ]
    each = "; for each m: " if len(report.ms) > 1 else ": "
    table = element(
        "table",
        element("thead", element("tr", heads)),
        element("tbody", [_claim(report, group, used_by) for _, group in claims]),
        class_="claims cards-on-phone",
    )
    tally = element("span", plural(len(claims), "claim"), each, Markup(counts), class_="tally")
    return fold(title, table, beside=tally, classes="fold group")


def _claim(report: Report, rows: Sequence[ClaimRow], used_by: dict[str, list[str]]) -> Markup:
    first = rows[0]
    own = anchor(first.proof, first.id)
    name = element("a", first.id, href=f"#{own}")
    chips = [_chip(row) for row in rows]
    grades = sorted({row.grade for row in rows})
    more = element(
        "details",
        element("summary", sentence(first.comment)),
        _details(report, rows, used_by),
        class_="more",
    )
    return element(
        "tr",
        element("th", name, scope="row", class_="id"),
        element("td", more, class_="statement"),
        element("td", element("span", chips, class_="chips")),
        element("td", ", ".join(grades), class_="grade"),
        id=own,
        data_verdict=" ".join(sorted({row.verdict for row in rows})),
        data_grade=" ".join(grades),
    )


def _chip(row: ClaimRow) -> Markup:
    word, verdict = row.decision.word, row.verdict
    letters = (f"{name}={value}" for name, value in (("m", row.m), ("n", row.n)) if value is not None)
    member = " ".join([*filter(None, [row.gains]), *letters, ""])
    shown = [element("span", member, class_="m"), f"{SYMBOLS[verdict]} {word}"]
    return element("span", shown, class_=f"chip {verdict}", data_m=row.m)


def _details(report: Report, rows: Sequence[ClaimRow], used_by: dict[str, list[str]]) -> list[Markup | None]:
    first = rows[0]
    own = anchor(first.proof, first.id)
    rests = [_link(first.proof, name) for name in first.uses]
    carries = [element("a", name, href=f"#{name}") for name in used_by.get(own, ())]
    lines = [
        _line("In the paper", _place(report, first)) if first.place else None,
        _line("Whose sentence", WHOSE[first.stands]) if first.proof == "published" else None,
        _line("Rests on", _joined(rests)) if rests else None,
        _line("Carries", _joined(carries)) if carries else None,
    ]
    return [element("dl", lines, class_="about"), *map(_member, rows)]


def _member(row: ClaimRow) -> Markup:
    """What was decided for one m, on what evidence."""
    head = f"{row.about}: " if row.about else ""
    lines = [
        element("p", element("b", head, row.decision.word), f" [{row.grade}: {GRADES.get(row.grade, '')}]"),
        element("p", row.statement, class_="decided"),
        [element("p", text) for text in row.details[1:]],
    ]
    if row.certificate and row.digest:
        link = element("a", "certificate", href=row.certificate)
        trust = [" Trusts the rules: ", ", ".join(row.decision.rules), "."] if row.decision.rules else None
        lines.append(element("p", link, " ", element("code", row.digest[:12]), ".", trust, class_="trust"))
        lines += [element("p", "Takes for granted: ", text) for text in row.decision.granted]
    return element("div", lines, class_=f"member {row.verdict}", data_m=row.m)


def _line(term: str, what: object) -> list[Markup]:
    return [element("dt", term), element("dd", what)]  # type: ignore[arg-type]


def _joined(links: Sequence[Markup]) -> list[Markup | str]:
    return [part for link in links for part in (", ", link)][1:]


def _link(proof: str, claim: str) -> Markup:
    return element("a", claim, href=f"#{anchor(proof, claim)}")


def _place(report: Report, row: ClaimRow) -> list[Markup | str]:
    """Where the paper says it, the numbers of formulas as links to them."""
    parts: list[Markup | str] = []
    for k, part in enumerate(re.split(r"\((\d+)\)", row.place)):
        if k % 2 == 0:
            parts.append(part)
        elif part in report.notes.equations:
            parts.append(element("a", f"({part})", href=f"#equation-{part}"))
        else:
            parts.append(f"({part})")
    return parts


def _equations(report: Report) -> Markup:
    rows = [
        element("li", element("b", f"({number})"), latex(text), id=f"equation-{number}")
        for number, text in report.notes.equations.items()
    ]
    return fold("The paper's formulas", element("ul", rows, class_="equations"))
