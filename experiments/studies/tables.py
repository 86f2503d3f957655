"""Tables of a study: given row by row, or read off its JSON."""

from __future__ import annotations

import csv
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from io import StringIO
from typing import Any

Value = str | int | float | bool | None  # what stands in a table

MAIN = ("rows", "runs")  # what a study calls its main rows
MOST_ROWS, MOST_COLUMNS = 45, 9  # of a table read off JSON that the report shows


@dataclass(frozen=True, slots=True)
class Table:
    """A table of a study, kept as CSV."""

    name: str  # stem of its file
    columns: Sequence[str]  # their heads
    rows: Sequence[Sequence[Value]]  # one value a column
    caption: str = ""  # what it shows, one sentence
    shown: bool = True  # whether the report shows it; those that are long, or for machines only, are named there

    @classmethod
    def of(cls, name: str, rows: Sequence[Mapping[str, Value]], caption: str = "", *, shown: bool = True) -> Table:
        """A table of rows by column; a row without a column has none there."""
        columns = tuple(dict.fromkeys(column for row in rows for column in row))
        return cls(name, columns, [[row.get(column) for column in columns] for row in rows], caption, shown)

    @property
    def alignment(self) -> list[str]:
        """By column, as Markdown has it: those that hold numbers only are set to the right."""
        right = [
            all(type(value) in (int, float, type(None)) for value in column) for column in zip(*self.rows, strict=True)
        ]
        return ["---:" if is_right else "---" for is_right in right or [False] * len(self.columns)]

    def csv(self) -> str:
        """The table as CSV with a line of heads; an empty field stands for none."""
        text = StringIO(newline="")
        csv.writer(text, lineterminator="\n").writerows([self.columns, *self.rows])
        return text.getvalue()


def plain(value: Any) -> Any:
    """The value as plain JSON: records as objects, tuples as lists, names of numbers as text."""
    return json.loads(json.dumps(value, default=_record, allow_nan=False))


def flat(values: Mapping[str, Any], before: str = "") -> dict[str, Value]:
    """Dotted names and single values of JSON; lists become JSON text, lists of objects are left out."""
    row: dict[str, Value] = {}
    for key, value in values.items():
        if isinstance(value, Mapping):
            row |= flat(value, f"{before}{key}.")
        elif not _is_rows(value):
            row[f"{before}{key}"] = json.dumps(value) if isinstance(value, list | tuple) else value
    return row


def tables_of(study: str, found: Mapping[str, Any]) -> list[Table]:
    """Every list of objects below `found`, plain JSON, as a table, the main rows first; and one of `summary`.

    Objects in a row get dotted columns; a list of objects in it gets a table of its own, in which the seed of the row
    is repeated, or else its number.
    """
    tables: dict[str, list[dict[str, Value]]] = {}
    for key, value in sorted(found.items(), key=lambda item: item[0] not in MAIN):
        name = study if key in MAIN else f"{study}_{key}"
        if key == "summary" and isinstance(value, Mapping):
            tables[name] = _summary(value)
        else:
            _collect(tables, name, key, value, {})
    made, top = list[Table](), {study, *(f"{study}_{key}" for key in found)}
    for name, rows in tables.items():
        caption = f"{name.replace('_', ' ')}, {len(rows)} row{'' if len(rows) == 1 else 's'}"
        short = len(rows) <= MOST_ROWS and len({column for row in rows for column in row}) <= MOST_COLUMNS
        made += [Table.of(name, rows, caption, shown=short and name in top)] if rows else []
    return made


def _record(value: Any) -> dict[str, Any]:
    own = getattr(value, "to_dict", None)
    return {field.name: getattr(value, field.name) for field in fields(value)} if own is None else own()


def _collect(tables: dict[str, Any], name: str, key: str, value: Any, owner: Mapping[str, Value]) -> None:
    parts = [(value, owner)] if isinstance(value, Mapping) else []
    for number, row in enumerate(value if _is_rows(value) else ()):
        whose = {**owner, **({"seed": row["seed"]} if "seed" in row else {key.removesuffix("s"): number})}
        tables.setdefault(name, []).append({**whose, **flat(row)})
        parts.append((row, whose))
    for part, whose in parts:
        for below, inner in part.items():
            _collect(tables, f"{name}_{below.replace(' ', '_').replace('.', '_')}", below, inner, whose)


def _summary(value: Mapping[str, Any]) -> list[dict[str, Value]]:
    """A row for each part, if there are parts; or else one for each value."""
    if value and all(isinstance(part, Mapping) for part in value.values()):
        return [{"part": key, **flat(part)} for key, part in value.items()]
    return [{"name": key, "value": part} for key, part in flat(value).items()]


def _is_rows(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and all(isinstance(row, Mapping) for row in value)
