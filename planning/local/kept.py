"""What planners work out of the ways of a cut alone, for the next plan there."""

from collections.abc import Hashable
from dataclasses import dataclass, field
from typing import Any


@dataclass(slots=True)
class Kept:
    """Policies and rollouts that come out the same as long as the ways are."""

    policies: dict[Hashable, Any] = field(default_factory=dict[Hashable, Any])  # by what else they depend on
    rollouts: dict[int, Any] = field(default_factory=dict[int, Any])  # of these, by their `id`
