from __future__ import annotations

import subprocess
import sys
from io import BytesIO

import numpy as np
import pytest
from charts import row
from cogmap.agent import Agent
from cogmap.experiments import walk
from cogmap.model import CogmapError, StaticGrowth
from cogmap.views import (
    BLUE,
    GREEN,
    ORANGE,
    PURPLE,
    SKY,
    VERMILION,
    Theme,
    contrast,
    explore_figure,
    ink_on,
    plot_expected_free_energy,
    plot_free_energy,
    plot_map,
    plot_world,
    sight_colour,
)
from cogmap.worlds import GRID, MAZES, Maze, label_colour, parse_maze
from hypothesis import given
from hypothesis import strategies as st
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Rectangle
from pictures import THEMES

MAZE = MAZES["tolman"]
OKABE = (BLUE, GREEN, ORANGE, PURPLE, SKY, VERMILION)


def rooms_of(ax: Axes) -> list[Rectangle]:
    return [patch for patch in ax.patches if isinstance(patch, Rectangle)]


@pytest.fixture(scope="module")
def agent() -> Agent:
    walker = walk(MAZES["3x3"], seed=0, max_steps=3).walker
    assert isinstance(walker, Agent)
    return walker


@pytest.mark.parametrize("label", [0, 5, 23, 24, 1000, "red", "日本"])
def test_colours_are_those_of_the_world(label: int | str) -> None:
    assert tuple(round(255 * part) for part in sight_colour(label)) == label_colour(label)


@given(st.one_of(st.integers(), st.text(max_size=5)))
def test_every_label_can_be_read_on_its_colour(label: int | str) -> None:
    colour = sight_colour(label)
    assert contrast(to_rgb(ink_on(colour)), colour) >= 4.5
    assert sight_colour(label) == colour


def test_sights_of_the_first_maze_are_colours_of_their_own() -> None:
    assert len({sight_colour(label) for label in range(24)}) == 24


def test_contrast_is_that_of_the_standard() -> None:
    assert contrast((0.0, 0.0, 0.0), (1.0, 1.0, 1.0)) == pytest.approx(21.0)
    assert contrast(to_rgb("#767676"), (1.0, 1.0, 1.0)) == pytest.approx(4.54, abs=0.01)  # the classic border case
    themes = (Theme((1, 1, 1), (0, 0, 0)), Theme((0, 0, 0), (1, 1, 1)))
    assert all(contrast(theme.line(colour), theme.paper) >= 3.0 for colour in OKABE for theme in themes)


@pytest.mark.parametrize("theme", THEMES)
def test_the_same_maze_has_the_same_colours(theme: str) -> None:
    with plt.style.context(theme):
        turned = Maze("turned", dict(reversed(MAZE.sights.items())))
        one, other = plot_world(MAZE), plot_world(turned)
    floors = [{patch.get_xy(): patch.get_facecolor()[:3] for patch in rooms_of(ax)} for ax in (one, other)]
    assert floors[0] == floors[1]
    assert all(
        floors[0][column - 0.5, row - 0.5] == sight_colour(label) for (row, column), label in MAZE.sights.items()
    )


def test_any_label_has_a_colour() -> None:
    colours = [sight_colour(label) for label in (("a", 1), None, 2.5, np.int64(3), -1)]
    assert all(0.0 <= part <= 1.0 for colour in colours for part in colour)
    assert colours[3] == sight_colour(3)


def line_of(ax: Axes) -> np.ndarray:
    """The points of a path that was drawn, as rows and columns."""
    segments = [part for part in ax.collections if isinstance(part, LineCollection)][-1].get_segments()
    return np.array([segments[0][0], *(segment[1] for segment in segments)])[:, ::-1]


def test_paths_keep_to_the_right() -> None:
    there_and_back = line_of(plot_world(row(1, 2), path=[(0, 0), (0, 1), (0, 0)]))
    lane = there_and_back[0][0]
    assert 0.05 < lane < 0.2
    assert there_and_back[0] == pytest.approx([lane, 0.0])  # to the right, below the middle
    assert there_and_back[-1] == pytest.approx([-lane, 0.0])  # back, above it
    corner = line_of(plot_world(MAZES["3x3"], path=[(1, 0), (0, 0), (0, 1)]))  # up, then right
    assert corner[1] == pytest.approx([lane, lane])


def test_standing_still_is_no_line() -> None:
    ax = plot_world(MAZES["3x3"], path=[(2, 2), (2, 2)])
    assert not [part for part in ax.collections if isinstance(part, LineCollection)][-1].get_segments()


def test_the_path_goes_from_black_to_white() -> None:
    ax = plot_world(MAZES["3x3"], path=[(0, 0), (0, 1), (0, 2), (1, 2)])
    line = [part for part in ax.collections if isinstance(part, LineCollection)][-1]
    shades = np.asarray(line.get_colors())[:, 0]
    assert shades[0] == 0.0
    assert shades[-1] == 1.0
    assert (np.diff(shades) > 0.0).all()


@pytest.mark.parametrize("floor", range(24))
def test_a_path_of_any_shade_shows_on_any_floor(floor: int) -> None:
    ax = plot_world(row(floor, floor), path=[(0, 0), (0, 1)])
    white, black, _ = (part for part in ax.collections if isinstance(part, LineCollection))
    rims = [tuple(np.asarray(part.get_colors())[0, :3]) for part in (white, black)]
    assert white.get_linewidths()[0] > black.get_linewidths()[0]
    assert max(contrast(rim, sight_colour(floor)) for rim in rims) >= 3.0
    for shade in np.linspace(0.0, 1.0, 11):
        assert max(contrast(rim, (shade, shade, shade)) for rim in rims) >= 3.0


def test_where_somebody_was_put_the_path_is_dashed() -> None:
    ax = plot_world(MAZES["4x4"], path=[(0, 0), (0, 1), (3, 3), (3, 2)])
    (jump,) = ax.lines
    assert jump.get_linestyle() == "--"
    walked = [part for part in ax.collections if isinstance(part, LineCollection)][-1].get_segments()
    assert all(np.abs(np.diff(segment, axis=0)).sum() < 1.5 for segment in walked)


def test_visited_places_are_filled_imagined_ones_hollow(agent: Agent) -> None:
    circles = [patch for patch in plot_map(agent.map).patches if isinstance(patch, Circle)]
    assert len(circles) == len(agent.map.places)
    hollow = sum(circle.get_facecolor() == (1.0, 1.0, 1.0, 1.0) for circle in circles)
    assert hollow == int((~agent.map.visited).sum()) > 0


def test_places_without_a_position_are_counted() -> None:

    lost = Agent(GRID, growth=StaticGrowth(5), seed=0)
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
    assert plot_world(MAZES["3x3"], ax=ax, title="here") is ax
    assert ax.get_title() == "here"


@pytest.mark.parametrize("layout", ["0", "0 1", "\n".join("0" * 12), "$a$ verylongword\nx_y ."])
def test_no_label_is_clipped(layout: str) -> None:
    maze = parse_maze(layout, name="small")
    done = walk(maze, seed=0)
    assert isinstance(done.walker, Agent)
    figure = explore_figure(maze, done.path, map_=done.walker.map, trace=done.walker.trace, title="$x")
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
    assert len(explore_figure(MAZES["3x3"], [(0, 0)]).axes) == 1


def test_bad_input() -> None:
    with pytest.raises(CogmapError, match=r"\(0, 1\) is no place of 'test'"):
        plot_world(row(1), path=[(0, 0), (0, 1)])
    with pytest.raises(CogmapError, match=r"\(5, 5\) is no place"):
        plot_world(row(1), closed=[(5, 5)])
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
