"""Factors: non-negative functions of named discrete variables, dense or sparse."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Floats, Ints
from ..errors import CogmapError
from .variables import Variable

FloatArray = Floats
IntArray = Ints

LARGEST_DENSE = 2**28  # entries of a sparse table that is still written out
MOST_AXES = 32  # axes of an array that numpy still broadcasts, of the 64 that it has
NORMALISED = 1e-12  # how far the sums of a conditional may be from 1


@dataclass(frozen=True, slots=True, eq=False)
class SparseValues:
    """Values listed one by one; every entry not listed is 0.

    Raises:
        CogmapError: shapes do not fit, an index is out of range or listed twice.
    """

    shape: tuple[int, ...]  # one length an axis, `n` axes
    indices: IntArray  # `[k, n]` integers, one row an entry, no row twice
    values: FloatArray  # `[k]` non-negative values

    def __post_init__(self) -> None:
        shape = tuple(int(length) for length in self.shape)
        indices = np.asarray(self.indices)
        values = _frozen_floats(self.values, "sparse values")
        if not np.issubdtype(indices.dtype, np.integer) and indices.size:
            raise CogmapError(f"sparse values: indices are {indices.dtype}; give integers")
        indices = np.array(indices, dtype=np.int64).reshape(-1, len(shape)) if indices.size == 0 else indices
        if indices.shape != (values.size, len(shape)) or values.ndim != 1:
            raise CogmapError(
                f"sparse values: indices {indices.shape} and values {values.shape} do not fit shape {shape}; "
                f"give indices [k, {len(shape)}] and values [k]"
            )
        if indices.size and ((indices < 0).any() or (indices >= np.array(shape)).any()):
            raise CogmapError(f"sparse values: an index is outside shape {shape}; count from 0")
        if len(np.unique(indices, axis=0)) < len(indices):
            raise CogmapError("sparse values: an entry is listed twice; add its values up first")
        indices = np.array(indices, dtype=np.int64)
        indices.setflags(write=False)
        for name, value in (("shape", shape), ("indices", indices), ("values", values)):
            object.__setattr__(self, name, value)

    def dense(self) -> FloatArray:
        """The same values as an array of `shape`.

        Raises:
            CogmapError: it would have more than `LARGEST_DENSE` entries.
        """
        if math.prod(self.shape) > LARGEST_DENSE or len(self.shape) > MOST_AXES:
            raise CogmapError(
                f"sparse values: {math.prod(self.shape):.3g} entries on {len(self.shape)} axes are too many to write "
                "out; use the entries listed (indices and values)"
            )
        array = np.zeros(self.shape)
        array[tuple(self.indices.T)] = self.values
        return array

    def at(self, index: Sequence[IntArray]) -> FloatArray:
        """The values at `[n]` places, one array of `[n]` integers an axis."""
        entries = {row.tobytes(): value for row, value in zip(self.indices, self.values, strict=True)}
        rows = np.ascontiguousarray(np.stack(list(index), axis=-1), dtype=np.int64)
        return np.array([entries.get(row.tobytes(), 0.0) for row in rows])


@dataclass(frozen=True, slots=True, eq=False)
class Factor:
    """A non-negative function of the variables in its scope.

    Raises:
        CogmapError: scope empty or with a variable twice, shape not that of the scope, or values that
            are NaN, infinite or negative.
    """

    name: str  # the symbol, such as `"A_o"`; name and scope together are unique within a graph
    # the variables, one an axis of `values`; the output of a conditional first (`A[outcome, state]`, `B[next,
    # previous]`)
    scope: tuple[Variable, ...]
    values: FloatArray | SparseValues  # the function itself, finite and non-negative, dense or sparse
    kind: str = "factor"  # what the factor stands for, such as `"prior"`, `"transition"` or `"sight"`
    equation: str = ""  # the equation it implements, for people
    table: object | None = None  # the learnable table the values come from, if any
    _known: dict[str, Any] = field(default_factory=dict[str, Any], init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "scope", tuple(self.scope))
        if not self.name:
            raise CogmapError("a factor's name is empty; give the symbol it should be printed with")
        if not self.scope or len({variable.name for variable in self.scope}) < len(self.scope):
            raise CogmapError(f"factor {self.label}: the scope must name at least one variable and none twice")
        if not isinstance(self.values, SparseValues):
            object.__setattr__(self, "values", _frozen_floats(self.values, f"factor {self.label}"))
        _check_values(self)

    @property
    def label(self) -> str:
        """How the factor reads in an equation, such as `B_s(s1, s0)`."""
        return f"{self.name}({', '.join(variable.name for variable in self.scope)})"

    @property
    def shape(self) -> tuple[int, ...]:
        """One cardinality a variable of the scope."""
        return self.values.shape

    def dense(self) -> FloatArray:
        """The values as an array `[*cardinalities of the scope]`, read-only if they were dense already."""
        return self.values.dense() if isinstance(self.values, SparseValues) else self.values

    def at(self, index: Sequence[IntArray]) -> FloatArray:
        """The values at `[n]` places, one array of `[n]` indices of labels a variable of the scope."""
        return self.values.at(index) if isinstance(self.values, SparseValues) else self.values[tuple(index)]

    @property
    def bounds(self) -> tuple[float, float]:
        """Logs of the smallest entry above 0 and of the largest; `(inf, -inf)` where all are 0. Looked up once."""
        if "bounds" not in self._known:
            self._known["bounds"] = log_bounds(self.entries, self._known["extremes"])
        return self._known["bounds"]

    @property
    def normalised(self) -> bool:
        """Whether the factor is a conditional: over its first variable the values sum to 1, within 1e-12."""
        if "normalised" not in self._known:
            self._known["normalised"] = bool(abs(self._sums() - 1.0).max() <= NORMALISED)
        return self._known["normalised"]

    @property
    def positive(self) -> bool:
        """Whether every value is above 0."""
        if "positive" not in self._known:
            whole = isinstance(self.values, np.ndarray) or len(self.entries) == math.prod(self.shape)
            self._known["positive"] = bool(whole and self._known["extremes"][0] > 0)
        return self._known["positive"]

    @property
    def entries(self) -> FloatArray:
        """The values that are stored: all of a dense table, those listed of a sparse one."""
        return self.values.values if isinstance(self.values, SparseValues) else self.values

    def check_normalised(self, *, tolerance: float = 1e-9) -> None:
        """Make sure that the factor is a conditional, P(first variable | the others).

        Raises:
            CogmapError: over the first variable the values do not sum to 1 somewhere, within the tolerance.
        """
        sums = self._sums()
        worst = np.unravel_index(int(abs(sums - 1.0).argmax()), sums.shape)
        if not abs(sums[worst] - 1.0) <= tolerance:
            parents = zip(self.scope[1:], worst, strict=True) if sums.ndim == len(self.scope) - 1 else ()
            given = ", ".join(f"{variable.name} = {variable.domain[i]!r}" for variable, i in parents)
            raise CogmapError(
                f"factor {self.label}: the values of {self.scope[0].name}{f' given {given}' if given else ''} sum to "
                f"{float(sums[worst])!r}, not to 1; divide each column by its sum"
            )

    def _sums(self) -> FloatArray:
        """Sums over the first axis, `[*cardinalities of the others]`; of sparse columns without an entry one only."""
        if not isinstance(self.values, SparseValues):
            return np.asarray(np.add.reduce(self.values, axis=0))
        columns, at = np.unique(self.values.indices[:, 1:], axis=0, return_inverse=True)
        sums = np.asarray(np.bincount(at.ravel(), weights=self.values.values, minlength=1), dtype=np.float64)
        return sums if len(columns) == math.prod(self.shape[1:]) else np.append(sums, 0.0)


def log_bounds(values: FloatArray, extremes: tuple[float, float] | None = None) -> tuple[float, float]:
    """Logs of the smallest entry above 0 and of the largest; `(inf, -inf)` where none is.

    `extremes` are the smallest and the largest entry, where they are known.
    """
    smallest, largest = extremes or _extremes(values)
    if largest <= 0.0:
        return math.inf, -math.inf
    if smallest <= 0.0:
        smallest = float(np.minimum.reduce(values[values > 0.0], axis=None))
    return math.log(smallest), math.log(largest)


def _extremes(values: FloatArray) -> tuple[float, float]:
    """The smallest and the largest entry; 0 where there is none."""
    if not values.size:
        return 0.0, 0.0
    return float(np.minimum.reduce(values, axis=None)), float(np.maximum.reduce(values, axis=None))


def sparse_values(shape: Sequence[int], indices: ArrayLike, values: ArrayLike) -> SparseValues:
    """`SparseValues` from plain sequences."""
    return SparseValues(tuple(shape), np.asarray(indices), np.asarray(values, dtype=float))


def _frozen_floats(values: Any, where: str) -> FloatArray:
    """A read-only float array; an array that is one already is taken as it is, anything else is copied."""
    if isinstance(values, np.ndarray) and values.dtype == np.float64 and not values.flags.writeable:
        return values
    try:
        array = np.array(values, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise CogmapError(f"{where}: the values are no array of numbers ({error})") from error
    array.setflags(write=False)
    return array


def _check_values(factor: Factor) -> None:
    expected = tuple(len(variable.domain) for variable in factor.scope)
    if factor.values.shape != expected:
        raise CogmapError(
            f"factor {factor.label}: values have shape {factor.values.shape}, the domains have {expected}; "
            "give one axis a variable, in the order of the scope"
        )
    smallest, largest = factor._known["extremes"] = _extremes(factor.entries)  # pyright: ignore[reportPrivateUsage]
    if not (smallest >= 0 and largest < math.inf):  # a NaN makes both comparisons false
        raise CogmapError(f"factor {factor.label}: a value is NaN, infinite or negative; mend the table")
