"""What an agent believes: the generative model as a list of factors, its log of changes, growth, the graph language."""

from __future__ import annotations

from .changes import STEPS, Branch, Change, Changes, Entry, Store
from .cognitive_map import CognitiveMap
from .dirichlet import EMPTY, SparseDirichlet
from .distinct import distinct
from .domain import Domain
from .errors import CogmapError
from .factors import (
    BLOCKED,
    ELSEWHERE,
    OPEN,
    POSES,
    SENSORS,
    UNKNOWN,
    Context,
    Displacement,
    Lattice,
    ModelFactor,
    NoPose,
    Pose,
    Sensor,
    Sight,
    Successors,
    Support,
    Table,
    Transition,
    Ways,
)
from .files import make_folder, write_through, write_whole
from .generative import GenerativeModel
from .graph import (
    MOST_DRAWN,
    AllEvidence,
    ConditionalTable,
    Evidence,
    Factor,
    FactorGraph,
    FloatArray,
    IntArray,
    LabelledTable,
    LearnableTable,
    SparseValues,
    Variable,
    equation,
    graph_svg,
    labelled,
    log_bounds,
    quoted,
    sparse_values,
    table,
)
from .growth import GROWTHS, Growth, ObservedGrowth, PredictedGrowth, StaticGrowth, Whereabouts, place_beyond
from .growth_event import KINDS, GrowthEvent
from .growth_table import GrownPlace, GrowthDifference, growth_between, growth_table
from .information import dirichlet_information
from .labels import decode, encode, identity, plain, shown
from .map_graph import LEAST, how_known, map_graph, transitions
from .map_state import map_state, restore_map
from .map_tables import counts_of, map_table
from .markup import html_table, safe
from .motions import Motions, MotionSpec, Position
from .percept import Percept
from .rates import TABLE_RATES, TEXT_RATES, Priors, Rates, is_number
from .slices import Slice, take_slice, window_graph
from .updates import ParameterUpdate, updates

__all__ = [
    "BLOCKED",
    "ELSEWHERE",
    "EMPTY",
    "GROWTHS",
    "KINDS",
    "LEAST",
    "MOST_DRAWN",
    "OPEN",
    "POSES",
    "SENSORS",
    "STEPS",
    "TABLE_RATES",
    "TEXT_RATES",
    "UNKNOWN",
    "AllEvidence",
    "Branch",
    "Change",
    "Changes",
    "CogmapError",
    "CognitiveMap",
    "ConditionalTable",
    "Context",
    "Displacement",
    "Domain",
    "Entry",
    "Evidence",
    "Factor",
    "FactorGraph",
    "FloatArray",
    "GenerativeModel",
    "GrownPlace",
    "Growth",
    "GrowthDifference",
    "GrowthEvent",
    "IntArray",
    "LabelledTable",
    "Lattice",
    "LearnableTable",
    "ModelFactor",
    "MotionSpec",
    "Motions",
    "NoPose",
    "ObservedGrowth",
    "ParameterUpdate",
    "Percept",
    "Pose",
    "Position",
    "PredictedGrowth",
    "Priors",
    "Rates",
    "Sensor",
    "Sight",
    "Slice",
    "SparseDirichlet",
    "SparseValues",
    "StaticGrowth",
    "Store",
    "Successors",
    "Support",
    "Table",
    "Transition",
    "Variable",
    "Ways",
    "Whereabouts",
    "counts_of",
    "decode",
    "dirichlet_information",
    "distinct",
    "encode",
    "equation",
    "graph_svg",
    "growth_between",
    "growth_table",
    "how_known",
    "html_table",
    "identity",
    "is_number",
    "labelled",
    "log_bounds",
    "make_folder",
    "map_graph",
    "map_state",
    "map_table",
    "place_beyond",
    "plain",
    "quoted",
    "restore_map",
    "safe",
    "shown",
    "sparse_values",
    "table",
    "take_slice",
    "transitions",
    "updates",
    "window_graph",
    "write_through",
    "write_whole",
]
