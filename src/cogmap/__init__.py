"""Agents that build their own map: growing cognitive maps as explicit discrete factor graphs.

`from cogmap import Agent, Settings, load_world` is what a first walk needs; everything else is in the folders:
`cogmap.worlds`, `cogmap.model`, `cogmap.inference`, `cogmap.planning`, `cogmap.agent`, `cogmap.views`,
`cogmap.baselines`, `cogmap.experiments`. The names here are imported when they are first used.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .agent import Agent, Settings
    from .worlds import load_world

    __version__: str

_HOMES = {"Agent": "agent", "Settings": "agent", "load_world": "worlds"}

__all__ = ["Agent", "Settings", "__version__", "load_world"]


def __getattr__(name: str) -> Any:
    if name == "__version__":
        from importlib.metadata import version

        return version("cogmap")
    if name in _HOMES:
        return getattr(import_module(f".{_HOMES[name]}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
