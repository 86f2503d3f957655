"""The paper's studies and the user's own: runs, sweeps, tables and the command line."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .cells import Cell, Row, run_cell, run_cells
    from .executors import workers
    from .exploring import ExploreRun, Walk, exploration, explore, explore_many, summarise, walk
    from .goals import parse_goal
    from .kidnapping import KidnapRun, kidnap, kidnap_many, kidnap_result
    from .knowledge import BELIEVED, Truth
    from .ledger import Ledger
    from .navigating import WEIGHT, NavigateRun, navigate, navigate_many, navigate_result
    from .oracle import frontier_steps, oracle_steps
    from .output import check_outputs, write_json, write_picture
    from .parts import AGENTS, CSCG, Maker, Parts
    from .pool import WorkerLostError, completed, map_seeds, map_tasks
    from .running import Moment, Run, run
    from .session import Options, Session, chart_of, default_steps, draw_start, explored, set_out
    from .statistics import count, mean, number, spread, std

__all__ = [
    "AGENTS",
    "BELIEVED",
    "CSCG",
    "WEIGHT",
    "Cell",
    "ExploreRun",
    "KidnapRun",
    "Ledger",
    "Maker",
    "Moment",
    "NavigateRun",
    "Options",
    "Parts",
    "Row",
    "Run",
    "Session",
    "Truth",
    "Walk",
    "WorkerLostError",
    "chart_of",
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
    "map_seeds",
    "map_tasks",
    "mean",
    "navigate",
    "navigate_many",
    "navigate_result",
    "number",
    "oracle_steps",
    "parse_goal",
    "run",
    "run_cell",
    "run_cells",
    "set_out",
    "spread",
    "std",
    "summarise",
    "walk",
    "workers",
    "write_json",
    "write_picture",
]

_MODULES = (
    "running pool executors statistics output ledger records parts knowledge oracle session goals exploring "
    "kidnapping navigating cells"
)


def __getattr__(name: str) -> Any:
    # imported on first use, so that `cogmap --help` need not wait for the agent
    if name in __all__:
        for module in _MODULES.split():
            found = import_module(f".{module}", __name__)
            if name in vars(found):
                return vars(found)[name]
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
