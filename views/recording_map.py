"""The map of a recording: what changed at each step, and the map rebuilt from that."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ..agent import Agent
from ..model import BLOCKED, OPEN, CognitiveMap

if TYPE_CHECKING:
    import networkx as nx

NOTICEABLE = 5e-4
"""A transition is written again once its probability differs by that much from the one written last."""

DIGITS = 4
"""Of a probability in the file."""

KNOWN = ("unknown", "imagined", "walked", "refuted")
"""How a transition is known, as in `CognitiveMap.to_networkx`; the file has the index."""

Place = tuple[tuple[int, ...] | None, bool, int | None, float]
"""Position, whether it was visited, number of the most probable sight (None before the first look), its probability."""

Row = tuple[int, tuple[tuple[int, float], ...]]
"""How a transition is known (index of `KNOWN`), and the next places with their probabilities."""


@dataclass(slots=True)
class MapPicture:
    """What a recording says of the map after some step.

    Attributes:
        places: by number.
        rows: by place and action.
    """

    places: list[Place] = field(default_factory=list[Place])
    rows: dict[tuple[int, int], Row] = field(default_factory=dict[tuple[int, int], Row])

    def apply(self, delta: Mapping[str, Any]) -> None:
        """Take up what changed at the next step."""
        size = delta.get("size", len(self.places))
        if size < len(self.places):
            self.places = self.places[:size]
            self.rows = {key: row for key, row in self.rows.items() if key[0] < size}
        for place, position, visited, sight, probability in delta.get("places", ()):
            entry = (None if position is None else tuple(position), bool(visited), sight, probability)
            if place == len(self.places):
                self.places.append(entry)
            else:
                self.places[place] = entry
        for place, action, known, *ways in delta.get("ways", ()):
            self.rows[place, action] = known, tuple(zip(ways[::2], ways[1::2], strict=True))

    def to_networkx(self, actions: Sequence[str], sights: Sequence[object]) -> nx.MultiDiGraph[Any]:
        """As `CognitiveMap.to_networkx`, with the most probable sight alone, and rounded.

        Args:
            actions: their names.
            sights: their labels.
        """
        import networkx as nx

        graph: nx.MultiDiGraph[Any] = nx.MultiDiGraph()
        for number, (position, visited, sight, probability) in enumerate(self.places):
            seen = {} if sight is None else {sights[sight]: probability}
            graph.add_node(number, position=position, visited=visited, sights=seen)
        for (place, action), (known, ways) in self.rows.items():
            name = actions[action]
            for next_, probability in ways:
                graph.add_edge(place, next_, key=name, action=name, probability=probability, known=KNOWN[known])
        return graph


class MapWatch:
    """Tells what changed in a map, from the agent's own account of each step."""

    def __init__(self) -> None:
        self._shown = MapPicture()
        self._step = -1
        self._certain = False
        self._p = np.zeros((0, 0))

    def delta(self, agent: Agent) -> dict[str, Any]:
        """What changed since the last call, as JSON values."""
        map_, record = agent.map, agent.trace[-1]
        caught_up = record.certain and not self._certain
        touched: set[int] | range = map_.places  # what was taken back or caught up with may lie anywhere
        if record.step == self._step + 1 and record.retracted is None and not caught_up:
            touched = _touched(agent)
            if agent.settings.forgetting:
                touched |= self._faded(map_)
        self._step, self._certain = record.step, record.certain
        delta = self._compare(map_, np.fromiter(sorted(touched), dtype=np.int64))
        if len(map_.places) != len(self._shown.places):
            delta["size"] = len(map_.places)
        self._shown.apply(delta)
        return delta

    def _faded(self, map_: CognitiveMap) -> set[int]:
        """The places whose transitions have faded noticeably since they were last found to have."""
        _, p, _ = map_.B_s.mean(np.arange(len(map_.B_s)))
        if p.shape[1] != self._p.shape[1]:
            self._p = p
            return set(map_.places)
        changed = np.ones(len(p), dtype=np.bool_)
        both = min(len(p), len(self._p))
        changed[:both] = (np.abs(p[:both] - self._p[:both]) >= NOTICEABLE / 2).any(axis=1)
        self._p = np.where(changed[:, None], p, np.resize(self._p, p.shape))
        return set((np.flatnonzero(changed) // len(map_.motions)).tolist())

    def _compare(self, map_: CognitiveMap, touched: np.ndarray[Any, np.dtype[np.int64]]) -> dict[str, Any]:
        shown, delta = self._shown, dict[str, Any]()
        known = _known(map_, touched).ravel().tolist()
        size = len(map_.motions)
        keys, p, _ = map_.B_s.mean((touched[:, None] * size + np.arange(size)).ravel())
        places = [[place, *entry] for place, entry in _entries(map_, touched) if not _same(shown.places, place, entry)]
        ways: list[list[float]] = []
        for at, (next_, probability) in enumerate(zip(keys.tolist(), p.tolist(), strict=True)):
            key = int(touched[at // size]), at % size
            row = known[at], tuple((k, q) for k, q in zip(next_, probability, strict=True) if k >= 0)
            if _noticeable(shown.rows.get(key), row):
                ways.append([*key, row[0], *(part for k, q in row[1] for part in (k, round(q, DIGITS)))])
        if places:
            delta["places"] = places
        if ways:
            delta["ways"] = ways
        return delta


def _touched(agent: Agent) -> set[int]:
    """The places of which anything may have changed at the last step."""
    map_, record = agent.map, agent.trace[-1]
    touched = {agent.belief.place, *(lesson.place for lesson in record.learned)}
    for part in agent.belief.pairwise[:2]:
        touched.update(part.tolist())
    for event in record.grown:
        if event.kind in ("place", "bind", "unbind"):
            touched.add(event.index)
    for place in [event.index for event in record.grown if event.kind in ("place", "bind")]:
        position = map_.position(place)
        if position is not None:
            around = (map_.place_at(map_.motions.move(position, action)) for action in range(len(map_.motions)))
            touched.update(there for there in around if there is not None)
    return touched


def _known(map_: CognitiveMap, places: np.ndarray[Any, np.dtype[np.int64]]) -> np.ndarray[Any, np.dtype[np.int64]]:
    sensed = map_.sensed[places]
    known = np.where(map_.walked[places], 2, np.where(sensed == OPEN, 1, 0))
    known[sensed == BLOCKED] = 3
    known[:, map_.motions.stay] = 2
    return known


def _entries(map_: CognitiveMap, places: np.ndarray[Any, np.dtype[np.int64]]) -> list[tuple[int, Place]]:
    keys, p, _ = map_.A_o.mean(places)
    found: list[tuple[int, Place]] = []
    for place, sights, likely in zip(places.tolist(), keys.tolist(), p.tolist(), strict=True):
        probability, sight = max((q, k) for k, q in zip(sights, likely, strict=True))
        seen = sight >= 0
        entry = map_.position(place), bool(map_.visited[place]), sight if seen else None
        found.append((place, (*entry, round(probability, DIGITS) if seen else 0.0)))
    return found


def _same(places: Sequence[Place], place: int, entry: Place) -> bool:
    return place < len(places) and places[place] == entry


def _noticeable(before: Row | None, now: Row) -> bool:
    if before is None or before[0] != now[0] or [k for k, _ in before[1]] != [k for k, _ in now[1]]:
        return True
    return any(abs(p - q) >= NOTICEABLE for (_, p), (_, q) in zip(before[1], now[1], strict=True))
