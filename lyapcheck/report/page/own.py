"""The first screen about an arm of one's own: the arm in motion, six tiles a gain set, and what to do."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from lyapcheck.output.mathml import Markup, element, sentence
from lyapcheck.report.model import SIGNS, Motion, Report, Tile

WIDTH, MARGIN = 320.0, 14.0
"""Of the picture of the arm, in its own units."""


def first_screen(report: Report) -> list[Markup]:
    """One row of tiles for each gain set, the arm beside the first, then all that is to be done."""
    result = []
    for name, known in report.tiles.items():
        motion = report.motions.get(name)
        grid = element("ul", [_tile(one) for one in known], class_="tiles")
        parts = [element("h2", name, class_="set"), grid] if len(report.tiles) > 1 else [grid]
        drawn = element("figure", _arm(motion), _caption(motion), class_="arm") if motion else None
        result.append(
            element("div", drawn, element("div", parts), class_="glance" if drawn else "glance alone")
        )
    steps = [element("li", step) for step in _steps(report)]
    todo = element("ol", steps) if steps else element("p", "Nothing needs attention.")
    return [*result, element("h2", "To do"), todo]


def _tile(tile: Tile) -> Markup:
    head = element("b", tile.subject)
    number = element("strong", f"{SIGNS[tile.tone]} {tile.number}")
    before = element("small", f"before: {tile.before}") if tile.before else None
    text = element("span", sentence(tile.text))
    drawn = _arm(tile.posture, "The arm where motions grow.") if tile.posture else None
    return element("li", head, number, before, text, drawn, class_=f"tile {tile.tone}")


def _steps(report: Report) -> Iterator[list[Markup | str]]:
    """Each thing to do once, what is wrong first."""
    order = ("bad", "warn", "open")
    every = [tile for known in report.tiles.values() for tile in known if tile.todo[0] and tile.tone in order]
    seen: set[tuple[str, str]] = set()
    for tile in sorted(every, key=lambda one: order.index(one.tone)):
        if tile.todo not in seen:
            seen.add(tile.todo)
            words, command = tile.todo
            yield [f"{tile.subject}: {words} ", *([element("code", command)] if command else [])]


def _caption(motion: Motion) -> Markup:
    return element("figcaption", f"The arm from its start to its goal, {motion.seconds:g} s, simulated.")


def _arm(motion: Motion, words: str = "The arm moves from its start to its goal.") -> Markup:
    """The arm at each time, one after the other; start and goal stay, and are all that moves no more."""
    points = [point for frame in motion.frames for point in frame]
    left, right = min(x for x, _ in points), max(x for x, _ in points)
    low, high = min(y for _, y in points), max(y for _, y in points)
    scale = (WIDTH - 2 * MARGIN) / (max(right - left, high - low) or 1.0)
    height = (high - low) * scale + 2 * MARGIN
    width = (right - left) * scale + 2 * MARGIN

    def line(frame: Sequence[tuple[float, float]], **more: str) -> Markup:
        spots = [(MARGIN + (x - left) * scale, MARGIN + (high - y) * scale) for x, y in frame]
        path = " ".join(f"{x:.1f},{y:.1f}" for x, y in spots)
        joints = [element("circle", cx=f"{x:.1f}", cy=f"{y:.1f}", r="3.5") for x, y in spots[1:-1]]
        return element("g", element("polyline", points=path), joints, **more)

    count = len(motion.frames)
    frames = (
        []
        if count == 1
        else [
            line(frame, class_="frame", style=f"animation-delay:{motion.seconds * k / count:.2f}s")
            for k, frame in enumerate(motion.frames)
        ]
    )
    x, y = motion.frames[0][0]
    base = element(
        "rect",
        x=f"{MARGIN + (x - left) * scale - 8:.1f}",
        y=f"{MARGIN + (high - y) * scale - 3:.1f}",
        width="16",
        height="6",
    )
    return element(
        "svg",
        line(motion.frames[0], class_="start"),
        line(motion.frames[-1], class_="goal" if frames else "still"),
        frames,
        base,
        viewBox=f"0 0 {width:.1f} {height:.1f}",
        role="img",
        aria_label=words,
        style=f"--run:{motion.seconds:g}s;--share:{100 / count:.2f}%",
    )
