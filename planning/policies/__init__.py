"""Policy generators, one a file: which action sequences to compare."""

from collections.abc import Callable

from ..reach import Reach
from .base import Policies
from .exhaustive import exhaustive
from .l_shaped import l_shaped
from .map_guided import DEFAULT_BEAM, map_guided
from .self_avoiding import self_avoiding

Generator = Callable[[Reach], Policies]

GENERATORS: dict[str, Generator] = {
    "map_guided": map_guided,
    "self_avoiding": self_avoiding,
    "l_shaped": l_shaped,
    "exhaustive": exhaustive,
}

__all__ = [
    "DEFAULT_BEAM",
    "GENERATORS",
    "Generator",
    "Policies",
    "exhaustive",
    "l_shaped",
    "map_guided",
    "self_avoiding",
]
