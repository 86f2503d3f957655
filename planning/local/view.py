"""All that a planner reads of a map: `CognitiveMap` has it, and so may anything else that is to be planned with."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ...model import Motions

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


class Table(Protocol):
    """Rows of Dirichlet counts; see `SparseDirichlet`."""

    background: float
    outcomes: int

    def keys(self, rows: Ints | slice) -> Ints:
        """`[n, slots]` outcomes that have counts of their own, below -1 where a slot is unused."""
        ...

    def concentration(self, rows: Ints) -> tuple[Ints, Floats, Floats]:
        """Keys and counts `[n, slots]`, and the number `[n]` of outcomes that have the background alone."""
        ...

    def mean(self, rows: Ints) -> tuple[Ints, Floats, Floats]:
        """Keys and expected probabilities `[n, slots]`, and that of one outcome without a slot, `[n]`."""
        ...

    def probability(self, key: int | Ints, rows: Ints) -> Floats:
        """`[n]` expected probability of an outcome."""
        ...


class MapView(Protocol):
    """A map as a planner sees it: places by number, and what is believed of each.

    Rows of `A_o` (sights) and `A_p` (positions) are places; those of `B_s` (transitions) are named by `rows_of`.
    """

    @property
    def motions(self) -> Motions:
        """The actions."""
        ...

    @property
    def A_o(self) -> Table:
        """P(sight | place)."""
        ...

    @property
    def A_p(self) -> Table:
        """P(position | place)."""
        ...

    @property
    def B_s(self) -> Table:
        """P(next place | place, action); the outcome -1 is a place never imagined."""
        ...

    @property
    def places(self) -> range:
        """The places, by number."""
        ...

    @property
    def visited(self) -> NDArray[np.bool_]:
        """`[S]` whether each place was ever entered."""
        ...

    @property
    def visited_places(self) -> Ints:
        """The places ever entered, in the order of their first visit."""
        ...

    @property
    def visits(self) -> Any:
        """What `changed_places` is asked about, for first visits."""
        ...

    def changed_places(self, cursor: int, *stores: Any) -> tuple[Collection[int] | None, int]:
        """The places of which something in these tables changed since `cursor`, None for any, and the next cursor."""
        ...

    def rows_of(self, places: Ints) -> Ints:
        """Rows of `B_s` for `places` under every action, place by place."""
        ...

    def position(self, place: int) -> Sequence[float] | None:
        """Where a place is; None where nobody knows."""
        ...
