"""The clone-structured cognitive graph as an agent."""

from collections.abc import Hashable, Mapping, Sequence
from typing import Any

import numpy as np

from ...worlds import Motions, WorldError
from .errands import Errands
from .memory import Memory
from .model import Floats
from .rooms import room_transitions
from .settings import NAVIGATION, CscgSettings, one_of, whole


class CscgAgent:
    """Learns a clone-structured model from its whole history every few steps, and plans with it.

    George et al. 2021, Clone-structured graph representations enable flexible learning and vicarious evaluation of
    cognitive maps, Nat. Commun. 12:2392. It does not sense doors: random moves are uniform over `tries`, those into
    walls among them.

    Args:
        motions: the actions, such as `world.motions`; one of them must stay.
        observations: how many different observations it can meet: sights or, with `positions`, (sight, position) pairs.
        positions: observe the true position too, as `"position"`.
        navigation: `"viterbi"` goes to a preferred sight by the most probable walk, and explores as the settings say;
            `"random"` takes random moves. Either stays where a preferred sight is seen.
        settings: how it learns and explores.
        seed: of its moves and of the random counts, drawn apart: the moves of a random walk do not depend on learning.

    Attributes:
        positions: as given.
        tries: the actions that it takes to explore: all, or all but `stay`.
        learning: False keeps the model of the latest training, while the belief goes on; True at first.

    Raises:
        WorldError: no action that stays, fewer than one observation, or unknown navigation.
    """

    def __init__(
        self,
        motions: Motions,
        *,
        observations: int,
        positions: bool = False,
        navigation: str = "viterbi",
        settings: CscgSettings | None = None,
        seed: int | np.random.SeedSequence | None = None,
    ) -> None:
        one_of("navigation", navigation, NAVIGATION)
        settings = settings or CscgSettings()
        whole("observations", observations, least=1)
        moves, counts = _generators(seed)
        self.positions, self.learning, self._motions = positions, True, motions
        self._labels: dict[Hashable, int] = {}
        self._observations = observations
        self._memory = Memory(observations=observations, actions=len(motions.names), settings=settings, rng=counts)
        self._stay = _staying(motions)
        self.tries = tuple(a for a in range(len(motions.names)) if settings.stays or a != self._stay)
        exploring = settings.exploring if navigation == "viterbi" else "random"
        self._errands = Errands(
            self._memory,
            exploring=exploring,
            goes=navigation == "viterbi",
            clones=settings.clones,
            tries=self.tries,
            rng=moves,
        )
        self._target: Hashable | None = None
        self._prefers = False
        self._action: int | None = None
        self._rooms: tuple[tuple[Any, ...], Floats] | None = None

    @property
    def trainings(self) -> int:
        """How often it was retrained."""
        return self._memory.trainings

    def prefer(self, sights: Mapping[Hashable, float]) -> None:
        """Go to the sight with the highest weight, the first of equal ones; `{}`: explore again.

        Raises:
            WorldError: not a mapping from sights to numbers.
        """
        try:
            best = max(sights, key=lambda sight: float(sights[sight]), default=None)
        except (TypeError, ValueError) as error:
            raise WorldError(f"prefer takes a weight for each sight, such as {{'red': 1.0}}; got {sights!r}") from error
        self._prefers, self._target = bool(sights), best

    def step(self, observation: Mapping[str, Any]) -> int:
        """The next action after `{"sight": label, "open": flag an action}` and, if it observes positions, "position".

        Where another action than the one answered led here, the observation says so: `"taken"`, its index.

        Raises:
            WorldError: the observation lacks a part, has another number of actions, or is one more than
                `observations`.
        """
        sight, label = self._read(observation)
        self._memory.add(observation.get("taken", self._action), self._number(label), learning=self.learning)
        self._action = self._choose(sight)
        return self._action

    def place_transitions(self, rooms: Sequence[int], n: int) -> Floats:
        """P(next room | room, action) as B[next room, previous room, action], `[n, n, K]`.

        As `room_transitions` of the model and path of the latest training: with them the states are matched with
        the true rooms. Zeros before the first training. Cheap between trainings.

        Args:
            rooms: the true room, 0 to n - 1, at each observation so far.
            n: how many rooms there are.

        Raises:
            WorldError: fewer rooms than steps, or a room that is not there.
        """
        learned = self._memory.learned
        if learned is None:
            return np.zeros((n, n, len(self._motions.names)))
        used = tuple(rooms[: len(learned.path)])
        key = (self.trainings, n, used)
        if self._rooms is None or self._rooms[0] != key:
            table = room_transitions(learned.model, learned.path, used, n, named=self.positions)
            table.setflags(write=False)
            self._rooms = (key, table)
        return self._rooms[1]

    def _choose(self, sight: Hashable) -> int:
        if self._prefers and sight == self._target:
            return self._stay
        goals = {number for label, number in self._labels.items() if self._prefers and self._shows(label)}
        return self._errands.action(goals)

    def _shows(self, label: Any) -> bool:
        return (label[0] if self.positions else label) == self._target

    def _read(self, observation: Mapping[str, Any]) -> tuple[Hashable, Hashable]:
        try:
            sight, flags = observation["sight"], np.asarray(observation["open"], dtype=bool)
        except (KeyError, TypeError, ValueError) as error:
            raise WorldError("an observation needs a 'sight' and an 'open' flag for each action") from error
        if flags.shape != (len(self._motions.names),):
            raise WorldError(f"'open' has shape {flags.shape}; give one flag an action, {len(self._motions.names)}")
        if not self.positions:
            return sight, sight
        if observation.get("position") is None:
            raise WorldError("this agent observes positions: add the true 'position', or make it with positions=False")
        return sight, (sight, observation["position"])

    def _number(self, label: Hashable) -> int:
        try:
            number = self._labels.setdefault(label, len(self._labels))
        except TypeError as error:
            raise WorldError(f"a sight and a position must be hashable; got {label!r}") from error
        if number >= self._observations:
            del self._labels[label]
            raise WorldError(f"{label!r} is one more than the {self._observations} observations foreseen; give more")
        return number


def _generators(seed: int | np.random.SeedSequence | None) -> tuple[np.random.Generator, np.random.Generator]:
    # not spawned: that would change a sequence which the caller may use again
    source = seed if isinstance(seed, np.random.SeedSequence) else np.random.SeedSequence(seed)
    return np.random.default_rng(source), np.random.default_rng([1, *source.generate_state(4).tolist()])


def _staying(motions: Motions) -> int:
    still = [not any(vector) for vector in motions.displacements]
    if True not in still:
        raise WorldError("baselines need an action that stays; add one with a displacement of zeros")
    return still.index(True)
