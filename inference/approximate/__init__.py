"""Approximations of inference, for graphs that are too large for the exact engines. Each says that it is one."""

from .loopy import Loopy, LoopyReport
from .sampling import Sampling, SamplingReport

__all__ = ["APPROXIMATIONS", "Loopy", "LoopyReport", "Sampling", "SamplingReport"]

APPROXIMATIONS = {"loopy": Loopy(), "sampling": Sampling()}
"""The approximations by name, with their default options."""
