"""Lower levels: from pixels to percepts, from ways to low-level actions."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from .loading import BODILY, COLOURS, load_embodied
from .protocol import OUTCOMES, Body, Percept

if TYPE_CHECKING:
    from .errand import errand_of
    from .eyes import Eyes, View
    from .minigrid import MiniGridBody
    from .registered import PixelView, RegisteredWorld
    from .world import GOAL, EmbodiedWorld, embodied

__all__ = [
    "BODILY", "COLOURS", "GOAL", "OUTCOMES", "Body", "EmbodiedWorld", "Eyes", "MiniGridBody", "Percept", "PixelView",
    "RegisteredWorld", "View", "embodied", "errand_of", "load_embodied",
]  # fmt: skip

_HEAVY = ("errand", "eyes", "minigrid", "registered", "world")


def __getattr__(name: str) -> Any:
    if name in __all__:
        from ..worlds import minigrid as mg

        mg.need_minigrid()
        for module in _HEAVY:
            found = vars(import_module(f".{module}", __name__))
            if name in found:
                return found[name]
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
