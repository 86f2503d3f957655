"""A world that lies for a while neither crashes an agent nor poisons its map for good.

Each test explores a maze, lets the world lie, and then tell the truth again: the agent must soon be certain of the
right place, and, after a while on its own and two tours through all rooms, its map must be right again.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from cogmap.experiments import BELIEVED, Session, Truth, explored
from cogmap.worlds import MAZES, Maze, MazeEnv, covering_walk
from walks import GRID, assert_agent_is_sound

from cogmap import UNSEEN

Observation = dict[str, Any]
Lie = Callable[[Session, int, np.random.Generator], Observation]

NAMES = ["3x3", "3x3_alias", "4x4", "t_maze_alias", "donut"]
ALONE = 45  # steps on its own after the lies, and before it is led around
TOURS = 2
MOVES = {displacement: action for action, displacement in enumerate(GRID.values())}


def wrong_sight(session: Session, step: int, rng: np.random.Generator) -> Observation:
    """The sight of a room that looks otherwise."""
    seen = session.world.observe()
    others = sorted({*session.world.maze.sights.values()} - {seen["sight"]}, key=str)
    return {**seen, "sight": others[int(rng.integers(len(others)))]}


def nothing_to_see(session: Session, step: int, rng: np.random.Generator) -> Observation:
    return {**session.world.observe(), "sight": UNSEEN}


def new_sight_each_step(session: Session, step: int, rng: np.random.Generator) -> Observation:
    return {**session.world.observe(), "sight": ("new", step)}


def moved_every_three_steps(session: Session, step: int, rng: np.random.Generator) -> Observation:
    if step % 3 == 0:
        session.displace(elsewhere=True)
    return session.world.observe()


def flickering_door(session: Session, step: int, rng: np.random.Generator) -> Observation:
    """A door of the maze that shuts and opens every step; it stands open in the end."""
    world = session.world
    doors = _doors(world.maze)
    door = doors[7 * sum(session.start) % len(doors)]
    (world.open_door if step % 2 else world.close_door)(*door)
    return world.observe()


def misread_door(session: Session, step: int, rng: np.random.Generator) -> Observation:
    """One of the doors here seems the opposite of what it is."""
    seen = session.world.observe()
    door = int(rng.integers(4))
    return {**seen, "open": [bool(is_open) != (action == door) for action, is_open in enumerate(seen["open"])]}


def _doors(maze: Maze) -> list[tuple[tuple[int, int], tuple[int, int]]]:
    return [(a, b) for a in maze.rooms for b in maze.rooms if a < b and abs(a[0] - b[0]) + abs(a[1] - b[1]) == 1]


@dataclass(frozen=True)
class Recovery:
    """How an agent came out of the lies.

    Attributes:
        certain: steps after the lies until it was certain of the right place; None if never.
        mended: steps until its map was right for good; None if it was wrong at the end.
        astray: observations of the last tour at which it was not certain of the right place.
        added: places added.
    """

    certain: int | None
    mended: int | None
    astray: int
    added: int


def lied_to(lie: Lie, name: str, seed: int, *, steps: int) -> Recovery:
    session = explored("lies", MAZES[name], seed)
    assert session.steps is not None
    agent, world, rng = session.agent, session.world, np.random.default_rng(seed)
    places, truth = len(agent.map.places), Truth(world.maze, session.start)
    for step in range(steps):
        world.step(agent.step(lie(session, step, rng)))
        assert_agent_is_sound(agent)
    astray, whole, taken = [], [], dict[str, int]()
    for tour in range(1 + TOURS):
        path = _tour(world) if tour else [None] * ALONE
        for led in path:
            action = agent.step({**world.observe(), **taken})
            astray.append(not agent.certain or agent.belief.place != session.true_place)
            whole.append(truth.learned(agent.map) and sights_are_right(session))
            taken = {} if led is None else {"taken": led}
            world.step(action if led is None else led)
    assert_agent_is_sound(agent)
    return Recovery(
        certain=astray.index(False) if False in astray else None,
        mended=_for_good(whole),
        astray=sum(astray[-len(path) :]),
        added=len(agent.map.places) - places,
    )


def _for_good(whole: list[bool]) -> int | None:
    """Since when all are true."""
    if not whole[-1]:
        return None
    return len(whole) - whole[::-1].index(False) if False in whole else 0


def _tour(world: MazeEnv) -> list[int]:
    """The actions of a shortest walk through all rooms."""
    path = covering_walk(world.maze, world.position)
    return [MOVES[b[0] - a[0], b[1] - a[1]] for a, b in pairwise(path)]


def sights_are_right(session: Session) -> bool:
    """Whether the true sight of every room is believed at `BELIEVED` or more."""
    map_, (row, column) = session.agent.map, session.start
    for room, sight in session.world.maze.sights.items():
        place = map_.place_at((room[0] - row, room[1] - column))
        if place is None or map_.A_o.probability(map_.sights.index(sight), np.array([place]))[0] < BELIEVED:
            return False
    return True


# lie, how long, then the steps until certain and right, and until the map is right for good: bounds a little above the
# most that 5 mazes x 10 seeds took
CASES = [
    (wrong_sight, 10, 10, 60),
    (nothing_to_see, 10, 2, 20),
    (new_sight_each_step, 10, 2, 20),
    (moved_every_three_steps, 15, 2, 2),
    (flickering_door, 20, 2, 60),
]

# seeds that are not got over: each look at a room that was lied about is explained by having been moved (t_maze_alias),
# or the lie was the sight of the room before, beside a wall, so that it seemed to have been shut out
NEVER: dict[tuple[str, str], set[int]] = {
    ("wrong_sight", "3x3"): {0},
    ("wrong_sight", "3x3_alias"): {0, 7},
    ("wrong_sight", "4x4"): {5},
    ("wrong_sight", "t_maze_alias"): {4},
    ("wrong_sight", "donut"): {0},
    ("new_sight_each_step", "3x3_alias"): {2},  # mended two steps later than most
    ("new_sight_each_step", "donut"): {5},  # ten rooms that were never seen, so it says
}


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize(("lie", "steps", "soon", "later"), CASES, ids=[case[0].__name__ for case in CASES])
def test_recovery_from_lies(lie: Lie, steps: int, soon: int, later: int, name: str, study: bool) -> None:
    lost: dict[int, Recovery] = {}
    for seed in range(10) if study else [1 + NAMES.index(name)]:
        recovery = lied_to(lie, name, seed, steps=steps)
        certain, mended = recovery.certain, recovery.mended
        if certain is None or certain > soon or mended is None or mended > later or recovery.astray:
            lost[seed] = recovery
    assert not lost.keys() - NEVER.get((getattr(lie, "__name__", ""), name), set()), lost


@pytest.mark.parametrize("name", NAMES)
def test_misread_doors_leave_the_agent_sound(name: str) -> None:
    """Not every map is mended: a wall that was shown open, and walked into, makes a room that is not there."""
    recovery = lied_to(misread_door, name, 1, steps=10)
    assert recovery.certain is not None
    assert recovery.certain <= 20
