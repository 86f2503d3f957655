"""Factors: non-negative functions of named discrete variables, dense or sparse."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import CogmapError
from .variables import Variable

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False)
class SparseValues:
    """Values listed one by one; every entry not listed is 0.

    Attributes:
        shape: one length an axis, `n` axes.
        indices: `[k, n]` integers, one row an entry, no row twice.
        values: `[k]` non-negative values.

    Raises:
        CogmapError: shapes do not fit, an index is out of range or listed twice.
    """

    shape: tuple[int, ...]
    indices: IntArray
    values: FloatArray

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
        """The same values as an array of `shape`."""
        array = np.zeros(self.shape)
        array[tuple(self.indices.T)] = self.values
        return array


@dataclass(frozen=True, slots=True, eq=False)
class Factor:
    """A non-negative function of the variables in its scope.

    Attributes:
        name: the symbol, such as `"A_o"`; name and scope together are unique within a graph.
        scope: the variables, one an axis of `values`; the output of a conditional first
            (`A[outcome, state]`, `B[next, previous]`).
        values: the function itself, finite and non-negative, dense or sparse.
        kind: what the factor stands for, such as `"prior"`, `"transition"` or `"sight"`.
        equation: the equation it implements, for people.
        table: the learnable table the values come from, if any.

    Raises:
        CogmapError: scope empty or with a variable twice, shape not that of the scope, or values that
            are NaN, infinite or negative.
    """

    name: str
    scope: tuple[Variable, ...]
    values: FloatArray | SparseValues
    kind: str = "factor"
    equation: str = ""
    table: object | None = None

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
    numbers = factor.values.values if isinstance(factor.values, SparseValues) else factor.values
    # a NaN makes both comparisons false
    if numbers.size and not (numbers.min() >= 0 and numbers.max() < math.inf):
        raise CogmapError(f"factor {factor.label}: a value is NaN, infinite or negative; mend the table")
