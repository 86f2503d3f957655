"""The paper's studies and the user's own: runs, sweeps, tables and the command line."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .cell_row import Row
    from .cells import Cell, run_cell, run_cells
    from .executors import workers
    from .exploring import ExploreRun, Walk, default_steps, explore, walk
    from .kidnapping import KidnapRun, kidnap, kidnap_many, kidnap_result
    from .knowledge import BELIEVED, Truth
    from .ledger import Ledger
    from .navigating import NavigateRun, navigate, navigate_many, parse_goal
    from .navigation import navigate_result
    from .oracle import frontier_steps, oracle_steps
    from .pool import WorkerLostError, completed, map_seeds, map_tasks
    from .sweep import exploration, explore_many, summarise
    from .walkers import AGENTS, Walker, check_agent, make_walker

__all__ = [
    "AGENTS",
    "BELIEVED",
    "Cell",
    "ExploreRun",
    "KidnapRun",
    "Ledger",
    "NavigateRun",
    "Row",
    "Truth",
    "Walk",
    "Walker",
    "WorkerLostError",
    "check_agent",
    "completed",
    "default_steps",
    "exploration",
    "explore",
    "explore_many",
    "frontier_steps",
    "kidnap",
    "kidnap_many",
    "kidnap_result",
    "make_walker",
    "map_seeds",
    "map_tasks",
    "navigate",
    "navigate_many",
    "navigate_result",
    "oracle_steps",
    "parse_goal",
    "run_cell",
    "run_cells",
    "summarise",
    "walk",
    "workers",
]

_MODULES = (
    "cell_row",
    "cells",
    "executors",
    "exploring",
    "kidnapping",
    "knowledge",
    "ledger",
    "navigating",
    "navigation",
    "oracle",
    "pool",
    "sweep",
    "walkers",
)


def __getattr__(name: str) -> Any:
    # imported on first use, so that `cogmap --help` need not wait for the agent
    if name in __all__:
        for module in _MODULES:
            found = import_module(f".{module}", __name__)
            if name in vars(found):
                return vars(found)[name]
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
