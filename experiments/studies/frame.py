"""What every study has in common: its name, and how it is run.

The study `x` is the module `x` beside this one with `x_study` and `x_lines`, and the module `x_figures` with
`x_figures`. In `x` there may also be `SETTINGS`, the settings that the protocol asks for; `x_tables`, its tables, where
those are not to be read off its JSON; and `x_tasks`, how often it reports to be done with a part.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from importlib import import_module
from typing import TYPE_CHECKING, Any, Protocol

from ...agent import Settings
from ...model.errors import CogmapError
from .failures import failures
from .json_tables import json_tables
from .report import Table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..ledger import Ledger

EVERYTHING = "all"
"""Stands for every study, one after the other."""


class Result(Protocol):
    """What a study gives back."""

    def to_dict(self) -> dict[str, Any]:
        """The result as plain JSON values."""
        ...


@dataclass(frozen=True, slots=True)
class Study:
    """A study that can be asked for by name.

    Attributes:
        name: of the study, its module and its functions.
        agents: how many take part unless told otherwise.
        keeps_cells: whether its runs are kept in a ledger as they finish, and not run again.
    """

    name: str
    agents: int
    keeps_cells: bool = False

    def run(
        self,
        *,
        agents: int,
        seed: int = 0,
        look_ahead: int | None = None,
        executor: Executor | None = None,
        ledger: Ledger | None = None,
        on_done: Callable[[], None] | None = None,
    ) -> Result:
        """Let `agents` agents take part, with the settings of the protocol but for `look_ahead`, if that is given.

        Args:
            agents: how many; agent i has the seed `seed` + i.
            seed: of the first.
            look_ahead: steps that a policy looks ahead.
            executor: where the work is done; in this process if None.
            ledger: of a study that keeps one; see `grid.ledger_in`.
            on_done: called `parts(agents)` times while the work goes on.

        Raises:
            CogmapError: a number is out of range, or a process was killed.
        """
        settings = None if look_ahead is None else self.settings(look_ahead)
        study = getattr(self._module(), f"{self.name}_study")
        kept: dict[str, Any] = {"ledger": ledger} if self.keeps_cells else {}
        return study(agents=agents, seed=seed, settings=settings, executor=executor, on_done=on_done, **kept)

    def settings(self, look_ahead: int | None = None) -> Settings:
        """The settings of the protocol, with another look-ahead if one is given.

        Raises:
            CogmapError: `look_ahead` is below 1.
        """
        own: Settings = getattr(self._module(), "SETTINGS", None) or Settings()
        return own if look_ahead is None else replace(own, look_ahead=look_ahead)

    def parts(self, agents: int) -> int:
        """How often `run` calls `on_done`."""
        return getattr(self._module(), f"{self.name}_tasks", _itself)(agents)

    def lines(self, result: Result) -> list[str]:
        """What the terminal shows of the result."""
        return getattr(self._module(), f"{self.name}_lines")(result)

    def figures(self, result: Result) -> dict[str, Figure]:
        """The figures, by the stem of their file."""
        module = import_module(f".{self.name}_figures", __package__)
        return getattr(module, f"{self.name}_figures")(result)

    @property
    def has_tables(self) -> bool:
        """Whether it has tables that say all that its lines do."""
        return hasattr(self._module(), f"{self.name}_tables")

    def tables(self, result: Result) -> Sequence[Table]:
        """The tables, the main rows first."""
        if not self.has_tables:
            return json_tables(self.name, result.to_dict())
        return getattr(self._module(), f"{self.name}_tables")(result)

    def failed(self, result: Result) -> tuple[str, ...]:
        """What did not get there, one line each."""
        own = getattr(result, "failed", None)
        return failures(self.name, result.to_dict()) if own is None else own()

    def _module(self) -> Any:
        return import_module(f".{self.name}", __package__)


STUDIES = {
    study.name: study
    for study in (
        Study("exploration", 20, keeps_cells=True),
        Study("rooms", 20, keeps_cells=True),
        Study("growth", 20, keeps_cells=True),
        Study("cost", 5),
        Study("localisation", 20),
        Study("goals", 20),
        Study("donut", 20),
        Study("tolman", 10),
        Study("martinet", 40),
        Study("insight", 40),
    )
}


def study_named(name: str) -> Study:
    """The study of that name.

    Raises:
        CogmapError: there is none.
    """
    if name not in STUDIES:
        raise CogmapError(f"no study is called {name!r}; choose one of {', '.join(STUDIES)}, or {EVERYTHING}")
    return STUDIES[name]


def _itself(agents: int) -> int:
    return agents
