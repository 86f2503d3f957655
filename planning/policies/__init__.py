"""Policy generators, one a file: which action sequences to compare."""

from .base import MAX_LOOK_AHEAD, MAX_POLICIES, Policies, PolicyGenerator
from .exhaustive import Exhaustive
from .frontier import BY
from .l_shaped import LShaped
from .map_guided import MapGuided
from .options import Options
from .self_avoiding import SelfAvoiding

POLICIES: dict[str, type[PolicyGenerator]] = {
    generator.name: generator for generator in (MapGuided, SelfAvoiding, LShaped, Exhaustive)
}
"""The generators by name, for command lines and files."""

__all__ = [
    "BY", "MAX_LOOK_AHEAD", "MAX_POLICIES", "POLICIES", "Exhaustive", "LShaped", "MapGuided", "Options", "Policies",
    "PolicyGenerator", "SelfAvoiding",
]  # fmt: skip
