"""Elements of HTML, SVG and MathML: markup is made here alone, and text inside it is escaped."""

from __future__ import annotations

from collections.abc import Iterable

from lyapcheck.output.escapes import html_text

VOID = frozenset({"br", "hr", "img", "input", "link", "meta"})


class Markup(str):
    """Text that is markup already, and is not escaped again."""

    __slots__ = ()


Child = str | None | Iterable["Child"]


def element(name: str, /, *children: Child, **attributes: str | int | float | bool | None) -> Markup:
    """An element, its text and attributes escaped.

    Args:
        name: of the element.
        children: text, markup, or any nesting of both; ``None`` is nothing.
        attributes: ``class_`` is class, ``data_m`` is data-m; ``True`` stands without a value, ``None`` and
            ``False`` not at all.
    """
    head = "".join(_attribute(key, value) for key, value in attributes.items())
    if name in VOID:
        return Markup(f"<{name}{head}>")
    return Markup(f"<{name}{head}>{joined(children)}</{name}>")


def joined(children: Child) -> Markup:
    """All children one after the other."""
    if children is None:
        return Markup()
    if isinstance(children, Markup):
        return children
    if isinstance(children, str):
        return Markup(html_text(children))
    return Markup("".join(map(joined, children)))


def _attribute(key: str, value: str | int | float | bool | None) -> str:
    if value is None or value is False:
        return ""
    name = key.rstrip("_").replace("_", "-")
    return f" {name}" if value is True else f' {name}="{html_text(str(value))}"'
