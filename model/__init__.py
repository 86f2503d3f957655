"""What an agent believes: the generative model as a list of factors, its log of changes, growth, the graph language."""

from .arrays import Floats, Ints
from .changes import Change, Changes, Entry, Store
from .cognitive_map import CognitiveMap
from .column import Column
from .dirichlet import EMPTY, SparseDirichlet
from .distinct import distinct
from .domain import Domain
from .errors import CogmapError
from .factors import (
    BLOCKED,
    ELSEWHERE,
    FEW_WAYS,
    NOTHING,
    OPEN,
    POSES,
    SENSORS,
    SHOWN,
    UNKNOWN,
    Bearings,
    Carried,
    Context,
    Contexts,
    Displacement,
    Features,
    Lattice,
    Locks,
    ModelFactor,
    NoPose,
    Plane,
    Pose,
    Sensor,
    Sight,
    Successors,
    Support,
    Table,
    Transition,
    Ways,
)
from .files import check_folder, check_writable, make_folder, unused, write_through, write_whole
from .generative import GenerativeModel
from .graph import (
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
from .percept import OUTCOMES, Outcome, Percept
from .periods import Periods, reduced, with_period
from .rates import PAPER_RATES, TABLE_RATES, TEXT_RATES, Priors, Rates, is_number, is_whole
from .reading import check_size, check_values, count_values, open_regular, parse_json, read_file, unpack_gzip
from .savepoint import Savepoint, go_back, release, savepoint
from .slices import Slice, take_slice, window_graph
from .unseen import UNSEEN, Unseen
from .updates import ParameterUpdate, updates

__all__ = [
    "BLOCKED", "ELSEWHERE", "EMPTY", "FEW_WAYS", "GROWTHS", "KINDS", "LEAST", "NOTHING", "OPEN", "OUTCOMES",
    "PAPER_RATES", "POSES", "SENSORS", "SHOWN", "TABLE_RATES", "TEXT_RATES", "UNKNOWN", "UNSEEN", "AllEvidence",
    "Bearings", "Before", "Carried", "Change", "Changes", "CogmapError", "CognitiveMap", "Column", "ConditionalTable",
    "Context", "Contexts", "Displacement", "Domain", "Entry", "Evidence", "Factor", "FactorGraph", "Features",
    "FloatArray", "Floats", "GenerativeModel", "GrownPlace", "Growth", "GrowthDifference", "GrowthEvent", "IntArray",
    "Ints", "LabelledTable", "Lattice", "LearnableTable", "Locks", "ModelFactor", "MotionSpec", "Motions", "NoPose",
    "ObservedGrowth", "Outcome", "ParameterUpdate", "Percept", "Periods", "Plane", "Pose", "Position",
    "PredictedGrowth", "Priors", "Rates", "Savepoint", "Sensor", "Sight", "Slice", "SparseDirichlet", "SparseValues",
    "StaticGrowth", "Store", "Successors", "Support", "Table", "Template", "Transition", "Unseen", "Variable", "Ways",
    "Whereabouts", "before", "check_folder", "check_size", "check_values", "check_writable", "count_values",
    "counts_of", "decode", "dirichlet_information", "distinct", "encode", "equation", "go_back", "growth_between",
    "growth_table", "how_known", "html_table", "identity", "is_number", "is_whole", "labelled", "load_graph",
    "log_bounds", "make_folder", "map_graph", "map_state", "map_table", "open_regular", "parse_json", "place_beyond",
    "plain", "quoted", "read_bif", "read_file", "read_uai", "read_uai_evidence", "read_xmlbif", "reduced", "release",
    "restore_map", "safe", "save_graph", "savepoint", "shown", "sparse_values", "table", "take_slice", "transitions",
    "unpack_gzip", "unused", "updates", "window_graph", "with_period", "write_bif", "write_graphml", "write_through",
    "write_uai", "write_uai_evidence", "write_whole", "write_xmlbif",
]  # fmt: skip
