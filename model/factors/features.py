"""P(x | s) of a vector of features: which prototype a place looks like, known again by a likelihood."""

from collections.abc import Collection, Mapping
from typing import Any

import numpy as np

from ..changes import Store
from ..errors import CogmapError
from ..growth_event import GrowthEvent
from ..rates import is_number
from .base import Context, Floats
from .prototypes import Prototypes
from .sight import Reading, Sight
from .transition import Transition

NEGLIGIBLE = 1e-6
"""Likelihood, beside that of the prototype that fits best, below which a prototype is left out of a reading."""


class Features(Sight):
    """A sensor of feature vectors, such as those that a network computes from an image.

    It keeps prototypes, by which it knows vectors again, and gets another one when a vector is more probable as
    something new; for the rest of the model it is a sight of which each label is the number of a prototype, and each
    reading has likelihoods of them. How far vectors stray from their prototype is learned. See `Prototypes`.

    Vectors of which the direction alone matters are given at length 1: the likelihood is then that of von Mises and
    Fisher, with concentration 1 / spread².

    Args:
        name: the key in observations.
        size: numbers of a vector.
        noise: a first guess of the standard deviation about a prototype, as a share of that of prototypes about each
            other.
        prior: as of `Sight`.

    Attributes:
        memory: the prototypes.

    Raises:
        CogmapError: a size below 1, or a noise that is no number above 0.
    """

    def __init__(self, name: str, *, size: int, noise: float = 0.3, prior: float | None = None) -> None:
        super().__init__(name, prior=prior)
        if isinstance(size, bool) or not isinstance(size, int | np.integer) or size < 1:  # pyright: ignore[reportUnnecessaryIsInstance]
            raise CogmapError(f"{name}: size is {size!r}; give how many numbers a vector has, 1 or more")
        if not is_number(noise, 1e-9, 1e9):
            raise CogmapError(f"{name}: noise is {noise!r}; use a number above 0")
        self.size, self.noise = int(size), float(noise)

    @property
    def options(self) -> dict[str, Any]:
        return {"name": self.name, "size": self.size, "noise": self.noise, "prior": self._prior}

    def forget(self, used: Collection[int], *, least: int) -> None:
        """Nothing: labels are prototypes here, which are kept."""

    @property
    def prototypes(self) -> dict[int, Floats]:
        """What vectors of each prototype are like on average, `[size]`, by its number."""
        return dict(zip(self.memory.numbers, self.memory.means, strict=True))

    @property
    def spread(self) -> float:
        """Standard deviation of a number of a vector about that of its prototype, as learned so far."""
        return self.memory.spread

    def join(self, context: Context, transitions: Transition) -> None:
        super().join(context, transitions)
        self.memory = Prototypes(f"{self.name}.prototypes", size=self.size, noise=self.noise)

    @property
    def stores(self) -> tuple[Store, ...]:
        return (*super().stores, self.memory)

    def check(self, value: Any) -> Floats:
        """The vector, as numbers. Raises CogmapError: it is no vector of `size` finite numbers."""
        if isinstance(value, np.ma.MaskedArray) and np.ma.getmaskarray(value).any():  # pyright: ignore[reportUnknownArgumentType, reportUnknownMemberType]
            raise CogmapError(f"observation: {self.name} is masked; give UNSEEN where nothing was seen")
        try:
            array = np.asarray(value)
        except ValueError:
            array = np.array(None)
        if array.dtype.kind not in "biuf":
            kind = type(value).__name__
            raise CogmapError(
                f"observation: {self.name} is a {kind}; give {self.size} numbers, or UNSEEN where nothing was seen"
            )
        vector = array.astype(np.float64)
        if vector.shape != (self.size,):
            raise CogmapError(f"observation: {self.name} has shape {vector.shape}; give {self.size} numbers")
        if not (np.abs(vector) < 1e100).all():
            raise CogmapError(
                f"observation: {self.name} has a number that is not finite, or above 1e100; "
                "give UNSEEN where nothing was seen"
            )
        return vector

    def read(self, checked: Any, *, step: int) -> Reading:
        """The prototype, or likelihoods of several; there is a new one where none is known that fits."""
        log = self.memory.take_in(checked)
        while len(self.labels) < self.memory.count:
            number = self.labels.add(len(self.labels))
            self.table.outcomes = len(self.labels) + 1
            self.context.grown(GrowthEvent(step, "sight", number, number, sensor=self.name))
        told = np.exp(log - log.max())
        likely = np.flatnonzero(told >= NEGLIGIBLE).tolist()
        return likely[0] if len(likely) == 1 else {number: float(told[number]) for number in likely}

    def glance(self, checked: Any, *, step: int) -> Reading:
        """Likelihoods of the prototypes that there are, beside which something new may fit better."""
        known, new = self.memory.log_likelihoods(checked)
        told = np.exp(known - max(known.max(initial=new), new))
        return {number: float(told[number]) for number in self.memory.numbers}

    def restore(self, state: Mapping[str, Any], arrays: Mapping[str, Any], places: int) -> None:
        """Take over labels, counts and prototypes. Raises CogmapError: not one label a prototype."""
        super().restore(state, arrays, places)
        self.memory.restore({part: arrays[f"{self.memory.name}.{part}"] for part in self.memory.state()})
        if self.memory.count != len(self.labels):
            raise CogmapError(f"map: {self.name} has not one label a prototype; save it again")
