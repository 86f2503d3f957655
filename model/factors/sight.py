"""P(o | s): which label a place shows, as Dirichlet counts."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..changes import Store
from ..dirichlet import SparseDirichlet
from ..domain import Domain
from ..errors import CogmapError
from ..growth_event import GrowthEvent
from ..information import information
from ..labels import decode, encode
from .base import Context, Floats, Ints, parts_of
from .sensor import Sensor
from .sight_index import SightIndex
from .transition import Transition


class Sight(Sensor):
    """Senses one label in each place; labels are met as they come.

    Args:
        name: the key in observations.
        prior: concentration of each label before any evidence, `Priors.sight` unless given: how noisy it is. After one
            look the probability of another label is about this.

    Attributes:
        labels: those met so far, by number.
        table: counts, a row a place.

    Raises:
        CogmapError: the prior is no positive number.
    """

    def __init__(self, name: str = "sight", *, prior: float | None = None) -> None:
        super().__init__(name)
        if prior is not None and not (isinstance(prior, float | int) and 0.0 < prior < 1e300):  # pyright: ignore[reportUnnecessaryIsInstance]
            raise CogmapError(f"{name}: prior is {prior!r}; use a number above 0")
        if name == "sight":
            self.symbol, self.variable = "A_o", "o"
        self._prior = prior

    @property
    def options(self) -> dict[str, Any]:
        """Name and prior."""
        return {"name": self.name, "prior": self._prior}

    def join(self, context: Context, transitions: Transition) -> None:
        """Make it part of a model."""
        super().join(context, transitions)
        self.labels = Domain("sights" if self.name == "sight" else self.name)
        background = context.priors.sight if self._prior is None else self._prior
        self.table = SparseDirichlet(
            name=self.symbol, slots=1, background=background, outcomes=1, changes=context.changes
        )
        self._index = SightIndex(self.table, context.changes, context.visits)

    @property
    def stores(self) -> tuple[Store, ...]:
        """The counts."""
        return (self.table,)

    def grow(self, places: int) -> None:
        """Any label is as likely as any other in a new place."""
        self.table.resize(places)

    def state(self) -> dict[str, Any]:
        """The labels."""
        return {"labels": [encode(label) for label in self.labels]}

    def restore(self, state: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]], places: int) -> None:
        """Take over labels and counts."""
        self.labels.extend(decode(label) for label in state["labels"])
        if len(self.labels) < len(state["labels"]):
            raise CogmapError(f"map: two labels of {self.name} are the same; save it again")
        self.table.outcomes = len(self.labels) + 1
        self.grow(places)
        self.table.restore(parts_of(self.table, arrays), outcomes=len(self.labels))

    def check(self, value: Any) -> Hashable:
        """The label, as a plain hashable value."""
        scalar = isinstance(value, np.generic) or (isinstance(value, np.ndarray) and value.ndim == 0)
        label: Any = value.item() if scalar else value
        try:
            hash(label)
        except TypeError as error:
            raise CogmapError(
                f"observation: {self.name} is a {type(value).__name__}, not hashable; "
                "label sights with str, int or tuple"
            ) from error
        if label != label:  # a NaN would be a new sight each time
            raise CogmapError(f"observation: {self.name} is NaN, which equals nothing; label with str, int or tuple")
        return label

    def read(self, checked: Hashable, *, step: int) -> int:
        """The number of the label; the domain grows where it was never met."""
        known = self.labels.find(checked)
        if known is not None:
            return known
        number = self.labels.add(checked)
        self.table.outcomes = len(self.labels) + 1  # and one never met
        self.context.grown(GrowthEvent(step, "sight", number, checked, sensor=self.name))
        return number

    def label(self, reading: int) -> Hashable:
        """The label of that number."""
        return self.labels[reading]

    def log_likelihood(self, places: Ints, reading: int) -> Floats:
        """`[n]` log P(o | s)."""
        return np.log(self.table.probability(reading, places))

    def likelihood(self, places: Ints, reading: int) -> Floats:
        """`[n]` P(o | s)."""
        return self.table.probability(reading, places)

    def log_predictive(self, reading: int) -> float:
        """Any label is as likely as any other, one never met among them."""
        return -float(np.log(self.table.outcomes))

    def candidates(self, reading: int) -> tuple[Ints, float]:
        """The visited places that have counts for it, or hardly any, and a bound on its probability elsewhere."""
        return self._index.places(reading)

    def learn(self, place: int, reading: int, weight: float) -> None:
        """Its count gains `weight` times the rate."""
        self.table.add(place, reading, weight * self.context.rates.likelihood)

    def information(self, places: Ints, steps: int) -> Floats:
        """`[n, N + 1]` nats that 0..N more looks teach of the column of each place."""
        _, alpha, others = self.table.concentration(places)
        alpha = np.concatenate([alpha, np.full((len(places), 1), self.table.background)], axis=1)
        many = np.ones(alpha.shape)
        many[:, -1] = others
        return information(alpha, steps, many)

    def information_unseen(self, steps: int) -> Floats:
        """`[N + 1]` the same in a place that was never imagined."""
        return information(np.array([[self.table.background]]), steps, np.array([[float(self.table.outcomes)]]))[0]
