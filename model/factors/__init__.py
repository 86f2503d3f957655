"""The factors of the generative model (eq. 1), one class a file."""

from .base import Context, ModelFactor, Successors, Support, Table, parts_of
from .bearings import Bearings
from .carried import NOTHING, Carried, Locks
from .contexts import Contexts
from .displacement import Displacement
from .features import Features
from .pose import POSES, Ahead, Lattice, NoPose, Plane, Pose
from .sensor import Sensor
from .sight import SHOWN, Sight
from .transition import BLOCKED, ELSEWHERE, OPEN, UNKNOWN, Transition
from .ways import FEW_WAYS, Ways

SENSORS: dict[str, type[Sensor]] = {
    "sight": Sight,
    "features": Features,
    "ways": Ways,
    "bearings": Bearings,
    "contexts": Contexts,
    "carried": Carried,
    "locks": Locks,
}
"""Kinds of sensors by name."""

__all__ = [
    "BLOCKED", "ELSEWHERE", "FEW_WAYS", "NOTHING", "OPEN", "POSES", "SENSORS", "SHOWN", "UNKNOWN", "Ahead", "Bearings",
    "Carried", "Context", "Contexts", "Displacement", "Features", "Lattice", "Locks", "ModelFactor", "NoPose", "Plane",
    "Pose", "Sensor", "Sight", "Successors", "Support", "Table", "Transition", "Ways", "parts_of",
]  # fmt: skip
