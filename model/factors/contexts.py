"""P(k | s): a context of the world that is not seen, on which sights and ways may depend."""

from collections.abc import Hashable, Iterable, Mapping
from typing import Any, cast

import numpy as np

from ..changes import Store
from ..column import Column
from ..errors import CogmapError
from ..rates import is_number
from .base import Context, Floats, Ints, Support, Table
from .sensor import Sensor

FLOOR = 1e-12  # likelihood of the contexts that a label leaves out: what is small may yet win
Shares = tuple[float, ...]  # likelihood of each context, the largest 1


class Contexts(Sensor):
    """The context of the world: a discrete latent that stays the same unless a way changes it.

    A place of the map is a place of the world in one context, so that Q(s) is the exact joint of both: sights and ways
    may differ from context to context, a way may lead on in another one (a key is taken), and plans foresee all that.
    What is sensed of the context itself, if anything, is a label or likelihoods; observations may leave it out.

    Args:
        values: the contexts, two or more.
        name: the key in observations, and of the variable in graphs.

    Attributes:
        values: as given.

    Raises:
        CogmapError: fewer than two contexts, or two that are the same.
    """

    kind = "context"
    optional = True

    def __init__(self, values: Iterable[Hashable], name: str = "context") -> None:
        super().__init__(name)
        self.values = tuple(values)
        if len(self.values) < 2 or len(set(self.values)) < len(self.values):
            raise CogmapError(f"{name}: contexts are {self.values}; give two or more that differ")
        self.symbol, self.variable = f"A_{name}", f"{name}_sensed"

    @property
    def options(self) -> dict[str, Any]:
        return {"values": list(self.values), "name": self.name}

    def attach(self, context: Context) -> None:
        super().attach(context)
        self._of = Column(f"{self.name}.of", np.int64, fill=-1, changes=context.changes)

    @property
    def stores(self) -> tuple[Store, ...]:
        return (self._of,)

    def grow(self, places: int) -> None:
        self._of.resize(places)

    def know(self, place: int, value: Any) -> None:
        if value is not None:
            self._of.set(place, self._number(value))

    def check(self, value: Any) -> Shares:
        """A context, or likelihoods of contexts. Raises CogmapError: it is neither."""
        if not isinstance(value, Mapping):
            number = self._number(value)
            return tuple(float(at == number) for at in range(len(self.values)))
        told = cast(Mapping[Any, Any], value)
        shares = dict.fromkeys(range(len(self.values)), 0.0) | {self._number(key): p for key, p in told.items()}
        if not all(is_number(p, 0.0, 1e300) for p in shares.values()) or not max(shares.values()) > 0.0:
            raise CogmapError(f"observation: {self.name} is {value!r}; give likelihoods, not all of them 0")
        most = max(shares.values())
        return tuple(shares[at] / most for at in range(len(self.values)))

    def _number(self, value: Any) -> int:
        if value not in self.values:
            known = ", ".join(map(repr, self.values))
            raise CogmapError(f"observation: {self.name} is {value!r}; the contexts are {known}")
        return self.values.index(value)

    def label(self, reading: Shares) -> Hashable:
        """The context, where it is certain; else what is likely how much."""
        likely = [(value, share) for value, share in zip(self.values, reading, strict=True) if share > 0.0]
        return likely[0][0] if len(likely) == 1 else tuple(likely)

    def log_likelihood(self, places: Ints, reading: Shares) -> Floats:
        """`[n]` log P(what is sensed of the context | s): of a place that is of none in particular the mean."""
        told = np.maximum(reading, FLOOR)
        return np.log(np.append(told, told.mean()))[self._of.values[places]]

    def log_predictive(self, reading: Shares) -> float:
        return float(np.log(np.maximum(reading, FLOOR).mean()))

    def learn(self, place: int, reading: Shares, weight: float) -> None:
        """A place of which nobody knew is of the context that is sensed there, where that is certain."""
        if weight > 0.5 and self._of.values[place] < 0 and sum(share > 0.0 for share in reading) == 1:
            self._of.set(place, reading.index(1.0))

    def table(self, places: Ints) -> Floats:
        """`[K, n]` P(k | s)."""
        of = self._of.values[places]
        return np.where(of < 0, 1.0 / len(self.values), of == np.arange(len(self.values))[:, None])

    def belief(self, places: Mapping[int, float]) -> dict[Hashable, float]:
        """Q(k) from Q(s)."""
        p = self.table(np.array([*places], dtype=np.int64)) @ np.array([*places.values()])
        return dict(zip(self.values, p.tolist(), strict=True))

    def tables(self, support: Support) -> Iterable[Table]:
        """P(k_t | s_t), and what was sensed of it."""
        scope, values = (f"{self.name}{support.step}", f"s{support.step}"), self.table(support.places)
        yield Table(f"P_{self.name}", scope, values, self.kind, "P(k_t | s_t)", domain=self.values)
        yield from super().tables(support)
