"""What an agent believes: growing domains, Dirichlet tables, the factor graph, learning, growth."""

from __future__ import annotations

from .changes import Branch, Change, Changes
from .cognitive_map import BLOCKED, ELSEWHERE, OPEN, UNKNOWN, CognitiveMap, Priors
from .dirichlet import EMPTY, SparseDirichlet
from .distinct import distinct
from .domain import Domain
from .errors import CogmapError
from .files import make_folder, write_through, write_whole
from .graph import (
    MOST_DRAWN,
    AllEvidence,
    Before,
    ConditionalTable,
    Evidence,
    Factor,
    FactorGraph,
    FloatArray,
    IntArray,
    LabelledTable,
    LearnableTable,
    SparseValues,
    Template,
    Variable,
    before,
    equation,
    graph_svg,
    labelled,
    log_bounds,
    quoted,
    sparse_values,
    table,
)
from .graph.exchange import (
    load_graph,
    read_bif,
    read_uai,
    read_uai_evidence,
    read_xmlbif,
    save_graph,
    write_bif,
    write_graphml,
    write_uai,
    write_uai_evidence,
    write_xmlbif,
)
from .growth import GROWTHS, Growth, growth_named
from .growth_event import KINDS, GrowthEvent
from .growth_table import GrownPlace, GrowthDifference, growth_between, growth_table
from .labels import decode, encode, identity, plain, shown
from .learning import TABLE_RATES, TEXT_RATES, Learner, Rates
from .map_graph import LEAST, how_known, map_graph, transitions
from .map_tables import counts_of, map_table
from .markup import html_table, safe
from .motions import Motions, MotionSpec, Position
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
    "TABLE_RATES",
    "TEXT_RATES",
    "UNKNOWN",
    "AllEvidence",
    "Before",
    "Branch",
    "Change",
    "Changes",
    "CogmapError",
    "CognitiveMap",
    "ConditionalTable",
    "Domain",
    "Evidence",
    "Factor",
    "FactorGraph",
    "FloatArray",
    "GrownPlace",
    "Growth",
    "GrowthDifference",
    "GrowthEvent",
    "IntArray",
    "LabelledTable",
    "LearnableTable",
    "Learner",
    "MotionSpec",
    "Motions",
    "ParameterUpdate",
    "Position",
    "Priors",
    "Rates",
    "Slice",
    "SparseDirichlet",
    "SparseValues",
    "Template",
    "Variable",
    "before",
    "counts_of",
    "decode",
    "distinct",
    "encode",
    "equation",
    "graph_svg",
    "growth_between",
    "growth_named",
    "growth_table",
    "how_known",
    "html_table",
    "identity",
    "labelled",
    "load_graph",
    "log_bounds",
    "make_folder",
    "map_graph",
    "map_table",
    "plain",
    "quoted",
    "read_bif",
    "read_uai",
    "read_uai_evidence",
    "read_xmlbif",
    "safe",
    "save_graph",
    "shown",
    "sparse_values",
    "table",
    "take_slice",
    "transitions",
    "updates",
    "window_graph",
    "write_bif",
    "write_graphml",
    "write_through",
    "write_uai",
    "write_uai_evidence",
    "write_whole",
    "write_xmlbif",
]
