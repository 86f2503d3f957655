"""A frame that may turn: the agent infers by how many quarter turns, together with the place."""

from collections.abc import Mapping
from typing import Any, Self, cast

import numpy as np
from numpy.typing import NDArray

from ..inference import Belief
from ..model import UNSEEN, CogmapError, Motions
from .agent import Agent
from .packing import Arrays
from .perceiving import checked

SURPRISE = 3.0
"""Nats by which another place or another turn must explain a percept better before the frame is in question."""
SURE = 0.9  # belief in one turn from which on it is taken as so
_FITS = -6.0  # log-likelihood below which nothing that is known fits: this is somewhere new
_STRAY = 1e-3  # share of the belief that is spread over everything, each step of a search


class TurningAgent(Agent):
    """An agent that may be silently moved and turned, for bodies without a compass.

    While everything fits it is an `Agent`. Where what it senses fits another known place, or the same places in a frame
    turned by quarters, far better than the place where it should be, its map is left alone: a filter over (place, turn)
    takes in what is sensed, it goes where that tells most, and once the turn is certain it goes on in that frame, told
    that it was moved. A `turn` in an observation, in degrees clockwise as it was measured, turns the frame by the
    nearest quarter.

    Attributes:
        turn: quarter turns, from up to right, of what the body calls up in the frame of the map.
        searching: whether that is in question.

    Raises:
        CogmapError: the actions are not four quarter turns of one another, and staying.
    """

    _frame_turns = True

    def _assemble(self, *parts: Any, **named: Any) -> None:
        super()._assemble(*parts, **named)
        self._turns = turns_of(self.map.motions)
        self.turn = 0
        self._sought: NDArray[np.float64] | None = None  # [visited places, 4]
        self._done = self.map.motions.stay

    @property
    def searching(self) -> bool:
        """Whether its frame is in question."""
        return self._sought is not None

    @property
    def certain(self) -> bool:
        """Whether one place holds enough of the belief, and the frame is not in question."""
        return not self.searching and super().certain

    def step(self, observation: Mapping[str, Any]) -> int:
        """As `Agent.step`; actions and ways are those of the body's frame."""
        return self._whole(lambda: self._step(observation))

    def _step(self, observation: Mapping[str, Any]) -> int:
        sensed = checked(observation, self.map)
        self._turn_by(round(sensed.get("turn", 0.0) / 90.0) % 4)
        fits = self._fits(sensed) if self.steps else None
        if fits is None or not (self.searching or self._surprised(fits)):
            return self._own(observation)
        if float(fits.max()) < _FITS:  # nothing that is known
            self._sought = None
            return self._own(observation)
        self._sought = self._filtered(fits)
        by_turn = self._sought.sum(axis=0)
        if by_turn.max() >= SURE:
            self.turn, self._sought = int(by_turn.argmax()), None
            self.moved()
            return self._own({key: value for key, value in observation.items() if key != "outcome"})
        self._done = self._telling(sensed)
        return self._done

    def _turn_by(self, quarters: int) -> None:
        """The body has turned by so many quarters after its last move, and knows it."""
        self.turn = (self.turn + quarters) % 4
        self._done = int(np.flatnonzero(self._turns[quarters] == self._done)[0])  # as it would be called now
        if self._sought is not None:
            self._sought = np.roll(self._sought, quarters, axis=1)

    def _own(self, observation: Mapping[str, Any]) -> int:
        """The step of an agent whose frame is known."""
        if self.turn and "open" in observation:
            sensed = checked(observation, self.map)["open"]
            if sensed is not UNSEEN:
                observation = {**observation, "open": self._turned(sensed, self.turn)}
        action = super().step(observation)
        self._done = int(np.flatnonzero(self._turns[self.turn] == action)[0])
        return self._done

    # -- going back, and files -----------------------------------------------------------------------------

    def _kept(self) -> Any:
        return self.turn, self._sought, self._done

    def _put_back(self, kept: Any) -> None:
        self.turn, self._sought, self._done = kept

    def state(self) -> tuple[dict[str, Any], Arrays]:
        """As of an `Agent`, and how its frame is turned."""
        header, arrays = super().state()
        sought = None if self._sought is None else self._sought.tolist()
        return {**header, "turning": {"turn": self.turn, "done": self._done, "sought": sought}}, arrays

    @classmethod
    def from_state(cls, header: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]], **parts: Any) -> Self:
        """The agent that `state` took apart; see `load`.

        Raises:
            CogmapError: its frame is turned as none can be, or as for `Agent`.
        """
        told: Mapping[str, Any] = header.get("turning", {"turn": 0, "done": header["state"]["action"], "sought": None})
        agent = super().from_state({k: v for k, v in header.items() if k != "turning"}, arrays, **parts)
        done = agent.map.motions.stay if told["done"] is None else told["done"]
        sought = None if told["sought"] is None else np.array(told["sought"], dtype=np.float64)
        whole = all(isinstance(number, int) and not isinstance(number, bool) for number in (told["turn"], done))
        shape = (len(agent.map.visited_places), 4)
        sound = sought is None or (sought.shape == shape and (sought >= 0.0).all() and abs(sought.sum() - 1.0) < 1e-6)
        if not (whole and 0 <= told["turn"] < 4 and 0 <= done < len(agent.map.motions) and sound):
            raise CogmapError("its frame is turned as none can be")
        agent._put_back((told["turn"], sought, done))
        return agent

    # -- where, and turned how -----------------------------------------------------------------------------

    def _turned(self, ways: Any, turn: int) -> tuple[Any, ...]:
        """What is sensed of ways, in the order of the map's actions, for a body turned so."""
        turned: list[Any] = [None] * len(ways)
        for action, way in enumerate(ways):
            turned[int(self._turns[turn][action])] = way
        return tuple(turned)

    def _fits(self, sensed: Mapping[str, Any]) -> NDArray[np.float64]:
        """`[visited places, 4]` log P(percept | place, turn)."""
        places = self.map.visited_places
        fits = np.zeros((len(places), 4))
        for name, sensor in cast(Mapping[str, Any], self.map.sensors).items():
            if sensed[name] is UNSEEN:
                continue
            if name != "open":
                fits += sensor.log_likelihood(places, sensor.glance(sensed[name], step=self.steps))[:, None]
                continue
            for turn in range(4):
                fits[:, turn] += sensor.log_likelihood(places, self._turned(sensed[name], turn))
        return fits

    def _surprised(self, fits: NDArray[np.float64]) -> bool:
        """Whether it was sure of where it is, the place where it should be is known, and something else fits better."""
        belief: Belief = self.belief
        if belief.certainty < self.settings.certainty:
            return False
        action = int(self._turns[self.turn][self._done])
        ahead = self._ahead(np.array([belief.place]))[0, action]
        at = np.flatnonzero(self.map.visited_places == ahead)
        return len(at) > 0 and float(fits[at[0], self.turn]) < float(fits.max()) - SURPRISE

    def _ahead(self, places: NDArray[np.int64]) -> NDArray[np.int64]:
        """`[n, K]` where each action most probably leads from each place; -1 where nothing is known."""
        keys, p, _ = self.map.B_s.mean(self.map.rows_of(places))
        best = np.where(keys >= 0, p, -1.0).argmax(axis=1)
        return keys[np.arange(len(keys)), best].reshape(len(places), len(self.map.motions))

    def _filtered(self, fits: NDArray[np.float64]) -> NDArray[np.float64]:
        places = self.map.visited_places
        even = np.full(fits.shape, 1.0 / fits.size)
        prior = even
        if self._sought is not None and self._sought.shape == fits.shape:
            prior = np.zeros(fits.shape)
            index = np.full(int(places.max()) + 2, -1)
            index[places] = np.arange(len(places))
            ahead = self._ahead(places)
            for turn in range(4):
                to = ahead[:, int(self._turns[turn][self._done])]
                known = np.where((to >= 0) & (to <= places.max()), index[np.clip(to, -1, places.max())], -1)
                np.add.at(prior[:, turn], known[known >= 0], self._sought[known >= 0, turn])
            prior = (1.0 - _STRAY) * prior + _STRAY * even
        weights = np.exp(np.log(prior) + fits - fits.max())
        return weights / weights.sum()

    def _telling(self, sensed: Mapping[str, Any]) -> int:
        """The open way whose outcome, as the hypotheses foresee it, is the least certain."""
        assert self._sought is not None
        places, motions = self.map.visited_places, self.map.motions
        ahead, worth = self._ahead(places), np.full(len(motions), -1.0)
        ways = sensed.get("open", UNSEEN)
        looks = self._looks()
        for action in range(len(motions)):
            if action == motions.stay or (ways is not UNSEEN and ways[action] is not None and ways[action] < 0.5):
                continue
            outcomes: dict[Any, float] = {}
            for row, turn in np.argwhere(self._sought > 1e-3).tolist():
                to = int(ahead[row, int(self._turns[turn][action])])
                seen = looks.get((to, turn), to)
                outcomes[seen] = outcomes.get(seen, 0.0) + float(self._sought[row, turn])
            mass = np.array([*outcomes.values()])
            worth[action] = float(-(mass * np.log(mass)).sum())
        best = np.flatnonzero(worth >= worth.max() - 1e-9)
        return int(best[int(self.rng.integers(len(best)))])

    def _looks(self) -> dict[tuple[int, int], Any]:
        """What each visited place most probably looks like for a body turned so."""
        places = self.map.visited_places
        sights: list[Any] = [sensor for sensor in self.map.sensors.values() if hasattr(sensor, "labels")]
        looks: dict[tuple[int, int], Any] = {}
        ahead = self._ahead(places)
        for row, place in enumerate(places.tolist()):
            here = np.array([place])
            seen = tuple(
                max(range(len(sensor.labels)), key=lambda label, see=sensor: float(see.likelihood(here, label)[0]))
                for sensor in sights
            )
            walls = ahead[row] == place
            for turn in range(4):
                looks[place, turn] = (seen, tuple(bool(walls[a]) for a in self._turns[turn]))
        return looks


def turns_of(motions: Motions) -> NDArray[np.int64]:
    """`[4, K]` which action of the map each action of a body is that is turned by so many quarters.

    Raises:
        CogmapError: displacements are not in a plane, or a quarter turn of one is none of them.
    """
    where = {tuple(vector): action for action, vector in enumerate(motions.displacements)}
    turned: list[list[int]] = []
    vectors = [tuple(vector) for vector in motions.displacements]
    for _ in range(4):
        if not all(len(vector) == 2 and vector in where for vector in vectors):
            raise CogmapError("agent: a frame that turns needs actions in a plane, each a quarter turn of another")
        turned.append([where[vector] for vector in vectors])
        vectors = [(right, -down) for down, right in vectors]
    return np.array(turned)
