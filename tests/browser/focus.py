"""Where the keyboard's focus is, what is seen of it, and where Tab leads."""

from dataclasses import dataclass
from typing import Any

from playwright.sync_api import Page

# Of radio buttons Tab stops at one: the arrows lead to the others.
TAB_STOPS = """() => {
    const controls = [...document.querySelectorAll("a[href], button, input, select, textarea")]
        .filter((one) => one.type !== "hidden" && !one.disabled && one.checkVisibility());
    const entry = ({ name }) => {
        const group = controls.filter((one) => one.type === "radio" && one.name === name);
        return group.find((one) => one.checked) ?? group[0];
    };
    return controls.filter((one) => one.type !== "radio" || one === entry(one));
}"""
FOCUSED = f"""() => {{
    const one = document.activeElement;
    const shown = one.closest("label") ?? one; // our radio buttons are drawn by their labels
    const [box] = shown.getClientRects();
    const middle = document.elementFromPoint(box.x + box.width / 2, box.y + box.height / 2);
    const outlined = (each) => {{
        const {{ outlineStyle, outlineWidth }} = getComputedStyle(each);
        const visible = each.checkVisibility({{ opacityProperty: true }});
        return visible && outlineStyle !== "none" && parseFloat(outlineWidth) >= 2;
    }};
    return {{
        stop: ({TAB_STOPS})().indexOf(one),
        text: (one.labels?.[0] ?? one).textContent.trim(),
        box: [box.top + scrollY, box.bottom + scrollY, box.left],
        outlined: outlined(one) || outlined(shown),
        uncovered: shown.contains(middle),
        outside: one === document.body,
    }};
}}"""


@dataclass(frozen=True)
class Focused:
    """What has the focus: which of the page's Tab stops (-1: none of them), and how it shows.

    `outside`: the focus has left the page, for the browser's own controls or nothing.
    """

    stop: int
    text: str
    box: tuple[float, float, float]
    """Top, bottom and left on the page, px."""
    outlined: bool
    uncovered: bool
    outside: bool

    @property
    def seen(self) -> bool:
        """Outlined, in view, and behind nothing."""
        return self.outlined and self.uncovered

    def reads_before(self, other: "Focused") -> bool:
        """Above it, or to its left: columns are read one after the other."""
        (_, bottom, left), (other_top, _, other_left) = self.box, other.box
        return bottom <= other_top or left < other_left


def focused(page: Page) -> Focused:
    """What has the focus."""
    found: dict[str, Any] = page.evaluate(FOCUSED)
    return Focused(**found)


def tab(page: Page) -> Focused:
    """Press Tab; what has the focus then."""
    page.keyboard.press("Tab")
    return focused(page)


def tab_to(page: Page, text: str) -> Focused:
    """Tab until something with that text has the focus."""
    for _ in range(30):
        reached = tab(page)
        if reached.stop >= 0 and text in reached.text:
            return reached
    raise AssertionError(f"Tab never reaches {text!r}")


def tab_around(page: Page) -> list[Focused]:
    """Tab as often as there are Tab stops; what had the focus, from the first of them on."""
    stops: int = page.evaluate(f"({TAB_STOPS})().length")
    reached = [tab(page) for _ in range(stops + 1)]  # at most once it is outside
    within = [one for one in reached if not one.outside][:stops]
    first = [one.stop for one in within].index(0)
    return within[first:] + within[:first]
