"""What an agent believes: growing domains, Dirichlet tables, the factor graph, learning, growth."""

from __future__ import annotations

from .cognitive_map import BLOCKED, ELSEWHERE, OPEN, UNKNOWN, CognitiveMap, Priors
from .conditional import ConditionalTable, LearnableTable
from .dirichlet import EMPTY, SparseDirichlet
from .distinct import distinct
from .domain import Domain
from .errors import CogmapError
from .factor_graph import FactorGraph
from .factors import Factor, SparseValues
from .growth import GROWTHS, Growth, growth_named
from .growth_log import GrowthEvent
from .growth_table import GrownPlace, GrowthDifference, growth_between, growth_table
from .learning import TABLE_RATES, TEXT_RATES, Learner, Rates
from .lesson import Lesson
from .map_tables import map_table
from .motions import Motions, MotionSpec, Position
from .slices import Slice, take_slice, window_graph
from .tables import LabelledTable, labelled, table
from .variables import Variable

__all__ = [
    "BLOCKED",
    "ELSEWHERE",
    "EMPTY",
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
    "GrownPlace",
    "Growth",
    "GrowthDifference",
    "GrowthEvent",
    "LabelledTable",
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
    "distinct",
    "growth_between",
    "growth_named",
    "growth_table",
    "labelled",
    "map_table",
    "table",
    "take_slice",
    "window_graph",
]
