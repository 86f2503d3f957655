"""Ways to choose among evaluated policies, one a file."""

from .base import TIE, Choice, Verdict
from .best import Best
from .outward import Outward
from .sampled import Sampled

CHOICES: dict[str, type[Choice]] = {choice.name: choice for choice in (Outward, Best, Sampled)}
"""The ways to choose by name, for command lines and files."""

__all__ = ["CHOICES", "TIE", "Best", "Choice", "Outward", "Sampled", "Verdict"]
