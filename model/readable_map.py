"""What is believed of the world, read from the factors."""

from collections.abc import Hashable

import numpy as np
from numpy.typing import NDArray

from .arrays import Floats, Ints
from .dirichlet import SparseDirichlet
from .domain import Domain
from .errors import CogmapError
from .factors import Lattice
from .generative import GenerativeModel
from .motions import Position


class ReadableMap(GenerativeModel):
    """A generative model in the words of maps.

    Places are numbered as they are imagined. `sights` and `positions` are labelled domains. The tables hold sparse
    Dirichlet counts: `A_o` P(o | s) and `A_p` P(p | s), a row a place; `B_s` P(s' | s, a), row
    `place * len(motions) + action`. `A()`, `positions_given_places()` and `B()` give them as dense arrays.
    """

    @property
    def tables(self) -> dict[str, SparseDirichlet]:
        """All tables of counts, by symbol."""
        return {store.name: store for store in self.stores if isinstance(store, SparseDirichlet)}

    @property
    def sights(self) -> Domain:
        """Labels of the first of them."""
        return self.sights_sensed[0].labels if self.sights_sensed else Domain("sights")

    @property
    def positions(self) -> Domain:
        """Positions met so far; none where places have no pose."""
        return self.pose.positions

    @property
    def visited(self) -> NDArray[np.bool_]:
        """`[S]` whether each place was ever entered."""
        return self.visits.visited.values

    @property
    def visited_places(self) -> Ints:
        """The places ever entered, in the order of their first visit."""
        return self.visits.order.values

    @property
    def first_visit(self) -> Ints:
        """`[S]` index of each place in `visited_places`; -1 where it was never entered."""
        return self.visits.first.values

    @property
    def sensed(self) -> NDArray[np.int8]:
        """`[S, K]` what was last sensed of each door: `UNKNOWN`, `OPEN` or `BLOCKED`."""
        return self.transitions.sensed.values

    @property
    def walked(self) -> NDArray[np.bool_]:
        """`[S, K]` whether each transition was ever walked."""
        return self.transitions.walked.values

    @property
    def position_index(self) -> Ints:
        """`[S]` the number of each place's position; -1 for a place that has none."""
        return self.pose.position_of.values if isinstance(self.pose, Lattice) else np.full(len(self.places), -1)

    @property
    def position_beyond(self) -> Ints:
        """`[P, K]` B_p: the number of the position that each motion leads to; -1 where it has none yet."""
        return self._lattice.beyond.values

    @property
    def _lattice(self) -> Lattice:
        if not isinstance(self.pose, Lattice):
            raise CogmapError("map: its places have no positions, so there are no A_p and B_p; give it a Lattice()")
        return self.pose

    def position(self, place: int) -> Position | None:
        """Position of `place` relative to the start; None for a place that has none.

        Raises:
            CogmapError: there is no such place.
        """
        self.check_place(place)
        return self.pose.position(place)

    def place_at(self, position: Hashable) -> int | None:
        """The place at `position`, or None."""
        return self.pose.place_at(position)

    def row(self, place: int, action: int) -> int:
        """Row of `B_s` for `place` under `action`."""
        return self.transitions.row(place, action)

    def rows_of(self, places: Ints) -> Ints:
        """Rows of `B_s` for `places` under every action, place by place."""
        return self.transitions.rows(places)

    def blocked(self, places: Ints) -> Floats:
        """`[n, K]` P(blocked | s, a) = B_s[s, s, a], within the floor of the doors; zero for `stay`."""
        return self.transitions.blocked(places)

    def transition(self, next_place: int, place: int, action: int) -> float:
        """P(s' = next_place | s = place, a), a being the action given: another one may be carried out instead.

        `B_s` says where ways lead; it is the same where actions hardly ever go astray.
        """
        carried_out = self.transitions.carried_out(action)
        if carried_out is None:
            return float(self.B_s.probability(next_place, np.array([self.row(place, action)]))[0])
        return float(carried_out @ self.B_s.probability(next_place, self.rows_of(np.array([place]))))

    def beyond(self, place: int, action: int) -> int | None:
        """The place that `action` most probably leads to from `place` if it is not blocked; None if none is known."""
        return self.transitions.beyond(place, action)

    def A(self) -> Floats:
        """A_o as an array `[O + 1, S]`; the last row is "a sight never met"."""
        return self.A_o.dense(len(self.sights))

    def positions_given_places(self) -> Floats:
        """A_p as an array `[P + 1, S]`; the last row is "no position yet"."""
        return self.A_p.dense(len(self.positions))

    def B(self) -> Floats:
        """B_s as an array `[S + 1, S, K]` (next, previous, action); the last row is "a place never imagined"."""
        size = len(self.places)
        return self.B_s.dense(size).reshape(size + 1, size, len(self.motions))
