"""Imagined paths and beliefs as bars."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from cogmap.agent import Settings
from cogmap.experiments import Session, explored
from cogmap.model import CogmapError
from cogmap.views import VERMILION, plot_belief, plot_policies, policy_paths
from cogmap.worlds import MAZES
from matplotlib.collections import LineCollection


@pytest.fixture(scope="module")
def session() -> Session:
    session = explored("test", MAZES["3x3"], 1, settings=Settings(look_ahead=4))
    session.agent.prefer({8: 3.0})
    session.agent.step(session.world.observe())
    return session


def walked(session: Session, policy: list[int]) -> tuple[tuple[int, int], ...]:
    """The rooms of a policy, walked in the world itself."""
    here = session.world.position
    rooms = [here]
    for action in policy:
        session.world.step(action)
        if session.world.position != rooms[-1]:
            rooms.append(session.world.position)
    session.world.displace(here)
    return tuple(rooms)


def test_imagined_paths_are_those_of_the_world(session: Session) -> None:
    plan = session.agent.plan
    expected: dict[tuple[tuple[int, int], ...], float] = {}
    for policy, p in zip(plan.policies.tolist(), plan.probability.tolist(), strict=True):
        rooms = walked(session, policy)
        expected[rooms] = expected.get(rooms, 0.0) + p
    found = policy_paths(plan, session.agent.map, start=session.start, least=1e-3)
    assert found == pytest.approx({rooms: p for rooms, p in expected.items() if p >= 1e-3}, abs=1e-3)
    assert list(found.values()) == sorted(found.values(), reverse=True)


def test_bars_are_as_high_as_places_are_probable() -> None:
    ax = plot_belief({"a": 0.25, "b": 0.75}, true="b", threshold=0.7, title="here")
    assert [bar.get_height() for bar in ax.patches] == [0.25, 0.75]  # type: ignore[attr-defined]
    assert [bar.get_facecolor()[:3] == pytest.approx(VERMILION) for bar in ax.patches] == [False, True]
    assert [label.get_text() for label in ax.get_xticklabels()] == ["a", "▲ b"]
    assert ax.lines[0].get_ydata()[0] == 0.7  # type: ignore[index]


def test_ways_are_as_dark_as_they_are_probable() -> None:
    paths = {((0, 0), (0, 1), (0, 0)): 0.25, ((0, 0), (0, 1), (0, 2)): 0.75, ((0, 0),): 0.001}
    ax = plot_policies(paths, title="here")
    shaded = [part for part in ax.collections if isinstance(part, LineCollection)][-1]
    lines = [tuple(map(tuple, segment)) for segment in shaded.get_segments()]
    assert lines == [((1.0, 0.0), (2.0, 0.0)), ((0.0, 0.0), (1.0, 0.0))]  # x, y; there and back counts once
    greys = [colour[0] for colour in np.asarray(shaded.get_color())]
    assert greys[0] > greys[1] == 0.0
    assert plot_policies(paths, ax=ax) is ax


@pytest.mark.parametrize(
    ("draw", "message"),
    [
        (lambda: plot_belief({}), "one or more places"),
        (lambda: plot_belief({"a": 1.5}), "from 0 to 1"),
        (lambda: plot_belief({"a": float("nan")}), "from 0 to 1"),
        (lambda: plot_policies({(): 1.0}), "no cells"),
        (lambda: plot_policies({((0, 0, 0),): 1.0}), "3 dimensions"),
    ],
)
def test_plots_refuse_what_they_cannot_draw(draw: Callable[[], object], message: str) -> None:
    with pytest.raises(CogmapError, match=message):
        draw()
