"""What failed in a study, out of its JSON: runs are counted with their seeds, not dropped."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any

Json = Mapping[str, Any]


def failures(study: str, report: Json) -> tuple[str, ...]:
    """One line for each kind of failure; none of a study that is not known here."""
    find = _FAILURES.get(study)
    return () if find is None else tuple(line for line in find(report) if line)


def _localisation(report: Json) -> Iterable[str]:
    rows = report["rows"]
    yield _seeds("did not explore the maze", rows, lambda row: row["steps_to_explore"] is None)
    for name, part in report["summary"]["conditions"].items():
        for what in ("localised", "reached", "map_intact"):
            yield _short(f"{name}: {what.replace('_', ' ')}", part[what], part["trials"])


def _goals(report: Json) -> Iterable[str]:
    for row in report["runs"]:
        if not row["reached"]:
            how = "with a map" if row["known"] else "without a map"
            yield f"{row['world']}, {how}, goal {row['goal']}, seed {row['seed']}: not reached"


def _donut(report: Json) -> Iterable[str]:
    rows = report["rows"]
    yield _seeds("did not explore the maze", rows, lambda row: row["steps_to_explore"] is None)
    yield _seeds("did not reach the goal", rows, lambda row: row["steps_to_explore"] is not None and not row["reached"])


def _tolman(report: Json) -> Iterable[str]:
    for name, part in report["summary"].items():
        why = ", ".join(f"{count} {reason}" for reason, count in part["missed"].items() if count)
        line = _short(f"{name}: goal reached in", part["goal_reached"]["count"], part["goal_reached"]["of"], "runs")
        yield f"{line} ({why})" if line and why else line


def _martinet(report: Json) -> Iterable[str]:
    summary = report["summary"]
    yield _short("goal reached in", summary["reached"], summary["runs"], "runs")


def _insight(report: Json) -> Iterable[str]:
    for key, name in (("rows", "agents"), ("controls", "controls")):
        rows = report[key]
        yield _seeds(f"{name} never met the block", rows, lambda row: row["choice"] is None)
        yield _seeds(f"{name} did not reach the goal again", rows, lambda row: row["steps_to_goal"] is None)


_FAILURES: dict[str, Callable[[Json], Iterable[str]]] = {
    "localisation": _localisation,
    "goals": _goals,
    "donut": _donut,
    "tolman": _tolman,
    "martinet": _martinet,
    "insight": _insight,
}


def _seeds(what: str, rows: Iterable[Json], failed: Callable[[Json], bool]) -> str:
    every = list(rows)
    seeds = [str(row["seed"]) for row in every if failed(row)]
    return f"{len(seeds)} of {len(every)} {what} (seeds {', '.join(seeds)})" if seeds else ""


def _short(what: str, count: int, of: int, unit: str = "") -> str:
    return f"{what} {count} of {of} {unit}".rstrip() if count < of else ""
