"""The places of a graph and the ways between them, as arrays: a hundred thousand places take some tens of megabytes."""

import hashlib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from reprlib import repr as shown
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import WorldError
from ..motions import Motions

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Layout:
    """An immutable graph world: the chart of a `GraphWorld`.

    The ways of the i-th place are the entries `first[i]` to `first[i + 1]` of `target`, `ways`, `bearings` and
    `lengths`, in the order in which the agent is told of them.
    """

    name: str  # what the world is called
    places: tuple[Any, ...]  # the ids of the nodes
    sensors: tuple[str, ...]  # names of the sensors
    labels: tuple[tuple[Any, ...], ...]  # of each sensor, the label at each place
    motions: Motions  # the actions
    pose: str  # what is told of a pose; see `POSES`
    first: NDArray[np.int64]  # `[R + 1]`
    target: NDArray[np.int32]  # `[W]` the number of the place that each way leads to
    ways: tuple[Any, ...]  # `[W]` labels, no two alike at one place
    bearings: Floats | None  # `[W]` degrees, 0 is +y, clockwise; None where unknown
    lengths: Floats | None  # `[W]` in the unit of the file; None where unknown
    coordinates: Floats | None  # `[R, 2 or 3]` where each place lies; None where unknown

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Layout) and self._digest == other._digest

    def __hash__(self) -> int:
        return hash(self._digest)

    def __repr__(self) -> str:
        return f"Layout({self.name!r}, {len(self.places)} places, {len(self.ways)} ways, pose {self.pose!r})"

    @property
    def sights(self) -> Mapping[Any, Any]:
        """The label of each place; a tuple of labels where there are several sensors."""
        if len(self.labels) == 1:
            return _Column(self._index, self.labels[0].__getitem__)
        return _Column(self._index, lambda i: tuple(column[i] for column in self.labels))

    @property
    def positions(self) -> Mapping[Any, tuple[float, ...]] | None:
        """Where each place lies; None where nobody knows."""
        where = self.coordinates
        return None if where is None else _Column(self._index, lambda i: tuple(where[i].tolist()))

    def find(self, place: Any) -> Any:
        """`place` as it stands in `places`. Raises WorldError: there is no such place."""
        return self.places[self._number(place)]

    def exits(self, place: Any) -> dict[Any, Any]:
        """Where each action leads from `place`, in the order of the action indices; None where there is no way.

        Raises:
            WorldError: there is no such place.
        """
        row = {self.ways[i]: self.places[self.target[i]] for i in self._row(place)}
        if self.motions.local:
            return {"stay": place, **row}
        return {name: place if name == "stay" else row.get(name) for name in self.motions.names}

    def successors(self, place: Any) -> dict[Any, Any]:
        """The same; what is no way leads back."""
        return {way: place if other is None else other for way, other in self.exits(place).items()}

    def told_bearings(self, place: Any) -> dict[Any, float]:
        """The bearing of each way of `place`, in degrees."""
        return {} if self.bearings is None else {self.ways[i]: float(self.bearings[i]) for i in self._row(place)}

    def told_lengths(self, place: Any) -> dict[Any, float]:
        """How long each way of `place` is."""
        return {} if self.lengths is None else {self.ways[i]: float(self.lengths[i]) for i in self._row(place)}

    def length(self, place: Any, way: Any) -> float | None:
        """How long a way is; 0 of none, None where nobody knows."""
        found = [i for i in self._row(place) if self.ways[i] == way]
        return None if self.lengths is None else float(self.lengths[found[0]]) if found else 0.0

    def displacement(self, place: Any, way: Any) -> Floats:
        """How far `way` leads from `place` along each axis; zeros of none.

        Raises:
            WorldError: there are neither positions nor bearings with lengths.
        """
        found = [i for i in self._row(place) if self.ways[i] == way]
        if not found:
            return np.zeros(2 if self.coordinates is None else self.coordinates.shape[1])
        if self.coordinates is not None:
            return self.coordinates[self.target[found[0]]] - self.coordinates[self._number(place)]
        if self.bearings is None or self.lengths is None:
            raise WorldError(f"{self.name}: displacements are not known; give nodes positions, or ways lengths")
        angle = np.deg2rad(self.bearings[found[0]])
        return self.lengths[found[0]] * np.array([np.sin(angle), np.cos(angle)])

    def _row(self, place: Any) -> range:
        at = self._number(place)
        return range(int(self.first[at]), int(self.first[at + 1]))

    def _number(self, place: Any) -> int:
        try:
            return self._index[place]
        except (KeyError, TypeError) as error:
            raise WorldError(f"{self.name!r} has no place {shown(place)}; see chart.places") from error

    @cached_property
    def _index(self) -> dict[Any, int]:
        return {place: i for i, place in enumerate(self.places)}

    @cached_property
    def _digest(self) -> bytes:
        words = (self.name, self.places, self.sensors, self.labels, self.motions, self.pose, self.ways)
        arrays = (self.first, self.target, self.bearings, self.lengths, self.coordinates)
        content = hashlib.sha256(repr(words).encode("utf-8", "surrogatepass"))
        for array in arrays:
            content.update(b"-" if array is None else array.tobytes())
        return content.digest()


class _Column(Mapping[Any, Any]):
    """A value for each place, looked up by its number."""

    def __init__(self, index: Mapping[Any, int], value: Callable[[int], Any]) -> None:
        self._index, self._value = index, value

    def __getitem__(self, place: Any) -> Any:
        return self._value(self._index[place])

    def __iter__(self) -> Iterator[Any]:
        return iter(self._index)

    def __len__(self) -> int:
        return len(self._index)
