"""What is drawn of a map, taken from it once: light enough to keep for every step."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from dataclasses import dataclass

import numpy as np

from ..model import CognitiveMap
from .axes import Cell, flat

LEAST = 0.05  # probabilities below are not drawn


@dataclass(frozen=True, slots=True)
class PlacePicture:
    """One place.

    Attributes:
        cell: row and column.
        visited: whether it was ever entered.
        sight: the most probable sight; None for a place not visited.
        links: for each other place that some action may lead to, its cell and the probability.
        walls: for each way that may be blocked, its direction (down, right) and P(blocked).
    """

    cell: Cell
    visited: bool
    sight: Hashable
    links: tuple[tuple[Cell, float], ...]
    walls: tuple[tuple[Cell, float], ...]


@dataclass(frozen=True, slots=True)
class MapPicture:
    """A map at one moment.

    Attributes:
        places: by number, those that have a position.
        lost: how many have none.
    """

    places: Mapping[int, PlacePicture]
    lost: int


def picture_of(map_: CognitiveMap, *, before: MapPicture | None = None) -> MapPicture:
    """The picture of a map as it is now; places that are as they were `before` are not kept twice.

    Raises:
        CogmapError: positions of more than two dimensions.
    """
    found = ((place, map_.position(place)) for place in map_.places)
    cells = {place: flat(position) for place, position in found if position is not None}
    keys, p, _ = map_.B_s.mean(np.arange(len(map_.places) * len(map_.motions)))
    sights, q, _ = map_.A_o.mean(np.arange(len(map_.places)))
    places: dict[int, PlacePicture] = {}
    for place, cell in cells.items():
        visited = bool(map_.visited[place])
        sight = map_.sights[int(sights[place, q[place].argmax()])] if visited else None
        links, walls = _ways(map_, place, cells, keys.tolist(), p.tolist())
        picture = PlacePicture(cell, visited, sight, links, walls)
        known = None if before is None else before.places.get(place)
        places[place] = known if known is not None and known == picture else picture
    return MapPicture(places, len(map_.places) - len(cells))


def _ways(
    map_: CognitiveMap, place: int, cells: Mapping[int, Cell], keys: list[list[int]], p: list[list[float]]
) -> tuple[tuple[tuple[Cell, float], ...], tuple[tuple[Cell, float], ...]]:
    """Links and walls. A door of which nothing is known is no wall."""
    links: list[tuple[Cell, float]] = []
    walls: list[tuple[Cell, float]] = []
    for action, vector in enumerate(map_.motions.displacements):
        if action == map_.motions.stay:
            continue
        row, unknown = map_.row(place, action), not map_.sensed[place, action]
        for key, probability in zip(keys[row], p[row], strict=True):
            if probability < LEAST:
                continue
            if key in cells and key != place:
                links.append((cells[key], probability))
            elif key == place and not (unknown and probability <= 0.5):
                walls.append((flat(vector), probability))
    return tuple(links), tuple(walls)
