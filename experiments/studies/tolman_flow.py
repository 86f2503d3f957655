"""How often each door of Tolman's maze was walked through, drawn on the maze."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

from ...views import plot_world
from ...worlds import Door, Position
from .tolman_maze import GOAL, MAZE, START, A, B

if TYPE_CHECKING:
    from matplotlib.axes import Axes

WIDEST = 13.0  # points


def flow(paths: Sequence[Sequence[Position]]) -> Counter[Door]:
    """Moves through each door, both ways together, by its rooms in row-major order."""
    moves = [(min(at, to), max(at, to)) for path in paths for at, to in pairwise(path) if at != to]
    return Counter(moves)


def plot_flow(paths: Sequence[Sequence[Position]], *, closed: Position | None, ax: Axes) -> Axes:
    """The maze with a line through each door, wider and darker the more often it was walked through."""
    from matplotlib.patches import Rectangle

    plot_world(MAZE, closed=[] if closed is None else [closed], ax=ax)
    for room in set(MAZE.rooms) - {closed}:  # paler, so that the flow stands out
        ax.add_patch(Rectangle((room[1] - 0.5, room[0] - 0.5), 1, 1, facecolor="white", alpha=0.5, zorder=1.5))
    counts = flow(paths)
    most = max(counts.values(), default=1)
    for (at, to), count in sorted(counts.items(), key=lambda item: item[1]):
        share = count / most
        (line,) = ax.plot([at[1], to[1]], [at[0], to[0]], zorder=2 + share, solid_capstyle="round")
        line.set(color=str(0.62 * (1.0 - share)), linewidth=0.8 + WIDEST * share)
    for room, name in ((START, "start"), (GOAL, "goal"), (A, "A"), (B, "B")):
        _label(ax, room, name)
    return ax


def _label(ax: Axes, room: Position, name: str) -> None:
    from matplotlib.patheffects import withStroke

    far = name in ("start", "goal")
    across, side = (room[1], "center") if far else (room[1] + 0.62, "left")
    down = room[0] + (0.72 if name == "start" else -0.72 if name == "goal" else 0.0)
    text = ax.text(across, down, name, ha=side, va="center", size=12, weight="bold", zorder=6)
    text.set_path_effects([withStroke(linewidth=3, foreground="white")])
    if far:
        ax.set_ylim(max(ax.get_ylim()[0], 6.95), min(ax.get_ylim()[1], -0.95))
