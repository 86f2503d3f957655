"""The paper's studies and the user's own: runs, sweeps, tables and the command line."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .cells import Cell, Key, Row, kept_rows, run_cell, run_cells
    from .exploring import ExploreRun, exploration, explore, explore_many, frontier_steps, oracle_steps, summarise, walk
    from .goals import WEIGHT, check_goal, parse_goal, shortest
    from .judging import BELIEVED, Trail, Verdict, judge
    from .kidnapping import KidnapRun, check_kidnap, kidnap, kidnap_many, kidnap_result
    from .knowledge import Truth
    from .ledger import Ledger
    from .navigating import NavigateRun, navigate, navigate_many, navigate_result
    from .output import check_outputs, file_named, picture_of, unused, write_json, write_picture
    from .parts import AGENTS, CSCG, Maker, Parts
    from .pool import WorkerLostError, completed, map_seeds, map_tasks, workers
    from .records import Record, mean, std
    from .registered import IdRun, ids_result, is_registered, run_id, run_ids
    from .running import Moment, Run, run
    from .session import Session, chart_of, default_steps, draw_start, explored, set_out
    from .text import count, number, spread
    from .yardsticks import frontier_mean, tour_steps

__all__ = [
    "AGENTS", "BELIEVED", "CSCG", "WEIGHT", "Cell", "ExploreRun", "IdRun", "Key", "KidnapRun", "Ledger", "Maker",
    "Moment", "NavigateRun", "Parts", "Record", "Row", "Run", "Session", "Trail", "Truth", "Verdict",
    "WorkerLostError", "chart_of", "check_goal", "check_kidnap", "check_outputs", "completed", "count",
    "default_steps", "draw_start", "exploration", "explore", "explore_many", "explored", "file_named",
    "frontier_mean", "frontier_steps", "ids_result", "is_registered", "judge", "kept_rows", "kidnap", "kidnap_many",
    "kidnap_result", "map_seeds", "map_tasks", "mean", "navigate", "navigate_many", "navigate_result", "number",
    "oracle_steps", "parse_goal", "picture_of", "run", "run_cell", "run_cells", "run_id", "run_ids", "set_out",
    "shortest", "spread", "std", "summarise", "tour_steps", "unused", "walk", "workers", "write_json",
    "write_picture",
]  # fmt: skip

_EARLY = "text pool running output ledger records low_level registered parts judging knowledge session yardsticks"
_MODULES = f"{_EARLY} goals exploring kidnapping navigating cells"


def __getattr__(name: str) -> Any:
    # imported on first use, so that `cogmap --help` need not wait for the agent
    if name in __all__:
        for module in _MODULES.split():
            found = import_module(f".{module}", __name__)
            if name in vars(found):
                return vars(found)[name]
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
