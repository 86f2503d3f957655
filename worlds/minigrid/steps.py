"""How few low-level steps would do, for one who knows everything: exact."""

import heapq
from collections import deque
from collections.abc import Collection
from itertools import count

from ..maze import Position
from .floorplan import Floorplan, Passage, Tile
from .tally import AHEAD

Pose = tuple[int, int, int]
"""x, y and heading."""
Leg = tuple[Position, Position]
"""From a room into the next: whoever arrives stands on the first tile of its floor and looks ahead."""


def low_steps_between(
    plan: Floorplan, pose: Pose, goals: Collection[Tile], *, shut: Collection[Tile] | None = None
) -> int:
    """Steps to the nearest of some tiles: turns, moves, and doors to open.

    Args:
        plan: where everything is.
        pose: where to set out.
        goals: tiles to stand on.
        shut: the doors that are closed; all, unless given. Locked ones are never opened.

    Raises:
        ValueError: no way leads there.
    """
    doors = {passage.door for passage in plan.passages} if shut is None else set(shut)
    free = {tile for here in plan.rooms for tile in plan.floor(here)}
    free |= {tile for passage in plan.passages if not passage.locked for tile in passage.tiles}
    targets, queue, best = set(goals), [(0, pose)], {pose: 0}
    while queue:
        steps, (x, y, heading) = heapq.heappop(queue)
        if (x, y) in targets:
            return steps
        if best[x, y, heading] < steps:
            continue
        ahead = (x + AHEAD[heading][0], y + AHEAD[heading][1])
        moves = [(1, (x, y, (heading + 1) % 4)), (1, (x, y, (heading - 1) % 4))]
        if ahead in free:
            moves.append((2 if ahead in doors else 1, (*ahead, heading)))
        for cost, new in moves:
            if steps + cost < best.get(new, 1 << 30):
                best[new] = steps + cost
                heapq.heappush(queue, (steps + cost, new))
    raise ValueError("no way leads to the goal")


def covering_low_steps(plan: Floorplan, pose: Pose, *, limit: int = 60_000) -> int | None:
    """Steps of the shortest walk that enters every room, all doors closed at first; None after `limit` states.

    A* over (the leg last gone, rooms entered, doors opened). Between legs the shortest way over the floor is taken;
    what is left takes at least, for each room, a passage, a door, and the shortest way over a floor.
    """
    legs = _legs(plan)
    within = {leg: _within(plan, leg, legs) for leg in legs}
    number = {room: i for i, room in enumerate(plan.maze.rooms)}
    here = plan.room_at((pose[0], pose[1]))
    if here is None:
        raise ValueError("the agent is in no room; begin on a floor")
    everything = (1 << len(number)) - 1
    crossing = min((cost for cost, _ in legs.values()), default=0) + 1
    between = min((steps for row in within.values() for steps in row.values()), default=0)

    def bound(entered: int) -> int:
        left = (everything & ~entered).bit_count()
        return left * crossing + max(left - 1, 0) * between

    order, first = count(), 1 << number[here]
    floor = _distances(plan, here, pose)
    begin: list[tuple[Leg, int]] = [(leg, floor[_edge(plan, leg, legs)]) for leg in legs if leg[0] == here]
    if first == everything:
        return 0
    best: dict[tuple[Leg, int, int], int] = {}
    queue: list[tuple[int, int, int, Leg, int, int]] = []

    def push(leg: Leg, steps: int, entered: int, opened: int) -> None:
        cost, door = legs[leg]
        steps += cost + (not opened >> door & 1)
        state = (leg, entered | 1 << number[leg[1]], opened | 1 << door)
        if steps < best.get(state, 1 << 30):
            best[state] = steps
            heapq.heappush(queue, (steps + bound(state[1]), -state[1].bit_count(), next(order), *state))

    for leg, steps in begin:
        push(leg, steps, first, 0)
    while queue and len(best) < limit:
        total, _, _, leg, entered, opened = heapq.heappop(queue)
        steps = best[leg, entered, opened]
        if entered == everything:
            return steps
        if total > steps + bound(entered):
            continue
        for new, inner in within[leg].items():
            push(new, steps + inner, entered, opened)
    return None


def _legs(plan: Floorplan) -> dict[Leg, tuple[int, int]]:
    """Steps of each leg once the agent stands before its passage and looks that way, and the number of its door."""
    found: dict[Leg, tuple[int, int]] = {}
    for i, passage in enumerate(plan.passages):
        if not passage.locked:
            a, b = passage.rooms
            found[a, b] = found[b, a] = (len(passage.tiles) + 1, i)
    return found


def _edge(plan: Floorplan, leg: Leg, legs: dict[Leg, tuple[int, int]]) -> Pose:
    """The last tile of floor before a leg, looking along it."""
    passage: Passage = plan.passages[legs[leg][1]]
    tiles = passage.tiles if passage.rooms == leg else passage.tiles[::-1]
    heading = next(h for h, (down, right) in enumerate(((0, 1), (1, 0), (0, -1), (-1, 0))) if _leads(leg, down, right))
    dx, dy = AHEAD[heading]
    return tiles[0][0] - dx, tiles[0][1] - dy, heading


def _leads(leg: Leg, down: int, right: int) -> bool:
    return (leg[1][0] - leg[0][0], leg[1][1] - leg[0][1]) == (down, right)


def _within(plan: Floorplan, leg: Leg, legs: dict[Leg, tuple[int, int]]) -> dict[Leg, int]:
    """Steps over the floor from the end of a leg to the beginning of each that leads on."""
    back = _edge(plan, (leg[1], leg[0]), legs)
    at = (back[0], back[1], (back[2] + 2) % 4)
    floor = _distances(plan, leg[1], at)
    return {new: floor[_edge(plan, new, legs)] for new in legs if new[0] == leg[1]}


def _distances(plan: Floorplan, room: Position, pose: Pose) -> dict[Pose, int]:
    """Steps from a pose to every other one on the floor of a room."""
    floor, steps, queue = set(plan.floor(room)), {pose: 0}, deque([pose])
    while queue:
        x, y, heading = queue.popleft()
        ahead = (x + AHEAD[heading][0], y + AHEAD[heading][1])
        moves = [(x, y, (heading + 1) % 4), (x, y, (heading - 1) % 4), *([(*ahead, heading)] if ahead in floor else [])]
        for new in moves:
            if new not in steps:
                steps[new] = steps[x, y, heading] + 1
                queue.append(new)
    return steps
