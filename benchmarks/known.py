"""Maps of mazes that would take too long to walk through: the same lessons, without inference and planning."""

from __future__ import annotations

from collections.abc import Iterator

from cogmap.agent import Agent, Settings
from cogmap.model import Whereabouts
from cogmap.planning import Planner
from cogmap.worlds import GRID, Maze, MazeEnv, Position


def known_agent(
    maze: Maze, start: Position, *, settings: Settings | None = None, planner: Planner | None = None, seed: int = 0
) -> Agent:
    """An agent with the map of one that has walked through all of the maze from `start`, depth first, and is back.

    It has taken no step yet: its first observation must be that of `start`.
    """
    agent = Agent(GRID, planner=planner, settings=settings, seed=seed)
    map_, world = agent.map, MazeEnv(maze)
    world.reset(options={"start": start})
    place = 0
    for step, (action, room) in enumerate(depth_first(maze, start)):
        if action is not None:
            before, place = place, map_.place_at((room[0] - start[0], room[1] - start[1])) or 0
            map_.transitions.learn(before, action, place, 1.0)
        observation = world.displace(room)
        values = {name: sensor.check(observation[name]) for name, sensor in map_.sensors.items()}
        map_.mark_visited(place)
        map_.recall(agent.growth.look(map_, Whereabouts({place: 1.0}), values["open"], step=step))
        readings = {name: sensor.read(values[name], step=step) for name, sensor in map_.sensors.items()}
        map_.learn(place, readings, 1.0)
    return agent


def depth_first(maze: Maze, start: Position) -> Iterator[tuple[int | None, Position]]:
    """A walk through all rooms and back: each action (None at the start), and the room that it leads to."""
    back: dict[Position, int] = {}
    doors = {frozenset(door) for door in maze.doors}
    seen, track = {start}, [start]
    yield None, start
    while track:
        row, column = track[-1]
        for action, (down, right) in enumerate(GRID.displacements):
            ahead = (row + down, column + right)
            if ahead not in seen and frozenset((track[-1], ahead)) in doors:
                seen.add(ahead)
                track.append(ahead)
                back[ahead] = GRID.displacements.index((-down, -right))
                yield action, ahead
                break
        else:
            room = track.pop()
            if track:
                yield back[room], track[-1]
