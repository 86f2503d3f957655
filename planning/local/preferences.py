"""What the agent hopes for."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from .transitions import Floats, Ints


@dataclass(frozen=True, slots=True)
class Preferences:
    """What the agent prefers, and what it avoids."""

    # log preference of sights by number, relative to all others, in nats; `-1` stands for a sight never met
    sights: Mapping[int, float] = field(default_factory=dict[int, float])
    # log preference of being in a place, by number, relative to all others, in nats
    places: Mapping[int, float] = field(default_factory=dict[int, float])
    collision_cost: float = 1.0  # -log P(c = 1): what a collision costs, in nats

    @property
    def known(self) -> bool:
        """Whether anything is hoped for that the map may have already."""
        sights = (value for key, value in self.sights.items() if key >= 0)
        return any(value > 0.0 for value in (*sights, *self.places.values()))

    def log_C(self, outcomes: int) -> tuple[Ints, Floats, float]:
        """Preferred outcomes, their log C, and that of each of the others, of `outcomes` in all."""
        keys = np.array(sorted(self.sights), dtype=np.int64)
        values = np.array([self.sights[int(key)] for key in keys])
        if not len(keys):
            return keys, values, 0.0
        norm = float(np.logaddexp.reduce(np.append(values, np.log(max(outcomes - len(keys), 1e-300)))))
        return keys, values - norm, -norm

    def log_C_place(self, places: Ints) -> Floats:
        """`[n]` log preference of being in each of `places`."""
        log_C = np.zeros(len(places))
        for place, value in self.places.items():
            log_C[places == place] = value
        return log_C
