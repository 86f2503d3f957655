"""P(o | s): which label a place shows, as Dirichlet counts."""

from collections.abc import Collection, Hashable, Iterable, Mapping
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from ..changes import Store
from ..dirichlet import SparseDirichlet
from ..domain import Domain
from ..errors import CogmapError
from ..growth_event import GrowthEvent
from ..labels import decode, encode
from .base import Context, Floats, Ints, parts_of
from .readings import Likelihoods, checked_label, checked_likelihoods, declared
from .sensor import Sensor
from .sight_index import SightIndex
from .transition import Transition

Reading = int | Mapping[int, float]  # the number of a label, or likelihoods of labels by number, the largest 1

SHOWN = 64
"""Labels of which a place has counts at most; of what was read there once in so many, the first is forgotten."""


class Sight(Sensor):
    """A sensor of one label per place. New labels are added when they are first seen.

    Args:
        name: the key in observations.
        prior: concentration of each label before any evidence, `Priors.sight` unless given: how noisy it is. After one
            look the probability of another label is about this.
        labels: those that are known beforehand; others are met as they come. `None` is a label only where it is
            declared here.

    Attributes:
        labels: those met so far, by number.
        table: counts, a row a place.

    Raises:
        CogmapError: the prior is no positive number, or a label cannot be one.
    """

    def __init__(
        self, name: str = "sight", *, prior: float | None = None, labels: Iterable[Hashable] | None = None
    ) -> None:
        super().__init__(name)
        if prior is not None and not (isinstance(prior, float | int) and 0.0 < prior < 1e300):  # pyright: ignore[reportUnnecessaryIsInstance]
            raise CogmapError(f"{name}: prior is {prior!r}; use a number above 0")
        if name == "sight":
            self.symbol, self.variable = "A_o", "o"
        self._prior = prior
        self._declared = declared(labels, name)

    @property
    def options(self) -> dict[str, Any]:
        return {"name": self.name, "prior": self._prior}

    def join(self, context: Context, transitions: Transition) -> None:
        super().join(context, transitions)
        self.labels = Domain("sights" if self.name == "sight" else self.name, self._declared)
        background = context.priors.sight if self._prior is None else self._prior
        outcomes = len(self.labels) + 1  # and one never met
        self.table = SparseDirichlet(
            name=self.symbol, slots=1, background=background, outcomes=outcomes, changes=context.changes
        )
        self._index = SightIndex(self.table, context.changes, context.visits)

    @property
    def stores(self) -> tuple[Store, ...]:
        return (self.table,)

    def grow(self, places: int) -> None:
        self.table.resize(places)

    def savepoint(self) -> Any:
        return self.labels.savepoint()

    def go_back(self, point: Any) -> None:
        self.labels.go_back(point)
        self._index = SightIndex(self.table, self.context.changes, self.context.visits)

    def state(self) -> dict[str, Any]:
        return {"labels": [encode(label) for label in self.labels]}

    def restore(self, state: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]], places: int) -> None:
        """Take over labels and counts. Raises CogmapError: two labels are the same."""
        self.labels.take(decode(label) for label in state["labels"])
        self.table.outcomes = len(self.labels) + 1
        self.grow(places)
        self.table.restore(parts_of(self.table, arrays), outcomes=len(self.labels))

    def check(self, value: Any) -> Any:
        """The label, as a plain hashable value, or `Likelihoods` of labels."""
        if isinstance(value, Mapping):
            return checked_likelihoods(cast(Mapping[Any, Any], value), self.name, self.labels)
        return checked_label(value, self.name, self.labels)

    def read(self, checked: Any, *, step: int) -> Reading:
        """The number of the label, or likelihoods by number; the domain grows where a label was never met."""
        if isinstance(checked, Likelihoods):
            return {self._number(label, step): likelihood for label, likelihood in checked.of.items()}
        return self._number(checked, step)

    def _number(self, label: Hashable, step: int) -> int:
        known = self.labels.find(label)
        if known is not None:
            return known
        number = self.labels.add(label)
        self.table.outcomes = len(self.labels) + 1  # and one never met
        self.context.grown(GrowthEvent(step, "sight", number, label, sensor=self.name))
        return number

    def label(self, reading: Reading) -> Hashable:
        """The label of that number; of likelihoods each label with its own, the most likely first."""
        if isinstance(reading, Mapping):
            ranked = sorted(reading.items(), key=lambda item: (-item[1], item[0]))
            return tuple((self.labels[number], likelihood) for number, likelihood in ranked)
        return self.labels[reading]

    def log_likelihood(self, places: Ints, reading: Reading) -> Floats:
        return np.log(self.likelihood(places, reading))

    def likelihood(self, places: Ints, reading: Reading) -> Floats:
        """`[n]` P(o | s): of likelihoods their mean over the labels that the place may show."""
        if isinstance(reading, Mapping):
            each = [likelihood * self.table.probability(label, places) for label, likelihood in reading.items()]
            return np.add.reduce(each)
        return self.table.probability(reading, places)

    def log_predictive(self, reading: Reading) -> float:
        """Any label is as likely as any other, one never met among them."""
        told = sum(reading.values()) if isinstance(reading, Mapping) else 1.0
        return float(np.log(told / self.table.outcomes))

    def candidates(self, reading: Reading) -> tuple[Ints, float]:
        """The visited places that have counts for it, or hardly any, and a bound on its probability elsewhere."""
        if not isinstance(reading, Mapping):
            return self._index.places(reading)
        found = {label: self._index.places(label) for label in reading}
        bound = sum(likelihood * found[label][1] for label, likelihood in reading.items())
        return np.unique(np.concatenate([places for places, _ in found.values()])), bound

    def learn(self, place: int, reading: Reading, weight: float) -> None:
        """Its count gains `weight` times the rate; of likelihoods each label its posterior share of that."""
        gain = weight * self.context.rates.likelihood
        self.table.make_room(place, SHOWN, of=(reading,) if isinstance(reading, int) else tuple(reading))
        if not isinstance(reading, Mapping):
            self.table.add(place, reading, gain)
            return
        here = np.array([place])
        share = {label: p * self.table.probability(label, here).item() for label, p in reading.items()}
        total = sum(share.values())
        for label, part in share.items():
            self.table.add(place, label, gain * part / total)

    def forget(self, used: Collection[int], *, least: int) -> None:
        """Forget labels that no place shows, nor `used` has; met again they are new, and their numbers those of others.

        Args:
            used: numbers of labels that others still speak of.
            least: so many have to go, or none does.
        """
        numbers = {*used, *range(len(self._declared)), *np.unique(self.table.keys(slice(len(self.table)))).tolist()}
        self.context.forgotten("sight", self.name, self.labels.forget(numbers, least=least))

    def information(self, places: Ints, steps: int) -> Floats:
        """`[n, N + 1]` nats that 0..N more looks teach of the column of each place."""
        _, alpha, others = self.table.concentration(places)
        alpha = np.concatenate([alpha, np.full((len(places), 1), self.table.background)], axis=1)
        many = np.ones(alpha.shape)
        many[:, -1] = others
        return self.context.information(alpha, steps, many)

    def information_unseen(self, steps: int) -> Floats:
        """`[N + 1]` the same in a place that was never imagined."""
        return self.context.information(
            np.array([[self.table.background]]), steps, np.array([[float(self.table.outcomes)]])
        )[0]
