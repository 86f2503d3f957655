from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from cogmap.agent import Agent, Settings
from cogmap.model import CogmapError, Rates, StaticGrowth
from cogmap.views import (
    VERMILION,
    MapPicture,
    plot_belief_bars,
    plot_belief_map,
    plot_map,
    plot_policies,
    plot_world,
    policy_paths,
)
from cogmap.worlds import GRID, MAZES, load_world
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Rectangle
from pictures import rendered
from strolls import half_way, split
from walks import walk

MAZE = MAZES["tolman"]


def circles(ax: Axes) -> list[Circle]:
    return [patch for patch in ax.patches if isinstance(patch, Circle)]


def corridor() -> Agent:
    """Two places: one with its right door open and the others shut, and the one imagined beyond."""
    agent = Agent(GRID, seed=0)
    agent.step({"sight": "a", "open": [False, False, False, True, True]})
    return agent


def test_links_and_walls_are_those_of_the_map() -> None:
    map_ = corridor().map
    picture = MapPicture.of(map_)
    assert [place[1] for place in picture.places] == [True, False]
    drawn = picture.drawn()
    assert drawn.labels == {0: "a"}
    right, links = map_.motions.names.index("right"), {(a, b): p for a, b, p in drawn.links}
    assert links[0, 1] == pytest.approx(map_.B()[1, 0, right], abs=1e-3)
    middles = {tuple(np.mean(ends, axis=0).round(2).tolist()) for *ends, _ in drawn.walls}
    assert middles == {(-0.42, 0.0), (0.42, 0.0), (0.0, -0.42)}  # nothing is known of the doors beyond
    assert all(p == pytest.approx(1.0, abs=1e-3) for *_, p in drawn.walls)


def test_weak_links_are_thin_and_pale_and_walls_are_bars() -> None:
    world = load_world("3x3")
    agent = Agent(world.motions, settings=Settings(rates=Rates(imagined=(0.05, 0.05))), seed=0)
    for _ in walk(world, agent, 4):
        pass
    map_ = agent.map
    links, walls = (part for part in plot_map(map_).collections if isinstance(part, LineCollection))
    drawn = MapPicture.of(map_).drawn()
    assert len(links.get_segments()) == len(drawn.links)
    widths, greys = np.asarray(links.get_linewidths()), np.asarray(links.get_colors())[:, 0]
    assert (np.diff(widths) >= 0.0).all()
    assert (np.diff(greys) <= 1e-12).all()
    assert len(set(widths.round(6))) > 1  # the map has links of different strength
    assert len(walls.get_segments()) == len(drawn.walls)
    assert all(np.hypot(*(bar[1] - bar[0])) == pytest.approx(0.4) for bar in walls.get_segments())


def test_a_refuted_way_becomes_a_bar() -> None:
    agent = corridor()
    assert len(MapPicture.of(agent.map).drawn().walls) == 3
    agent.step({"sight": "a", "open": [False, False, False, False, True]})  # shut in its face
    drawn = MapPicture.of(agent.map).drawn()
    assert len(drawn.walls) == 4 or all(p < 0.5 for a, _, p in drawn.links if a == 0)


def test_over_the_maze_places_stand_on_their_rooms() -> None:
    agent = half_way().agent
    ax = plot_map(agent.map, chart=MAZE, start=(6, 2))
    rooms = {(patch.get_y() + 0.5, patch.get_x() + 0.5) for patch in ax.patches if isinstance(patch, Rectangle)}
    assert rooms == {(float(row), float(column)) for row, column in MAZE.rooms}
    places = {tuple(circle.get_center())[::-1] for circle in circles(ax)}
    assert places <= rooms
    (x0, x1), (y1, y0) = ax.get_xlim(), ax.get_ylim()
    assert all(x0 < column - 0.5 and column + 0.5 < x1 and y0 < row - 0.5 and row + 0.5 < y1 for row, column in rooms)


def test_belief_is_a_disc_and_a_number_behind_each_place() -> None:
    agent = split().agent
    assert sorted(agent.belief.places.values()) == pytest.approx([0.5, 0.5])
    plain, ax = plot_map(agent.map), plot_belief_map(agent.belief, agent.map)
    discs = [circle for circle in circles(ax) if circle.get_facecolor()[:3] == VERMILION]
    shares = [disc for disc in discs if disc.get_facecolor()[3] == pytest.approx(0.5)]
    assert len(shares) == len(circles(ax)) - len(circles(plain)) == 2
    cells = {tuple(float(x) for x in agent.map.position(place) or ()) for place in agent.belief.places}
    assert {tuple(disc.get_center())[::-1] for disc in shares} == cells
    rendered(ax)
    assert [text.get_text() for text in ax.texts].count("50%") == 2


def test_belief_without_a_position_is_told() -> None:
    lost = Agent(GRID, growth=StaticGrowth(5), seed=0)
    lost.step({"sight": "a", "open": [False] * 4 + [True]})
    ax = plot_belief_map({0: 0.25, 3: 0.75}, lost.map)
    assert "75% of the belief among them" in "".join(text.get_text() for text in ax.texts)


def test_bars_are_the_belief_and_the_rest_is_added_up() -> None:
    ax = plot_belief_bars({3: 0.1, 1: 0.5, 7: 0.25, 2: 0.15}, most=2, threshold=0.7)
    assert [bar.get_width() for bar in ax.patches] == pytest.approx([0.5, 0.25, 0.25])  # type: ignore[attr-defined]
    assert [label.get_text() for label in ax.get_yticklabels()] == ["place 1", "place 7", "2 more"]
    assert ax.lines[0].get_xdata()[0] == 0.7  # type: ignore[index]
    named = plot_belief_bars(half_way().agent.belief, map_=half_way().agent.map)
    assert named.get_yticklabels()[0].get_text().startswith(f"place {half_way().agent.belief.place} at (")


def test_paths_of_policies_are_probable_and_start_where_it_believes_to_be() -> None:
    for agent in (half_way().agent, split().agent):
        paths = policy_paths(agent.plan, agent.map, least=0.0)
        assert sum(paths.values()) == pytest.approx(1.0)
        assert list(paths.values()) == sorted(paths.values(), reverse=True)
        believed = {tuple(map(float, agent.map.position(place) or ())) for place in agent.belief.places}
        assert {path[0] for path in paths} == believed
        steps = [np.abs(np.subtract(a, b)).sum() for path in paths for a, b in pairwise(path)]
        assert set(steps) == {1.0}
    moved = policy_paths(half_way().agent.plan, half_way().agent.map, start=(6, 2))
    assert {cell for path in moved for cell in path} <= {(float(row), float(column)) for row, column in MAZE.rooms}


def test_over_a_map_paths_are_blue_and_end_in_rings_over_a_maze_in_dots() -> None:
    agent = half_way().agent
    paths = policy_paths(agent.plan, agent.map, start=(6, 2))
    map_ = plot_map(agent.map, chart=MAZE, start=(6, 2))
    places = len(circles(map_))
    plot_policies(paths, ax=map_)
    ends = {path[-1] for path, p in paths.items()}
    rings = {tuple(ring.get_center())[::-1] for ring in circles(map_)[places:]}
    assert rings
    assert rings <= ends
    maze = plot_policies(paths, ax=plot_world(MAZE))
    assert not circles(maze)
    assert len(maze.collections[-1].get_offsets()) == len(rings)  # type: ignore[arg-type]
    shades = [np.asarray(ax.collections[-1 - i].get_edgecolor()) for i, ax in ((0, map_), (1, maze))]
    assert (np.ptp(shades[0][:, :3], axis=1) > 0.01).all()
    assert np.ptp(shades[1][:, :3], axis=1) == pytest.approx(0.0)


def test_plots_share_axes() -> None:
    ax = Figure().add_subplot()
    agent = half_way().agent
    assert plot_world(MAZE, ax=ax) is ax
    wide = ax.get_xlim()
    assert plot_map(agent.map, start=(6, 2), ax=ax) is ax
    assert ax.get_xlim() == wide  # the maze has room for the map, and keeps its own
    assert plot_belief_map(agent.belief, agent.map, start=(6, 2), ax=ax, title="here") is ax
    assert ax.get_title() == "here"


def test_bad_input() -> None:
    map_ = half_way().agent.map
    for draw in (plot_belief_bars, lambda belief: plot_belief_map(belief, map_)):
        with pytest.raises(CogmapError, match="probability from 0 to 1"):
            draw({})
        with pytest.raises(CogmapError, match="probability from 0 to 1"):
            draw({0: 1.5})
    with pytest.raises(CogmapError, match="no place 99"):
        plot_belief_map({99: 1.0}, map_)
    with pytest.raises(CogmapError, match="no place 99"):
        plot_belief_bars({99: 1.0}, map_=map_)
    with pytest.raises(CogmapError, match="most is 0"):
        plot_belief_bars({0: 1.0}, most=0)
    with pytest.raises(CogmapError, match="3 dimensions"):
        plot_map(map_, start=(0, 0, 0))
    with pytest.raises(CogmapError, match="no place of 'tolman'"):
        plot_map(map_, chart=MAZE, start=(0, 0))
