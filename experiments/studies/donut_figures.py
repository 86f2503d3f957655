"""Figures of the study of the donut."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...views import plot_policies, plot_world
from .donut import DonutResult
from .donut_rows import CLOSED, DOORS, GOAL_ROOM, MAZE, DonutRow

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

FRAMES = 11
ACROSS = 4


def donut_figures(result: DonutResult) -> dict[str, Figure]:
    """The frames of the first agent that explored; none if nobody did."""
    rows = [row for row in result.rows if row.steps]
    return {"donut_frames": _frames(rows[0])} if rows else {}


def _frames(row: DonutRow) -> Figure:
    from matplotlib.figure import Figure

    shown = _evenly(len(row.steps))
    down = -(-(len(shown) + 1) // ACROSS)
    figure = Figure(figsize=(14.0, 3.1 * down + 0.9), layout="constrained")
    figure.get_layout_engine().set(h_pad=0.08)  # type: ignore[union-attr]
    figure.suptitle(
        "Path so far (white), paths imagined (darker: more probable), the closed room (hatched), the goal (red square)",
        fontsize=13,
    )
    axes = figure.subplots(down, ACROSS, squeeze=False).ravel()
    for ax in axes[len(shown) : -1]:
        ax.set_axis_off()
    for ax, number in zip(axes, shown, strict=False):
        _draw_frame(ax, row, number)
    _draw_way_open(axes[-1], row)
    return figure


def _evenly(count: int) -> list[int]:
    """Numbers of the frames that are shown, the first and the last among them."""
    if count <= FRAMES:
        return list(range(count))
    return [round(frame * (count - 1) / (FRAMES - 1)) for frame in range(FRAMES)]


def _draw_frame(ax: Axes, row: DonutRow, number: int) -> None:
    step = row.steps[number]
    plot_world(MAZE, closed=[CLOSED], ax=ax)
    _draw_square(ax, GOAL_ROOM, facecolor="none", edgecolor="#cc0000", linewidth=3.0, zorder=2.2)
    plot_policies({path.rooms: path.probability for path in step.paths}, ax=ax)
    way = row.path[: number + 1]
    for colour, width in (("0.35", 3.6), ("white", 1.8)):
        ax.plot([room[1] for room in way], [room[0] for room in way], color=colour, linewidth=width, zorder=3)
    at = step.room
    ax.scatter(at[1], at[0], marker="X", s=150, color="#d55e00", edgecolors="white", linewidths=1.3, zorder=6)
    ax.set_title(f"{number + 1}) {step.action}, P = {step.first_action[step.action]:.2f}", fontsize=12)


def _draw_square(ax: Axes, room: tuple[int, int], **style: object) -> None:
    from matplotlib.patches import Rectangle

    ax.add_patch(Rectangle((room[1] - 0.46, room[0] - 0.46), 0.92, 0.92, **style))  # pyright: ignore[reportArgumentType]


def _draw_way_open(ax: Axes, row: DonutRow) -> None:
    frames = range(1, len(row.steps) + 1)
    styles = (("#0072b2", "-", "o"), ("#d55e00", "--", "s"))
    ax.set_axis_off()
    ax = ax.inset_axes((0.12, 0.14, 0.86, 0.78))  # its labels take no room from the frames
    for name, (colour, style, marker) in zip(DOORS, styles, strict=True):
        values = [step.way_open[name] for step in row.steps]
        ax.plot(frames, values, label=name, color=colour, linestyle=style, marker=marker, markersize=5)
    ax.set_ylim(-0.05, 1.05)
    ax.set_xlabel("frame")
    ax.set_title("P(way open) into the closed room", fontsize=12)
    ax.legend(frameon=False, loc="center right")
