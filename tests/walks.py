"""Helpers of the tests of model, filter and agent: walks through worlds, and what must hold after each step."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np
from cogmap.agent import Agent
from cogmap.model import CognitiveMap, map_state
from cogmap.model.domain import FORGOTTEN
from cogmap.planning import LocalCache
from cogmap.worlds import MazeEnv
from parts import agent_with

GRID = {"up": (-1, 0), "down": (1, 0), "left": (0, -1), "right": (0, 1), "stay": (0, 0)}
UP, DOWN, LEFT, RIGHT, STAY = range(5)

KEPT: WeakKeyDictionary[Agent, LocalCache] = WeakKeyDictionary()
"""A cache of each agent, asked after every step."""

Observe = Callable[[dict[str, Any]], dict[str, Any]]


def walk(
    world: MazeEnv,
    agent: Agent,
    steps: int,
    *,
    seed: int = 0,
    displace_every: int = 0,
    steer: bool = False,
    observe: Observe = lambda observation: observation,
) -> Iterator[int]:
    """Steps of `agent` in `world` from a random room; yields after each step.

    It is moved silently every so often, or steered: then a random action takes the place of its choice.
    """
    rng = np.random.default_rng(seed)
    observation, _ = world.reset(seed=seed)
    taken: dict[str, Any] = {}
    for k in range(steps):
        if displace_every and k % displace_every == displace_every - 1:
            rooms = [room for room in world.maze.rooms if room not in world.closed_rooms]
            observation = world.displace(rooms[int(rng.integers(len(rooms)))])
        action = agent.step({**observe(observation), **taken})
        if steer:
            action = int(rng.integers(len(world.motions.names)))
            taken = {"taken": action}
        yield action
        observation, *_ = world.step(action)


def walked(world: MazeEnv, steps: int, *, seed: int = 0, displace_every: int = 0, **settings: Any) -> Agent:
    """An agent that has walked."""
    agent = agent_with(world.motions, seed=seed, **{"look_ahead": 3, **settings})
    for _ in walk(world, agent, steps, seed=seed, displace_every=displace_every):
        pass
    return agent


def assert_map_is_sound(map_: CognitiveMap) -> None:
    """Counts are finite and never below their prior; every column of every table is a distribution."""
    for table in (map_.A_o, map_.A_p, map_.B_s):
        state = table.state()
        for counts in (state["prior"], state["evidence"]):
            assert np.isfinite(counts).all()
            assert (counts >= 0.0).all()
    for columns in (map_.A(), map_.positions_given_places(), map_.B()):
        assert (columns >= 0.0).all()
        np.testing.assert_allclose(columns.sum(axis=0), 1.0, atol=1e-9)
    known = [position for position in map_.positions if position is not FORGOTTEN]
    assert len(set(known)) == len(known)
    assert set(map_.visited_places.tolist()) == set(np.flatnonzero(map_.visited).tolist())


def assert_cache_is_fresh(agent: Agent) -> None:
    """What plans have kept of each place is what a plan that has kept nothing would work out."""
    visits = agent.settings.look_ahead
    kept, fresh = KEPT.setdefault(agent, LocalCache(agent.map, visits)), LocalCache(agent.map, visits)
    places = np.arange(len(agent.map.places))
    for cache in (kept, fresh):
        cache.refresh()
    for rows, new in ((kept.ways(places), fresh.ways(places)), (kept.sights(places), fresh.sights(places))):
        for name in type(rows).__slots__:
            np.testing.assert_array_equal(getattr(rows, name), getattr(new, name), err_msg=name)
    np.testing.assert_array_equal(kept.likely(places), fresh.ways(places).likely[:-1])
    np.testing.assert_array_equal(kept.unseen(), fresh.unseen())


def assert_agent_is_sound(agent: Agent) -> None:
    """What must hold after every step, whatever was seen."""
    assert_map_is_sound(agent.map)
    belief, plan = agent.belief, agent.plan
    assert (belief.message.mass >= 0.0).all()
    for q in (belief.message.mass, list(belief.places.values()), list(belief.positions.values()), plan.probability):
        np.testing.assert_allclose(np.sum(q), 1.0, atol=1e-9)
    assert belief.evidence <= 1e-9
    assert -1e-9 <= belief.moved <= 1.0 + 1e-9
    assert -1e-9 <= belief.dropped <= 1.0
    assert (belief.pairwise[2] >= 0.0).all()
    assert_cache_is_fresh(agent)
    assert belief.pairwise[2].sum() <= 1.0 + 1e-9
    numbers = [belief.evidence, belief.complexity, belief.accuracy, *agent.trace[-1].G.values()]
    assert np.isfinite(numbers).all()
    assert 0 <= plan.action < len(agent.map.motions)


def assert_same_map(one: CognitiveMap, other: CognitiveMap) -> None:
    """Every number, label and event of two maps is equal."""
    assert list(one.sights) == list(other.sights)
    assert [type(label) for label in one.sights] == [type(label) for label in other.sights]
    assert list(one.positions) == list(other.positions)
    assert one.growth == other.growth
    left, right = map_state(one)[1], map_state(other)[1]
    assert left.keys() == right.keys()
    for name, values in left.items():
        np.testing.assert_array_equal(values, right[name], err_msg=name)


def assert_same_belief(one: Agent, other: Agent) -> None:
    """Two agents believe exactly the same of where they are."""
    for a, b in zip(
        (*_parts(one.belief.message), *one.belief.pairwise),
        (*_parts(other.belief.message), *other.belief.pairwise),
        strict=True,
    ):
        np.testing.assert_array_equal(a, b)
    for name in ("evidence", "complexity", "accuracy", "moved", "dropped", "examined"):
        assert getattr(one.belief, name) == getattr(other.belief, name), name


def _parts(message: Any) -> tuple[Any, Any, Any]:
    return message.places, message.positions, message.mass
