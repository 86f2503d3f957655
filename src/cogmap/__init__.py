"""Agents that build their own map: `from cogmap import Agent, load_world`."""

from __future__ import annotations

from importlib import import_module
from importlib.metadata import version
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:  # a type checker finds these in an installed wheel, not in a checkout
    from cogmap.agent import Agent, Settings  # pyright: ignore[reportMissingImports]
    from cogmap.model import UNSEEN  # pyright: ignore[reportMissingImports]
    from cogmap.worlds import load_world  # pyright: ignore[reportMissingImports]

__version__ = version("cogmap")

_HOMES = {"UNSEEN": "model", "Agent": "agent", "Settings": "agent", "load_world": "worlds"}

__all__ = ["UNSEEN", "Agent", "Settings", "__version__", "load_world"]


def __getattr__(name: str) -> Any:
    # imported on first use, so that `import cogmap.worlds` need not wait for the agent
    if name in _HOMES:
        return getattr(import_module(f"cogmap.{_HOMES[name]}"), name)
    raise AttributeError(f"module 'cogmap' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
