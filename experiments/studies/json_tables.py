"""Tables out of the JSON of a study: one for every list of rows, however deep it lies, and one of its summary."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

from .report import Table, Value

MAIN = ("rows", "runs")
"""What a study calls its main rows."""
MOST_ROWS, MOST_COLUMNS = 45, 9
"""Of a table that the report shows."""

_Rows = list[dict[str, Value]]


def json_tables(study: str, report: Mapping[str, Any]) -> list[Table]:
    """Every list of objects below `report` as a table, and `summary`; objects in them get dotted columns.

    A list inside of a row gets a table of its own, in which the seed of the row is repeated, or else its number.
    """
    found: dict[str, _Rows] = {}
    top = {study, f"{study}_summary", *(f"{study}_{key}" for key in report)}
    for key, value in sorted(report.items(), key=lambda item: item[0] not in MAIN):
        if _is_rows(value):
            _collect(found, study if key in MAIN else f"{study}_{key}", key, value, {})
        elif key == "summary":
            found[f"{study}_summary"] = _summary(value)
        elif isinstance(value, Mapping) and key != "settings":
            _inner(found, f"{study}_{key}", value, {})
    return [_table(name, rows, nested=name not in top) for name, rows in found.items() if rows]


def flat(values: Mapping[str, Any], before: str = "") -> dict[str, Value]:
    """Dotted names and plain values; lists become JSON text, lists of objects are left out."""
    row: dict[str, Value] = {}
    for key, value in values.items():
        name = f"{before}{key}"
        if isinstance(value, Mapping):
            row |= flat(value, f"{name}.")
        elif isinstance(value, list | tuple):
            row |= {} if _is_rows(value) else {name: json.dumps(value)}
        else:
            row[name] = value
    return row


def _collect(
    found: dict[str, _Rows], name: str, key: str, rows: Sequence[Mapping[str, Any]], owner: dict[str, Value]
) -> None:
    table = found.setdefault(name, [])
    for number, row in enumerate(rows):
        whose = {"seed": row["seed"]} if "seed" in row else {key.removesuffix("s"): number}
        table.append({**owner, **whose, **flat(row)})
        _inner(found, name, row, {**owner, **whose})


def _inner(found: dict[str, _Rows], name: str, values: Mapping[str, Any], owner: dict[str, Value]) -> None:
    for key, value in values.items():
        below = f"{name}_{str(key).replace(' ', '_').replace('.', '_')}"
        if _is_rows(value):
            _collect(found, below, str(key), value, owner)
        elif isinstance(value, Mapping):
            _inner(found, below, value, owner)


def _summary(value: Mapping[str, Any]) -> _Rows:
    """A row for each part, if there are parts; or else one for all."""
    parts = {key: part for key, part in value.items() if isinstance(part, Mapping)}
    if parts and len(parts) == len(value):
        return [{"part": key, **flat(part)} for key, part in parts.items()]
    return [{"name": key, "value": part} for key, part in flat(value).items()]


def _table(name: str, rows: Sequence[Mapping[str, Value]], *, nested: bool) -> Table:
    columns = tuple(dict.fromkeys(column for row in rows for column in row))
    short = len(rows) <= MOST_ROWS and len(columns) <= MOST_COLUMNS and not nested
    cells = tuple(tuple(row.get(column) for column in columns) for row in rows)
    caption = f"{name.replace('_', ' ')}, {len(rows)} row{'' if len(rows) == 1 else 's'}"
    return Table(name, columns, cells, caption, shown=short)


def _is_rows(value: Any) -> bool:
    return isinstance(value, list | tuple) and bool(value) and all(isinstance(row, Mapping) for row in value)
