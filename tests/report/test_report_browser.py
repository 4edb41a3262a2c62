"""The page in a real browser: no error, links, runs, keyboard, phone, dark, paper, no script."""

import re

import pytest

from tests.helpers.browser import CHROMIUM, browser

pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="chromium is not installed")
PHONE, DESK = 390, 1280
MOST_PAGES = 7


@pytest.fixture(scope="module")
def chromium():
    with browser() as tab:
        yield tab


@pytest.fixture
def page(chromium, folder):
    """The page, freshly loaded at a desk."""
    chromium.send("Emulation.setScriptExecutionDisabled", value=False)
    chromium.media()
    chromium.open(folder / "index.html")
    chromium.size(DESK)
    yield chromium
    assert chromium.errors == []


def test_the_first_screen_answers(page):
    page.size(DESK, 900)
    end = page.run("document.querySelector('.picture').getBoundingClientRect().bottom")
    assert end <= 900
    colours = "[...document.querySelectorAll('.chain:not(.around) li')].map(li => li.className)"
    assert page.run(colours).count("bad") == 1


def test_a_claim_that_is_followed_is_open(page, folder):
    page.open(folder / "index.html", "16.6")
    assert page.until("document.getElementById('16.6').querySelector('.member').checkVisibility()")
    page.run("location.hash = '#equation-16'")
    assert page.until("document.getElementById('equation-16').checkVisibility()")


def test_a_finger_sees_what_falls_before_it_follows_the_link(page):
    page.run("window.box = document.querySelector('.claim-graph .box.refuted')")
    tap = "box.dispatchEvent(new PointerEvent('click', {pointerType: 'touch', cancelable: true}))"
    lit = "document.querySelector('.claim-graph').className.baseVal"
    assert page.run(tap) is False
    assert page.run(lit) == "claim-graph lit falls"
    assert page.run(tap) is True
    page.run("box.dispatchEvent(new FocusEvent('blur'))")
    assert page.run(lit) == "claim-graph"


def test_the_switch_of_m_needs_no_script(page):
    both = "<i id=other data-m=2>other</i><i id=same data-m=1>same</i>"
    page.run(f"document.body.insertAdjacentHTML('beforeend', '{both}')")
    page.run("document.getElementById('m1').click()")
    assert not page.run("document.getElementById('other').checkVisibility()")
    assert page.run("document.getElementById('same').checkVisibility()")


def test_each_gain_set_shows_its_run_without_anything_that_moves(page, report):
    drawn = "[...document.querySelectorAll('#gains .run')].map(one => one.querySelectorAll('svg').length)"
    assert page.run(drawn) == [2] * len(report.runs)
    assert page.run("document.getAnimations().length") == 0


def test_the_keyboard_goes_down_the_page(page):
    """In the order in which a screen reader says it, beginning with the way past the navigation."""
    page.run("window.at = document.body; window.back = 0")
    seen = []
    for _ in range(25):
        page.press("Tab")
        forward = (
            "back += !(at.compareDocumentPosition(document.activeElement) & 4); at = document.activeElement"
        )
        page.run(forward)
        seen.append(page.run("document.activeElement.textContent.trim().slice(0, 30)"))
    assert seen[0].startswith("Skip to")
    assert page.run("back") == 0
    assert page.run("getComputedStyle(document.activeElement).outlineStyle") != "none"


@pytest.mark.parametrize("opened", [False, True])
def test_a_phone_needs_no_sideways_scrolling(page, opened):
    page.size(PHONE)
    if opened:
        page.run("document.querySelectorAll('details').forEach(one => { one.open = true })")
    assert page.run("document.documentElement.scrollWidth") <= PHONE


READ = "h1, .lead p, .badge span, .chain small, .card dd, .cite, nav a, figcaption"
CONTRAST = """
[...document.querySelectorAll(READ)].map(one => {
  const style = (node) => getComputedStyle(node ?? document.body);
  const bright = (colour) => {
    const [r, g, b] = colour.match(/[\\d.]+/g).map(x => (x / 255) ** 2.2);
    return 0.2126 * r + 0.7152 * g + 0.0722 * b + 0.05;
  };
  let behind = one;
  while (behind && style(behind).backgroundColor === 'rgba(0, 0, 0, 0)') behind = behind.parentElement;
  const ratio = bright(style(one).color) / bright(style(behind).backgroundColor);
  return Math.max(ratio, 1 / ratio);
})
""".replace("READ", f"'{READ}'")


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_everything_can_be_read_by_day_and_by_night(page, scheme):
    page.media(scheme=scheme)
    ratios = page.run(CONTRAST)
    assert len(ratios) > 30
    assert min(ratios) >= 4.5
    assert (page.run("getComputedStyle(document.body).backgroundColor") == "rgb(255, 255, 255)") == (
        scheme == "light"
    )


def test_paper_holds_it_on_few_pages(page):
    counts = re.findall(rb"/Count (\d+)", page.paper())
    assert 1 <= max(map(int, counts)) <= MOST_PAGES


def test_nothing_is_lost_without_a_script(page, folder, report):
    page.send("Emulation.setScriptExecutionDisabled", value=True)
    page.open(folder / "index.html")
    text = page.send("DOM.getOuterHTML", nodeId=page.send("DOM.getDocument")["root"]["nodeId"])["outerHTML"]
    assert all(f'id="{row.id}"' in text for row in report.claims)


def test_the_graph_shows_what_a_claim_rests_on_and_what_falls_with_one(page):
    def lit(claim):
        page.run(
            f"document.querySelector('.box[data-claim=\"{claim}\"]').dispatchEvent(new Event('pointerenter'))"
        )
        return set(page.run("[...document.querySelectorAll('.box.on')].map(box => box.dataset.claim)"))

    falls = lit("16")  # refuted
    assert "P" in falls
    assert not {"16.6", "15"} & falls
    rests = lit("15")  # proved
    assert "15" in rests
    assert len(rests) > 1
    assert "P" not in rests
