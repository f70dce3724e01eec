"""One look for the figures of the experiments, and the same bytes from the same numbers."""

from collections.abc import Callable
from io import BytesIO
from typing import Any

import matplotlib as mpl
from matplotlib.figure import Figure

from policies.pool_sheet import UNDATED

_STYLE: dict[Any, Any] = {
    "svg.hashsalt": "goalguess",
    "font.size": 8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#e3e3e3",
}


def draw_images(draw: Callable[[], Figure]) -> dict[str, bytes]:
    """The figure that `draw` makes, as the bytes of an image for each ending, .svg and .png."""
    # A fixed salt and no date: the same figure gives the same file.
    with mpl.rc_context(_STYLE):
        figure = draw()
        images = {}
        for suffix in (".svg", ".png"):
            image = BytesIO()
            figure.savefig(image, format=suffix[1:], dpi=160, metadata=UNDATED[suffix])
            images[suffix] = image.getvalue()
    return images
