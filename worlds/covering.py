"""The shortest walk through every place: A* over (place, visited set), the set as the bits of an integer."""

from __future__ import annotations

import heapq
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import networkx as nx

State = tuple[int, int]  # place, visited places
Ways = Sequence[Sequence[int]]


def search(ahead: Ways, start: int, *, limit: int) -> list[int] | None:
    """A shortest walk from `start` over all places, or None after `limit` expanded states.

    A move of the search goes to a place not yet visited, through visited ones: every walk is a sequence
    of such moves, in the order of its first visits.

    Args:
        ahead: the places that each place leads to, one-way ways as they are.
        start: the first place.
        limit: most states to expand.
    """
    import networkx as nx  # slow to import

    graph = nx.DiGraph((at, to) for at, row in enumerate(ahead) for to in row)
    graph.add_nodes_from(range(len(ahead)))
    bound = _Bound(graph)
    everything = (1 << len(ahead)) - 1
    first: State = (start, 1 << start)
    cost: dict[State, int] = {first: 0}
    before: dict[State, State] = {}
    queue = [(bound(first), -1, first)]
    done: set[State] = set()
    while queue:
        _, _, state = heapq.heappop(queue)
        if state[1] == everything:
            return _walk(graph, before, state)
        if state in done:
            continue
        if len(done) >= limit:
            return None
        done.add(state)
        for place, steps in _frontier(ahead, state):
            new = (place, state[1] | 1 << place)
            total = cost[state] + steps
            if total < cost.get(new, 1 << 30):
                cost[new], before[new] = total, state
                done.discard(new)
                # among equals the one with most places visited, so that a perfect walk is found depth first
                heapq.heappush(queue, (total + bound(new), -new[1].bit_count(), new))
    return None


def tree_walk(ahead: Ways, start: int) -> list[int]:
    """The shortest walk from `start` over a tree: every branch there and back, the deepest last and only there."""
    order, before = [start], {start: start}
    for place in order:  # grows while it is read: breadth first
        new = [other for other in ahead[place] if other not in before]
        before.update((other, place) for other in new)
        order.extend(new)
    depth = dict.fromkeys(order, 0)
    for place in order[:0:-1]:
        depth[before[place]] = max(depth[before[place]], depth[place] + 1)
    # a stack, so that the deepest branch is put first to be taken last
    left = {place: sorted(set(ahead[place]) - {before[place]}, key=depth.__getitem__, reverse=True) for place in order}
    walk, unseen = [start], len(order) - 1
    while unseen:
        here = walk[-1]
        unseen -= bool(left[here])
        walk.append(left[here].pop() if left[here] else before[here])
    return walk


def _frontier(ahead: Ways, state: State) -> Iterator[tuple[int, int]]:
    """The unvisited places next to visited ones, with their distance through visited places."""
    here, visited = state
    seen, edge, steps = 1 << here, [here], 0
    while edge:
        steps += 1
        beyond: list[int] = []
        for place in edge:
            for other in ahead[place]:
                bit = 1 << other
                if seen & bit:
                    continue
                seen |= bit
                if visited & bit:
                    beyond.append(other)
                else:
                    yield other, steps
        edge = beyond


class _Bound:
    """Steps that every covering walk still needs: the larger of two lower bounds.

    Tree: to the nearest unvisited place, then a minimum spanning tree of the unvisited places under path
    distance, the shorter of the two directions. Colour: where every way changes colour, a walk needs two steps
    for each place of the colour that is left in excess.
    """

    def __init__(self, graph: nx.DiGraph[int]) -> None:
        import networkx as nx

        count = len(graph)
        far = dict(nx.all_pairs_shortest_path_length(graph))
        self._near = [[far[a].get(b, count) for b in range(count)] for a in range(count)]
        columns = zip(*self._near, strict=True)
        self._either = [list(map(min, row, column)) for row, column in zip(self._near, columns, strict=True)]
        self._everything = (1 << count) - 1
        self._dark = _bits_of(nx.bipartite.color(graph)) if nx.is_bipartite(graph) else None
        self._trees: dict[int, int] = {}

    def __call__(self, state: State) -> int:
        here, visited = state
        left = self._everything & ~visited
        if not left:
            return 0
        if left not in self._trees:
            self._trees[left] = _spanning_tree(self._either, list(_bits(left)))
        near = self._near[here]
        return max(min(near[place] for place in _bits(left)) + self._trees[left], self._alternating(here, left))

    def _alternating(self, here: int, left: int) -> int:
        if self._dark is None:
            return 0
        same = left & (self._dark if self._dark >> here & 1 else ~self._dark)
        other = left & ~same
        return max(2 * other.bit_count() - 1, 2 * same.bit_count())


def _spanning_tree(near: Ways, places: list[int]) -> int:
    # Prim's algorithm on the complete graph of path distances
    total, newest = 0, places.pop()
    reach = {place: near[newest][place] for place in places}
    while reach:
        newest = min(reach, key=reach.__getitem__)
        total += reach.pop(newest)
        row = near[newest]
        for place, distance in reach.items():
            if row[place] < distance:
                reach[place] = row[place]
    return total


def _bits(mask: int) -> Iterator[int]:
    while mask:
        low = mask & -mask
        yield low.bit_length() - 1
        mask ^= low


def _bits_of(colour: dict[int, int]) -> int:
    return sum(1 << place for place, dark in colour.items() if dark)


def _walk(graph: nx.DiGraph[int], before: dict[State, State], last: State) -> list[int]:
    """The walk that ends in `last`: between first visits, by a shortest way through what was visited."""
    import networkx as nx

    walk = [last[0]]
    while last in before:
        here, visited = before[last]
        through = graph.subgraph([*_bits(visited), last[0]])
        walk.extend(nx.shortest_path(through, here, last[0])[-2::-1])
        last = here, visited
    return walk[::-1]
