"""An open path over all places of a weighted graph, made short by local search on the distances between them."""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[np.int64]
Distances = NDArray[np.float32]

_LONGEST = 3  # places of a segment that is moved
_NEAR = 50  # places of the segments that are exchanged at random
_NEVER = 1e7  # the distance of what cannot be reached


def shortest_tour(
    ahead: Sequence[Mapping[int, float]], start: int, *, rounds: int, rng: np.random.Generator
) -> list[int] | None:
    """The order in which to visit all places, `start` first; None where some cannot be reached.

    Args:
        ahead: of each place, the cost of going to those next to it.
        start: the first place.
        rounds: exchanges to try when nothing helps any more.
        rng: draws these.
    """
    distances = _distances(ahead)
    both = distances, distances.T.copy()  # the distances to a place are read row by row as well
    best = _Path(*both, np.append(_nearest_neighbours(distances, start), len(ahead)))
    best.improve(range(1, len(ahead)))
    for _ in range(rounds if len(ahead) > 4 else 0):
        trial = _Path(*both, best.order)
        trial.improve(trial.exchange(rng))
        best = trial if trial.length <= best.length else best
    return best.order[:-1].tolist() if best.length < _NEVER else None


class _Path:
    """An order of places and what it costs. Its last place is none: it lies at no distance from any other."""

    def __init__(self, distances: Distances, back_distances: Distances, order: Numbers) -> None:
        self._distances, self._back_distances = distances, back_distances
        self._set(order)

    def _set(self, order: Numbers) -> None:
        self.order = order
        self._step = self._distances[order[:-1], order[1:]].astype(np.float64)
        self._forth = np.concatenate([[0.0], np.cumsum(self._step)])
        back = self._distances[order[1:], order[:-1]].astype(np.float64)
        self._back = np.concatenate([[0.0], np.cumsum(back)])
        self.length = float(self._forth[-1])

    def improve(self, at: Iterable[int]) -> None:
        """Turn and move segments at these positions, and wherever that was done, for as long as it helps."""
        waiting = dict.fromkeys(self.order[list(at)].tolist())
        while waiting:
            place = next(iter(waiting))
            del waiting[place]
            position = int(np.flatnonzero(self.order == place)[0])
            if 0 < position < len(self.order) - 1:
                gain, order, joints = max(self._turn(position), self._move(position), key=lambda found: found[0])
                if gain > 1e-3:
                    self._set(order)
                    waiting.update(dict.fromkeys(order[joints].tolist()))

    def exchange(self, rng: np.random.Generator) -> list[int]:
        """Exchange two neighbouring segments, and return the positions where they join."""
        first, middle, end = np.sort(rng.choice(min(_NEAR, len(self.order) - 1), size=3, replace=False))
        shift = int(rng.integers(1, len(self.order) - end))
        first, middle, end = first + shift, middle + shift, end + shift
        parts = np.split(self.order, [first, middle, end])
        self._set(np.concatenate([parts[0], parts[2], parts[1], parts[3]]))
        joint = first + end - middle
        return [first - 1, first, joint - 1, joint, end - 1, end]

    def _turn(self, at: int) -> tuple[float, Numbers, list[int]]:
        """The best segment to turn round that begins or ends at a position: what it saves, and the new order."""
        order, last = self.order, len(self.order) - 1
        here, before, after = order[at], order[at - 1], order[at + 1]
        inner = self._forth - self._back
        end = np.arange(at, last)
        saved = self._step[at - 1] + self._step[end] + inner[end] - inner[at]
        saved -= self._distances[before][order[end]] + self._distances[here][order[end + 1]]
        begin = np.arange(1, at + 1)
        other = self._step[begin - 1] + self._step[at] + inner[at] - inner[begin]
        other -= self._back_distances[here][order[begin - 1]] + self._back_distances[after][order[begin]]
        i, j = (at, at + int(saved.argmax())) if saved.max() >= other.max() else (1 + int(other.argmax()), at)
        turned = np.concatenate([order[:i], order[i : j + 1][::-1], order[j + 1 :]])
        return float(max(saved.max(), other.max())), turned, [i - 1, i, j, j + 1]

    def _move(self, at: int) -> tuple[float, Numbers, list[int]]:
        """The best place for a short segment that begins at a position, either way round."""
        order, last = self.order, len(self.order) - 1
        best: tuple[float, int, int, bool] = (0.0, at, at, False)
        for end in range(at, min(at + _LONGEST, last)):
            first, final = order[at], order[end]
            saved = self._step[at - 1] + self._step[end] - self._distances[order[at - 1], order[end + 1]]
            gap = self._step.copy()  # of the step that is opened
            gap[at - 1 : end + 1] = -np.inf
            turned = self._back[end] - self._back[at] - self._forth[end] + self._forth[at]
            ahead = gap - self._back_distances[first][order[:-1]] - self._distances[final][order[1:]]
            back = gap - self._back_distances[final][order[:-1]] - self._distances[first][order[1:]] - turned
            for gains, reverse in ((ahead, False), (back, True)):
                into = int(gains.argmax())
                best = max(best, (saved + float(gains[into]), end, into, reverse))
        gain, end, into, reverse = best
        segment = order[at : end + 1][:: -1 if reverse else 1]
        rest = np.concatenate([order[:at], order[end + 1 :]])
        into = into + 1 if into < at else into + 1 - len(segment)
        moved = np.concatenate([rest[:into], segment, rest[into:]])
        near = [into - 1, into, into + len(segment) - 1, into + len(segment)]
        return gain, moved, [*near, *([at - 1, at] if into > at else [end, min(end + 1, last)])]


def _distances(ahead: Sequence[Mapping[int, float]]) -> Distances:
    """`[n + 1, n + 1]` the cost of the cheapest way between each two places; the last place lies at none from any."""
    from scipy.sparse import csr_array  # slow to import
    from scipy.sparse.csgraph import dijkstra

    count = len(ahead)
    ends = np.array([(at, to) for at, row in enumerate(ahead) for to in row], dtype=np.int32).reshape(-1, 2)
    costs = np.array([max(cost, 1e-6) for row in ahead for cost in row.values()])  # a zero would be no way
    graph = csr_array((costs, (ends[:, 0], ends[:, 1])), shape=(count, count))
    found = np.zeros((count + 1, count + 1), dtype=np.float32)
    for begin in range(0, count, 500):  # in parts: scipy answers in double precision
        rows = np.arange(begin, min(begin + 500, count), dtype=np.int32)
        found[rows, :count] = np.minimum(dijkstra(graph, indices=rows), _NEVER)
    return found


def _nearest_neighbours(distances: Distances, start: int) -> Numbers:
    left = np.ones(len(distances) - 1, dtype=np.bool_)
    order = [start]
    for _ in range(len(left) - 1):
        left[order[-1]] = False
        order.append(int(np.where(left, distances[order[-1], :-1], np.inf).argmin()))
    return np.array(order, dtype=np.int64)
