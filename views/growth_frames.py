"""The map as it grows, frame by frame."""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import islice, takewhile
from os import PathLike
from pathlib import Path
from typing import Any

from ..agent import Agent
from ..model import CogmapError, GrowthEvent, make_folder, write_through
from ..worlds import Chart
from .axes import Axes, Cell, Figure, axes_or_new
from .map_picture import MapPicture
from .map_plot import draw_map, underlay
from .picture import RADIUS
from .theme import VERMILION, theme_of

HERE = RADIUS + 0.08  # radius of the ring around the place where the agent believes to be
PIXELS = 100  # an inch

_WORDS = {"place": "imagined", "bind": "bound", "unbind": "unbound", "retract": "taken back"}


@dataclass(frozen=True, slots=True)
class GrowthFrame:
    """One moment of a growing map."""

    step: int  # of the agent's last observation
    delta: dict[str, Any]  # what has changed in the map since the frame before, as `MapPicture.apply` takes it
    place: int  # where the agent believed to be
    news: str  # what had been added since the frame before


class GrowthFrames:
    """Pictures of an agent's map, one per step. Only what changes between steps is stored.

    Example: `frames = GrowthFrames()`, then `frames.add(agent)` after each step, and `frames.save_gif("map.gif")`.
    The `frames` so far can be read.
    """

    def __init__(self, *, chart: Chart | None = None, start: Any = (0, 0)) -> None:
        self.frames: list[GrowthFrame] = []
        self._beneath = underlay(chart, start)
        self._map: MapPicture | None = None
        self._logged = 0
        self._cells: set[Cell] = set()  # where there is a place in any of the frames

    def __len__(self) -> int:
        return len(self.frames)

    def add(self, agent: Agent) -> None:
        """Keep the map as it is after the agent's last step.

        Raises:
            CogmapError: the agent has seen nothing yet, or its map has more than two dimensions.
        """
        since, growth = self._logged, agent.map.growth  # from its end, as its beginning may be made shorter
        place, news = agent.belief.place, _news([*takewhile(lambda event: event.step >= since, reversed(growth))][::-1])
        self._logged = agent.steps
        self._map = self._map or MapPicture(agent.map.motions, agent.map.sights)
        self.frames.append(GrowthFrame(agent.steps - 1, self._map.update(agent.map), place, news))
        if self._map.located:
            self._cells.update(self._map.drawn(self._beneath[1]).cells.values())

    def maps(self) -> Iterator[MapPicture]:
        """The map at each frame: always the same object, changed in place."""
        if self._map is not None:
            layout = None if self._map.located else self._map.cells  # so that places stay where they are
            picture = MapPicture(self._map.motions, self._map.sights, layout=layout)
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
        from matplotlib.patches import Circle

        if not -len(self) <= index < len(self):
            raise CogmapError(f"growth frames: there is no frame {index}; there are {len(self)}, call add(agent) first")
        frame, picture = self.frames[index], next(islice(self.maps(), index % len(self), None))
        ax = axes_or_new(ax=ax, size=(6.0, 6.0))
        cells = draw_map(ax, picture, self._beneath, room=self._cells).cells
        if frame.place in cells:
            (row, column), colour = cells[frame.place], theme_of(ax).line(VERMILION)
            ax.add_artist(Circle((column, row), HERE, fill=False, edgecolor=colour, linewidth=2.5, zorder=4))
        size = f"{len(picture.places)} place{'s' if len(picture.places) != 1 else ''}, {picture.visited} visited"
        caption = f"step {frame.step}: {size}\n{frame.news or 'nothing new'}"
        ax.set_title(caption if title is None else title, fontsize="medium")
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
        drawn = self._drawn()

        def write(target: Path) -> None:
            writer = PillowWriter(fps=1 / seconds)  # pyright: ignore[reportArgumentType]
            for number, figure in enumerate(drawn):
                if not number:
                    writer.setup(figure, str(target), dpi=PIXELS)
                stays = max(round(last / seconds), 1) if number == len(self) - 1 else 1
                for _ in range(stays):
                    writer.grab_frame(facecolor=figure.get_facecolor())
            writer.finish()

        return write_through(path, write)

    def save_pngs(self, folder: str | PathLike[str]) -> list[Path]:
        """Write each frame as `frame_0000.png` and so on into a folder, which is made where it is missing.

        Returns:
            The files, in order. Others in the folder stay as they are.

        Raises:
            CogmapError: there are no frames, or a file that cannot be written.
        """
        drawn, target = enumerate(self._drawn()), make_folder(Path(folder))
        paths = ((target / f"frame_{index:04}.png", figure) for index, figure in drawn)
        return [write_through(path, partial(figure.savefig, dpi=PIXELS)) for path, figure in paths]

    def _drawn(self) -> Iterator[Figure]:
        """The figure of each frame: always the same, drawn anew."""
        from matplotlib.figure import Figure

        if not self.frames:
            raise CogmapError("growth frames: there are none yet; call add(agent) after each step")
        figure = Figure(figsize=(6.0, 6.0), layout="constrained")

        def draw(index: int) -> Figure:
            figure.clear()
            self.plot(index, ax=figure.add_subplot())
            return figure

        return map(draw, range(len(self)))


def _news(events: Sequence[GrowthEvent]) -> str:
    """What the events added, such as "2 imagined, new sight 7"."""
    counts = Counter[str]()
    for event in events:
        if event.kind in _WORDS:
            counts[_WORDS[event.kind]] += event.index if event.kind == "retract" else 1
    sights = [str(event.label) for event in events if event.kind == "sight"]
    parts = [f"{count} {what}" for what, count in counts.items() if count]
    return ", ".join([*parts, *([f"new sight {', '.join(sights)[:24]}"] if sights else [])])
