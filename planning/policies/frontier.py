"""The likely shortest ways to places never entered, and which of them are worth taking."""

import heapq
from dataclasses import dataclass

import numpy as np

from ...model import Carried, Floats, Ints
from ..local import Frontier, MapView, Surroundings

STEPS, METRES = "steps", "metres"
BY = (STEPS, METRES)
"""What ways are measured in: one a step, or how far apart places lie, over the mean length of a way."""

MOST = 64  # options that are weighed, the nearest, and equals of the last of them
DOUBT = 6.0  # steps that it is worth to see where a way leads, for each nat of doubt
MOST_SPARED = 24.0  # steps that it is worth at most
SAMPLE = 512  # other places never entered to which the way back is measured, at most, spread evenly over all

LARGEST = 1_000
"""Places of the largest map in which ways back are measured along its ways, where places have no positions."""


def frontier_of(around: Surroundings, *, weight: float, most: int, beyond: int = 0, by: str = STEPS) -> Frontier | None:
    """The best options from where the agent is; None where there are none, or one within `beyond` steps.

    The nearest first along likely ways of places that were entered; what was never entered ends an option. Costs what
    it touches: places within (1 + weight) / (1 - weight) times the way to the nearest option. Ways are measured `by`
    one of `BY`; by steps where places have no positions.
    """
    map_ = around.map
    if map_.visited.all() or (map_.pose.measures and not len(around.cache.where.never_entered()[0])):
        return _doubted(around, most)
    pose, reach = map_.pose, (1.0 + weight) / (1.0 - weight)
    search = _by_length(around, reach) if by == METRES and pose.measures else _by_steps(around, reach)
    ends = search.ends
    if not ends:
        return _doubted(around, most)
    if search.depth[ends[0]] <= beyond:
        return None
    depth = np.array([search.depth[end] + search.extra(end) for end in ends], dtype=np.float64)
    back = _back(around, np.array(ends, dtype=np.int64), search)
    worth = depth - weight * back
    best = np.argsort(worth, kind="stable")
    kept = [ends[i] for i in best[:most].tolist()]
    ties = worth[best] <= worth[best[0]] + 1e-9
    kept = kept if int(ties.sum()) <= most else [ends[i] for i in best[ties].tolist()]
    paths = tuple(search.path(end) for end in kept)
    on = {place for end in kept for place in search.walk(end)}
    spared = {end: float(back[ends.index(end)]) for end in kept}
    return Frontier(paths, tuple(sorted(on)), spared, search.costs(on))


def _doubted(around: Surroundings, most: int) -> Frontier | None:
    """Where nothing new is left, ways that may lead elsewhere than is thought; None if there are none."""
    doubts, great = around.cache.doubts.read()
    spared = MOST_SPARED if great else DOUBT
    start = int(around.starts[0])
    search, level, best = _Search({start: 0}, [], STEPS, {}, around.prices), [start], np.inf
    met, steps = list[tuple[float, int, int]](), 0
    while doubts and level and steps + 1 - spared < best:
        met += [
            (steps + 1 - min(DOUBT * doubt, MOST_SPARED), place, action)
            for place in level
            for action, doubt in doubts.get(place, ())
        ]
        best, steps = min(met, default=(best,))[0], steps + 1
        level = _ahead(around, search, level, steps)
    if not met:
        return None
    kept = [(place, action) for worth, place, action in sorted(met) if worth < best + 1e-9][:most]
    on = {place for at, _ in kept for place in search.walk(at)}
    paths = tuple((*search.path(place), action) for place, action in kept)
    return Frontier(paths, tuple(sorted(on)), {}, search.costs(on))


@dataclass(slots=True)
class _Search:
    """From the place where the agent most probably is."""

    depth: dict[int, float]  # how far it is to each place that was met
    ends: list[int]  # places never entered, the nearest first
    by: str  # what ways are measured in
    before: dict[int, tuple[int, int]]  # the place and the action that lead to each
    prices: Floats | None = None  # `[K]` what the first step costs, by its action; None where that is one

    def extra(self, end: int) -> float:
        """What the first step of the way there costs more than a usual one."""
        return 0.0 if self.prices is None else float(self.prices[self.path(end)[0]]) - 1.0

    def path(self, end: int) -> tuple[int, ...]:
        """The actions that lead there."""
        actions: list[int] = []
        while end in self.before:
            end, action = self.before[end]
            actions.append(action)
        return tuple(reversed(actions))

    def walk(self, end: int) -> list[int]:
        """The places on the way there."""
        places = [end]
        while places[-1] in self.before:
            places.append(self.before[places[-1]][0])
        return places

    def costs(self, on: set[int]) -> dict[tuple[int, int], float]:
        """What each step between these places costs, by place and action, where that is not one."""
        if self.by == STEPS:
            return {}
        steps = ((place, self.before[place]) for place in on if place in self.before)
        return {way: self.depth[place] - self.depth[way[0]] for place, way in steps}


def _by_steps(around: Surroundings, reach: float) -> _Search:
    """Breadth first, until `reach` times as far as the nearest place never entered, and a step."""
    start = int(around.starts[0])
    search = _Search({start: 0}, [], STEPS, {}, around.prices)
    level, steps, most = [start], 0, np.inf
    while level and steps < most and len(search.ends) < MOST:
        steps += 1
        level = _ahead(around, search, level, steps)
        if search.ends and most == np.inf:
            most = reach * steps + 1.0
    return search


def _ahead(around: Surroundings, search: _Search, level: list[int], steps: int) -> list[int]:
    """The places that were entered `steps` steps away, one from those of `level`; the others are ends of the search."""
    rows = around.cache.likely(np.array(level)) if steps > 1 else around.sensed()
    visited, ahead = around.map.visited, list[int]()
    at, actions = np.nonzero(rows >= 0)
    if steps == 1 and search.prices is not None:  # of two ways to one place the one that begins cheaper is taken
        actions = actions[np.argsort(search.prices[actions], kind="stable")]
    for row, action, after in zip(at.tolist(), actions.tolist(), rows[at, actions].tolist(), strict=True):
        if after not in search.depth:
            search.depth[after], search.before[after] = steps, (level[row], action)
            (ahead if visited[after] else search.ends).append(after)
    return ahead


def _by_length(around: Surroundings, reach: float) -> _Search:
    """The same by how far it is, in mean lengths of a way."""
    map_, start = around.map, int(around.starts[0])
    pose, visited = map_.pose, map_.visited
    search = _Search({start: 0.0}, [], METRES, {})
    queue, done, most = [(0.0, start)], set[int](), np.inf
    while queue and queue[0][0] <= most and len(search.ends) < MOST:
        far, place = heapq.heappop(queue)
        if place in done:
            continue
        done.add(place)
        if not visited[place]:
            search.ends.append(place)
            most = min(most, reach * far + 1.0)
            continue
        row = (around.cache.likely(np.array([place])) if place != start else around.sensed())[0]
        ways = np.flatnonzero(row >= 0)
        for action, after, length in zip(
            ways.tolist(), row[ways].tolist(), pose.lengths_to(place, row[ways]).tolist(), strict=True
        ):
            if far + length < search.depth.get(after, np.inf):
                search.depth[after], search.before[after] = far + length, (place, action)
                heapq.heappush(queue, (far + length, after))
    return search


def _back(around: Surroundings, ends: Ints, search: _Search) -> Floats:
    """`[n]` how far it is from each end to what else was never entered, on average, as ways are measured."""
    places, where = around.cache.where.never_entered()
    mine = around.cache.where.of(ends)
    if not len(places) or np.isnan(mine).any():
        return _back_on_map(around, ends, search)
    if len(places) > SAMPLE:
        some = np.linspace(0, len(places) - 1, SAMPLE).astype(np.int64)
        places, where = places[some], where[some]
    apart = np.sqrt(np.square(mine[:, None] - where[None]).sum(axis=2))
    others = (ends[:, None] != places[None]).sum(axis=1)
    pose = around.map.pose
    unit = max(pose.longest if search.by == STEPS else pose.length, 1e-12)
    return np.asarray(apart.sum(axis=1) / np.maximum(others, 1) / unit)


def _back_on_map(around: Surroundings, ends: Ints, search: _Search) -> Floats:
    """The same without positions: along the ways of the map; none in a large one.

    Of a way that another one undoes both are open; where nobody knows what undoes any, all are. What nothing undoes
    among ways that are undone, such as to take a key, leads one way.
    """
    from scipy.sparse import csr_array  # slow to import, and only needed where ends of a map are many
    from scipy.sparse.csgraph import dijkstra

    map_, motions = around.map, around.map.motions
    size, entered = len(map_.places), map_.visited_places
    if len(entered) > LARGEST:
        return np.zeros(len(ends))
    ahead = around.cache.likely(entered)
    row, action = np.nonzero(ahead >= 0)
    undone = np.array(motions.inverse) >= 0
    both = undone[action] | (undone.sum() == 1)  # what stays undoes itself
    here, there = entered[row], ahead[row, action]
    to, source = np.append(here, there[both]), np.append(there, here[both])  # backwards: from each place to the ends
    graph = csr_array((np.ones(len(to)), (source, to)), shape=(size, size))
    graph.data[:] = 1.0  # of two ways between two places
    others, rooms = _one_a_room(map_, search)
    twins = np.flatnonzero(np.isin(rooms, rooms[ends]) & ~map_.visited)
    every = dijkstra(graph, unweighted=True, indices=twins)[:, others]
    far = np.array([every[rooms[twins] == rooms[end]].min(axis=0) for end in ends.tolist()])
    far = np.where(np.isfinite(far), far, 0.0)
    return np.asarray(far.sum(axis=1) / np.maximum((far > 0.0).sum(axis=1), 1))


def _one_a_room(map_: MapView, search: _Search) -> tuple[Ints, Ints]:
    """The places never entered, of those of one room the nearest; and `[S]` the room of each place."""
    rooms = np.arange(len(map_.places))
    for sensor in map_.sensors.values():
        rooms = sensor.rooms(rooms) if isinstance(sensor, Carried) else rooms
    others = np.flatnonzero(~map_.visited)
    far = np.array([search.depth.get(place, np.inf) for place in others.tolist()])
    order = np.lexsort((others, far))
    return np.sort(others[order[np.unique(rooms[others][order], return_index=True)[1]]]), rooms
