"""What a world is, and what else it may offer, as protocols: each use asks for no more than it needs."""

from collections.abc import Iterator, Mapping
from typing import Any, Protocol, TypeVar, runtime_checkable

import gymnasium as gym

from .errors import WorldError
from .motions import Motions

Observation = dict[str, Any]
Place = Any
"""Whatever names a place, hashable: (row, column) in mazes, the id of a node in graphs."""

Offer = TypeVar("Offer")


@runtime_checkable
class World(Protocol):
    """A `gymnasium.Env` with motions. The truth is in `info` alone."""

    @property
    def motions(self) -> Motions:
        """The actions."""
        ...

    def reset(self, *, seed: int | None = None, options: Any = None) -> tuple[Observation, dict[str, Any]]:
        """The first observation, and the truth."""
        ...

    def step(self, action: Any) -> tuple[Observation, Any, bool, bool, dict[str, Any]]:
        """Take one action."""
        ...


@runtime_checkable
class Chart(Protocol):
    """The true map of a world, for experiments, oracles and pictures, never for agents. Immutable and hashable."""

    @property
    def name(self) -> str:
        """What the world is called in results and errors."""
        ...

    @property
    def places(self) -> tuple[Place, ...]:
        """All places, in a fixed order."""
        ...

    @property
    def motions(self) -> Motions:
        """The actions of an agent there."""
        ...

    @property
    def sights(self) -> Mapping[Any, Any]:
        """The label of each place; a tuple of labels where there are several sensors."""
        ...

    @property
    def positions(self) -> Mapping[Any, tuple[float, ...]] | None:
        """Where each place lies, or None where nobody knows."""
        ...

    def find(self, place: Any) -> Place:
        """`place` as it stands in `places`; a WorldError if there is none."""
        ...

    def exits(self, place: Place) -> Mapping[Any, Place | None]:
        """Where each action leads with everything open, by its name, in the order of the indices; None of no way."""
        ...

    def successors(self, place: Place) -> Mapping[Any, Place]:
        """The same; what is no way leads back."""
        ...

    def length(self, place: Place, way: Any) -> float | None:
        """How long a way is; None where nobody knows."""
        ...


@runtime_checkable
class HasChart(Protocol):
    """A world whose true map is known."""

    @property
    def chart(self) -> Chart:
        """The true map."""
        ...


@runtime_checkable
class CanDisplace(Protocol):
    """A world in which the agent can be silently moved."""

    def displace(self, place: Place) -> Observation:
        """Move the agent to `place`, and return what it senses there."""
        ...

    def observe(self) -> Observation:
        """What the agent senses now, without acting."""
        ...


@runtime_checkable
class CanClose(Protocol):
    """A world whose rooms, and doors between two rooms, can be closed and opened."""

    @property
    def closed_rooms(self) -> frozenset[Any]:
        """The rooms closed at present."""
        ...

    @property
    def closed_doors(self) -> frozenset[Any]:
        """The doors closed by themselves at present, as pairs of rooms."""
        ...

    def close_room(self, room: Place) -> None:
        """Close every way into and out of `room`."""
        ...

    def open_room(self, room: Place) -> None:
        """Open `room` again."""
        ...

    def close_door(self, a: Place, b: Place) -> None:
        """Close the ways between rooms `a` and `b`."""
        ...

    def open_door(self, a: Place, b: Place) -> None:
        """Open the ways between rooms `a` and `b` again."""
        ...


def offered(world: Any, kind: type[Offer], what: str) -> Offer:
    """The outermost of `world` and its wrapped environments that offers `kind`.

    Raises:
        WorldError: none does; `what` is the subject, such as "kidnapping".
    """
    for layer in _layers(world):
        if isinstance(layer, kind):
            return layer
    raise WorldError(f"{what} needs a world that is a cogmap.worlds.{kind.__name__}; {world} is none")


def place_of(info: Mapping[str, Any]) -> Place:
    """The true place of the agent in the `info` of a step. Raises WorldError: it is not told."""
    for key in ("place", "position"):
        if key in info:
            return info[key]
    raise WorldError("info tells no place; have reset() and step() of the world put it there as info['place']")


def _layers(world: Any) -> Iterator[Any]:
    yield world
    while isinstance(world, gym.Wrapper):
        world = world.env
        yield world
