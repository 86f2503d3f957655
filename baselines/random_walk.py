"""The random walk."""

from collections.abc import Sequence

from .explorer import Explorer


class RandomAgent(Explorer):
    """Takes any open way but `stay`, uniformly. It stays where no way is open, or where it sees what it prefers."""

    def _choose(self, is_open: Sequence[bool]) -> int:
        stay = self._reckoner.stay
        ways = [action for action, free in enumerate(is_open) if free and action != stay]
        return ways[int(self._rng.integers(len(ways)))] if ways else stay
