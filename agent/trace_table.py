"""The trace of an agent as a table, a row a step."""

from collections.abc import Sequence

from ..model import CogmapError, LabelledTable
from .agent import Agent
from .trace import StepRecord

COLUMNS = ("place", "certainty", "doubt", "moved", "free energy", "complexity", "accuracy", "evidence")


def trace_table(agent: Agent, records: Sequence[StepRecord] | None = None) -> LabelledTable:
    """A table with one row per step: readings, believed place, F and G with their parts, action.

    `to_pandas()` makes a frame of it.

    Args:
        agent: whose trace it is, and whose words for actions are used.
        records: of these steps alone; all that `agent.trace` has unless given.

    Raises:
        CogmapError: there is no step in it.
    """
    records = agent.trace if records is None else records
    if not records:
        raise CogmapError("trace_table: the trace has no step yet; call agent.step(observation) first")
    sensed = list(dict.fromkeys(name for record in records for name in record.sensed))
    terms = list(dict.fromkeys(name for record in records for name in record.G))
    names, actions = agent.map.motions.names, ("action", "policies", "probability", "grown", "revised")
    cells: list[list[object]] = []
    for record in records:
        seen = [record.sensed.get(name) for name in sensed]
        place = next(iter(record.places), None)
        believed = [place, record.certainty, record.doubt, record.moved]
        energy = [record.free_energy, record.complexity, record.accuracy, record.evidence]
        planned = [float(record.G[name]) if name in record.G else None for name in terms]
        grown = sum(event.kind == "place" for event in record.grown)
        done = [names[record.action], record.policies, record.probability, grown, record.revised]
        cells.append([*seen, *map(_plain, believed), *map(_plain, energy), *done, *planned])
    columns = (*sensed, *COLUMNS, *actions, *(f"G: {name}" if name != "G" else "G" for name in terms))
    return LabelledTable(cells, tuple(record.step for record in records), columns, "step", title="trace")


def _plain(value: object) -> object:
    return value if value is None or isinstance(value, int) else float(value)  # type: ignore[arg-type]
