"""Checks of what a rendered figure shows."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.text import Text
from matplotlib.transforms import Bbox

THEMES = ("default", "dark_background")
SLACK = 1.0  # pixels


def rendered(picture: Axes | Figure) -> Figure:
    """The figure, drawn once, so that the layout has settled and every text has its size."""
    figure = picture if isinstance(picture, Figure) else picture.get_figure(root=True)
    assert figure is not None
    FigureCanvasAgg(figure).draw()
    return figure


def texts(figure: Figure) -> Iterator[tuple[Text, Bbox]]:
    """Every text that can be seen, and its box in pixels; ticks off the axes are left out."""
    hidden = {id(text) for ax in figure.axes for text in _unseen(ax)}
    for text in figure.findobj(Text):
        assert isinstance(text, Text)
        if text.get_visible() and text.get_text().strip() and id(text) not in hidden:
            yield text, text.get_window_extent()


def assert_readable(picture: Axes | Figure) -> None:
    """No text leaves the figure, none lies over another, none is smaller than 5 points."""
    figure = rendered(picture)
    page, found = figure.bbox, list(texts(figure))
    for text, box in found:
        inside = page.x0 - SLACK <= box.x0 and box.x1 <= page.x1 + SLACK
        assert inside, f"{text.get_text()!r} leaves the figure sideways"
        assert page.y0 - SLACK <= box.y0, f"{text.get_text()!r} leaves the figure"
        assert box.y1 <= page.y1 + SLACK, f"{text.get_text()!r} leaves the figure"
        assert text.get_fontsize() >= 5.0, f"{text.get_text()!r} is tiny"
    for (one, a), (other, b) in combinations(found, 2):
        apart = a.x1 <= b.x0 + SLACK or b.x1 <= a.x0 + SLACK or a.y1 <= b.y0 + SLACK or b.y1 <= a.y0 + SLACK
        assert apart, f"{one.get_text()!r} lies over {other.get_text()!r}"


def ground(figure: Figure) -> tuple[float, float, float]:
    """The colour that the figure is drawn on."""
    return to_rgb(figure.get_facecolor())


def _unseen(ax: Axes) -> Iterator[Text]:
    for axis in (ax.xaxis, ax.yaxis):
        low, high = sorted(axis.get_view_interval())
        for tick in (*axis.get_major_ticks(), *axis.get_minor_ticks()):
            if not ax.axison or not low <= tick.get_loc() <= high:
                yield from (tick.label1, tick.label2)
        if not ax.axison:
            yield axis.label
            yield axis.offsetText
