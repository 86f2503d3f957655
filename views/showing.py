"""A recorded walk inside of a notebook."""

import html
from dataclasses import dataclass

from ..model import CogmapError
from .recording import Recording
from .replay import replay_html


@dataclass(frozen=True, slots=True)
class Shown:
    """A page in an isolated frame, which cannot reach the notebook around it."""

    page: str  # the page, as `replay_html` makes it
    height: int  # of the frame, in pixels

    def _repr_html_(self) -> str:
        text = html.escape(self.page, quote=True).replace("\n", "&#10;")  # whoever joins our lines leaves its own
        look = f'width="100%" height="{self.height}" style="border: 0" title="replay of a walk"'
        return f'<iframe sandbox="allow-scripts" {look} srcdoc="{text}"></iframe>'

    def __repr__(self) -> str:
        return f"Shown(a page of {len(self.page):,} characters; notebooks show it in a frame)"


def show(recording: Recording, *, height: int = 720) -> Shown:
    """The replay page of a recording, to be shown as the last value of a notebook cell.

    Raises:
        CogmapError: it is no recording, a height below 100, or positions of more than two dimensions.
    """
    if not isinstance(recording, Recording):  # pyright: ignore[reportUnnecessaryIsInstance]
        raise CogmapError(f"show: {type(recording).__name__} is no recording; give recorder.recording()")
    if isinstance(height, bool) or not isinstance(height, int) or height < 100:  # pyright: ignore[reportUnnecessaryIsInstance]
        raise CogmapError(f"show: height is {height!r}; give a whole number of pixels, 100 or more")
    return Shown(replay_html(recording), height)
