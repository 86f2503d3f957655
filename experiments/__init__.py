"""The paper's studies and the user's own: runs, sweeps, tables and the command line."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .exploring import ExploreRun, Walk, default_steps, explore, walk
    from .kidnapping import KidnapRun, kidnap, kidnap_many, kidnap_result
    from .knowledge import BELIEVED, Truth
    from .navigating import NavigateRun, navigate, navigate_many, parse_goal
    from .navigation import navigate_result
    from .oracle import frontier_steps, oracle_steps
    from .pool import map_seeds, map_tasks
    from .sweep import exploration, explore_many, summarise
    from .walkers import AGENTS, Walker, check_agent, make_walker

__all__ = [
    "AGENTS",
    "BELIEVED",
    "ExploreRun",
    "KidnapRun",
    "NavigateRun",
    "Truth",
    "Walk",
    "Walker",
    "check_agent",
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
    "summarise",
    "walk",
]

_MODULES = ("exploring", "kidnapping", "knowledge", "navigating", "navigation", "oracle", "pool", "sweep", "walkers")


def __getattr__(name: str) -> Any:
    # imported on first use, so that `cogmap --help` need not wait for the agent
    if name in __all__:
        for module in _MODULES:
            found = import_module(f".{module}", __name__)
            if name in vars(found):
                return vars(found)[name]
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
