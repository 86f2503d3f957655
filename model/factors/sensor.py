"""What every sensor offers: its part P(reading | s) of the likelihood."""

from collections.abc import Hashable, Iterable
from typing import Any

import numpy as np

from ..errors import CogmapError
from .base import Context, Floats, Ints, ModelFactor, Support, Table
from .transition import Transition

_OF_THE_MOVE = ("moved", "taken", "outcome", "displacement", "turn", "cost", "costs")
_TAKEN = frozenset({"s", "p", "o", "c", "Q", "M", "places", "visits", "transition", "pose", *_OF_THE_MOVE})


class Sensor(ModelFactor):
    """A sensor. Observations have its reading under its name.

    A class of your own has `log_likelihood` at least; whatever it must remember it learns in `learn`.

    Args:
        name: the key in observations.

    Attributes:
        name: that key.
        symbol: of its factor in the window's graph.
        variable: what its observed variable is called there, without the time step.
        kind: of that factor.
        optional: whether an observation may leave it out, which means that it saw nothing.

    Raises:
        CogmapError: the name is no identifier, ends in a digit, or stands for something else already.
    """

    kind = "sight"
    optional = False

    def __init__(self, name: str) -> None:
        if not (isinstance(name, str) and name.isidentifier() and not name[-1].isdigit() and name not in _TAKEN):  # pyright: ignore[reportUnnecessaryIsInstance]
            raise CogmapError(
                f"sensor: cannot be called {name!r}; use a word of letters that is not s, p, o, c or moved"
            )
        self.name = self.variable = name
        self.symbol = f"A_{name}"

    @property
    def options(self) -> dict[str, Any]:
        return {"name": self.name}

    def join(self, context: Context, transitions: Transition) -> None:
        """Make it part of a model, whose ways are given for sensors that sense them."""
        self.attach(context)

    # -- perceiving ----------------------------------------------------------------------------------------

    def check(self, value: Any) -> Any:
        """The value of an observation, normalised; nothing is remembered yet.

        Raises:
            CogmapError: it is none that this sensor could have sensed.
        """
        return value

    def read(self, checked: Any, *, step: int) -> Any:
        """The reading that a checked value is; domains grow with what was never sensed before."""
        return checked

    def glance(self, checked: Any, *, step: int) -> Any:
        """The same reading, of a value that is not to be learned from: it will be read later, or never."""
        return self.read(checked, step=step)

    def label(self, reading: Any) -> Hashable:
        """The reading as the graph shows it."""
        return reading

    # -- inferring -----------------------------------------------------------------------------------------

    def log_likelihood(self, places: Ints, reading: Any) -> Floats:
        """`[n]` log P(reading | s), in nats."""
        raise NotImplementedError

    def likelihood(self, places: Ints, reading: Any) -> Floats:
        """`[n]` P(reading | s), where that is not too small for a number."""
        return np.exp(self.log_likelihood(places, reading))

    def log_predictive(self, reading: Any) -> float:
        """Log P(reading) in a place of which nothing is known, in nats."""
        return 0.0

    def candidates(self, reading: Any) -> tuple[Ints, float] | None:
        """The visited places that may show the reading, and a bound on the probability in every visited place besides.

        None where only looking at all of them can tell.
        """
        return None

    def tables(self, support: Support) -> Iterable[Table]:
        if self.name in support.likelihoods:
            reading = support.percept.readings[self.name]
            o, s = f"{self.variable}{support.step}", f"s{support.step}"
            values, equation = support.likelihoods[self.name][None], f"P({self.variable}_t | s_t)"
            yield Table(self.symbol, (o, s), values, self.kind, equation, observed=(self.label(reading),))

    # -- learning ------------------------------------------------------------------------------------------

    def learn(self, place: int, reading: Any, weight: float) -> None:
        """The reading was sensed in `place`, as far as the agent is certain (`weight`)."""

    def know(self, place: int, value: Any) -> None:
        """A map that was given says this of `place`, under the name of the sensor; None where it says nothing."""

    def recall(self, place: int) -> None:
        """`place` is new: note what is known of it from elsewhere."""

    def information(self, places: Ints, steps: int) -> Floats:
        """`[n, N + 1]` nats that 0..N more visits teach."""
        return np.zeros((len(places), steps + 1))

    def information_unseen(self, steps: int) -> Floats:
        """`[N + 1]` the same in a place that was never imagined."""
        return np.zeros(steps + 1)
