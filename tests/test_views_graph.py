from __future__ import annotations

import numpy as np
import pytest
from cogmap.model import CogmapError, FactorGraph
from cogmap.views import plot_factor_graph
from hypothesis import given, settings
from hypothesis import strategies as st
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import Ellipse, Rectangle
from pictures import assert_readable, rendered
from strolls import split


def parts(ax: Axes) -> tuple[list[Ellipse], list[Rectangle]]:
    variables = [patch for patch in ax.patches if isinstance(patch, Ellipse)]
    return variables, [patch for patch in ax.patches if isinstance(patch, Rectangle)]


def spots(ax: Axes) -> dict[str, tuple[float, float]]:
    """Where each variable stands, by the name that is written in it."""
    centres = [tuple(patch.get_center()) for patch in parts(ax)[0]]
    return {text.whole: text.get_position() for text in ax.texts if text.get_position() in centres}  # type: ignore[attr-defined]


def distances(ax: Axes) -> np.ndarray:
    """Between the centres of all variables and factors."""
    variables, factors = parts(ax)
    squares = [(x + part.get_width() / 2, y + part.get_height() / 2) for part in factors for x, y in [part.get_xy()]]
    points = np.array([*(patch.get_center() for patch in variables), *squares])
    return np.hypot(*(points[:, None] - points[None]).transpose(2, 0, 1)) + 9.0 * np.eye(len(points))


def sprinkler() -> FactorGraph:
    graph = FactorGraph()
    for name in ("cloudy", "sprinkler", "rain", "wet_grass"):
        graph.variable(name, (False, True))
    graph.factor("P", ["cloudy"], [0.5, 0.5])
    for scope in (["sprinkler", "cloudy"], ["rain", "cloudy"], ["wet_grass", "sprinkler", "rain"]):
        graph.factor("P", scope, np.ones((2,) * len(scope)))
    return graph


def chain(length: int) -> FactorGraph:
    graph = FactorGraph()
    graph.variable("theta", range(3))
    for time in range(length):
        graph.variable(f"x{time}", range(3), time=time)
        graph.variable(f"y{time}", range(2), time=time, observed=True)
        graph.factor("E", [f"y{time}", f"x{time}", "theta"], np.ones((2, 3, 3)))
        if time:
            graph.variable(f"a{time - 1}", range(2), time=time - 1)
            graph.factor("T", [f"x{time}", f"x{time - 1}", f"a{time - 1}"], np.ones((3, 3, 2)))
    graph.factor("prior", ["x0"], np.ones(3))
    return graph


def test_every_variable_factor_and_line_of_the_window_is_drawn() -> None:
    graph = split().agent.graph
    ax = plot_factor_graph(graph)
    variables, factors = parts(ax)
    assert (len(variables), len(factors)) == (len(graph.variables), len(graph.factors))
    (lines,) = (part for part in ax.collections if isinstance(part, LineCollection))
    assert len(lines.get_segments()) == sum(len(factor.scope) for factor in graph.factors)


def test_observed_and_latent_are_told_apart() -> None:
    graph = split().agent.graph
    faces = {tuple(np.round(patch.get_facecolor(), 6)) for patch in parts(plot_factor_graph(graph))[0]}
    assert len(faces) == 2
    latent = sum(not graph.is_observed(variable) for variable in graph.variables)
    white = [patch for patch in parts(plot_factor_graph(graph))[0] if patch.get_facecolor()[:3] == (1.0, 1.0, 1.0)]
    assert len(white) == latent
    seen = plot_factor_graph(sprinkler().observe("wet_grass", True))
    rendered(seen)
    assert "=True" in [text.get_text() for text in seen.texts]


def test_columns_are_steps_and_rows_are_kinds() -> None:
    graph = split().agent.graph
    found = spots(plot_factor_graph(graph))
    first, last = (choose(variable.time or 0 for variable in graph.variables) for choose in (min, max))
    for variable in graph.variables:
        assert abs(found[variable.name][0] - ((variable.time or 0) - first)) <= 0.5
    heights: list[float] = []
    for kind in ("p", "moved", "s", "o", "c"):
        row = [found[f"{kind}{time}"] for time in range(first + 1, last + 1)]
        assert len({y for _, y in row}) == 1
        assert np.ptp(np.diff([x for x, _ in row])) == pytest.approx(0.0)
        heights.append(row[0][1])
    assert heights == sorted(heights, reverse=True)


@pytest.mark.parametrize("graph", [sprinkler(), chain(6), split().agent.graph], ids=["own", "chain", "window"])
def test_nothing_lies_on_anything_else(graph: FactorGraph) -> None:
    assert distances(plot_factor_graph(graph)).min() >= 0.1


@given(st.data())
@settings(max_examples=8, deadline=None)
def test_graphs_without_time_are_spread_the_same_way_each_time(data: st.DataObject) -> None:
    size = data.draw(st.integers(1, 7))
    graph = FactorGraph()
    for i in range(size):
        graph.variable(f"v{i}", (0, 1))
    for scope in data.draw(st.sets(st.frozensets(st.integers(0, size - 1), min_size=1, max_size=3), max_size=8)):
        graph.factor("f", [f"v{i}" for i in sorted(scope)], np.ones((2,) * len(scope)))
    one, other = distances(plot_factor_graph(graph)), distances(plot_factor_graph(graph))
    assert (one == other).all()
    assert one.min() >= 0.9


def test_the_last_steps_alone() -> None:
    graph = split().agent.graph
    ax = plot_factor_graph(graph, last=3)
    rendered(ax)
    words = [text.get_text() for text in ax.texts]
    newest = max(variable.time or 0 for variable in graph.variables)
    times = [word for word in words if "t =" in word]
    assert times == [f"… t = {newest - 2}", f"t = {newest - 1}", f"t = {newest}"]
    assert f"moved{newest - 2}" not in words  # what it decided on is not shown
    assert len(parts(plot_factor_graph(graph, last=99))[0]) == len(graph.variables)
    one = parts(plot_factor_graph(chain(3), last=1))
    assert len(one[0]) == 3


def test_actions_stand_between_the_states_they_join() -> None:
    found = spots(plot_factor_graph(chain(4)))
    assert [found[f"a{i}"][0] for i in range(3)] == [0.5, 1.5, 2.5]
    assert found["theta"][1] > max(y for name, (_, y) in found.items() if name != "theta")


@pytest.mark.parametrize("make", [sprinkler, lambda: chain(6), lambda: chain(10)])
def test_labels_of_other_graphs_are_readable(make) -> None:  # type: ignore[no-untyped-def]
    assert_readable(plot_factor_graph(make(), title="a graph of one's own"))


def test_long_names_are_cut_not_spilt() -> None:
    graph = FactorGraph()
    graph.variable("an_extraordinarily_long_name_of_a_variable", (0, 1), time=0, observed=True)
    graph.variable("x0", (0, 1), time=0)
    graph.factor("quite_a_long_factor_name", [graph.variables[0], "x0"], np.ones((2, 2)))
    ax = plot_factor_graph(graph)
    assert_readable(ax)
    assert any(text.get_text().endswith("…") for text in ax.texts)


def test_it_goes_where_it_is_told() -> None:
    ax = Figure(figsize=(4, 3), layout="constrained").add_subplot()
    assert plot_factor_graph(split().agent.graph, last=3, ax=ax, title="here") is ax
    assert_readable(ax)


def test_bad_input() -> None:
    with pytest.raises(CogmapError, match="no variables"):
        plot_factor_graph(FactorGraph())
    with pytest.raises(CogmapError, match="last is 0"):
        plot_factor_graph(sprinkler(), last=0)
