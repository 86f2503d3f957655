"""Going home, and dead ends: where a way leads, whatever was there before."""

from typing import Any

import numpy as np

from ..choices import Choices
from .base import Floats, Parameter, Term


def _pull(name: str, meaning: str) -> Parameter:
    spans = {"low": -10.0, "high": 10.0, "start": 0.0, "spread": 0.2, "doubt": 3.0}
    return Parameter(name=name, meaning=meaning, typical=(-1.0, 1.0), **spans)


class Home(Term):
    """A pull towards home, one that grows with how far home is, and a pull into dead ends."""

    parameters = (
        _pull("homeward", "nats for ways that lead nearer to home"),
        _pull("homeward from afar", "nats more for these from the farthest place than from home itself"),
        _pull("dead end", "nats for ways into dead ends"),
    )

    def prepare(self, choices: Choices) -> Any:
        home = choices.homeward.astype(np.float64)
        return np.stack([home, home * choices.far[:, None], choices.end.astype(np.float64)])

    def weigh(self, prepared: Any, values: Floats) -> tuple[Floats, Floats]:
        pull: Floats = np.einsum("p,pck->ck", values, prepared)
        return pull, prepared
