"""Where a CSCG agent goes next."""

from collections.abc import Sequence

import numpy as np

from .memory import Memory


class Errands:
    """Chooses actions: towards goals by bridges, and otherwise as `exploring` says (see `CscgSettings`).

    Args:
        memory: what the agent remembers.
        exploring: `"random"`, `"targets"` or `"curious"`.
        goes: whether it goes to goals by bridges, or leaves that to chance.
        clones: clones an observation.
        tries: the actions that exploring takes.
        rng: of its moves.
    """

    def __init__(
        self,
        memory: Memory,
        *,
        exploring: str,
        goes: bool,
        clones: int,
        tries: Sequence[int],
        rng: np.random.Generator,
    ) -> None:
        self._memory, self._exploring, self._goes, self._clones, self._rng = memory, exploring, goes, clones, rng
        self._tries = np.array(tries, dtype=np.int64)
        self._errand: int | None = None  # the step of the history whose state is the target
        self._patience = 0

    def action(self, goals: set[int]) -> int:
        """The next action; `goals` are the observations wanted that were met before."""
        if goals and self._goes:
            states = {sight * self._clones + clone for sight in goals for clone in range(self._clones)}
            ahead = self._towards(states)
            return self._random() if ahead is None else ahead
        if self._exploring == "targets":
            return self._on_errand()
        return self._curious() if self._exploring == "curious" else self._random()

    def _random(self) -> int:
        return int(self._rng.choice(self._tries))

    def _towards(self, states: set[int]) -> int | None:
        """The first action of the way to any of `states`; None where there is no way, or it has been gone."""
        way = self._memory.way(states)
        return way.actions[0] if way is not None and way.actions else None

    def _on_errand(self) -> int:
        if self._memory.learned is None:
            return self._random()
        if self._errand is None:
            here = self._memory.states[-1]
            others = sorted({state for state in self._memory.states if state != here})
            if not others:
                return self._random()
            target = others[int(self._rng.integers(len(others)))]
            self._errand, self._patience = self._memory.states.index(target), 2 * len(others)
        self._patience -= 1
        target = self._memory.states[self._errand]
        ahead = None if target == self._memory.states[-1] else self._towards({target})
        if ahead is None or self._patience < 0:
            self._errand = None
            return self._random()
        return ahead

    def _curious(self) -> int:
        if self._memory.learned is None:
            return self._random()
        states, tried = self._memory.states, self._memory.tried[:, self._tries]
        known = sorted(set(states))
        least = tried[known].min()
        here = tried[states[-1]]
        if here.min() > least:
            ahead = self._towards({state for state in known if tried[state].min() == least})
            if ahead is not None:
                return ahead
        return int(self._rng.choice(self._tries[here == here.min()]))
