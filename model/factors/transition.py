"""P(s' | s, a): where the ways of a place lead, as Dirichlet counts B_s."""

from collections.abc import Callable, Iterable, Mapping
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..changes import Store
from ..column import Column
from ..dirichlet import EMPTY, SparseDirichlet
from ..errors import CogmapError
from ..percept import Percept
from .base import Context, Floats, Ints, ModelFactor, Successors, Support, Table, parts_of

ELSEWHERE = -1
"""Successor that is no place of the map yet."""

UNSURE = 0.1  # P(open) and P(blocked) from which on it is open whether a way is open

UNKNOWN, OPEN, BLOCKED = 0, 1, 2
"""What was last sensed of a door."""


def _as_given(action: int) -> None:
    """Actions are carried out as they are given."""


class Transition(ModelFactor):
    """The transitions: row `place * K + action` of the table `B_s` has the places that the action may lead to.

    Attributes:
        table: B_s.
        sensed: `[S, K]` what was last sensed of each door.
        walked: `[S, K]` whether each way was ever walked.
        fading: whether evidence fades.
        carried_out: `[K]` P(action carried out | an action given), as whoever learns it has it; None where actions
            hardly ever go astray, as long as nobody says otherwise.
    """

    name = "transition"
    carried_out: Callable[[int], Floats | None] = staticmethod(_as_given)

    def attach(self, context: Context) -> None:
        super().attach(context)
        size, log = len(context.motions), context.changes
        self.motions, self.rates = context.motions, context.rates
        self.table = SparseDirichlet(name="B_s", slots=2, rows_each=size, changes=log)
        self.sensed = Column("sensed", np.int8, width=size, changes=log)
        self.walked = Column("walked", np.bool_, width=size, changes=log)
        self.fading = False

    @property
    def stores(self) -> tuple[Store, ...]:
        return self.table, self.sensed, self.walked

    def grow(self, places: int) -> None:
        """A new place may turn out to be blocked in each direction, or lead somewhere."""
        old, size = len(self.sensed), len(self.motions)
        self.table.resize(places * size)
        self.sensed.resize(places)
        self.walked.resize(places)
        if places > old:
            self.table.begin(slice(old * size, places * size), *self._blank(np.arange(old, places)))

    def blank(self, place: int) -> None:
        """Its ways may be blocked or lead somewhere, for all that is known."""
        rows, (keys, prior) = self.rows(np.array([place])), self._blank(np.array([place]))
        slots = self.table.slots(rows)
        if slots[2].any():  # first what was learned of places that will not be named any more
            self.table.write(rows, *slots[:2], np.zeros(slots[2].shape))
        wide = np.full(slots[0].shape, EMPTY), np.zeros(slots[0].shape)
        wide[0][:, :2], wide[1][:, :2] = keys, prior
        if not (np.array_equal(wide[0], slots[0]) and np.array_equal(wide[1], slots[1])):
            self.table.write(rows, *wide, np.zeros(slots[2].shape))
        self.sensed.write(place, np.full(len(self.motions), UNKNOWN, dtype=np.int8))
        self.walked.write(place, np.zeros(len(self.motions), dtype=np.bool_))

    def _blank(self, places: Ints) -> tuple[Ints, Floats]:
        """`[n K, 2]` outcomes and priors of places of which nothing is known."""
        size, stay = len(self.motions), self.motions.stay
        keys = np.full((len(places), size, 2), ELSEWHERE)
        keys[:, :, 0], keys[:, stay, 1] = places[:, None], EMPTY
        prior = np.full(keys.shape, self.context.priors.transition)
        prior[:, stay, 1] = 0.0
        return keys.reshape(-1, 2), prior.reshape(-1, 2)

    def restore(self, state: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]], places: int) -> None:
        """Take over the arrays. Raises CogmapError: an action leads nowhere, not even back."""
        self.grow(places)
        self.table.restore(parts_of(self.table, arrays), outcomes=places, least=ELSEWHERE)
        keys, alpha, _ = self.table.concentration(np.arange(places * len(self.motions)))
        stays = (keys == np.arange(places).repeat(len(self.motions))[:, None]) & (alpha > 0.0)
        if not stays.any(axis=1).all():
            raise CogmapError("map: an action leads nowhere, not even back; save it again")
        self.sensed.restore(parts_of(self.sensed, arrays), least=UNKNOWN, bound=BLOCKED + 1)
        self.walked.restore(parts_of(self.walked, arrays))

    # -- reading -------------------------------------------------------------------------------------------

    def row(self, place: int, action: int) -> int:
        """Row of B_s for `place` under `action`."""
        return place * len(self.motions) + action

    def rows(self, places: Ints) -> Ints:
        """Rows of B_s for `places` under every action, place by place."""
        size = len(self.motions)
        return (places[:, None] * size + np.arange(size)).ravel()

    def beyond(self, place: int, action: int) -> int | None:
        """The place that `action` most probably leads to from `place` if it is not blocked; None if none is known."""
        alpha = self.table.concentrations(self.row(place, action))
        others = [(a, -k, k) for k, a in alpha.items() if k >= 0 and k != place]
        return max(others)[2] if others else None

    def targets(self, places: Ints) -> Ints:
        """`[n, K]` what `beyond` says of each; -1 of none."""
        keys, alpha, _ = self.table.concentration(self.rows(places))
        others = (keys >= 0) & (keys != places.repeat(len(self.motions))[:, None])
        found = np.where(others, alpha, -1.0).argmax(axis=1)
        keys = np.where(others.any(axis=1), keys[np.arange(len(keys)), found], ELSEWHERE)
        return keys.reshape(len(places), -1)

    def blocked(self, places: Ints, actions: Ints | None = None) -> Floats:
        """`[n, K]` P(blocked | s, a) = B_s[s, s, a], within the floor of the doors; zero for `stay`.

        Args:
            places: `[n]` s.
            actions: those that are asked for, instead of all.
        """
        size, floor = len(self.motions), self.context.priors.door_floor
        asked = np.arange(size) if actions is None else actions
        rows = (places[:, None] * size + asked).ravel()
        p = self.table.probability(places.repeat(len(asked)), rows).reshape(len(places), len(asked))
        np.minimum(np.maximum(p, floor, out=p), 1.0 - floor, out=p)
        p[:, asked == self.motions.stay] = 0.0
        return p

    def predict(self, places: Ints, action: int, percept: Percept, *, stays: float) -> Successors:
        """Where `action` leads from `places`, and how that goes with what is sensed then.

        Who did not get through a door, and now senses it shut, has one thing to explain, not three: that the place is
        the same, that the pose is, and that the door is shut. The less probable of the first two stays, the others are
        taken out again. What the body says of the outcome is wrong as rarely as a door is believed otherwise.

        Args:
            places: `[n]` s.
            action: a.
            percept: what is sensed after it.
            stays: probability that the pose stays.
        """
        keys, p, _ = self.table.mean(places * len(self.motions) + action)
        coupling = np.ones(keys.shape)
        if percept.shut(action):
            others = self.blocked(places)[:, action, None] * np.maximum(p, stays)
            np.divide(1.0, others, out=coupling, where=(keys == places[:, None]) & (others > 0.0))
        if percept.outcome in ("arrived", "blocked") and action != self.motions.stay:
            believed = (keys == places[:, None]) == (percept.outcome == "blocked")
            coupling[~believed] *= self.context.priors.door_floor
        return Successors(keys, p, coupling)

    def information(self, places: Ints, steps: int) -> Floats:
        """`[n, N + 1]` nats that 0..N looks at the doors of a place teach of its rows, summed over the actions.

        A look teaches nothing where a visit has shown all it can, and no place lies beyond.
        """
        keys, alpha, _ = self.table.concentration(self.rows(places))
        shape = len(places), len(self.motions), -1
        keys, alpha = keys.reshape(shape), alpha.reshape(shape)
        visited: NDArray[np.bool_] = self.context.visits.visited.values[places]
        shown = visited[:, None] & (keys == ELSEWHERE).any(axis=2)
        return (self.context.information(alpha, steps) * ~shown[..., None]).sum(axis=1)

    def looks(self, place: int, action: int, steps: int) -> Floats:
        """`[N + 1]` the part of `information` that comes of one way."""
        _, alpha, _ = self.table.concentration(np.array([self.row(place, action)]))
        return self.context.information(alpha, steps)[0]

    def untried(self, places: Ints) -> Floats:
        """`[n, K]` nats that the first step along each way teaches, if no visit has told whether it is open.

        That is H[open], the entropy of whether it is, for ways of places where the agent was that it never walked, but
        for those beyond which no place is imagined.
        """
        p, visited = self.blocked(places), self.context.visits.visited.values[places]
        unsure = (p > UNSURE) & (p < 1.0 - UNSURE) & ~self.walked.values[places] & visited[:, None]
        if not unsure.any():
            return np.zeros(p.shape)
        keys = self.table.keys(self.rows(places)).reshape(*p.shape, -1)
        unsure &= ((keys >= 0) & (keys != places[:, None, None])).any(axis=2)
        q = np.where(unsure, p, 0.5)
        return np.where(unsure, -q * np.log(q) - (1.0 - q) * np.log1p(-q), 0.0)

    def tables(self, support: Support) -> Iterable[Table]:
        """B_s[a](s_t, s_t-1), times the coupling; any visited place where the agent was moved."""
        if support.ahead is None or support.percept.action is None:
            return
        name, given = (
            f"B_s[{self.motions.names[support.percept.action]}]",
            "" if support.arrival is None else ", moved_t",
        )
        values = partial(_values, support.ahead, support.places, support.arrival)
        yield Table(name, support.scope("s"), values, "transition", f"P(s_t | s_t-1, a_t-1{given})")

    # -- learning ------------------------------------------------------------------------------------------

    def link(self, place: int, action: int, neighbour: int) -> None:
        """What lies beyond a door has become a place of the map: its slot gets the name."""
        row = self.row(place, action)
        if neighbour in self.table.concentrations(row):
            self.table.unite(row, ELSEWHERE, neighbour)
        else:
            self.table.rename(row, ELSEWHERE, neighbour)

    def lead(self, place: int, action: int, neighbour: int) -> None:
        """What lies beyond a way is this place, whatever was thought before."""
        row = self.row(place, action)
        keys = [key for key in self.table.concentrations(row) if key not in (EMPTY, place)]
        if neighbour not in (place, *keys):
            self.table.rename(row, keys[0] if keys else ELSEWHERE, neighbour)

    def may_lead(self, place: int, action: int, neighbour: int) -> None:
        """An action may lead to this place too, besides where it led before: that counts as once at least."""
        self.raise_to(neighbour, place, action, 1.0)

    def learn(self, previous: int, action: int, next_: int, weight: float, *, back: bool = True) -> None:
        """A walked transition, weighted by its pairwise posterior; one that went nowhere was blocked (eq. B_up).

        It leads `back` too, unless that is known to be otherwise.
        """
        if action == self.motions.stay:
            return
        if previous == next_:
            self.shut(previous, action, weight, changed=True, seen=weight > 0.5)
            return
        forward, reverse = self.rates.possible
        self.add(next_, previous, action, weight * forward)
        if back and self.motions.inverse[action] >= 0:  # else nobody knows what undoes it
            self.add(previous, next_, self.motions.inverse[action], weight * reverse)
        if weight > 0.5:
            self.walked.set((previous, action), True)

    def shut(self, place: int, action: int, weight: float, *, changed: bool, seen: bool = True) -> None:
        """The way was found blocked; if that is news, so is its other side, and if it was seen, that is noted."""
        forward, reverse = self.rates.impossible
        self.raise_to(place, place, action, -weight * forward)
        if seen:
            self.sensed.set((place, action), BLOCKED)
        beyond = self.beyond(place, action)
        self.add(ELSEWHERE if beyond is None else beyond, place, action, weight * forward)
        if beyond is None:
            return
        inverse = self.motions.inverse[action]
        if changed and inverse >= 0 and self.beyond(beyond, inverse) in (None, place):  # else it is another door
            self.raise_to(beyond, beyond, inverse, -weight * reverse)
            self.add(place, beyond, inverse, weight * reverse)

    def shut_all(self, place: int, actions: Ints, weight: float) -> None:
        """Ways beyond which no place is known were found blocked: `shut` of many at once."""
        rows, least = place * len(self.motions) + actions, -weight * self.rates.impossible[0]
        keys, prior, before = self.table.slots(rows)
        most = np.maximum(before, self.rates.ceiling)
        shut, elsewhere = np.minimum(np.maximum(before, least), most), np.maximum(before - least, 0.0)
        evidence = np.where(keys == place, shut, elsewhere)
        self.table.write(rows, keys, prior, evidence)
        sensed = self.sensed.values[place].copy()
        sensed[actions] = BLOCKED
        self.sensed.write(place, sensed)

    def raise_to(self, next_: int, previous: int, action: int, level: float) -> None:
        """Have counts of `level` at least."""
        have = self.table.evidence(self.row(previous, action), next_)
        self.add(next_, previous, action, max(level - have, 0.0))

    def level(self, next_: int, previous: int, action: int, level: float) -> None:
        """Have counts of `level`, no more and no less."""
        self.add(next_, previous, action, level - self.table.evidence(self.row(previous, action), next_))

    def add(self, next_: int, previous: int, action: int, amount: float) -> None:
        """Add counts, up to the ceiling."""
        self.table.add(self.row(previous, action), next_, amount, most=self.rates.ceiling)

    def forget(self, keep: float) -> None:
        """Let all evidence fade by the factor `keep`."""
        self.fading = True
        self.table.fade(keep)


def _values(ahead: Successors, places: Ints, arrival: Floats | None) -> Floats:
    """`[n, n']`, or `[n, n', 2]` where the agent may have been moved."""
    here = ahead.places == places[:, None, None]
    values = np.einsum("jk,ijk->ij", ahead.probability * ahead.coupling, here)
    if arrival is None:
        return values
    return np.stack([values, np.broadcast_to(arrival[:, None], values.shape)], axis=-1)
