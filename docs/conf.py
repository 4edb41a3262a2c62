"""The site of the documents: Sphinx with MyST and furo. ``make site`` builds it, strict about dead links."""

import json
import re
from html import escape
from pathlib import Path

from myst_parser.parsers.sphinx_ import MystParser

project = "lyapcheck"
author = copyright = "The lyapcheck authors"  # noqa: A001 (Sphinx asks for this name)
release = re.search(r'^version = "(.*)"', Path("../pyproject.toml").read_text(encoding="utf-8"), re.M)[1]
extensions = ["myst_parser"]
source_suffix = {".md": "markdown", ".ipynb": "notebook"}
exclude_patterns = ["README.md", "_static", "_templates"]
templates_path = ["_templates"]
myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 4
nitpicky = True
smartquotes = False  # they turn --out into an en dash, and no such command runs
html_theme = "furo"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_title = f"lyapcheck {release}"
html_copy_source = html_show_sphinx = False
html_theme_options = {
    "light_css_variables": {"color-brand-primary": "#00695c", "color-brand-content": "#00695c"},
    "dark_css_variables": {"color-brand-primary": "#4db6ac", "color-brand-content": "#4db6ac"},
}
html_math_renderer = "mathml"

KINDS = {
    "Tutorials": ["install", "tutorial", "tutorial_proof"],
    "How to": ["tune", "ci", "friction", "uncertainty", "urdf", "sweep", "export", "own_proof", "extend"],
    "Reference": [
        "reference/commands", "reference/conditions", "reference/files", "reference/gain_files",
        "reference/arm_files", "reference/plan_files", "reference/reference_files", "reference/python",
        "reference/python_names", "reference/claims", "format", "reference/messages", "reference/glossary",
    ],
    "Explanation": [
        "verdicts", "assumptions", "epsilon", "paper", "kernel", "architecture", "related",
    ],
}  # fmt: skip
"""The pages of each kind in their order; what is missing is left out, and what is not listed comes last."""
FOLDERS = {"reference/": "Reference", "gallery/": "Gallery"}
"""Pages of a folder that no kind lists go to this kind."""


def navigation(pages):
    """The pages of each kind: those listed above that exist, then all others."""
    kinds = {kind: [page for page in listed if page in pages] for kind, listed in KINDS.items()}
    listed = {page for group in kinds.values() for page in group}
    for page in sorted(set(pages) - listed - {"index"}):
        kind = next((kind for folder, kind in FOLDERS.items() if page.startswith(folder)), "More")
        if page.count("/") < 2:  # the page of its folder lists deeper ones
            kinds.setdefault(kind, []).append(page)
    return {kind: group for kind, group in kinds.items() if group}


def add_navigation(app, page, source):
    """Append the navigation to the first page, and to a page that has a folder the pages of that folder."""
    pages = app.env.found_docs
    if page == "index":
        groups = navigation(pages)
    else:
        groups = {"": sorted(other for other in pages if other.startswith(f"{page}/"))}
    for kind, group in groups.items():
        if group:
            lines = "\n".join(f"/{other}" for other in group)
            caption = f":caption: {kind}\n" if kind else ""
            source[0] += f"\n\n```{{toctree}}\n:hidden:\n{caption}\n{lines}\n```\n"


class NotebookParser(MystParser):
    """A notebook as a page: its text, its code, and what the code prints and draws."""

    supported = ("notebook",)

    def parse(self, inputstring, document):
        """Read the notebook as Markdown."""
        name = Path(document["source"]).name
        super().parse(markdown(json.loads(inputstring), name), document)


def markdown(notebook, name):
    """A notebook as Markdown."""
    parts = []
    for cell in notebook["cells"]:
        source = "".join(cell["source"])
        if cell["cell_type"] == "markdown":
            parts.append(source)
            continue
        parts.append(f"```python\n{source}\n```")
        for output in cell["outputs"]:
            data = output.get("data", {})
            text = "".join(output.get("text") or ("" if "image/png" in data else data.get("text/plain", "")))
            if text:
                parts.append(f"```text\n{text.rstrip()}\n```")
            if "image/png" in data:
                picture = "".join(data["image/png"]).replace("\n", "")
                title = escape("".join(data["text/plain"]))
                parts.append(f'<img alt="{title}" src="data:image/png;base64,{picture}">')
    return "\n\n".join([*parts, f"A test runs this notebook and compares its output: {{download}}`{name}`."])


def show_math(self, node):
    """Write a formula as MathML, which a browser shows without a script."""
    from docutils.nodes import SkipNode, math_block
    from latex2mathml.converter import convert

    shown = "block" if isinstance(node, math_block) else "inline"
    self.body.append(convert(node.astext(), display=shown))
    raise SkipNode


def name_parts(app, page, template, context, doctree):
    """Give headings of the navigation their level, and let the keyboard reach all that scrolls."""
    tree = context.get("furo_navigation_tree", "")
    context["furo_navigation_tree"] = tree.replace('role="heading"', 'role="heading" aria-level="2"')
    body = context.get("body", "").replace(
        '<div class="table-wrapper', '<div tabindex="0" class="table-wrapper'
    )
    context["body"] = body.replace("<pre>", '<pre tabindex="0">')


def setup(app):
    """Register the navigation, the notebooks, the formulas and what readers of the screen need."""
    app.connect("source-read", add_navigation)
    app.add_source_parser(NotebookParser)
    app.connect("html-page-context", name_parts, priority=900)  # after the theme
    app.add_html_math_renderer("mathml", (show_math, None), (show_math, None))
