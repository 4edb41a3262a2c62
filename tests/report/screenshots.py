"""``make screenshots``: pictures of the committed page for people to look at, in build/screenshots/."""

import sys
from pathlib import Path

from tests.helpers.browser import CHROMIUM, browser

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "reports" / "index.html"
FOLDER = ROOT / "build" / "screenshots"
PLACES = ("verdict", "findings", "claims", "gains", "evidence")


def main():
    """Every section at a desk by day and by night, the whole page on a phone, and what is printed."""
    if CHROMIUM is None:
        print("install chromium to take pictures", file=sys.stderr)
        return 2
    FOLDER.mkdir(parents=True, exist_ok=True)
    with browser() as tab:
        for scheme in ("light", "dark"):
            tab.size(1280, 900)
            tab.media(scheme=scheme)
            for place in PLACES:
                _take(tab, f"desk-{scheme}-{place}", place)
        tab.media()
        tab.size(390, 844)
        for place in PLACES:
            _take(tab, f"phone-{place}", place)
        (FOLDER / "paper.pdf").write_bytes(tab.paper())
    print(f"{len(list(FOLDER.iterdir()))} files in {FOLDER.relative_to(ROOT)}")
    return 0


def _take(tab, name, place):
    tab.open(PAGE, place)
    (FOLDER / f"{name}.png").write_bytes(tab.picture())


if __name__ == "__main__":
    sys.exit(main())
