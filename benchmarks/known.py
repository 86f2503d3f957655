"""Agents that know mazes which would take too long to explore: they are led through, and plan nothing."""

from __future__ import annotations

from collections.abc import Iterator

from cogmap.agent import Agent, Settings
from cogmap.planning import Planner
from cogmap.worlds import GRID, Maze, MazeEnv, Position


def known_agent(
    maze: Maze, start: Position, *, settings: Settings | None = None, planner: Planner | None = None, seed: int = 0
) -> Agent:
    """An agent that was led through all of the maze from `start`, depth first, and back, and has made no choice yet.

    Its first observation must be that of `start`, where it has stayed.
    """
    agent, world = Agent(GRID, planner=planner, settings=settings, seed=seed), MazeEnv(maze)
    world.reset(options={"start": start})
    for action, room in depth_first(maze, start):
        agent.perceive({**world.displace(room), **({} if action is None else {"taken": action})})
    agent._state.action, agent._state.acted = agent.map.motions.stay, True
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
