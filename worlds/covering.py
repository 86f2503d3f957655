"""The shortest walk through every room: A* over (room, visited set), the set as the bits of an integer."""

from __future__ import annotations

import heapq
from collections.abc import Iterator, Sequence

State = tuple[int, int]  # room, visited rooms


def search(doors: Sequence[Sequence[int]], colours: Sequence[int], start: int, *, limit: int) -> list[int] | None:
    """A shortest walk from `start` over all rooms, or None after `limit` expanded states.

    A move of the search goes to a room not yet visited, through visited ones: every walk is a sequence
    of such moves, in the order of its first visits.

    Args:
        doors: the rooms next to each room.
        colours: 0 or 1 a room, different behind every door.
        start: the first room.
        limit: most states to expand.
    """
    bound = _Bound(doors, colours)
    everything = (1 << len(doors)) - 1
    first: State = (start, 1 << start)
    cost: dict[State, int] = {first: 0}
    before: dict[State, State] = {}
    queue = [(bound(first), -1, first)]
    done: set[State] = set()
    while queue:
        _, _, state = heapq.heappop(queue)
        if state[1] == everything:
            return _walk(doors, before, state)
        if state in done:
            continue
        if len(done) >= limit:
            return None
        done.add(state)
        for room, steps in _frontier(doors, state):
            new = (room, state[1] | 1 << room)
            total = cost[state] + steps
            if total < cost.get(new, 1 << 30):
                cost[new], before[new] = total, state
                done.discard(new)
                # among equals the one with most rooms visited, so that a perfect walk is found depth first
                heapq.heappush(queue, (total + bound(new), -new[1].bit_count(), new))
    return None


def _frontier(doors: Sequence[Sequence[int]], state: State) -> Iterator[tuple[int, int]]:
    """The unvisited rooms next to visited ones, with their distance through visited rooms."""
    here, visited = state
    seen, edge, steps = 1 << here, [here], 0
    while edge:
        steps += 1
        ahead: list[int] = []
        for room in edge:
            for other in doors[room]:
                bit = 1 << other
                if seen & bit:
                    continue
                seen |= bit
                if visited & bit:
                    ahead.append(other)
                else:
                    yield other, steps
        edge = ahead


class _Bound:
    """Steps that every covering walk still needs: the larger of two lower bounds.

    Tree: to the nearest unvisited room, then a minimum spanning tree of the unvisited rooms under path
    distance. Colour: a walk changes colour at every step, so it needs two steps for each room of the
    colour that is left in excess.
    """

    def __init__(self, doors: Sequence[Sequence[int]], colours: Sequence[int]) -> None:
        self._near = [_distances(doors, room) for room in range(len(doors))]
        self._everything = (1 << len(doors)) - 1
        self._colours = colours
        self._dark = sum(1 << room for room, colour in enumerate(colours) if colour)
        self._trees: dict[int, int] = {}

    def __call__(self, state: State) -> int:
        here, visited = state
        left = self._everything & ~visited
        if not left:
            return 0
        near = self._near[here]
        to_first = min(near[room] for room in _bits(left))
        same = left & (self._dark if self._colours[here] else ~self._dark)
        other = left & ~same
        colour = max(2 * other.bit_count() - 1, 2 * same.bit_count())
        return max(to_first + self._tree(left), colour)

    def _tree(self, left: int) -> int:
        if left not in self._trees:
            self._trees[left] = _spanning_tree(self._near, list(_bits(left)))
        return self._trees[left]


def _spanning_tree(near: Sequence[Sequence[int]], rooms: list[int]) -> int:
    # Prim's algorithm on the complete graph of path distances
    total, newest = 0, rooms.pop()
    reach = {room: near[newest][room] for room in rooms}
    while reach:
        newest = min(reach, key=reach.__getitem__)
        total += reach.pop(newest)
        row = near[newest]
        for room, distance in reach.items():
            if row[room] < distance:
                reach[room] = row[room]
    return total


def _distances(doors: Sequence[Sequence[int]], start: int) -> list[int]:
    far = [-1] * len(doors)
    far[start] = 0
    order = [start]
    for room in order:
        for other in doors[room]:
            if far[other] < 0:
                far[other] = far[room] + 1
                order.append(other)
    return far


def _bits(mask: int) -> Iterator[int]:
    while mask:
        low = mask & -mask
        yield low.bit_length() - 1
        mask ^= low


def _walk(doors: Sequence[Sequence[int]], before: dict[State, State], last: State) -> list[int]:
    walk = [last[0]]
    while last in before:
        previous = before[last]
        walk.extend(_backwards(doors, previous, last[0]))
        last = previous
    return walk[::-1]


def _backwards(doors: Sequence[Sequence[int]], state: State, room: int) -> list[int]:
    """From `room` back to the room of `state` through visited rooms, without `room` itself."""
    here, visited = state
    after = {room: room}
    order = [room]
    for at in order:
        for other in doors[at]:
            if visited >> other & 1 and other not in after:
                after[other] = at
                order.append(other)
    path = [here]
    while after[path[-1]] != room:
        path.append(after[path[-1]])
    return path[::-1]
