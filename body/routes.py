"""Shortest ways over tiles: turns, steps, and doors to open."""

import heapq
from collections.abc import Collection
from itertools import count

from ..worlds import minigrid as mg
from .room_map import Pose, RoomMap
from .whereabouts import FORWARD, LEFT, PICKUP, RIGHT, TOGGLE

LIFTING = 8  # steps that it is worth to go round a thing rather than to take it out of the way


def route(
    start: Pose,
    known: RoomMap,
    goals: Collection[mg.Tile | Pose],
    *,
    within: Collection[mg.Tile],
    lift: Collection[mg.Tile] = (),
) -> list[int] | None:
    """The actions of a shortest way to one of some tiles or poses; None where there is none.

    Args:
        start: where it begins.
        known: the tiles.
        goals: where to be.
        within: the tiles that may be stepped on; closed doors are opened.
        lift: tiles of things that may be taken out of the way, which costs as much as `LIFTING` steps.
    """
    order, best = count(), {start: 0}
    before: dict[Pose, tuple[Pose, tuple[int, ...]]] = {}
    queue = [(0, next(order), start)]
    while queue:
        steps, _, pose = heapq.heappop(queue)
        if pose in goals or pose[:2] in goals:
            return _actions(before, pose)
        if best[pose] < steps:
            continue
        x, y, heading = pose
        ahead = (x + mg.AHEAD[heading][0], y + mg.AHEAD[heading][1])
        moves: list[tuple[Pose, tuple[int, ...]]] = [
            ((x, y, (heading - 1) % 4), (LEFT,)),
            ((x, y, (heading + 1) % 4), (RIGHT,)),
        ]
        if ahead in within:
            if known.free(ahead):
                moves.insert(0, ((*ahead, heading), (FORWARD,)))
            elif known.shut(ahead):
                moves.insert(0, ((*ahead, heading), (TOGGLE, FORWARD)))
        if ahead in lift:
            moves.append(((*ahead, heading), (PICKUP, FORWARD)))
        for new, actions in moves:
            cost = steps + len(actions) + LIFTING * (PICKUP in actions)
            if cost < best.get(new, 1 << 30):
                best[new], before[new] = cost, (pose, actions)
                heapq.heappush(queue, (cost, next(order), new))
    return None


def distances(start: Pose, known: RoomMap, room: Collection[mg.Tile]) -> dict[Pose, int]:
    """Steps to every pose in a room."""
    steps, queue = {start: 0}, [start]
    for pose in queue:  # grows while it is read: breadth first
        x, y, heading = pose
        ahead = (x + mg.AHEAD[heading][0], y + mg.AHEAD[heading][1])
        moves = [(x, y, (heading - 1) % 4), (x, y, (heading + 1) % 4)]
        if ahead in room and known.free(ahead):
            moves.append((*ahead, heading))
        for new in moves:
            if new not in steps:
                steps[new] = steps[pose] + 1
                queue.append(new)
    return steps


def _actions(before: dict[Pose, tuple[Pose, tuple[int, ...]]], pose: Pose) -> list[int]:
    found: list[int] = []
    while pose in before:
        pose, actions = before[pose]
        found[:0] = actions
    return found
