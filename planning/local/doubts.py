"""Ways that are only thought to lead where they do, kept from plan to plan until something changes at their place."""

from .view import MapView

GREAT = 1.0  # nats of doubt for which a longer way is taken


class Doubts:
    """The ways of one map that are worth seeing about, by place; costs what has changed.

    Where places lie as they were measured, all of them once anything has: a guess is made of the places at both ends
    and of how long ways are elsewhere.

    Args:
        map_: the map.
    """

    __slots__ = ("_great", "_map", "_of", "_read")

    def __init__(self, map_: MapView) -> None:
        self._map, self._read = map_, -1  # of the log of changes
        self._of: dict[int, list[tuple[int, float]]] = {}
        self._great = set[int]()  # places with a way that is greatly in doubt

    def read(self) -> tuple[dict[int, list[tuple[int, float]]], bool]:
        """For each place with such ways the action and the doubt of each; and whether any doubt is great."""
        map_ = self._map
        stores = map_.B_s, map_.visits, map_.transitions.walked, *map_.pose.stores
        changed, self._read = map_.changed_places(self._read, *stores)
        if changed and map_.pose.measures:
            changed = None
        if changed is None:
            self._of.clear()
            self._great.clear()
        for place in changed or ():
            self._of.pop(place, None)
            self._great.discard(place)
        for place, action, doubt in map_.pose.guessed(map_.transitions, None if changed is None else sorted(changed)):
            self._of.setdefault(place, []).append((action, doubt))
            if doubt > GREAT:
                self._great.add(place)
        return self._of, bool(self._great)
