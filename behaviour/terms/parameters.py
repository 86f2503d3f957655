"""Parameters that several terms share."""

from .base import Parameter

FORGETTING = Parameter(
    name="forgetting",
    meaning="φ: share of what was learned of a place that fades with each step since",
    low=0.0,
    high=0.9,
    start=0.05,
    spread=0.03,
    typical=(0.005, 0.3),
    doubt=0.5,
)
