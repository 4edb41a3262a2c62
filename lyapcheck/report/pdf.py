"""The report on paper: typeset by Typst, which needs no browser."""

from __future__ import annotations

from pathlib import Path

from lyapcheck.errors import argument_error
from lyapcheck.output.typst import markup
from lyapcheck.report.document import ReportAnswer
from lyapcheck.report.model import Report
from lyapcheck.temporary import temporary_folder


def require_typst() -> None:
    """Refuse before any work what could not be written at its end.

    Raises:
        InputError: the typesetter is not installed.
    """
    try:
        import typst  # noqa: F401
    except ImportError as error:
        repair = "install it with: pip install lyapcheck[pdf]"
        raise argument_error("--format", "pdf", "needs the package typst", repair) from error


def render(report: Report, appendix: bool = False) -> bytes:
    """A PDF of a few pages; the same report gives the same bytes.

    Args:
        report: what it says.
        appendix: whether claims, gate, runs and the experiment follow one by one.
    """
    import typst

    document = ReportAnswer(report, appendix).document()
    running = document.title if report.own else f"{document.title} · {report.notes.paper.source}"
    with temporary_folder() as folder:
        source = Path(folder, "report.typ")
        source.write_text(markup(document, running), encoding="utf-8")
        for name, drawing in report.figures.items():
            if isinstance(drawing, str) and name.endswith(".svg"):
                path = Path(folder, "figures", name)
                path.parent.mkdir(exist_ok=True)
                path.write_text(drawing, encoding="utf-8")
        pages = typst.compile(str(source), root=folder, ignore_system_fonts=True)
    assert isinstance(pages, bytes)
    return pages
