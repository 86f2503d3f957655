"""Has the map say what the most probable hypothesis says."""

from collections.abc import Collection, Iterable, Mapping, Sequence
from math import inf
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..inference import NOWHERE, Hypothesis, Place, label_probabilities, open_probability, together, whereabouts
from ..model import CognitiveMap, Column, Growth, Position, Ways, Whereabouts
from .counterparts import Counterparts
from .doors import Doors
from .fading import Counts, fade_to, left_of, still_there, unheard

SMALL = 64
"""Places of a map that is built anew, and so put into order, whenever one of them is gone."""

WALKS = 3  # Walks along a way from which on more of them add nothing to its counts
SURE = 0.9  # From this probability on a way is taken to be open, or shut


class Journal(dict[int, Any]):
    """A dict that can go back to how it was when it began to take notes; nothing is ever taken out of it."""

    notes: list[tuple[int, Any]] | None = None

    def __setitem__(self, key: int, value: Any) -> None:
        if self.notes is not None:
            self.notes.append((key, self.get(key)))
        super().__setitem__(key, value)

    def go_back(self) -> None:
        """Forget what was set since."""
        for key, old in reversed(self.notes or ()):
            if old is None:
                self.pop(key, None)
            else:
                super().__setitem__(key, old)
        self.notes = None


Point = tuple[Journal, Journal, frozenset[int], Any]


class Mirror:
    """The places of a hypothesis, and what it knows of them, in a map.

    Attributes:
        places: by number of a place of the hypothesis, the place of the map.
        missed: the places of the hypothesis of which the map was not taught what the last steps said.
        ways: what teaches the map which ways are open.
        counterparts: the same rooms in other contexts; `places` are those of the one that the agent is in.
    """

    def __init__(self, map_: CognitiveMap, growth: Growth, actions: Sequence[int]) -> None:
        self._map, self._growth, self._actions = map_, growth, actions
        self.places: dict[int, int] = {}
        self.missed: set[int] = set()
        self._records: dict[int, Place] = {}
        self._stamp: Any = None  # of the hypothesis of which these are the records
        found = [sensor for sensor in map_.sensors.values() if isinstance(sensor, Ways)]
        self.ways = found[0] if found else map_.unsensed_ways()
        self.counterparts = Counterparts(map_, growth, self.ways)

    @property
    def in_order(self) -> tuple[int, ...]:
        """The places of the map, in the order of those of the hypothesis."""
        return tuple(self.places[number] for number in sorted(self.places))

    # -- reading -------------------------------------------------------------------------------------------

    def position(self, h: Hypothesis, number: int) -> Position | None:
        """The position of a place of the hypothesis, as the pose of the map has it; None without poses."""
        return self._at(h.places[number].frame, h.places[number].position)

    def _at(self, frame: int, position: Position) -> Position | None:
        return None if self._map.pose.origin is None else position if frame == 0 else (*position, frame)

    def action(self, way: int) -> str:
        """The name of the action that takes a way."""
        return self._map.motions.names[self._actions[way]]

    def place(self, h: Hypothesis) -> int | None:
        """The place of the map where a hypothesis has the agent; None for one that the map does not have."""
        return self._place(h, h.here)

    def grows(self, h: Hypothesis, place: int) -> bool:
        """Whether a step that only adds to the map leads to `place` of it, as the hypothesis has it."""
        known = self.places.get(h.here)
        if known is not None:
            return known == place
        at = self.position(h, h.here)
        alone = not self._map.visited[place] and (at is None or self._map.pose.place_at(at) == place)
        return alone and not self._off(h)

    def holds(self, h: Hypothesis, place: int) -> bool:
        """Whether `place` of the map is one of those where a hypothesis that has lost the agent may have it."""
        return any(self._place(h, number) == place for number in whereabouts(h))

    def _off(self, h: Hypothesis) -> bool:
        """Whether the agent came to the place where it is by a way that leads where the pose does not say."""
        if h.scheme.displacements is None:
            return False
        here = h.places[h.here]
        return any(h.beyond(h.places[source], way) != (here.frame, here.position) for source, way in here.into)

    def belief(self, hypotheses: Sequence[tuple[Hypothesis, float]], *, here: int) -> tuple[dict[int, float], float]:
        """Mass of the places of the map where the agent may be, and that of the hypotheses that have it elsewhere.

        Args:
            hypotheses: with their probabilities, the one that the map says first.
            here: the place of the map where the first one has the agent.
        """
        best = hypotheses[0][0]
        mass, elsewhere = dict[int, float](), 0.0
        for h, p in hypotheses:
            if h.crowd is None and best.crowd is None and together(h, best):
                mass[here] = mass.get(here, 0.0) + p
                continue
            for number, share in whereabouts(h).items():
                same = number == best.here and self._key(h, number) == self._key(best, number)
                place = here if same else self._place(h, number)
                if place is None:
                    elsewhere += p * share
                else:
                    mass[place] = mass.get(place, 0.0) + p * share
        return mass, elsewhere

    def _key(self, h: Hypothesis, number: int) -> tuple[int, Position]:
        record = h.places[number]
        return record.frame, record.position

    def _place(self, h: Hypothesis, number: int) -> int | None:
        """The place of the map that a place of a hypothesis is; None where the map does not have it."""
        known = self._records.get(number)
        same = known is not None and (known.frame, known.position) == self._key(h, number)
        return self.places.get(number) if same else None

    def steps_in(self, place: int) -> tuple[int, ...]:
        """The last steps at which the agent was in a place of the map, if the map is right; a handful at most."""
        numbers = [number for number, at in self.places.items() if at == place]
        return self._records[numbers[0]].recent if numbers and numbers[0] in self._records else ()

    def doors(self, h: Hypothesis, number: int) -> Doors:
        """For each action whether its way is believed open, or how much so; None where nothing is known of it."""
        map_, record = self._map, h.places[number]
        doors: list[bool | float | None] = [False] * len(map_.motions)  # ways that nobody thinks of are shut
        doors[map_.motions.stay] = True
        for way in h.awake:
            known = record.ways[way]
            heard = known.net or known.walks or h.neighbour(record, way) != NOWHERE
            doors[self._actions[way]] = _sure(open_probability(h, number, way)) if heard else None
        place = self.places.get(number)
        return tuple(doors) if place is None else self.counterparts.corrected(place, tuple(doors))

    def one_way(self, h: Hypothesis, number: int) -> tuple[int, ...]:
        """The actions whose ways from a place are no way back: what is known of one side says nothing of the other.

        They are believed open on one side and shut on the other, or walks from there lead, or came from, elsewhere.
        """
        record, inverse = h.places[number], h.scheme.inverse
        if inverse is None:
            return ()
        come = {(inverse[by], source) for source, by in record.into}
        found: list[int] = []
        for way in h.awake:
            known, other = record.ways[way], h.neighbour(record, way)
            if other == NOWHERE:
                continue
            back = h.places[other].ways[inverse[way]]
            here, there = open_probability(h, number, way), open_probability(h, other, inverse[way])
            crooked = known.to != NOWHERE and any(by == way and source != known.to for by, source in come)
            if (here > 0.5) != (there > 0.5) or back.to not in (NOWHERE, number) or crooked:
                found.append(self._actions[way])
        return tuple(found)

    # -- following -----------------------------------------------------------------------------------------

    def grown(self, h: Hypothesis, place: int, touched: Iterable[int]) -> None:
        """The map was taught the last step already: take note of it.

        Args:
            h: the hypothesis.
            place: the place of the map where it has the agent.
            touched: the places of the hypothesis that the step has changed.
        """
        self.places[h.here] = place
        self._note(h, touched)

    def miss(self, h: Hypothesis, touched: Iterable[int]) -> None:
        """The map was not taught the last step."""
        self.missed |= {h.here, *touched}
        self._note(h, touched)

    def _note(self, h: Hypothesis, touched: Iterable[int]) -> None:
        for number in {h.here, *touched}:
            self._records[number] = h.places[number]
        self._stamp = h.places.stamp

    def follow(self, h: Hypothesis, *, step: int) -> dict[int, int] | None:
        """Have the map say what the hypothesis says.

        Returns:
            Where the places of the map are now that it was built anew, those that are gone left out; None where only
            what is known of its places has changed.
        """
        before, records, asked = self.places, self._records, self._asked(h)
        gone = [number for number in asked if number in before and self._elsewhere(h, number)]
        beside = self._take_away(gone, step=step) if gone else set[int]()
        changed = [k for k in sorted(beside.union(asked)) if h.places.get(k) is not None and self._differs(h, k)]
        if (gone and not beside) or not self._fits(h, changed):
            moved = self._rebuild(h, before, records, step=step)
            self._records = {number: h.places[number] for number in h.places}
        else:
            self._change(h, changed, step=step)
            same = still_there(h, records, before, among=asked) if gone else {}
            moved = {before[old]: self.places[number] for old, number in same.items()} if gone else None
        self._stamp, self.missed = h.places.stamp, set()
        return moved

    def _asked(self, h: Hypothesis) -> Sequence[int]:
        """The places of which something else may be known than the map says, or which there are not any more."""
        changed = None if self._stamp is None else h.places.changed_since(self._stamp)
        return sorted({*h.places, *self.places} if changed is None else changed | self.missed)

    def _elsewhere(self, h: Hypothesis, number: int) -> bool:
        """Whether there is no such place any more, or not where the map has it."""
        at = None if h.places.get(number) is None else self.position(h, number)
        return h.places.get(number) is None or (at is not None and self._map.pose.place_at(at) != self.places[number])

    def _change(self, h: Hypothesis, changed: Sequence[int], *, step: int) -> None:
        """Have the map say of some places what the hypothesis says, and of the others what it says already."""
        for number in changed:
            if number not in self.places:
                self._add(h, number, step=step)
        for number in changed:
            self._map.blank(self.places[number])
        self._teach(h, changed, step=step)
        for number in {*changed} - self._records.keys():
            self._lead_back(h, number, {*changed})
        self._note(h, changed)

    def _differs(self, h: Hypothesis, number: int) -> bool:
        now, before = h.places[number], self._records.get(number)
        return number in self.missed or (now is not before and now != before)

    def _take_away(self, gone: Collection[int], *, step: int) -> set[int]:
        """Take all places from the end of the map, up to the first of those that are gone.

        Returns:
            Which of those that are left or taken away are to be taught anew; none where that cannot be, or the map is
            small: then it is to be built anew, which gives its places numbers in order.
        """
        map_, first = self._map, min(self.places[number] for number in gone)
        size, order = len(map_.motions), map_.visits.order.values
        since = {number for number, place in self.places.items() if place >= first}
        last = {self.places[number] for number in since} == {*order[len(order) - len(since) :].tolist()}
        alone = last and map_.visited[first:].sum() == len(since) and not self._kept() and not map_.transitions.fading
        if not alone or first <= max(SMALL, len(map_.places) // 2):
            return set()
        rows, _ = np.nonzero(map_.B_s.keys(slice(first * size)) >= first)
        beside = {*(rows // size).tolist()}
        imagined = [place for place in beside if not map_.visited[place]]
        if not all(self._entered(place, -1, before=first) for place in imagined):
            return set()
        map_.clear(step=step, first=first)
        for place in sorted(beside):
            map_.blank(place)
            for action, neighbour in map_.pose.neighbours(place):
                map_.transitions.link(place, action, neighbour)
                if not map_.visited[place]:
                    beside.add(neighbour)
        self.places = {number: place for number, place in self.places.items() if place < first}
        near = {number for number, place in self.places.items() if place in beside}
        known = self.places.keys() - near  # of those beside the map says nothing any more
        self._records = {number: record for number, record in self._records.items() if number in known}
        return near | since

    def _fits(self, h: Hypothesis, changed: Sequence[int]) -> bool:
        """Whether no place of the map is elsewhere than the hypothesis has it."""
        map_ = self._map
        if not self.places or h.periods.get(0, ()) != map_.pose.periods or map_.pose.origin is None:
            return False
        for number in {*changed, h.here}:
            at, place = self.position(h, number), self.places.get(number)
            there = None if at is None else map_.pose.place_at(at)
            if place is None and there is not None and (map_.visited[there] or there in self.places.values()):
                return False
            if place is not None and there != place:
                return False
            if not self._leads_there(h, number, place):
                return False
        return True

    def _leads_there(self, h: Hypothesis, number: int, place: int | None, *, told: bool = False) -> bool:
        """Whether the ways of a place lead to where the pose says, and none that is shut to a place only imagined.

        With `told` a way may lead elsewhere if that is where the map has it lead.
        """
        record, map_ = h.places[number], self._map
        for way in h.awake:
            action, to = self._actions[way], record.ways[way].to
            if to != NOWHERE and h.scheme.displacements is not None:
                as_told = told and place is not None and map_.beyond(place, action) == self.places.get(to)
                if not as_told and h.beyond(record, way) != (h.places[to].frame, h.places[to].position):
                    return False
            elif place is not None and to == NOWHERE and open_probability(h, number, way) < 0.5:
                beyond = map_.beyond(place, action)
                if beyond is not None and not map_.visited[beyond] and not self._entered(beyond, place):
                    return False
        return True

    def _entered(self, imagined: int, place: int, *, before: float = inf) -> bool:
        """Whether an open way leads to an imagined place from another one than `place`, of those `before` a number."""
        map_ = self._map
        for action, neighbour in map_.pose.neighbours(imagined):
            back = np.array([map_.row(neighbour, map_.motions.inverse[action])])
            there = neighbour != place and neighbour < before
            if there and map_.visited[neighbour] and map_.B_s.probability(imagined, back)[0] > 0.5:
                return True
        return False

    def outdated(self, h: Hypothesis) -> bool:
        """Whether a way of the place where the agent is leads elsewhere than the map has it, or is now believed shut
        and was all that led to an imagined place."""
        place = self.places.get(h.here)
        return place is not None and not self._leads_there(h, h.here, place, told=True)

    # -- building ------------------------------------------------------------------------------------------

    def _rebuild(
        self, h: Hypothesis, before: Mapping[int, int], records: Mapping[int, Place], *, step: int
    ) -> dict[int, int]:
        same, kept = still_there(h, records, before), self._kept()
        faded = self._faded(h, same, step=step) if self._map.transitions.fading else {}
        self._map.clear(step=step)
        self._map.pose.close(h.periods.get(0, ()))
        self.places = {}
        numbers = sorted(h.places)
        for number in numbers:
            self._add(h, number, step=step)
        for old, number in same.items():
            self._give_back(kept, before[old], self.places[number])
        self.counterparts.rebuilt(self.places.values(), here=self.places[h.here], step=step)
        self._teach(h, numbers, step=step)
        for (number, action), counts in faded.items():
            fade_to(self._map, self.places[number], action, counts)
        for place in self.places.values():
            self.counterparts.share(place, step=step)
        return {before[old]: self.places[number] for old, number in same.items()}

    def _faded(self, h: Hypothesis, same: Mapping[int, int], *, step: int) -> dict[tuple[int, int], Counts]:
        """By number of a place and action, the counts of ways of which this step says nothing."""
        ways = [(old, way) for old, way in unheard(h, self._records, same, step) if old not in self.missed]
        return {
            (same[old], self._actions[way]): left_of(self._map, self.places[old], self._actions[way])
            for old, way in ways
        }

    def _ahead(self, source: int, way: int) -> Position | None:
        """Where a way leads as the pose of the map has it."""
        return self._map.pose.ahead(self.places[source], self._actions[way])[0]

    def _kept(self) -> dict[Column, NDArray[Any]]:
        """What sensors hold of places that are neither sights nor ways, of which hypotheses have no records."""
        known = {*self._map.sights_sensed, self.ways}
        stores = [store for sensor in self._map.sensors.values() if sensor not in known for store in sensor.stores]
        return {store: store.values.copy() for store in stores if isinstance(store, Column)}

    def _give_back(self, kept: Mapping[Column, NDArray[Any]], before: int, now: int) -> None:
        for store, values in kept.items():
            row = values[before]
            for at in np.ndindex(row.shape):
                store.set((now, *at) if at else now, row[at].item())

    def _add(self, h: Hypothesis, number: int, *, step: int) -> None:
        """A place of the map for one of the hypothesis: an imagined one, if there is one where it is."""
        map_, at = self._map, self.position(h, number)
        if not len(map_.places) and at == map_.pose.origin:
            self.places[number] = self._growth.begin(map_, step=step)[0]
            return
        there = None if at is None else map_.pose.place_at(at)
        for source, way in sorted(h.places[number].into):
            if there is None and source in self.places and self._ahead(source, way) == at is not None:
                self._growth.enter(map_, Whereabouts({self.places[source]: 1.0}), self._actions[way], step=step)
                there = map_.pose.place_at(at)
        self.places[number] = map_.new_place(at, step=step) if there is None else there

    def _teach(self, h: Hypothesis, numbers: Sequence[int], *, step: int) -> None:
        """What the hypothesis knows of places that the map knows nothing of."""
        map_ = self._map
        for number in numbers:
            place = self.places[number]
            map_.mark_visited(place)
            self._link(h, number)
        for number in numbers:
            place, doors = self.places[number], self.doors(h, number)
            map_.recall(self._growth.look(map_, Whereabouts({place: 1.0}), self.counterparts.beyond(doors), step=step))
            self._teach_place(h, number, doors)
        for number in numbers:
            self._walk(h, number)

    def _link(self, h: Hypothesis, number: int) -> None:
        """Name what lies beyond the ways of a place: what poses say, but for the ways that lead elsewhere."""
        map_, place, record = self._map, self.places[number], h.places[number]
        leads = dict(map_.pose.neighbours(place))
        for way in h.awake:
            to = h.neighbour(record, way)
            if to != NOWHERE and to in self.places:
                leads[self._actions[way]] = self.places[to]
        for action, neighbour in leads.items():
            if map_.beyond(place, action) != neighbour:
                map_.transitions.lead(place, action, neighbour)

    def _teach_place(self, h: Hypothesis, number: int, doors: Doors) -> None:
        map_, place, record = self._map, self.places[number], h.places[number]
        for at, (sensor, counts) in enumerate(zip(map_.sights_sensed, record.sights, strict=False)):
            sure = not any(count % 1.0 for count in counts.values())
            p = {} if sure else label_probabilities(h, number, sensor=at)
            for label, count in counts.items():
                sensor.learn(place, label, count if sure else p[label] * len(record.recent))
        map_.pose.learn(place, float(len(record.recent)))
        self.ways.learn(place, doors, 1.0, one_way=self.one_way(h, number))

    def _walk(self, h: Hypothesis, number: int) -> None:
        map_, place, one_way = self._map, self.places[number], self.one_way(h, number)
        for way in h.awake:
            action, known = self._actions[way], h.places[number].ways[way]
            if known.walks and known.to != NOWHERE and open_probability(h, number, way) > 0.5:
                for _ in range(min(known.walks, WALKS)):
                    map_.transitions.learn(place, action, self.places[known.to], 1.0, back=action not in one_way)

    def _lead_back(self, h: Hypothesis, number: int, taught: Collection[int]) -> None:
        """What walks to a place of which the map knew nothing any more say of its ways back, but for those taught."""
        map_, inverse = self._map, self._map.motions.inverse
        for source, way in sorted(h.places[number].into):
            action, known = self._actions[way], h.places[source].ways[way]
            leads = source not in taught and known.to == number and known.walks and inverse[action] >= 0
            if leads and action not in self.one_way(h, source):
                amount = min(known.walks, WALKS) * map_.rates.possible[1]
                map_.transitions.add(self.places[source], self.places[number], inverse[action], amount)

    # -- going back ----------------------------------------------------------------------------------------

    def savepoint(self) -> Point:
        """What `go_back` needs: which place is which, and what was known of each."""
        if not isinstance(self.places, Journal):
            self.places = Journal(self.places)
        if not isinstance(self._records, Journal):
            self._records = Journal(self._records)
        self.places.notes, self._records.notes = [], []
        return self.places, self._records, frozenset(self.missed), self._stamp

    def go_back(self, point: Point) -> None:
        """Be as it was."""
        self.places, self._records, missed, self._stamp = point
        self.places.go_back()
        self._records.go_back()
        self.missed = set(missed)

    # -- files ---------------------------------------------------------------------------------------------

    def restore(self, h: Hypothesis, places: Mapping[int, int], *, missed: Iterable[int] = ()) -> None:
        """Take over which place is which, as the map has them, and of which it was not taught the last steps."""
        self.places, self.missed = dict(places), set(missed)
        self._records = {number: h.places[number] for number in h.places}
        self._stamp = h.places.stamp


def _sure(p: float) -> bool | float:
    return p if 1.0 - SURE < p < SURE else p > 0.5
