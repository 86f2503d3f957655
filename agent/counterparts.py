"""The same room with something else carried: what is known of it in one context is known in all."""

from collections.abc import Iterable, MutableMapping
from itertools import product

import numpy as np

from ..model import BLOCKED, OPEN, Carried, CognitiveMap, Growth, Locks, Percept, Ways, Whereabouts
from .doors import Doors, passable


class Counterparts:
    """Keeps the places that are one room, a context each, saying the same of it.

    Ways that are locked are open in the context that they take alone, and actions that take something lead to the
    same room in the context that follows. A map without `Carried` it leaves alone.

    Args:
        map_: the map.
        growth: what imagines places behind ways.
        ways: what teaches the map which ways are open.
    """

    def __init__(self, map_: CognitiveMap, growth: Growth, ways: Ways) -> None:
        self._map, self._growth, self._ways = map_, growth, ways
        sensors = map_.sensors.values()
        self._carried = next((sensor for sensor in sensors if isinstance(sensor, Carried)), None)
        self._locks = next((sensor for sensor in sensors if isinstance(sensor, Locks)), None)
        self._now, self._seen = -1, Percept()  # the context that it is in, and what it sensed last

    def note(self, place: int, percept: Percept, *, step: int) -> None:
        """What is carried in a place, what lies there, and what is locked."""
        carried, readings = self._carried, percept.readings
        if carried is None:
            return
        for sensor in (carried, self._locks):
            if sensor is not None and sensor.name in readings:
                sensor.learn(place, readings[sensor.name], 1.0)
        for action, context in carried.takes.items():
            if percept.open is not None and percept.open[action] is not None:
                carried.offers.set((place, context), percept.open[action] == 1)
        for context in self._known() if carried.of.values[place] >= 0 else ():
            self._peer(place, context, step=step)
        self._lead(place)

    def corrected(self, place: int, doors: Doors) -> Doors:
        """What a room's ways are in the context of a place: its own actions lead on, or are locked."""
        carried = self._carried
        if carried is None or carried.of.values[place] < 0:
            return doors
        found, mine, known = list(doors), int(carried.of.values[place]), self._known()
        for action, context in carried.takes.items():
            found[action] = bool(context != mine and context in known and carried.offers.values[place, context])
        if self._locks is not None:
            for action in np.flatnonzero(self._locks.needs.values[place] >= 0).tolist():
                found[action] = bool(self._locks.needs.values[place, action] == mine)
        return tuple(found)

    def beyond(self, doors: Doors) -> tuple[bool, ...]:
        """For each action whether a place may be imagined beyond: those that take something lead to a known room."""
        takes = () if self._carried is None else self._carried.takes
        return tuple(is_open and action not in takes for action, is_open in enumerate(passable(doors)))

    def share(self, place: int, *, step: int) -> None:
        """Have the counterparts of a place know what it knows; and those of other rooms, where there were none yet."""
        carried, map_ = self._carried, self._map
        if carried is None or (mine := int(carried.of.values[place])) < 0:
            return
        contexts = sorted(self._known() - {mine})
        here = np.flatnonzero((carried.of.values == mine) & map_.visited)
        new = here[(carried.peers.values[here][:, contexts] < 0).any(axis=1)].tolist()
        rooms = [*new, *([] if place in new else [place])]
        for room, context in product(rooms, contexts):
            self._peer(room, context, step=step)
        for room in new:
            self._lead(room)
            takes: list[bool | None] = [None] * len(map_.motions)
            for action in carried.takes:
                takes[action] = bool(self.corrected(room, tuple(takes))[action])
            self._ways.learn(room, tuple(takes), 1.0)
        for room, context in product(rooms, contexts):
            self._copy(room, context, step=step)

    def turn(self, places: MutableMapping[int, int], percept: Percept, *, step: int) -> None:
        """Have these places be those of the context that is sensed, where it has changed.

        Args:
            places: places of the map, by whatever.
            percept: what is sensed now.
            step: the time step.
        """
        carried, self._seen = self._carried, percept
        shares = None if carried is None else percept.readings.get(carried.name)
        if carried is None or shares is None or sum(share > 0.0 for share in shares) != 1:
            return
        now = self._now = shares.index(1.0)
        for key, place in list(places.items()):
            if carried.of.values[place] not in (now, -1):
                if carried.peers.values[place, now] < 0:
                    self._copy(place, now, step=step)
                places[key] = int(carried.peers.values[place, now])

    def rebuilt(self, places: Iterable[int], *, here: int, step: int) -> None:
        """The map was built anew of these places alone, as the agent sees them now, `here`."""
        carried = self._carried
        if carried is None:
            return
        for place in places:
            for context in range(len(carried.values)):
                carried.peers.set((place, context), -1)
            of = int(carried.of.values[place])
            carried.settle(place, self._now if of < 0 else of)
        self.note(here, self._seen, step=step)

    # -- the work ------------------------------------------------------------------------------------------

    def _known(self) -> set[int]:
        """Contexts that the agent was in, or may get into and needs somewhere."""
        carried, visited = self._carried, self._map.visited
        assert carried is not None
        found = set(carried.of.values[visited].tolist()) - {-1}
        if self._locks is not None:
            needed = set(self._locks.needs.values.ravel().tolist()) - {-1}
            found |= needed & set(np.flatnonzero(carried.offers.values.any(axis=0)).tolist())
        return found

    def _peer(self, place: int, context: int, *, step: int) -> int:
        """The place of the same room in a context; imagined where there is none."""
        carried = self._carried
        assert carried is not None
        if (known := int(carried.peers.values[place, context])) >= 0:
            return known
        new = self._map.new_place(step=step)
        row = carried.peers.values[place].copy()
        row[context] = new
        carried.settle(new, context)
        for at, peer in enumerate(row.tolist()):
            if peer >= 0:
                carried.peers.set((new, at), peer)
                carried.peers.set((peer, context), new)
        return new

    def _copy(self, place: int, context: int, *, step: int) -> None:
        """Have the counterpart of a place know of its room what the place knows."""
        map_, twin, motions = self._map, self._peer(place, context, step=step), self._map.motions
        assert self._carried is not None
        if map_.visited[place]:
            map_.mark_visited(twin)
        for action, beyond in enumerate(map_.transitions.targets(np.array([place]))[0].tolist()):
            if beyond >= 0 and action not in (motions.stay, *self._carried.takes):
                there = self._peer(beyond, context, step=step)
                map_.transitions.lead(twin, action, there)
                if motions.inverse[action] >= 0:
                    map_.transitions.lead(there, motions.inverse[action], twin)
        for sensor in map_.sights_sensed:
            for label, count in sensor.table.counts(place).items():
                sensor.table.add(twin, label, count - sensor.table.evidence(twin, label))
        for store in (self._carried.offers, *(() if self._locks is None else (self._locks.needs,))):
            for at, value in enumerate(store.values[place].tolist()):
                store.set((twin, at), value)
        self._lead(twin)
        sensed = map_.sensed[place].tolist()
        doors: Doors = tuple(None if known not in (OPEN, BLOCKED) else known == OPEN for known in sensed)
        doors = self.corrected(twin, doors)
        map_.recall(self._growth.look(map_, Whereabouts({twin: 1.0}), self._imagined(doors), step=step))
        self._ways.learn(twin, doors, 1.0)

    def _imagined(self, doors: Doors) -> tuple[bool, ...]:
        return tuple(is_open and door is not None for is_open, door in zip(self.beyond(doors), doors, strict=True))

    def _lead(self, place: int) -> None:
        """What is taken in a place leads to its counterparts."""
        carried, known = self._carried, self._known()
        assert carried is not None
        for action, context in carried.takes.items():
            there = int(carried.peers.values[place, context])
            if context in known and carried.offers.values[place, context] and there not in (-1, place):
                self._map.transitions.lead(place, action, there)
