"""What a map that is known says to the hypotheses: files of earlier versions, and maps that are given."""

from collections.abc import Mapping, Sequence

from ..inference import NOWHERE, Place, Share, Way
from ..model import BLOCKED, OPEN, CognitiveMap
from .sensing import Sensing

MOST = 8.0  # readings of a sight that a map is worth at most; counts that were learned at other rates would be more


def records_of(map_: CognitiveMap, sensing: Sensing) -> tuple[dict[int, Place], dict[int, int]]:
    """The visited places of a map as records, and the place of the map that each of them is."""
    places = dict(enumerate(map_.visited_places.tolist()))
    numbers = {place: number for number, place in places.items()}
    ways = {number: _ways(map_, place, numbers, sensing.actions) for number, place in places.items()}
    into: dict[int, set[tuple[int, int]]] = {number: set() for number in places}
    for number, own in ways.items():
        for index, way in enumerate(own):
            if way.to != NOWHERE and way.walks:
                into[way.to].add((number, index))
    records = {
        number: Place(
            _sights(map_, place, sensing.scheme.sensors),
            ways[number],
            0,
            map_.position(place) or () if sensing.scheme.displacements else (),
            (number,),
            frozenset(into[number]),
            Share(),
        )
        for number, place in places.items()
    }
    return records, places


def _sights(map_: CognitiveMap, place: int, sensors: int) -> tuple[dict[int, float], ...]:
    unit = map_.rates.likelihood or 1.0
    found = [
        {label: min(count / unit, MOST) for label, count in sensor.table.counts(place).items() if count > 0.0}
        for sensor in map_.sights_sensed
    ]
    return tuple(found) or ({},) * sensors


def _ways(map_: CognitiveMap, place: int, numbers: Mapping[int, int], actions: Sequence[int]) -> tuple[Way, ...]:
    ways: list[Way] = []
    for action in actions:
        sensed, walked = map_.sensed[place, action], bool(map_.walked[place, action])
        opened, blocked = float(sensed == OPEN or walked), float(sensed == BLOCKED)
        beyond = map_.beyond(place, action) if walked else None
        to = NOWHERE if beyond is None else numbers.get(beyond, NOWHERE)
        ways.append(Way(opened - blocked, opened, blocked, int(to != NOWHERE), to))
    return tuple(ways) or (Way(),)
