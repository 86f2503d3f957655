"""Tables with labels on both axes: plain text, HTML in notebooks, and pandas frames where they are asked for."""

from __future__ import annotations

import unicodedata
from collections.abc import Hashable, Sequence
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from numpy.typing import NDArray

from ..errors import CogmapError
from ..labels import plain, shown
from ..markup import html_table
from .conditional import ConditionalTable
from .factors import Factor

if TYPE_CHECKING:
    from pandas import DataFrame, Index

NO_PANDAS = "table: pandas is not installed; run: pip install 'cogmap[tables]'"


@dataclass(frozen=True, slots=True, eq=False)
class LabelledTable:
    """A table with a label for each row and column. `str` aligns it, and notebooks show it as HTML.

    Raises:
        CogmapError: the cells do not fit the labels.
    """

    cells: NDArray[np.float64] | Sequence[Sequence[object]]  # `[rows, columns]`, an array or one sequence a row
    index: tuple[Hashable, ...]  # label of each row
    columns: tuple[Hashable, ...]  # label of each column; with several `column_names`, a tuple of one label a name
    index_name: str = ""  # what the rows are
    column_names: tuple[str, ...] = ("",)  # what the columns are
    title: str = ""  # what the table is
    digits: int | None = None  # decimals of numbers in text; four significant digits unless given

    def __post_init__(self) -> None:
        if len(self.cells) != len(self.index) or any(len(row) != len(self.columns) for row in self.cells):
            raise CogmapError(f"table: the cells do not fit {len(self.index)} rows and {len(self.columns)} columns")

    def text(self, *, most_rows: int = 60, most_columns: int = 12) -> str:
        """Aligned plain text of the first rows and columns; what is left out is counted."""
        names, rows = self._shown(most_rows, most_columns)
        widths = [max(map(_width, column)) for column in zip(names, *rows, strict=True)]
        left = [self._is_text(at) for at in range(len(names))]
        lines = [self.title] if self.title else []
        for row in (names, *rows):
            parts = (_aligned(*part) for part in zip(row, widths, left, strict=True))
            lines.append("  ".join(parts).rstrip())
        if (hidden := len(self.index) - most_rows) > 0:
            lines.append(f"… {hidden} more rows")
        if (hidden := len(self.columns) - most_columns) > 0:
            lines.append(f"… {hidden} more columns")
        return "\n".join(lines)

    def __str__(self) -> str:
        return self.text()

    def html(self) -> str:
        """The first 60 rows and 24 columns as an HTML table."""
        names, rows = self._shown(len(self.index), 24)
        return html_table(names, rows, most=60, caption=self.title)

    def _repr_html_(self) -> str:
        return self.html()

    def to_pandas(self) -> DataFrame:
        """The table as a pandas DataFrame; several `column_names` become a MultiIndex.

        Raises:
            CogmapError: pandas is not installed.
        """
        try:
            import pandas as pd
        except ImportError as error:
            raise CogmapError(NO_PANDAS) from error
        index = _pandas_index(pd, self.index, self.index_name)
        names = list(self.column_names)
        if len(names) > 1:
            columns: Index = pd.MultiIndex.from_tuples(cast(Any, self.columns), names=names)
        else:
            columns = _pandas_index(pd, self.columns, names[0])
        if isinstance(self.cells, np.ndarray):
            return pd.DataFrame(self.cells.copy(), index=index, columns=columns)
        by_column = [[row[at] for row in self.cells] for at in range(len(self.columns))]
        series = {at: pd.Series(values, index=index, dtype=_dtype(values)) for at, values in enumerate(by_column)}
        return pd.DataFrame(series, index=index).set_axis(columns, axis=1)

    def _shown(self, most_rows: int, most_columns: int) -> tuple[list[str], list[list[str]]]:
        """Headings and rows as text."""
        several = len(self.column_names) > 1
        heads = [self._heading(label) if several else shown(label) for label in self.columns[:most_columns]]
        corner = self.index_name
        if self.column_names != ("",):
            corner += f" \\ {', '.join(self.column_names)}"
        rows = zip(self.index[:most_rows], self.cells, strict=False)
        body = [[shown(label), *(_cell(cell, self.digits) for cell in list(row)[:most_columns])] for label, row in rows]
        return [corner, *heads], body

    def _heading(self, label: Hashable) -> str:
        return ", ".join(shown(part, most=16) for part in cast(tuple[Hashable, ...], label))

    def _is_text(self, column: int) -> bool:
        if column == 0:
            return not all(isinstance(label, int | float | np.number) for label in self.index)
        if isinstance(self.cells, np.ndarray):
            return False
        return not all(isinstance(row[column - 1], int | float | np.number | None) for row in self.cells)


def labelled(item: Factor | ConditionalTable) -> LabelledTable:
    """A factor, or the mean of a learnable table, with labels: one row a label of the first axis (the outcome).

    The columns are the labels of the other axes, in the order of the scope; where there are several, tuples.

    Raises:
        CogmapError: it is neither.
    """
    if isinstance(item, Factor):
        title = f"{item.label}: {item.equation}" if item.equation else item.label
        names = tuple(variable.name for variable in item.scope)
        return _laid_out(item.dense(), [variable.domain for variable in item.scope], names, title)
    if isinstance(item, ConditionalTable):  # pyright: ignore[reportUnnecessaryIsInstance]
        mean = item.mean()
        names = ("outcome", *(f"parent {axis}" for axis in range(1, mean.ndim)))
        return _laid_out(mean, [range(length) for length in mean.shape], names, "mean")
    kind = type(item).__name__
    raise CogmapError(f"table: cannot show a {kind}; give a factor, such as graph.factor_named('A'), or its table")


def table(item: Factor | ConditionalTable | LabelledTable) -> LabelledTable:
    """`labelled`, of a table the table itself; `to_pandas()` makes a frame of it.

    Raises:
        CogmapError: it is no factor and no table.
    """
    return item if isinstance(item, LabelledTable) else labelled(item)


def _laid_out(
    values: NDArray[np.float64], domains: Sequence[Sequence[Hashable]], names: Sequence[str], title: str
) -> LabelledTable:
    index = tuple(plain(label) for label in domains[0])
    if len(domains) == 1:
        return LabelledTable(values[:, None], index, ("value",), names[0], title=title)
    parents = [[plain(label) for label in domain] for domain in domains[1:]]
    columns = tuple(parents[0]) if len(parents) == 1 else tuple(product(*parents))
    return LabelledTable(values.reshape(len(index), -1), index, columns, names[0], tuple(names[1:]), title)


def _pandas_index(pd: Any, labels: Sequence[Hashable], name: str) -> Index:
    """Labels as they are: pandas would make levels of tuples, and one number of 1 and True."""
    kinds = {type(label) for label in labels}
    dtype = None if kinds and (kinds <= {int} or kinds <= {str}) else object
    return pd.Index(list(labels), dtype=dtype, tupleize_cols=False, name=name or None)


def _dtype(values: Sequence[object]) -> Any:
    kinds = {type(value) for value in values}
    return None if len(kinds) == 1 and kinds <= {int, float, str, bool} else object


def _cell(cell: object, digits: int | None) -> str:
    if cell is None:
        return "-"
    if isinstance(cell, float | np.floating):
        # + 0.0: no -0
        return f"{float(cell) + 0.0:.4g}" if digits is None else f"{round(float(cell), digits) + 0.0:.{digits}f}"
    return shown(cast(Hashable, cell), most=60)


def _width(text: str) -> int:
    """Columns of a terminal that the text takes."""
    return sum(
        0 if unicodedata.combining(sign) else 2 if unicodedata.east_asian_width(sign) in "WF" else 1 for sign in text
    )


def _aligned(text: str, width: int, left: bool) -> str:
    gap = " " * (width - _width(text))
    return text + gap if left else gap + text
