"""All that the golden walks know of how an agent is made and read: edit this where that changes, and nothing else."""

from __future__ import annotations

import tempfile
from collections import defaultdict
from collections.abc import Callable, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
from cogmap.agent import Agent, Settings
from cogmap.inference import FilterOptions
from cogmap.model import TABLE_RATES, TEXT_RATES, Priors
from numpy.typing import NDArray
from parts import parts_of

Facts = dict[str, Any]

NOTHING: Mapping[Any, float] = MappingProxyType({})
MOST_PLACES = 8
"""Places of a belief that are written down."""

RATES = {"table": TABLE_RATES, "text": TEXT_RATES}
PARTS: dict[str, Callable[[Any], Any]] = {
    "rates": lambda name: RATES[name],
    "filter": lambda numbers: FilterOptions(**numbers),
    "priors": lambda numbers: Priors(**numbers),
}


def agent_of(motions: Any, settings: dict[str, Any], *, seed: int) -> Agent:
    """The agent that a walk's plain settings speak of."""
    parts, numbers = parts_of(settings)
    made: dict[str, Any] = {name: PARTS[name](value) if name in PARTS else value for name, value in numbers.items()}
    return Agent(motions, **parts, settings=Settings(**made), seed=seed)


def reloaded(agent: Agent) -> Agent:
    """The agent as it comes back from a file."""
    with tempfile.TemporaryDirectory() as folder:
        agent.save(Path(folder, "agent.npz"))
        return Agent.load(Path(folder, "agent.npz"))


def prefer(
    agent: Agent,
    *,
    sights: Mapping[Any, float] = NOTHING,
    positions: Mapping[Any, float] = NOTHING,
    imagined: float | None = None,
) -> None:
    """Let an agent prefer sights, places by their position, and (if it is given) all places never entered."""
    new = [] if imagined is None else np.flatnonzero(~agent.map.visited).tolist()
    places = dict.fromkeys(new, imagined or 0.0)
    for position, value in positions.items():
        place = agent.map.place_at(position)
        assert place is not None, f"there is no place at {position} yet: prefer it later"
        places[place] = value
    agent.prefer(sights, places=places)


def facts_of(agent: Agent) -> Facts:
    """What the agent believed, planned, learned and grew in the step that it just took."""
    belief, plan, record = agent.belief, agent.plan, agent.trace[-1]
    return {
        "action": int(plan.action),
        "belief": _most_probable(belief.places),
        "certainty": belief.certainty,
        "doubt": belief.doubt,
        "evidence": belief.evidence,
        "moved": belief.moved,
        "dropped": belief.dropped,
        "policy": plan.policy.tolist(),
        "policies": len(plan.policies),
        "cut": plan.cut,
        "left_out": plan.dropped,
        "probability": float(plan.probability[plan.chosen]),
        "G": plan.expected_free_energy.row(plan.chosen),
        "learned": _changes(record.learned),
        "grown": [[event.kind, event.index] for event in record.grown],
        "revised": record.revised,
    }


def map_of(agent: Agent) -> Facts:
    """A digest of the agent's map: its size, and a weighted sum of every column of its expected tables."""
    map_ = agent.map
    tables = {"A_o": map_.A(), "A_p": map_.positions_given_places(), "B_s": map_.B()}
    return {
        "places": len(map_.places),
        "sights": [str(label) for label in map_.sights],
        "positions": [str(label) for label in map_.positions],
        "visited": map_.visited_places.tolist(),
        "sensed": ["".join(map(str, doors)) for doors in map_.sensed.tolist()],
        **{name: _sums(np.moveaxis(table, 1, 0)) for name, table in tables.items()},
    }


def _most_probable(places: dict[int, float]) -> dict[str, float]:
    """The most probable places; of those as good as equal, the ones with the lowest numbers."""
    ranked = sorted(places.items(), key=lambda one: (-float(f"{one[1]:.6g}"), one[0]))
    return {str(place): q for place, q in ranked[:MOST_PLACES]}


def _changes(lessons: Any) -> dict[str, float]:
    """By how much each count changed: "table outcome place action" -> amount."""
    total: defaultdict[tuple[Any, ...], float] = defaultdict(float)
    for lesson in lessons:
        action = -1 if lesson.action is None else lesson.action
        total[lesson.table, lesson.outcome, lesson.place, action] += lesson.amount
    return {" ".join(map(str, key)): total[key] for key in sorted(total) if abs(total[key]) > 1e-12}


def _sums(table: NDArray[np.float64]) -> list[float]:
    """`[S]` sums of what belongs to each place, under weights that tell its entries apart."""
    weights = np.random.default_rng(2024).random(table.shape[1:])
    return (table * weights).reshape(len(table), -1).sum(axis=1).tolist()
