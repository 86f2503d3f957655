"""What happened at every step, light enough to keep."""

from collections.abc import Hashable, Iterable, Mapping
from dataclasses import dataclass, field

from ..inference import Belief
from ..model import Entry, GrowthEvent, ParameterUpdate, Percept, updates
from ..planning import Plan, Term


@dataclass(frozen=True, slots=True)
class StepRecord:
    """One step of the agent.

    Attributes:
        step: the time step, from 0.
        sight: label of what the sensor `sight` saw; None where there is none.
        open: for each action, whether its way was sensed open: true, false, P(open), or None; empty where none was.
        places: Q(s_t), the most probable first.
        certainty: the first of them.
        doubt: probability of the hypotheses in which it is elsewhere.
        certain: whether learning and growth went on.
        moved: P(moved_t).
        dropped: posterior mass left out, at most.
        evidence: log P(o_t, c_t | the past), in nats.
        complexity: first part of F, in nats.
        accuracy: second part of F, in nats.
        grown: what was added to the model.
        learned: which counts changed.
        policy: the chosen policy, by action index.
        probability: its P(policy).
        G: its expected free energy, term by term, and their sum under `G`, in nats.
        terms: what G is the sum of.
        policies: how many policies were considered.
        action: the action taken.
        cost: what the move that led here cost; None where that was not said.
        sensed: label of what each sensor but that of the ways sensed, by its name.
        revised: whether it changed its mind: the map, or where it is in it.
    """

    step: int
    sight: Hashable
    open: tuple[bool | float | None, ...]
    places: dict[int, float]
    certainty: float
    doubt: float
    certain: bool
    moved: float
    dropped: float
    evidence: float
    complexity: float
    accuracy: float
    grown: tuple[GrowthEvent, ...]
    learned: tuple[ParameterUpdate, ...]
    policy: tuple[int, ...]
    probability: float
    G: dict[str, float]
    terms: tuple[Term, ...]
    policies: int
    action: int
    revised: bool = False
    sensed: Mapping[str, Hashable] = field(default_factory=dict[str, Hashable])
    cost: float | None = None

    @property
    def free_energy(self) -> float:
        """F = complexity - accuracy (eq. 3), in nats."""
        return self.complexity - self.accuracy


def record_of(
    step: int,
    sensed: Mapping[str, Hashable],
    percept: Percept,
    belief: Belief,
    plan: Plan,
    entries: Iterable[Entry],
    *,
    certain: bool,
    revised: bool,
) -> StepRecord:
    """The record of a step; `entries` are those of the log of changes since it began."""
    entries = list(entries)
    return StepRecord(
        step=step,
        sight=sensed.get("sight"),
        open=percept.open or (),
        places=belief.places,
        certainty=belief.certainty,
        doubt=belief.doubt,
        certain=certain,
        moved=belief.moved,
        dropped=belief.dropped,
        evidence=belief.evidence,
        complexity=belief.complexity,
        accuracy=belief.accuracy,
        grown=tuple(entry for entry in entries if isinstance(entry, GrowthEvent)),
        learned=tuple(updates(entries)),
        policy=tuple(plan.policy.tolist()),
        probability=float(plan.probability[plan.chosen]),
        G=plan.expected_free_energy.row(plan.chosen),
        terms=plan.expected_free_energy.terms,
        policies=len(plan.policies),
        action=plan.action,
        revised=revised,
        sensed=sensed,
        cost=percept.cost,
    )
