"""The Jinja environment of the documents."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from importlib import resources
from itertools import groupby
from typing import Any

from lyapcheck.report import text, words
from lyapcheck.report.drawings import file_stem


def environment(escape: Callable[[str], str]) -> Any:
    """An environment with the templates, strict about names, and the words of ``lyapcheck.report.text``.

    Whatever a template fills in is escaped unless it is markup already.
    """
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    folder = str(resources.files("lyapcheck.report") / "templates")
    env = Environment(
        loader=FileSystemLoader(folder),
        autoescape=True,
        finalize=partial(_escaped, escape),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    env.globals.update(SYMBOLS=text.SYMBOLS, plural=text.plural, tally=text.tally)
    env.filters.update(number=text.number, fixed=text.fixed, bracket=text.bracket, joined=text.joined)
    env.filters.update(listed=text.listed, together=text.together, sections=sections, stem=file_stem)
    env.filters.update(
        quantity=words.quantity_words,
        printed=words.printed_words,
        value=words.value_words,
        answer=words.answer_cell,
        tally_words=words.tally_words,
        leading=words.leading,
        span=words.span,
        together_words=words.together_words,
        at_once=words.at_once_words,
        figure_gains=words.figure_gains_words,
        arm=words.arm_words,
        form=form,
        capitalised=capitalised,
    )
    return env


def form(name: str, suffix: str) -> str:
    """The same figure in another form: ``a.svg`` as ``a.png``."""
    return f"{name.rsplit('.', 1)[0]}.{suffix}"


def capitalised(sentence: str) -> str:
    """A sentence with a large first letter, and nothing else changed."""
    return sentence[:1].upper() + sentence[1:]


def sections(claims: Any) -> list[tuple[str, list[Any]]]:
    """Claims grouped by the paper's sections, in the order of the text."""
    return [(name, list(rows)) for name, rows in groupby(claims, key=lambda row: row["section"] or "Claims")]


def _escaped(escape: Callable[[str], str], value: Any) -> Any:
    """A value as markup, on one line; spaces at which no line ends stay what they are."""
    from markupsafe import Markup

    if hasattr(value, "__html__"):
        return value
    line = str(value).replace("\n", " ")
    return Markup(words.NARROW.join(map(escape, line.split(words.NARROW))))
