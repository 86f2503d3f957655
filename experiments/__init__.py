"""The paper's studies and the user's own: runs, sweeps, tables and the command line."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .cell_row import Row
    from .cells import Cell, run_cell, run_cells
    from .cli_table import count, number, spread
    from .executors import workers
    from .exploring import ExploreRun, Walk, default_steps, draw_start, explore, walk
    from .kidnapping import KidnapRun, kidnap, kidnap_many, kidnap_result
    from .knowledge import BELIEVED, Truth
    from .ledger import Ledger
    from .navigating import NavigateRun, navigate, navigate_many, parse_goal
    from .navigation import navigate_result
    from .oracle import frontier_steps, oracle_steps
    from .output import check_outputs, write_json, write_picture
    from .pool import WorkerLostError, completed, map_seeds, map_tasks
    from .session import Session, explored, mean, std
    from .sweep import exploration, explore_many, summarise
    from .walkers import AGENTS, CSCG, Walker, check_agent, make_walker, sensed

__all__ = [
    "AGENTS",
    "BELIEVED",
    "CSCG",
    "Cell",
    "ExploreRun",
    "KidnapRun",
    "Ledger",
    "NavigateRun",
    "Row",
    "Session",
    "Truth",
    "Walk",
    "Walker",
    "WorkerLostError",
    "check_agent",
    "check_outputs",
    "completed",
    "count",
    "default_steps",
    "draw_start",
    "exploration",
    "explore",
    "explore_many",
    "explored",
    "frontier_steps",
    "kidnap",
    "kidnap_many",
    "kidnap_result",
    "make_walker",
    "map_seeds",
    "map_tasks",
    "mean",
    "navigate",
    "navigate_many",
    "navigate_result",
    "number",
    "oracle_steps",
    "parse_goal",
    "run_cell",
    "run_cells",
    "sensed",
    "spread",
    "std",
    "summarise",
    "walk",
    "workers",
    "write_json",
    "write_picture",
]

_MODULES = (
    "session",
    "output",
    "cli_table",
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
