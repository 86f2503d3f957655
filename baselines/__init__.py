"""Whom the agent is compared with: clone-structured graphs, nearest-frontier search, habit alone, random walk."""

from .chart_frontier import ChartFrontier
from .cscg import CscgAgent, CscgSettings
from .cue_optimum import CueOptimum
from .frontier import FrontierAgent
from .habit import HabitAgent
from .random_walk import RandomAgent
from .tile_frontier import TileFrontier

__all__ = [
    "ChartFrontier", "CscgAgent", "CscgSettings", "CueOptimum", "FrontierAgent", "HabitAgent", "RandomAgent",
    "TileFrontier",
]  # fmt: skip
