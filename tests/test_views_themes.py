"""Every plot in both themes: nothing clipped, nothing on top of anything else, everything readable."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from charts import row
from cogmap.views import (
    contrast,
    explore_figure,
    plot_belief,
    plot_belief_bars,
    plot_belief_map,
    plot_certainty,
    plot_expected_free_energy,
    plot_factor_graph,
    plot_free_energy,
    plot_map,
    plot_policies,
    plot_surprise,
    plot_terms,
    plot_world,
    policy_paths,
    theme_of,
)
from cogmap.worlds import MAZES
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from pictures import THEMES, assert_readable, ground, rendered, texts
from strolls import Stroll, aliased, half_way, small, split

MAZE, ALIAS = MAZES["tolman"], MAZES["4x4_alias"]
STROLLS: dict[str, Callable[[], Stroll]] = {"half": half_way, "split": split}

PLOTS: dict[str, Callable[[Stroll], Axes | Figure]] = {
    "map": lambda s: plot_map(s.agent.map, title="map"),
    "belief map": lambda s: plot_belief_map(s.agent.belief, s.agent.map, title="belief"),
    "bars": lambda s: plot_belief_bars(s.agent.belief, map_=s.agent.map, threshold=0.7, title="belief"),
    "policies": lambda s: plot_policies(policy_paths(s.agent.plan, s.agent.map), ax=plot_map(s.agent.map)),
    "F": lambda s: plot_free_energy(s.agent.trace, title="F"),
    "certainty": lambda s: plot_certainty(s.agent.trace, threshold=0.7, title="certainty"),
    "surprise": lambda s: plot_surprise(s.agent.trace, title="surprise"),
    "G": lambda s: plot_expected_free_energy(s.agent.trace, title="G"),
    "terms": lambda s: plot_terms(s.agent.plan, title="terms"),
    "graph": lambda s: plot_factor_graph(s.agent.graph, title="window"),
    "frame": lambda s: s.frames.plot(),
}


@pytest.mark.parametrize("theme", THEMES)
@pytest.mark.parametrize("who", STROLLS)
@pytest.mark.parametrize("plot", PLOTS)
def test_text_is_whole_and_apart_and_stands_out(plot: str, who: str, theme: str) -> None:
    with plt.style.context(theme):
        figure = rendered(PLOTS[plot](STROLLS[who]()))
        assert_readable(figure)
        for text, _ in texts(figure):
            if not _on_a_floor(text.get_zorder(), text):
                assert contrast(to_rgb(text.get_color()), ground(figure)) >= 4.5, text.get_text()


def _on_a_floor(zorder: float, text: object) -> bool:
    """Whether the text stands on a patch of its own: the label of a place, or of an observation."""
    return hasattr(text, "whole") and zorder == 3


@pytest.mark.parametrize("theme", THEMES)
def test_mazes_are_readable(theme: str) -> None:
    with plt.style.context(theme):
        for maze, walk in ((MAZE, half_way()), (ALIAS, aliased())):
            assert_readable(plot_world(maze, path=walk.path, title="maze"))
        over = plot_belief_map(split().agent.belief, split().agent.map, chart=MAZE, start=(6, 2), title="belief")
        assert_readable(over)
        walk = half_way()
        assert_readable(explore_figure(MAZE, walk.path, map_=walk.agent.map, trace=walk.agent.trace, title="all"))


@pytest.mark.parametrize("theme", THEMES)
def test_lines_stand_out(theme: str) -> None:
    with plt.style.context(theme):
        for draw in (plot_free_energy, plot_certainty, plot_surprise, plot_expected_free_energy):
            ax = draw(split().agent.trace)
            paper = theme_of(ax).paper
            named = [part for part in ax.lines if not str(part.get_label()).startswith("_")]
            assert all(contrast(to_rgb(part.get_color()), paper) >= 3.0 for part in named)
        ax = plot_map(small().agent.map)
        (links, walls) = (part for part in ax.collections if isinstance(part, LineCollection))
        for part in (links, walls):
            assert all(contrast(tuple(colour[:3]), ground(rendered(ax))) >= 4.5 for colour in part.get_colors())


def test_the_ground_decides_whatever_the_style() -> None:
    for colour, ink in (("black", "white"), ("white", "black"), ("#222244", "white")):
        figure = Figure(facecolor=colour)
        ax = figure.add_subplot(facecolor=colour)
        assert theme_of(ax).ink == to_rgb(ink)
        ax.set_axis_off()
        assert theme_of(ax).paper == to_rgb(colour)
    clear = Figure(facecolor="none").add_subplot(facecolor="none")
    assert theme_of(clear).paper == (1.0, 1.0, 1.0)


@pytest.mark.parametrize("size", [(2.0, 2.0), (6.0, 5.0), (12.0, 9.0)])
@pytest.mark.filterwarnings("ignore:Glyph")
def test_labels_fit_their_rooms_whatever_the_size(size: tuple[float, float]) -> None:
    ax = plot_world(row("verylongword", "日本", 7, "$x_y$", "wide" * 12))
    figure = rendered(ax)
    figure.set_size_inches(*size)  # after it was drawn
    rendered(figure)
    for text in ax.texts:
        box = text.get_window_extent()
        room = ax.transData.transform([text.get_position(), (text.get_position()[0] + 0.8, 0.0)])
        assert not text.get_text() or box.x1 <= room[1][0] + 1.0
        assert text.whole.startswith(text.get_text().removesuffix("…"))  # type: ignore[attr-defined]
    assert_readable(figure)


@pytest.mark.parametrize("theme", THEMES)
@pytest.mark.parametrize("walk", [small, aliased])
def test_known_mazes_are_readable(walk: Callable[[], Stroll], theme: str) -> None:
    with plt.style.context(theme):
        for plot in ("map", "belief map", "policies", "terms", "frame"):
            assert_readable(PLOTS[plot](walk()))


def test_many_long_names_stand_upright() -> None:
    belief = {f"room with a long name {i}": 1 / 12 for i in range(12)}
    assert_readable(plot_belief(belief, threshold=0.7, title="belief"))
    assert {label.get_rotation() for label in plot_belief(belief).get_xticklabels()} == {90.0}
    assert {label.get_rotation() for label in plot_belief({"a": 0.5, "b": 0.5}).get_xticklabels()} == {0.0}


@pytest.mark.parametrize("theme", THEMES)
def test_a_wide_belief_is_readable(theme: str) -> None:
    with plt.style.context(theme):
        places = dict.fromkeys(range(17), 1 / 17)
        agent = aliased().agent
        assert_readable(plot_belief_map(dict.fromkeys(agent.map.places, 1 / 16), agent.map))
        assert_readable(plot_belief_bars(places, most=12))
