"""What an agent believes: growing domains, Dirichlet tables, the factor graph, learning, growth."""

from __future__ import annotations

from .cognitive_map import BLOCKED, ELSEWHERE, OPEN, UNKNOWN, CognitiveMap, Priors
from .conditional import ConditionalTable, LearnableTable
from .dirichlet import SparseDirichlet
from .domain import Domain
from .errors import CogmapError
from .factor_graph import FactorGraph
from .factors import Factor, SparseValues
from .growth import GROWTHS, Growth, growth_named
from .growth_log import GrowthEvent
from .learning import TABLE_RATES, TEXT_RATES, Learner, Rates
from .lesson import Lesson
from .motions import Motions, MotionSpec, Position
from .slices import Slice, take_slice, window_graph
from .variables import Variable

__all__ = [
    "BLOCKED",
    "ELSEWHERE",
    "GROWTHS",
    "OPEN",
    "TABLE_RATES",
    "TEXT_RATES",
    "UNKNOWN",
    "CogmapError",
    "CognitiveMap",
    "ConditionalTable",
    "Domain",
    "Factor",
    "FactorGraph",
    "Growth",
    "GrowthEvent",
    "LearnableTable",
    "Learner",
    "Lesson",
    "MotionSpec",
    "Motions",
    "Position",
    "Priors",
    "Rates",
    "Slice",
    "SparseDirichlet",
    "SparseValues",
    "Variable",
    "growth_named",
    "take_slice",
    "window_graph",
]
