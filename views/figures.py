"""Whole figures."""

from collections.abc import Sequence
from typing import Any

from ..model import CognitiveMap
from ..worlds import Chart
from .axes import Figure
from .map_plot import plot_map
from .scene_plot import Scene, plot_scene
from .time_plots import Trace, plot_expected_free_energy, plot_free_energy
from .world_plot import plot_world, world_picture

WIDTH = 5.5  # of a plot, inches


def world_figure(chart: Chart, *, title: str | None = None) -> Figure:
    """A picture of a world, large enough to read."""
    from matplotlib.figure import Figure

    cells = world_picture(chart).cells.values()
    rows, columns = (max(part) - min(part) + 1 for part in zip(*cells, strict=True))
    figure = Figure(figsize=(1.6 * WIDTH, min(max(1.6 * WIDTH * rows / columns, 2.0), 12.0)), layout="constrained")
    plot_world(chart, title=chart.name if title is None else title, ax=figure.add_subplot())
    return figure


def explore_figure(
    chart: Chart,
    path: Sequence[Any],
    *,
    map_: CognitiveMap | None = None,
    trace: Trace = (),
    title: str | None = None,
    scene: Scene | None = None,
) -> Figure:
    """A figure of the world with the path, the learned map, and F and G over time. With a body, its scene comes first.

    Args:
        chart: the true map: `world.chart`, or a maze.
        path: the places walked through, in order.
        map_: what was learned; without it the world alone is shown.
        trace: the agent's records; without them the lower half is left out.
        title: above everything.
        scene: the world as it looks from above, if it does.

    Raises:
        CogmapError: what the plots raise.
    """
    from matplotlib.figure import Figure

    first = int(scene is not None)
    across = (1 if map_ is None else 2) + first
    cells = world_picture(chart).cells.values()
    rows, columns = (max(part) - min(part) + 1 for part in zip(*cells, strict=True))
    above = min(max(WIDTH * rows / columns, 2.0), 6.5) + 0.4
    heights = [above, 4.4] if trace else [above]
    figure = Figure(figsize=(WIDTH * across, sum(heights) + 0.3), layout="constrained")
    if title is not None:
        figure.suptitle(title, parse_math=False)
    grid = figure.add_gridspec(len(heights), across, height_ratios=heights)
    plot_world(chart, path=path, title="path, from black to white", ax=figure.add_subplot(grid[0, first]))
    if scene is not None:
        plot_scene(scene, title="a body's path, from black to white", ax=figure.add_subplot(grid[0, 0]))
    if map_ is not None:
        hollow = "" if map_.visited.all() else " (hollow: imagined)"
        plot_map(map_, title=f"map learned{hollow}", ax=figure.add_subplot(grid[0, first + 1]))
    if trace:
        plot_free_energy(trace, title="free energy and certainty", ax=figure.add_subplot(grid[1, 0]))
    if trace and map_ is not None:
        name = "expected free energy of the policy chosen"
        plot_expected_free_energy(trace, title=name, ax=figure.add_subplot(grid[1, 1]))
    return figure
