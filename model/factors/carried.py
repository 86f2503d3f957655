"""What the agent carries: a context that it senses, that actions change, and that opens ways that are locked."""

from collections.abc import Hashable, Iterable, Mapping, Sequence
from typing import Any, cast

import numpy as np

from ..changes import Store
from ..column import Column
from ..errors import CogmapError
from .base import Context, Floats, Ints
from .contexts import Contexts, Shares
from .sensor import Sensor
from .transition import Transition

NONE = -1
NOTHING = "nothing"
"""What is carried by who carries nothing."""
Lock = tuple[int, ...]  # for each action the context that its way takes to be open, `NONE` where any will do


class Carried(Contexts):
    """What is carried, as a context of the map: each room is a place in each context, and these know the same.

    What leads from one context into another are actions (`Motions.takes`). Only where a lock is known that something
    would open does the map have places in which it is carried, or where it is carried already.

    Args:
        values: what may be carried, nothing being one of them.
        name: the key in observations.

    Attributes:
        of: the context of each place, `NONE` where that is not known.
        peers: `[S, C]` the place of the same room in each context, `NONE` where there is none yet.
        offers: `[S, C]` whether something lies there that leads into each context.
    """

    def __init__(self, values: Iterable[Hashable], name: str = "carried") -> None:
        super().__init__(values, name)

    def join(self, context: Context, transitions: Transition) -> None:
        """Make it part of a model. Raises CogmapError: places have positions, or an action takes what is no context."""
        if context.motions.placed:
            raise CogmapError(
                f"{self.name}: a room is a place for each thing carried, and they would lie at one position; give "
                "actions without displacements"
            )
        super().join(context, transitions)
        self._transitions = transitions
        self.takes = {action: self._number(what) for action, what in enumerate(context.motions.takes) if what}

    def attach(self, context: Context) -> None:
        super().attach(context)
        size, log = len(self.values), context.changes
        self.of = self._of
        self.peers = Column(f"{self.name}.peers", np.int64, width=size, fill=NONE, changes=log)
        self.offers = Column(f"{self.name}.offers", np.bool_, width=size, changes=log)

    @property
    def stores(self) -> tuple[Store, ...]:
        return self._of, self.peers, self.offers

    def grow(self, places: int) -> None:
        for store in (self._of, self.peers, self.offers):
            store.resize(places)

    def carried_in(self, place: int) -> str | None:
        """What is carried in a place, in words; None where nobody knows."""
        of = int(self._of.values[place])
        return None if of < 0 else str(self.values[of])

    def rooms(self, places: Ints) -> Ints:
        """`[n]` the room of each place, by the first of its places."""
        peers = self.peers.values[places]
        first = np.where(peers < 0, len(self._of), peers).min(axis=1)
        return np.where(first < len(self._of), first, places)

    def recall(self, place: int) -> None:
        """A place imagined behind a way is in the context of the place from which the way leads there."""
        for action, back in enumerate(self.context.motions.inverse):
            if back >= 0 and self._of.values[place] < 0:
                source = self._transitions.beyond(place, action)
                if source is not None:
                    self.settle(place, int(self._of.values[source]))

    def settle(self, place: int, context: int) -> None:
        """A place is in a context."""
        if context >= 0:
            self._of.set(place, context)
            self.peers.set((place, context), place)

    def learn(self, place: int, reading: Shares, weight: float) -> None:
        super().learn(place, reading, weight)
        self.settle(place, int(self._of.values[place]))


class Locks(Sensor):
    """A sensor of which ways are locked: for each action what must be carried for its way to be open, None of others.

    What was seen last counts.

    Args:
        values: the contexts of `Carried`.
        name: the key in observations.

    Attributes:
        needs: `[S, K]` the context that each way takes, `NONE` where any will do.
    """

    kind = "locks"
    optional = True

    def __init__(self, values: Iterable[Hashable], name: str = "locks") -> None:
        super().__init__(name)
        self.values = tuple(values)

    @property
    def options(self) -> dict[str, Any]:
        return {"values": list(self.values), "name": self.name}

    def attach(self, context: Context) -> None:
        super().attach(context)
        width = len(context.motions)
        self.needs = Column(f"{self.name}.needs", np.int64, width=width, fill=NONE, changes=context.changes)

    @property
    def stores(self) -> tuple[Store, ...]:
        return (self.needs,)

    def grow(self, places: int) -> None:
        self.needs.resize(places)

    def check(self, value: Any) -> Lock:
        """One of the contexts for each action, or None. Raises CogmapError: it is none."""
        names = self.context.motions.names
        if isinstance(value, Mapping):
            told = cast(Mapping[Any, Any], value)
            value = [told.get(name) for name in names] if set(told) <= set(names) else None
        given = list(cast(Sequence[Any], value)) if isinstance(value, list | tuple) else []
        if len(given) != len(names) or not all(each is None or each in self.values for each in given):
            known = ", ".join(map(repr, self.values))
            raise CogmapError(f"observation: {self.name} are {value!r}; give each action one of {known}, or None")
        return tuple(NONE if each is None else self.values.index(each) for each in given)

    def label(self, reading: Lock) -> Hashable:
        """For each action what opens its way."""
        return tuple(None if each < 0 else self.values[each] for each in reading)

    def log_likelihood(self, places: Ints, reading: Lock) -> Floats:
        """`[n]` zeros: that a door is locked tells no places apart that its being there does not."""
        return np.zeros(len(places))

    def learn(self, place: int, reading: Lock, weight: float) -> None:
        if weight > 0.5:
            for action, need in enumerate(reading):
                self.needs.set((place, action), need)
