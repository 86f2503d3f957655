"""Kinds of poses: positions on a lattice, or none."""

from __future__ import annotations

from .base import Ahead, Pose
from .lattice import Lattice
from .none import NoPose

POSES: dict[str, type[Pose]] = {"lattice": Lattice, "none": NoPose}
"""Kinds of poses by name."""

__all__ = ["POSES", "Ahead", "Lattice", "NoPose", "Pose"]
