"""The language: discrete factor graphs declared, shown, written and read."""

from .conditional import ConditionalTable, LearnableTable
from .export import equation, quoted
from .factor_graph import FactorGraph
from .factors import Factor, FloatArray, IntArray, SparseValues, log_bounds, sparse_values
from .structure import AllEvidence, Evidence, GraphStructure
from .tables import LabelledTable, labelled, table
from .template import Before, Template, before
from .variables import Variable

__all__ = [
    "AllEvidence", "Before", "ConditionalTable", "Evidence", "Factor", "FactorGraph", "FloatArray", "GraphStructure",
    "IntArray", "LabelledTable", "LearnableTable", "SparseValues", "Template", "Variable", "before", "equation",
    "labelled", "log_bounds", "quoted", "sparse_values", "table",
]  # fmt: skip
