"""Recorded walks for the tests of recordings and of the replay page."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from itertools import cycle
from typing import Any

import networkx as nx
from cogmap.agent import Agent
from cogmap.model import FactorGraph, window_graph
from cogmap.views import Recorder, Recording
from cogmap.worlds import MazeEnv, load_world
from parts import agent_with

After = Callable[[Agent], None]


def recorded(
    world: MazeEnv,
    steps: int,
    *,
    seed: int = 0,
    events: dict[int, Callable[[MazeEnv, Agent], Any]] | None = None,
    after: After = lambda agent: None,
    sights: bool = True,
    **settings: Any,
) -> Recording:
    """A walk in which things happen before the steps named; `after` is called after every step."""
    agent = agent_with(world.motions, seed=seed, **{"look_ahead": 3, **settings})
    recorder = Recorder(world.chart if sights else None, title=world.maze.name)
    world.reset(seed=seed)
    for step in range(steps):
        if events and step in events:
            events[step](world, agent)
        action = agent.step(world.observe())
        position, closed = world.position, world.closed_rooms
        recorder.add(agent, place=position, closed_rooms=closed, closed_doors=world.closed_doors)
        after(agent)
        world.step(action)
    return recorder.recording()


def kidnaps(every: int, until: int, *rooms: tuple[int, int]) -> dict[int, Callable[[MazeEnv, Agent], Any]]:
    """Silent moves to the rooms in turn."""
    turns = zip(range(every, until, every), cycle(rooms), strict=False)
    return {step: lambda world, _, room=room: world.displace(room) for step, room in turns}


def close_elsewhere(world: MazeEnv, room: tuple[int, int]) -> None:
    """Close a room, unless the agent is in it."""
    if world.position != room:
        world.close_room(room)


def eventful(steps: int = 90, **options: Any) -> Recording:
    """Kidnapped before it knows the maze, so that it takes back what it learned; a room and a door are closed."""
    world = load_world("4x4_alias")
    events = {
        **kidnaps(6, 60, (1, 2), (3, 0)),
        65: lambda world, _: close_elsewhere(world, (1, 1)),
        70: lambda world, _: world.close_door((2, 2), (2, 3)),
        80: lambda world, _: world.open_room((1, 1)),
    }
    return recorded(world, steps, events=events, **options)


@cache
def witnessed_walk() -> tuple[Recording, list[nx.MultiDiGraph[Any]], list[FactorGraph]]:
    """`eventful()`, made once, with the map after every step and the window's graph after each of the first 60."""
    maps: list[nx.MultiDiGraph[Any]] = []
    graphs: list[FactorGraph] = []

    def witness(agent: Agent) -> None:
        maps.append(agent.map.to_networkx())
        if agent.steps <= 60:
            graphs.append(window_graph(agent.map, agent.window))

    return eventful(after=witness), maps, graphs


def eventful_walk() -> Recording:
    """`eventful()`, made once."""
    return witnessed_walk()[0]


@cache
def tolman_walk() -> Recording:
    """Three hundred steps of the Tolman maze, made once."""
    return recorded(load_world("tolman"), 300, look_ahead=6)


def outline(graph: nx.MultiDiGraph[Any]) -> dict[str, Any]:
    """What a recording keeps of a map: nodes with their most probable sight, edges with how they are known."""
    nodes = {}
    for place, facts in graph.nodes(data=True):
        seen = max(facts["sights"], key=facts["sights"].get) if facts["sights"] else None
        nodes[place] = facts["position"], facts["visited"], seen
    edges = {(a, b, key): facts["known"] for a, b, key, facts in graph.edges(keys=True, data=True)}
    return {"nodes": nodes, "edges": edges}


def probabilities(graph: nx.MultiDiGraph[Any]) -> dict[Any, float]:
    """P of every edge."""
    return {(a, b, key): facts["probability"] for a, b, key, facts in graph.edges(keys=True, data=True)}
