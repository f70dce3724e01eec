"""The six areas, in the maze and among the choices, to eyes that see few colours or none."""

import io
from itertools import combinations, product
from typing import Any

import numpy as np
from matplotlib.image import imread
from numpy.typing import NDArray
from playwright.sync_api import FloatRect, Page

from tests.browser import walk
from tests.browser.colours import Values, contrast, difference, luminance
from tests.browser.conftest import DESKTOP, PHONE, Visit

EYES = ("none", "protanopia", "deuteranopia", "tritanopia", "achromatopsia")
LOOKS: Any = tuple(product((PHONE, DESKTOP), ("light", "dark"), EYES))

# What is asked of every area, or of any two; behind it the least that was measured.
PATTERN_CONTRAST = 1.5  # 1.8
LETTER_CONTRAST = 7  # 16.7
LETTER_HEIGHT_PX = 8  # 9
PATTERNS_APART = 0.18  # share of the tile, without its plate, light in only one of them: 0.23
# Pixels of only one letter, as a share of the thinner one: 0.30 in Liberation Sans, 0.147 in DejaVu
# Sans Bold, in whose thick strokes the bar that makes an F an E is 10 pixels of 68.
LETTERS_APART = 0.12
COLOURS_APART = 10  # CIE 1976, where any colour is seen: 14


class Tile:
    """A picture of an area, taken apart: its colour, its pattern, and the letter on its plate."""

    def __init__(self, picture: Values) -> None:
        tones = luminance(picture)
        y, x = np.indices(tones.shape) / (len(tones) - 1) * 40 - 20  # tiles are drawn 40 by 40
        from_middle = np.hypot(x, y)
        inside = np.hypot(np.maximum(abs(x) - 12, 0), np.maximum(abs(y) - 12, 0)) < 6
        around, plate = inside & (from_middle > 13.5), from_middle < 10

        pattern, self.pattern_contrast = two_tones(tones[around], 0.1)
        letter, self.letter_contrast = two_tones(tones[plate], 0)
        # The pattern is drawn towards the plate's tone, letter and ground away from it.
        light_plate = letter.mean() > 0.5
        self.pattern = pattern == light_plate
        self.letter = letter != light_plate
        self.letter_height_px = np.ptp(np.nonzero(plate)[0][self.letter]) + 1
        self.colour = np.median(picture[around][~self.pattern], axis=0)


def two_tones(tones: Values, outliers: float) -> tuple[NDArray[np.bool_], float]:
    """Which pixels are light, and the contrast of light to dark."""
    dark, light = np.quantile(tones, (outliers, 1 - outliers))
    return tones > (dark + light) / 2, contrast(light, dark)


Tiles = dict[str, Tile]


def test_areas_differ_by_pattern_alone_by_letter_alone_and_by_what_colour_is_seen(visit: Visit):
    page = visit()
    walk.reach_trials(page)
    walk.play(page)
    walk.stop(page)
    session = page.context.new_cdp_session(page)
    for viewport, scheme, eyes in LOOKS:
        page.set_viewport_size(viewport)
        page.emulate_media(color_scheme=scheme)
        session.send("Emulation.setEmulatedVisionDeficiency", {"type": eyes})
        picture = imread(io.BytesIO(page.screenshot()))[..., :3].astype(np.float64)
        coloured = np.ptp(picture, axis=2).max() > 0.05
        assert coloured == (eyes != "achromatopsia")
        for where, boxes in (("maze", in_maze(page)), ("choices", among_choices(page))):
            cuts = (cut(picture, box) for box in boxes)
            tiles = dict(zip("ABCDEF", map(Tile, cuts), strict=True))
            look = f"{viewport['width']} px, {scheme}, {eyes}, {where}"
            assert_legible(tiles, look)
            assert_apart(tiles, look, coloured=coloured)


def assert_legible(tiles: Tiles, look: str) -> None:
    for letter, tile in tiles.items():
        assert tile.pattern_contrast >= PATTERN_CONTRAST, (look, letter)
        assert tile.letter_contrast >= LETTER_CONTRAST, (look, letter)
        assert tile.letter_height_px >= LETTER_HEIGHT_PX, (look, letter)


def assert_apart(tiles: Tiles, look: str, *, coloured: bool) -> None:
    for letters in combinations(tiles, 2):
        one, other = (tiles[letter] for letter in letters)
        assert np.mean(one.pattern != other.pattern) >= PATTERNS_APART, (look, letters)
        thinner = min(one.letter.sum(), other.letter.sum())
        changed = np.sum(one.letter != other.letter)
        assert changed / thinner >= LETTERS_APART, (look, letters)
        if coloured:
            assert difference(one.colour, other.colour) >= COLOURS_APART, (look, letters)


def in_maze(page: Page) -> list[FloatRect]:
    """Where the maze's areas are drawn: within their cells."""
    boxes = []
    for cell in walk.area_cells(page).values():
        margin, size = 0.07 * cell["width"], 0.86 * cell["width"]
        boxes.append(FloatRect(x=cell["x"] + margin, y=cell["y"] + margin, width=size, height=size))
    return boxes


def among_choices(page: Page) -> list[FloatRect]:
    """Where the choices' tiles are drawn."""
    tiles = page.locator(".area svg").all()
    return [box for tile in tiles if (box := tile.bounding_box())]


def cut(picture: Values, box: FloatRect) -> Values:
    left, top, size = round(box["x"]), round(box["y"]), int(box["width"])
    return picture[top : top + size, left : left + size]
