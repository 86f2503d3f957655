"""The map as it grows, frame by frame."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

from ..agent import Agent
from ..model.errors import CogmapError
from ..model.files import make_folder, write_through, write_whole
from .axes import Cell, axes_or_new, flat
from .growth_news import GrowthFrame, caption, news_of
from .map_picture import PlacePicture, picture_of
from .map_plot import RADIUS, draw_picture
from .maze_plot import Sights
from .theme import theme_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

HERE = RADIUS + 0.08  # radius of the ring around the place where the agent believes to be
PIXELS = 100  # an inch


class GrowthFrames:
    """Pictures of an agent's map, one a step; what did not change from one to the next is kept once.

    Example: `frames = GrowthFrames()`, then `frames.add(agent)` after each step, and `frames.save_gif("map.gif")`.

    Args:
        sights: the rooms of the true maze, drawn faintly beneath; label by (row, column).
        start: row and column of the place that the agent takes as its origin.

    Attributes:
        frames: the frames so far.
    """

    def __init__(self, *, sights: Sights | None = None, start: Sequence[float] = (0, 0)) -> None:
        self.frames: list[GrowthFrame] = []
        self._sights, self._start = sights, start
        self._logged = 0

    def __len__(self) -> int:
        return len(self.frames)

    def add(self, agent: Agent) -> None:
        """Keep the map as it is after the agent's last step.

        Raises:
            CogmapError: the agent has seen nothing yet, or its map has more than two dimensions.
        """
        place = agent.belief.place
        before = self.frames[-1].picture if self.frames else None
        news = news_of(agent.map.growth[self._logged :])
        self._logged = len(agent.map.growth)
        self.frames.append(GrowthFrame(agent.steps - 1, picture_of(agent.map, before=before), place, news))

    def plot(self, index: int = -1, *, title: str | None = None, ax: Axes | None = None) -> Axes:
        """One frame, on axes that have room for all of them; the ring is where the agent believes to be.

        Args:
            index: number of the frame, from 0; negative ones count from the last.
            title: above the plot; the step, the size of the map and what is new unless given.
            ax: axes to draw on; new ones unless given.

        Raises:
            CogmapError: there is no such frame.
        """
        if not -len(self) <= index < len(self):
            raise CogmapError(f"growth frames: there is no frame {index}; there are {len(self)}, call add(agent) first")
        frame = self.frames[index]
        ax = axes_or_new(ax, size=(6.0, 6.0))
        draw_picture(ax, frame.picture, sights=self._sights, start=self._start, room=self._cells())
        _draw_here(ax, frame.picture.places.get(frame.place), self._start)
        ax.set_title(caption(frame) if title is None else title, fontsize="medium")
        return ax

    def save_gif(self, path: str | PathLike[str], *, seconds: float = 0.5, last: float = 2.0) -> Path:
        """Write all frames as one animation that runs for ever.

        Args:
            path: of the file, which ends in `.gif`; it is replaced at once, when all is drawn.
            seconds: each frame is shown.
            last: seconds that the last one is shown, in whole frames.

        Raises:
            CogmapError: there are no frames, another suffix, times that are not positive, or a file that cannot be
                written.
        """
        from matplotlib.animation import PillowWriter

        path = Path(path)
        if path.suffix.lower() != ".gif":
            raise CogmapError(f"growth frames: {path} is no .gif; give it that suffix")
        if not (0.0 < seconds <= 60.0 and 0.0 < last <= 600.0):
            raise CogmapError(
                f"growth frames: {seconds} and {last} seconds a frame; give positive times of a minute or so"
            )
        self._check()
        shown = [*range(len(self)), *[len(self) - 1] * (max(round(last / seconds), 1) - 1)]

        def draw(target: Path) -> None:
            figure, writer = _figure(), PillowWriter(fps=1 / seconds)  # pyright: ignore[reportArgumentType]
            with writer.saving(figure, str(target), dpi=PIXELS):
                for index in shown:
                    self._draw(figure, index)
                    writer.grab_frame(facecolor=figure.get_facecolor())

        return write_through(path, draw)

    def save_pngs(self, folder: str | PathLike[str]) -> list[Path]:
        """Write each frame as `frame_0000.png` and so on into a folder, which is made where it is missing.

        Returns:
            The files, in order. Others in the folder stay as they are.

        Raises:
            CogmapError: there are no frames, or a file that cannot be written.
        """
        self._check()
        target, figure = make_folder(Path(folder)), _figure()
        written: list[Path] = []
        for index in range(len(self)):
            self._draw(figure, index)
            written.append(write_whole(target / f"frame_{index:04}.png", _png(figure)))
        return written

    def _check(self) -> None:
        if not self.frames:
            raise CogmapError("growth frames: there are none yet; call add(agent) after each step")

    def _cells(self) -> list[Cell]:
        """Where there is a place in any of the frames."""
        down, right = flat(self._start)
        cells = {place.cell for frame in self.frames for place in frame.picture.places.values()}
        return [(row + down, column + right) for row, column in cells]

    def _draw(self, figure: Figure, index: int) -> None:
        figure.clear()
        self.plot(index, ax=figure.add_subplot())


def _figure() -> Figure:
    from matplotlib.figure import Figure

    return Figure(figsize=(6.0, 6.0), layout="constrained")


def _png(figure: Figure) -> bytes:
    from io import BytesIO

    buffer = BytesIO()
    figure.savefig(buffer, format="png", dpi=PIXELS)
    return buffer.getvalue()


def _draw_here(ax: Axes, place: PlacePicture | None, start: Sequence[float]) -> None:
    from matplotlib.patches import Circle

    from .colours import VERMILION
    from .map_plot import shifted

    if place is not None:
        row, column = shifted(place, start).cell
        colour = theme_of(ax).line(VERMILION)
        ax.add_artist(Circle((column, row), HERE, fill=False, edgecolor=colour, linewidth=2.5, zorder=4))
