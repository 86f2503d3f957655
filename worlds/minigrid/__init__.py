"""Room mazes, and any others, as MiniGrid environments; MiniGrid itself is imported when one is made."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from .floorplan import Floorplan, Passage, Tile, draw_floorplan
from .geometry import DOORS, Geometry
from .missing import INSTALL, need_minigrid
from .palette import COLOURS, SIGHTS, WHITE, decode_floor, encode_floor, floors_of
from .steps import covering_low_steps, low_steps_between
from .tally import AHEAD, Tally, view_offsets

if TYPE_CHECKING:
    from .environment import RoomsEnv, rooms_env
    from .tiles import TILE, UNSEEN, Code, ColouredFloor, codes, look_of, paint
    from .unsteady import Unsteady

__all__ = [
    "AHEAD", "COLOURS", "DOORS", "INSTALL", "SIGHTS", "TILE", "UNSEEN", "WHITE", "Code", "ColouredFloor", "Floorplan",
    "Geometry", "Passage", "RoomsEnv", "Tally", "Tile", "Unsteady", "codes", "covering_low_steps", "decode_floor",
    "draw_floorplan", "encode_floor", "floors_of", "look_of", "low_steps_between", "need_minigrid", "paint",
    "rooms_env", "view_offsets",
]  # fmt: skip

_HEAVY = ("environment", "tiles", "unsteady")


def __getattr__(name: str) -> Any:
    if name in __all__:
        need_minigrid()
        for module in _HEAVY:
            found = vars(import_module(f".{module}", __name__))
            if name in found:
                return found[name]
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
