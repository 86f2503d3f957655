"""Text that is as large as its box allows, whatever becomes of the figure. Import it where matplotlib is wanted."""

from typing import Any

from matplotlib.text import Text
from matplotlib.transforms import Bbox

SMALLEST = 5.5  # points; text that would be smaller is shortened, then left out
SPARE = 1.04  # letters are not exactly as wide at every size
_TRIAL = 10.0


class FittedText(Text):
    """Text in a box given in data units; its size is found when it is drawn.

    Text that would be smaller than `SMALLEST` is cut and ends in "…", if it may be `cut`; where not even that fits it
    is left out.
    `whole` is the text uncut.
    """

    def __init__(
        self, x: float, y: float, text: str, *, box: tuple[float, float], largest: float, cut: bool, **style: Any
    ):
        super().__init__(x, y, text, parse_math=False, **style)
        self.set_in_layout(False)  # it lies within the axes, and its size follows from theirs
        self.whole = text
        self._box, self._largest, self._cut = box, largest, cut
        self._fitted: tuple[float, float] | None = None

    def draw(self, renderer: Any) -> None:
        """Draw it at the size that fits now."""
        self._fit(renderer)
        super().draw(renderer)

    def get_window_extent(self, renderer: Any = None, dpi: float | None = None) -> Bbox:
        """The box of the text as it would be drawn now, in pixels."""
        self._fit(renderer)
        return super().get_window_extent(renderer, dpi)

    def _fit(self, renderer: Any) -> None:
        figure = self.get_figure(root=True)
        if self.axes is None or figure is None:
            return
        (left, bottom), (right, top) = self.axes.transData.transform([(0, 0), self._box])
        box = (72 / figure.dpi * abs(right - left), 72 / figure.dpi * abs(top - bottom))
        if self._fitted == box:
            return
        self._fitted = box
        size = min(self._size(renderer, self.whole, box, figure.dpi), self._largest)
        lines = self.whole.split("\n")
        longest = max(map(len, lines)) if self._cut and box[1] >= SMALLEST else 0
        lengths = range(min(longest - 1, int(longest * size / SMALLEST) + 1), 0, -1) if size < SMALLEST else ()
        cuts = ("\n".join(line if len(line) <= length else f"{line[:length]}…" for line in lines) for length in lengths)
        fits = (text for text in cuts if self._size(renderer, text, box, figure.dpi) >= SMALLEST)
        text = self.whole if size >= SMALLEST else next(fits, "")
        self.set_text(text)
        self.set_fontsize(max(size, SMALLEST))

    def _size(self, renderer: Any, text: str, box: tuple[float, float], dpi: float) -> float:
        """Points at which `text` would fill the box."""
        self.set_text(text)
        self.set_fontsize(_TRIAL)
        extent = super().get_window_extent(renderer)
        scale = SPARE * 72 / dpi / _TRIAL
        return min(box[0] / max(scale * extent.width, 1e-9), box[1] / max(scale * extent.height, 1e-9))
