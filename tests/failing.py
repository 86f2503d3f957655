"""Parts and observations of somebody else, whose every method may fail, before its work is done or after it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from inspect import getattr_static
from types import FunctionType
from typing import Any

from cogmap.agent import Agent, Settings
from cogmap.model import Features, Lattice, PredictedGrowth, Sight, Ways
from cogmap.planning import TERMS, MapGuided, Outward, Planner
from cogmap.worlds import GRID

_OF_THE_AGENT = frozenset({"savepoint", "go_back", "state", "restore", "attach", "join", "grow", "options", "copy"})
"""Methods by which a part is made, kept and put back."""


class Failing(Exception):  # noqa: N818
    """Of somebody else."""


class Clock:
    """Counts the calls of parts of somebody else, and has one fail.

    Attributes:
        calls: so many since it was set.
        fails: the one that fails; None for none.
    """

    calls = 0
    fails: int | None = None

    def set(self, fails: int | None) -> None:
        """Count from the beginning."""
        self.calls, self.fails = 0, fails

    def tick(self, name: str) -> None:
        """One more call."""
        self.calls += 1
        if self.calls == self.fails:
            self.fails = None
            raise Failing(name)


CLOCK = Clock()


def _method(kind: type[Any], name: str) -> Any:
    inherited = getattr_static(kind, name)

    def method(self: Any, *args: Any, **options: Any) -> Any:
        CLOCK.tick(name)
        result = inherited(self, *args, **options)
        CLOCK.tick(name)
        return result

    return method


def somebodys(kind: type[Any]) -> type[Any]:
    """A class like that, of somebody else."""
    names = [name for name in dir(kind) if not name.startswith("_") and name not in _OF_THE_AGENT]
    methods = {name: _method(kind, name) for name in names if isinstance(getattr_static(kind, name), FunctionType)}
    return type(kind)(f"Own{kind.__name__}", (kind,), {**methods, "__module__": "somebody"})


OwnSight, OwnFeatures, OwnWays, OwnLattice, OwnGrowth, OwnPolicies, OwnChoice = map(
    somebodys, (Sight, Features, Ways, Lattice, PredictedGrowth, MapGuided, Outward)
)
OWN_TERMS = tuple(somebodys(type(term))() for term in TERMS)


class Observation(Mapping[str, Any]):
    """Fails when it is read."""

    def __init__(self, values: Mapping[str, Any]) -> None:
        self._values = values

    def __getitem__(self, name: str) -> Any:
        CLOCK.tick(name)
        return self._values[name]

    def __iter__(self) -> Iterator[str]:
        CLOCK.tick("iter")
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)


def agent_of_somebody(seed: int = 0) -> Agent:
    """One all of whose parts are somebody else's."""
    planner = Planner(policies=OwnPolicies(), terms=OWN_TERMS, choice=OwnChoice())
    sensors = [OwnSight("sight"), OwnFeatures("view", size=2), OwnWays()]
    own: dict[str, Any] = {"sensors": sensors, "pose": OwnLattice(), "growth": OwnGrowth(), "planner": planner}
    return Agent(GRID, **own, settings=Settings(look_ahead=2), seed=seed)
