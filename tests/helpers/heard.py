"""What a screen reader says of a page: the parts that have no name in words."""

from html.parser import HTMLParser

NAMED = {"a", "button", "summary", "th", "legend", "figcaption", "h1", "h2", "h3", "h4", "h5", "h6"}
"""Elements whose text is their name."""
LABELLED = {"img", "region", "group"}
"""Roles whose name is a label."""
UNSAID = {"math", "script", "style"}
"""What browsers leave out of the name of an element around it."""
VOID = {"meta", "link", "img", "br", "input", "hr"}


class _Reader(HTMLParser):
    def __init__(self):
        super().__init__()
        self.open = []  # tag, whether it is left out of names, its name so far
        self.unnamed = []
        self.count = 0

    def handle_starttag(self, tag, attrs):
        known = dict(attrs)
        label = (known.get("aria-label") or "").strip()
        if known.get("role") in LABELLED and not label:
            self.unnamed.append(self.get_starttag_text())
        if tag in NAMED and label:  # whoever says what is seen must reach it
            self.unnamed.append(self.get_starttag_text())
        if tag not in VOID:
            left_out = tag in UNSAID or known.get("aria-hidden") == "true"
            self.open.append([tag, left_out, "", self.getpos()])

    def handle_data(self, data):
        if not any(left_out for _, left_out, _, _ in self.open):
            for one in self.open:
                one[2] += data

    def handle_endtag(self, tag):
        name, _, said, (line, _) = self.open.pop()
        assert name == tag
        if tag in NAMED:
            self.count += 1
            if not said.strip():
                self.unnamed.append(f"<{tag}> in line {line}")


def unnamed(page):
    """The headings, links, summaries and the like of a page that have no name, or another than is seen."""
    reader = _Reader()
    reader.feed(page)
    assert reader.count > 0
    return reader.unnamed
