"""Worlds as pictures: rooms as squares, other places as circles at their positions, or laid out."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
from charts import TestChart, row, torus
from cogmap.model import CogmapError
from cogmap.views import contrast, explore_figure, plot_world, sight_colour, theme_of
from cogmap.worlds import Maze
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.patches import Circle, Rectangle
from pictures import THEMES, assert_readable

RING = TestChart({name: name for name in "abcdef"}, {a: {"on": b} for a, b in zip("abcdef", "bcdefa", strict=True)})


def circles(ax: Axes) -> list[Circle]:
    return [patch for patch in ax.patches if isinstance(patch, Circle)]


def lines(ax: Axes) -> list[np.ndarray]:
    return [
        np.asarray(line) for part in ax.collections if isinstance(part, LineCollection) for line in part.get_segments()
    ]


def test_places_stand_at_their_positions() -> None:
    chart = TestChart(
        {"hall": 1, "attic": 2, "shed": 3},
        {"hall": {"out": "shed", "up": "attic"}, "shed": {"in": "hall"}, "attic": {"down": "hall"}},
        {"hall": (100.0, 50.0), "attic": (100.0, 54.0), "shed": (103.0, 50.0)},
    )
    ax = plot_world(chart)
    hall, attic, shed = (np.array(circle.get_center()) for circle in circles(ax))
    assert [circle.get_facecolor()[:3] for circle in circles(ax)] == [sight_colour(label) for label in (1, 2, 3)]
    assert attic - hall == pytest.approx([0.0, -4 / 3])  # up is up, and those side by side are a unit apart
    assert shed - hall == pytest.approx([1.0, 0.0])
    assert len(lines(ax)) == 4


@pytest.mark.parametrize("chart", [RING, TestChart({"only": 0}), TestChart({1: "a", 2: "b"})])
def test_places_without_positions_are_laid_out_apart_and_always_alike(chart: TestChart) -> None:
    one, other = ([circle.get_center() for circle in circles(plot_world(chart))] for _ in range(2))
    assert one == other
    assert all(np.hypot(*np.subtract(a, b)) >= 0.9 for a, b in combinations(one, 2))


def test_of_one_way_ways_only_the_first_half_is_drawn() -> None:
    ax = plot_world(RING)
    centres = {name: np.array(circle.get_center()) for name, circle in zip("abcdef", circles(ax), strict=True)}
    assert len(lines(ax)) == 6
    for line in lines(ax):
        a = min("abcdef", key=lambda name: np.hypot(*(centres[name] - line[0])))
        b = RING.ways[a]["on"]
        assert line[0] == pytest.approx(centres[a])
        assert line[-1] == pytest.approx(centres[a] + 0.51 * (centres[b] - centres[a]))


def test_ways_bend_around_places_between() -> None:
    ax = plot_world(torus(4))
    centres = np.array([circle.get_center() for circle in circles(ax)])
    bent = [line for line in lines(ax) if len(line) > 2]
    assert len(bent) == 16  # eight ways lead around, each in two halves
    for line in bent:
        middle = np.hypot(*(centres - line[-1]).T)
        assert middle.min() > 0.3


def test_rooms_are_squares_with_walls_between_them() -> None:
    walled = Maze("walled", {(0, 0): 0, (0, 1): 1, (1, 0): 2, (1, 1): 3}, frozenset({((0, 0), (0, 1))}))
    ax = plot_world(walled)
    assert sum(isinstance(patch, Rectangle) for patch in ax.patches) == 4
    assert not circles(ax)
    (wall,) = lines(ax)
    assert sorted(wall.tolist()) == [[0.5, -0.5], [0.5, 0.5]]
    assert not lines(plot_world(row(0, 1)))
    jumped = plot_world(walled, path=[(0, 0), (0, 1)])
    assert len(jumped.lines) == 1  # nobody walks through a wall


def test_closed_places_are_hatched() -> None:
    for chart, closed in ((row(0, 1, 2), (0, 1)), (torus(3), (1, 1))):
        hatched = [patch.get_hatch() for patch in plot_world(chart, closed=[closed]).patches]
        assert hatched.count("////") == 1
        assert hatched[list(chart.places).index(closed)] == "////"


def test_paths_follow_bent_ways_and_jump_where_there_is_none() -> None:
    ax = plot_world(torus(4), path=[(0, 0), (0, 3), (2, 2)])
    assert len(ax.lines) == 1
    path = [part for part in ax.collections if isinstance(part, LineCollection)][-1].get_segments()
    assert min(np.asarray(piece)[:, 1].min() for piece in path) < -0.3  # around the places between


@pytest.mark.parametrize("theme", THEMES)
@pytest.mark.parametrize("chart", [RING, torus(3)])
def test_graphs_are_readable(chart: TestChart, theme: str) -> None:
    with plt.style.context(theme):
        path = [chart.places[0], next(iter(chart.successors(chart.places[0]).values()))]
        assert_readable(explore_figure(chart, path, title="a world"))
        ax = plot_world(chart, path=path)
        ways = next(part for part in ax.collections if isinstance(part, LineCollection))
        assert all(contrast(tuple(colour[:3]), theme_of(ax).paper) >= 3.0 for colour in ways.get_colors())


def test_heights_are_told_apart() -> None:
    positions = {"x": (0.0, 0.0, 0.0), "y": (0.0, 0.0, 3.0), "z": (1.4, 0.5, 0.0)}
    ax = plot_world(TestChart({name: name for name in "xyz"}, positions=positions))
    low, high, _ = (circle.get_center() for circle in circles(ax))
    assert high[1] < low[1]


def test_bad_input() -> None:
    with pytest.raises(CogmapError, match="'z' is no place of 'test'"):
        plot_world(RING, path=["a", "z"])
    with pytest.raises(CogmapError, match="'z' is no place of 'test'"):
        plot_world(RING, closed="z")
