"""All that a planner reads of a map: `CognitiveMap` has it, and so may anything else that is to be planned with."""

from collections.abc import Collection, Mapping, Sequence
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ...model import Ints, Motions, Pose, Sensor, Sight, SparseDirichlet, Transition


class MapView(Protocol):
    """A map as a planner sees it: numbered places, and what is believed of each.

    Attributes:
        motions: the actions.
        A_o: P(sight | place), a row a place.
        A_p: P(position | place), a row a place.
        B_s: P(next place | place, action), its rows named by `rows_of`; the outcome -1 is a place never imagined.
        sights_sensed: the sensors that see labels, each with what visits teach of it.
        transitions: what looks at ways teach of B_s.
        pose: what visits teach of A_p.
        visits: what `changed_places` is asked about, for first visits.
    """

    motions: Motions
    A_o: SparseDirichlet
    A_p: SparseDirichlet
    B_s: SparseDirichlet
    sights_sensed: tuple[Sight, ...]
    transitions: Transition
    pose: Pose
    visits: Any

    @property
    def sensors(self) -> Mapping[str, Sensor]:
        """All sensors, by name."""
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
        """The places ever entered."""
        ...

    def rows_of(self, places: Ints) -> Ints:
        """Rows of `B_s` for `places` under every action, place by place."""
        ...

    def position(self, place: int) -> Sequence[float] | None:
        """Where a place is; None where nobody knows."""
        ...

    def changed_places(self, cursor: int, *stores: Any) -> tuple[Collection[int] | None, int]:
        """The places of which something in these tables changed since `cursor`, None for any, and the next cursor."""
        ...
