"""The page of a sweep: its answer with the maps drawn, in the style of the report."""

from __future__ import annotations

from lyapcheck.answers.sweep.result import SweepAnswer, stem
from lyapcheck.output.document import Figure
from lyapcheck.output.elements import Markup, element
from lyapcheck.output.html import blocks, page


def files(answer: SweepAnswer) -> dict[str, str | bytes]:
    """``index.html`` and ``sweep.json``, and each map as SVG, PNG and CSV, by their names in the folder."""
    from lyapcheck.report.figures.heat import heat_plot

    drawings: dict[str, str | bytes] = {}
    for number, one in enumerate(answer.maps, start=1):
        plot = heat_plot(one.rows, one.columns, one.cells, one.measure.title, one.measure.text)
        drawings |= {f"figures/{name}": drawing for name, drawing in plot.files(stem(number, one)).items()}
    return {**drawings, "index.html": _page(answer, drawings), "sweep.json": answer.written("json")}


def _page(answer: SweepAnswer, drawings: dict[str, str | bytes]) -> str:
    from lyapcheck.report.page.drawing import drawn
    from lyapcheck.report.page.shell import raw

    def shown(figure: Figure) -> Markup | None:
        name = figure.path.removeprefix("figures/").removesuffix(".svg")
        return drawn(name, str(drawings[figure.path]), figure.caption)

    document = answer.document()
    section = element("section", element("h1", document.title), blocks(document.body, 2, shown))
    return page(document.title, element("main", section), raw("style.css"))
