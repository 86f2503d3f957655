"""What an agent is told to hope for, checked, and as plans weigh it."""

from collections.abc import Hashable, Mapping
from typing import Any, cast

import numpy as np

from ..model import CogmapError, CognitiveMap, is_number
from ..planning import Preferences
from .settings import Settings
from .state import GivenPreferences

LARGEST = 1e9  # of log preferences, in nats


def given_preferences(sights: object, places: object, sensors: object, map_: CognitiveMap) -> GivenPreferences:
    """Log preferences by label of the first sensor, by place, and by sensor and label.

    Raises:
        CogmapError: no mapping, a preference that is no finite number, or a place or a sensor that is not the map's.
    """
    by_sensor = {name: _finite(values) for name, values in _mapping(sensors).items()}
    names = [sensor.name for sensor in map_.sights_sensed]
    if unknown := [name for name in by_sensor if name not in names]:
        known = ", ".join(map(repr, names)) or "none"
        raise CogmapError(f"agent: no sensor {unknown[0]!r} sees labels to prefer; those that do: {known}")
    of_first = by_sensor.pop(names[0]) if names and names[0] in by_sensor else {}
    by_place = _finite(places)
    for place in by_place:
        if place not in map_.places:
            raise CogmapError(f"agent: no place {place!r} to prefer; places are 0 to {len(map_.places) - 1}")
    return GivenPreferences({**_finite(sights), **of_first}, cast(dict[int, float], by_place), by_sensor)


def weighed(preferences: GivenPreferences, map_: CognitiveMap, settings: Settings) -> Preferences:
    """As plans weigh them: labels of further sensors make a place worth as much as it probably shows them."""
    weight = settings.goal_weight
    sights: dict[int, float] = {}
    for label, value in preferences.sights.items():
        known = map_.sights.find(label)
        key = -1 if known is None else known
        sights[key] = max(sights.get(key, -np.inf), weight * value)
    places = {place: weight * value for place, value in preferences.places.items()}
    for sensor in map_.sights_sensed[1:]:
        for label, value in preferences.sensors.get(sensor.name, {}).items():
            number = sensor.labels.find(label)
            if number is None:
                continue
            there, _ = sensor.candidates(number)
            for place, p in zip(there.tolist(), sensor.likelihood(there, number).tolist(), strict=True):
                places[place] = places.get(place, 0.0) + weight * value * p
    return Preferences(sights=sights, places=places, collision_cost=settings.collision_cost)


def _mapping(given: object) -> Mapping[Any, Any]:
    if not isinstance(given, Mapping | None):
        kind = type(given).__name__
        raise CogmapError(f"agent: preferences are a {kind}; give a mapping to log preferences in nats")
    return {} if given is None else cast(Mapping[Any, Any], given)


def _finite(given: object) -> dict[Hashable, float]:
    preferences = dict(_mapping(given))
    for wanted, value in preferences.items():
        if not is_number(value, -LARGEST, LARGEST):
            raise CogmapError(
                f"agent: preference {value!r} of {wanted!r} is not a finite number; give a log preference in nats, "
                f"{LARGEST:g} at most"
            )
    return preferences
