from __future__ import annotations

import subprocess
import sys
from io import BytesIO

import numpy as np
import pytest
from cogmap.agent import Agent
from cogmap.experiments import walk
from cogmap.model import CogmapError
from cogmap.views import (
    explore_figure,
    plot_expected_free_energy,
    plot_free_energy,
    plot_map,
    plot_maze,
    sight_colour,
)
from cogmap.views.maze_plot import LANE, lanes
from cogmap.worlds import GRID, MAZES, label_colour, parse_maze
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import Circle


@pytest.fixture(scope="module")
def agent() -> Agent:
    walker = walk(MAZES["3x3"], seed=0, max_steps=3).walker
    assert isinstance(walker, Agent)
    return walker


@pytest.mark.parametrize("label", [0, 5, 23, 24, 1000, "red", "日本"])
def test_colours_are_those_of_the_world(label: int | str) -> None:
    assert tuple(round(255 * part) for part in sight_colour(label)) == label_colour(label)


def test_any_label_has_a_colour() -> None:
    colours = [sight_colour(label) for label in (("a", 1), None, 2.5, np.int64(3), -1)]
    assert all(0.0 <= part <= 1.0 for colour in colours for part in colour)
    assert colours[3] == sight_colour(3)


def test_lanes_keep_to_the_right() -> None:
    there_and_back = lanes(np.array([[0.0, 0.0], [0.0, 1.0], [0.0, 0.0]]))
    assert there_and_back[0] == pytest.approx([LANE, 0.0])  # to the right, below the middle
    assert there_and_back[-1] == pytest.approx([-LANE, 0.0])  # back, above it
    corner = lanes(np.array([[1.0, 0.0], [0.0, 0.0], [0.0, 1.0]]))  # up, then right
    assert corner[1] == pytest.approx([LANE, LANE])


def test_standing_still_is_no_line() -> None:
    assert lanes(np.array([[2.0, 2.0], [2.0, 2.0]])) == pytest.approx(np.array([[2.0, 2.0]]))


def test_the_path_goes_from_black_to_white() -> None:
    ax = plot_maze(MAZES["3x3"].sights, path=[(0, 0), (0, 1), (0, 2), (1, 2)])
    line = [part for part in ax.collections if isinstance(part, LineCollection)][-1]
    shades = line.get_colors()
    assert list(shades[0]) == [0, 0, 0, 1]
    assert list(shades[-1]) == [1, 1, 1, 1]


def test_visited_places_are_filled_imagined_ones_hollow(agent: Agent) -> None:
    circles = [patch for patch in plot_map(agent.map).patches if isinstance(patch, Circle)]
    assert len(circles) == len(agent.map.places)
    hollow = sum(circle.get_facecolor() == (1.0, 1.0, 1.0, 1.0) for circle in circles)
    assert hollow == int((~agent.map.visited).sum()) > 0


def test_places_without_a_position_are_counted() -> None:
    from cogmap.agent import Settings

    lost = Agent(GRID, settings=Settings(growth="static", places=5), seed=0)
    lost.step({"sight": "a", "open": [False] * 4 + [True]})
    assert [text.get_text() for text in plot_map(lost.map).texts][-1] == "4 places without a position"


def test_energies_are_those_of_the_trace(agent: Agent) -> None:
    F = plot_free_energy(agent.trace).lines[0].get_ydata()
    assert np.asarray(F) == pytest.approx([record.free_energy for record in agent.trace])
    lines = {
        str(line.get_label()): np.asarray(line.get_ydata()) for line in plot_expected_free_energy(agent.trace).lines
    }
    G = lines.pop("G")
    assert pytest.approx([record.G["G"] for record in agent.trace]) == G
    terms = [values for name, values in lines.items() if not name.startswith("_")]
    assert sum(terms) == pytest.approx(G, abs=1e-5)


def test_plots_go_where_they_are_told() -> None:
    ax = Figure().add_subplot()
    assert plot_maze(MAZES["3x3"].sights, ax=ax, title="here") is ax
    assert ax.get_title() == "here"


@pytest.mark.parametrize("layout", ["0", "0 1", "\n".join("0" * 12), "$a$ verylongword\nx_y ."])
def test_no_label_is_clipped(layout: str) -> None:
    maze = parse_maze(layout, name="small")
    done = walk(maze, seed=0)
    assert isinstance(done.walker, Agent)
    figure = explore_figure(maze.sights, done.path, map_=done.walker.map, trace=done.walker.trace, title="$x")
    figure.savefig(BytesIO())
    page = figure.bbox
    for ax in figure.axes:
        box = ax.get_tightbbox()
        assert box is not None
        assert box.x0 >= page.x0 - 1
        assert box.x1 <= page.x1 + 1
        assert box.y0 >= page.y0 - 1
        assert box.y1 <= page.y1 + 1


def test_a_baseline_has_the_maze_alone() -> None:
    assert len(explore_figure(MAZES["3x3"].sights, [(0, 0)]).axes) == 1


def test_bad_input() -> None:
    with pytest.raises(CogmapError, match="no rooms"):
        plot_maze({})
    with pytest.raises(CogmapError, match="no room"):
        plot_maze({(0, 0): 1}, path=[(0, 0), (0, 1)])
    with pytest.raises(CogmapError, match="trace is empty"):
        plot_free_energy([])
    with pytest.raises(CogmapError, match="trace is empty"):
        plot_expected_free_energy([])
    space = Agent({"east": (1, 0, 0), "west": (-1, 0, 0), "stay": (0, 0, 0)}, seed=0)
    space.step({"sight": 0, "open": [True, True, True]})
    with pytest.raises(CogmapError, match="3 dimensions"):
        plot_map(space.map)


def test_importing_the_plots_does_not_import_matplotlib() -> None:
    code = "import sys, cogmap.views; print('matplotlib' in sys.modules)"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout == "False\n"
