"""Kinds of poses: positions on a lattice, as measured, or none."""

from .base import Ahead, Pose
from .lattice import Lattice
from .none import NoPose
from .plane import Plane

POSES: dict[str, type[Pose]] = {"lattice": Lattice, "none": NoPose, "plane": Plane}
"""Kinds of poses by name."""

__all__ = ["POSES", "Ahead", "Lattice", "NoPose", "Plane", "Pose"]
