"""What a CSCG agent remembers: its history, the model learned from it, and where it believes to be."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property

import numpy as np

from .bridging import Bridge, Roads, bridge
from .inference import filtered, followed
from .learning import baum_welch
from .model import CloneModel, Floats, empty_model, sprinkled
from .sequence import Ints, Walk
from .settings import CscgSettings
from .viterbi import viterbi_training


class Memory:
    """The history of one agent, and what its latest training made of it.

    Attributes:
        sights: index of each observation so far.
        actions: each action between them.
        states: the state of each step: decoded up to the latest training, the most probable one since.
        trainings: how many trainings there were.
        learned: what the latest one learned; None before the first.
    """

    def __init__(self, *, observations: int, actions: int, settings: CscgSettings, rng: np.random.Generator) -> None:
        self._settings, self._rng = settings, rng
        self.sights: list[int] = []
        self.actions: list[int] = []
        self.states: list[int] = []
        self.trainings = 0
        self.learned: Learned | None = None
        self._clones = np.full(settings.clones, 1 / settings.clones)
        self._counts = empty_model(
            observations=observations, clones=settings.clones, actions=actions, pseudocount=settings.pseudocount
        )

    def add(self, action: int | None, sight: int, *, learning: bool = True) -> None:
        """Note what was observed after `action` (None at first), and retrain when it is time, if `learning`."""
        if action is not None:
            self.actions.append(action)
            if self.learned is not None:
                self._clones = followed(
                    self.learned.model, self._clones, sight=self.sights[-1], action=action, after=sight
                )
        self.sights.append(sight)
        self.states.append(sight * self._settings.clones + int(self._clones.argmax()))
        if learning and len(self.sights) % self._settings.retrain_every == 0:
            self._train()

    @property
    def belief(self) -> Floats:
        """`[S]` the probability of each state now."""
        belief = np.zeros((self._counts.observations, self._settings.clones))
        belief[self.sights[-1]] = self._clones
        return belief.reshape(-1)

    @property
    def tried(self) -> Ints:
        """`[S, K]` how often each action was taken in each state, by `states`."""
        table = np.zeros((self._counts.states, self._counts.actions), dtype=np.int64)
        np.add.at(table, (self.states[: len(self.actions)], self.actions), 1)
        return table

    def way(self, targets: set[int]) -> Bridge | None:
        """The most probable walk from the belief to a target state; None before the first training."""
        if self.learned is None:
            return None
        return bridge(self.learned.roads, self.belief, targets, steps=self._counts.states)

    def _train(self) -> None:
        settings, walk = self._settings, Walk.of(self.sights, self.actions)
        start = self._counts if settings.retraining == "continue" else _bare(self._counts)
        fit = baum_welch(
            sprinkled(start, self._rng, among=walk), walk, iterations=settings.iterations, tolerance=settings.tolerance
        )
        model = replace(fit.model, pseudocount=float(settings.viterbi_pseudocount))
        hard = viterbi_training(model, walk, iterations=settings.viterbi_iterations)
        self._counts, self.learned = fit.model, Learned(hard.model, hard.path)
        self.states, self._clones = hard.path.tolist(), filtered(hard.model, walk)[-1]
        self.trainings += 1


class Learned:
    """A trained model and the path that it decoded."""

    def __init__(self, model: CloneModel, path: Ints) -> None:
        self.model, self.path = model, path

    @cached_property
    def roads(self) -> Roads:
        """For planning."""
        return Roads(self.model)


def _bare(model: CloneModel) -> CloneModel:
    return empty_model(
        observations=model.observations, clones=model.clones, actions=model.actions, pseudocount=model.pseudocount
    )
