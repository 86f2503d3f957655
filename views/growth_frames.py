"""The map as it grows, frame by frame."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import islice
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..agent import Agent
from ..model import CogmapError, GrowthEvent, make_folder, write_through, write_whole
from ..worlds import Chart
from .axes import Cell, axes_or_new
from .colours import VERMILION
from .map_picture import MapPicture, MapWatch
from .map_plot import draw_map, underlay
from .picture import RADIUS
from .theme import theme_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

HERE = RADIUS + 0.08  # radius of the ring around the place where the agent believes to be
PIXELS = 100  # an inch

_WORDS = {"place": "imagined", "bind": "bound", "unbind": "unbound", "retract": "taken back"}


@dataclass(frozen=True, slots=True)
class GrowthFrame:
    """One moment of a growing map.

    Attributes:
        step: of the agent's last observation.
        delta: what has changed in the map since the frame before, as `MapPicture.apply` takes it.
        place: where the agent believed to be.
        news: what had been added since the frame before, in words.
    """

    step: int
    delta: dict[str, Any]
    place: int
    news: str


class GrowthFrames:
    """Pictures of an agent's map, one a step; what did not change from one to the next is kept once.

    Example: `frames = GrowthFrames()`, then `frames.add(agent)` after each step, and `frames.save_gif("map.gif")`.

    Args:
        chart: the true map, drawn faintly beneath: `world.chart`, or a maze.
        start: the place that the agent takes as its origin: of the chart, or row and column.

    Attributes:
        frames: the frames so far.
    """

    def __init__(self, *, chart: Chart | None = None, start: Any = (0, 0)) -> None:
        self.frames: list[GrowthFrame] = []
        self._world, self._origin = underlay(chart, start)
        self._watch: MapWatch | None = None
        self._logged = 0
        self._cells: set[Cell] = set()  # where there is a place in any of the frames

    def __len__(self) -> int:
        return len(self.frames)

    def add(self, agent: Agent) -> None:
        """Keep the map as it is after the agent's last step.

        Raises:
            CogmapError: the agent has seen nothing yet, or its map has more than two dimensions.
        """
        place, news = agent.belief.place, _news(agent.map.growth[self._logged :])
        self._logged = len(agent.map.growth)
        self._watch = self._watch or MapWatch(agent.map)
        self.frames.append(GrowthFrame(agent.steps - 1, self._watch.delta(), place, news))
        self._cells.update(self._watch.picture.drawn(self._origin).cells.values())

    def maps(self) -> Iterator[MapPicture]:
        """The map at each frame: always the same object, changed in place."""
        if self._watch is not None:
            picture = self._watch.picture.blank()
            for frame in self.frames:
                picture.apply(frame.delta)
                yield picture

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
        index %= len(self)
        frame, picture = self.frames[index], next(islice(self.maps(), index, None))
        ax = axes_or_new(ax, size=(6.0, 6.0))
        cells = draw_map(ax, picture, self._world, self._origin, room=self._cells).cells
        if frame.place in cells:
            _draw_here(ax, *cells[frame.place])
        ax.set_title(_caption(frame, picture) if title is None else title, fontsize="medium")
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


def _draw_here(ax: Axes, row: float, column: float) -> None:
    from matplotlib.patches import Circle

    colour = theme_of(ax).line(VERMILION)
    ax.add_artist(Circle((column, row), HERE, fill=False, edgecolor=colour, linewidth=2.5, zorder=4))


def _caption(frame: GrowthFrame, picture: MapPicture) -> str:
    """The step, the size of the map, and what is new, in two lines."""
    size = len(picture.places)
    places = f"{size} place{'s' if size != 1 else ''}, {picture.visited} visited"
    return f"step {frame.step}: {places}\n{frame.news or 'nothing new'}"


def _news(events: Sequence[GrowthEvent]) -> str:
    """What the events added, such as "2 imagined, new sight 7"."""
    counts = Counter[str]()
    for event in events:
        if event.kind in _WORDS:
            counts[_WORDS[event.kind]] += event.index if event.kind == "retract" else 1
    sights = [str(event.label) for event in events if event.kind == "sight"]
    parts = [f"{count} {what}" for what, count in counts.items() if count]
    return ", ".join([*parts, *([f"new sight {', '.join(sights)[:24]}"] if sights else [])])
