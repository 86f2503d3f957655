"""A, B, C and D, as pymdp has them: out of an agent, and in from anybody's arrays."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass
from string import ascii_lowercase
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from ..model import CogmapError, FactorGraph, Floats, Motions, NoPose, Sight
from .agent import Agent

if TYPE_CHECKING:
    import networkx as nx


ELSEWHERE = "elsewhere"
"""The state of an agent's matrices that is no place of its map."""

NEARLY = 1e-6  # how far a column may be from adding up to one


@dataclass(frozen=True, slots=True, eq=False)
class Pomdp:
    """A partially observable Markov decision process with one state factor and any number of observations.

    Raises:
        CogmapError: shapes that do not fit, numbers that are no probabilities, or names that repeat.
    """

    A: tuple[Floats, ...]  # of each observation `[O, S]`, P(o | s); columns sum to one
    B: Floats  # `[S, S, K]`, P(s' | s, a), next state first; columns sum to one
    C: tuple[Floats, ...]  # of each observation `[O]`, log preferences in nats
    D: Floats  # `[S]`, where it is at first
    names: tuple[str, ...]  # of the observations, such as `sight`
    labels: tuple[tuple[Hashable, ...], ...]  # of each observation, what its outcomes are called
    actions: tuple[str, ...]  # what the actions are called

    def __post_init__(self) -> None:
        states = len(self.D)
        _check(self.B.shape == (states, states, len(self.actions)), f"B is {self.B.shape}", "[S, S, K], S as in D")
        _check(len(self.A) == len(self.C) == len(self.names) == len(self.labels) > 0, "A and C differ", "one C an A")
        for name, A, C, labels in zip(self.names, self.A, self.C, self.labels, strict=True):
            _check(A.shape == (len(labels), states), f"A of {name!r} is {A.shape}", f"[O, {states}], a label an O")
            _check(C.shape == (len(labels),) and bool(np.isfinite(C).all()), f"C of {name!r} is {C}", "[O] numbers")
        for what, table in (*((f"A of {n!r}", A) for n, A in zip(self.names, self.A, strict=True)), ("B", self.B)):
            _check_columns(what, table)
        _check_columns("D", self.D)
        unique = len(set(self.names)) == len(self.names) and len(set(self.actions)) == len(self.actions)
        _check(unique, f"names are {self.names} and {self.actions}", "names that differ")

    @classmethod
    def of(cls, agent: Agent) -> Pomdp:
        """The matrices of an agent: what each sensor of labels sees, whether each way is open, B_s, and its belief.

        One state more than the map has places stands for all places that it does not have: it leads to itself, and
        anything may be seen there. What the agent prefers of places is in no matrix.

        Raises:
            CogmapError: the agent has perceived nothing yet.
        """
        map_, belief = agent.map, agent.belief
        size = len(map_.places)
        B = np.zeros((size + 1, size + 1, len(map_.motions)))
        B[:, :size], B[size, size] = map_.B(), 1.0
        D = np.zeros(size + 1)
        D[list(belief.places)] = list(belief.places.values())
        hopes = agent.preferences
        A, C, names, labels = list[Floats](), list[Floats](), list[str](), list[tuple[Hashable, ...]]()
        for number, sight in enumerate(map_.sights_sensed):
            dense, seen = sight.table.dense(len(sight.labels)), (*sight.labels, ELSEWHERE)
            wanted = hopes.sights if not number else hopes.sensors.get(sight.name, {})
            A.append(np.column_stack([dense, np.full(len(seen), 1.0 / len(seen))]))
            C.append(np.array([wanted.get(label, 0.0) for label in seen]))
            names.append(sight.name)
            labels.append(seen)
        blocked = np.append(map_.blocked(np.arange(size)), np.full((1, len(map_.motions)), 0.5), axis=0)
        for action, name in enumerate(map_.motions.names):
            A.append(np.stack([1.0 - blocked[:, action], blocked[:, action]]))
            C.append(np.zeros(2))
            names.append(f"way {name}")
            labels.append(("open", "blocked"))
        return cls(tuple(A), B, tuple(C), D / D.sum(), tuple(names), tuple(labels), tuple(map_.motions.names))

    @classmethod
    def from_arrays(
        cls,
        A: Any,
        B: Any,
        C: Any = None,
        D: Any = None,
        *,
        actions: Sequence[str] | None = None,
        observations: Sequence[str] | None = None,
    ) -> Pomdp:
        """The same from arrays, or from the lists and arrays of arrays that pymdp makes, of one state factor.

        Outcomes are called 0, 1, …, actions `a0`, `a1`, … and observations `sight`, `sight_a`, `sight_b`, … unless
        told. Without C nothing is preferred, without D it may be anywhere.

        Raises:
            CogmapError: more than one state factor, and as for the class.
        """
        tables = _listed(A, 2)
        transitions = _listed(B, 3)
        _check(len(transitions) == 1, f"B has {len(transitions)} state factors", "one; join them to one state")
        wanted = [np.zeros(len(table)) for table in tables] if C is None else _listed(C, 1)
        start = [np.full(len(transitions[0]), 1.0 / len(transitions[0]))] if D is None else _listed(D, 1)
        _check(len(start) == 1, f"D has {len(start)} state factors", "one; join them to one state")
        given = tuple(actions) if actions is not None else tuple(f"a{k}" for k in range(transitions[0].shape[-1]))
        spoken = ("sight", *(f"sight_{letter}" for letter in ascii_lowercase))
        names = tuple(spoken[: len(tables)] if observations is None else observations)
        labels = tuple(tuple(range(len(table))) for table in tables)
        return cls(tuple(tables), transitions[0], tuple(wanted), start[0], names, labels, given)

    def arrays(self) -> dict[str, list[Floats]]:
        """`A`, `B`, `C`, `D` as lists with an array an observation or a state factor, to be given to pymdp."""
        return {"A": [*self.A], "B": [self.B], "C": [*self.C], "D": [self.D]}

    def graph(self, actions: Sequence[str] = ()) -> FactorGraph:
        """The graph of one time step more than there are actions: states `s0`, `s1`, …, and observations `sight@0`, ….

        Raises:
            CogmapError: an unknown action.
        """
        graph = FactorGraph()
        for step in range(len(actions) + 1):
            graph.variable(f"s{step}", tuple(range(len(self.D))), time=step)
            if step == 0:
                graph.factor("D", ["s0"], self.D)
            else:
                _check(actions[step - 1] in self.actions, f"action {actions[step - 1]!r} is unknown", str(self.actions))
                graph.factor("B", [f"s{step}", f"s{step - 1}"], self.B[:, :, self.actions.index(actions[step - 1])])
            for name, A, labels in zip(self.names, self.A, self.labels, strict=True):
                graph.variable(f"{name}@{step}", labels, time=step)
                graph.factor("A", [f"{name}@{step}", f"s{step}"], A)
        return graph

    def to_networkx(self) -> nx.MultiDiGraph[Any]:
        """States as places with what is seen there, and a way for each action that probably leads to another state."""
        import networkx as nx

        graph: nx.MultiDiGraph[Any] = nx.MultiDiGraph()
        for state in range(len(self.D)):
            seen = zip(self.names, self.A, self.labels, strict=True)
            facts = {
                name: {o: float(p) for o, p in zip(labels, A[:, state], strict=True) if p} for name, A, labels in seen
            }
            graph.add_node(state, **facts)
            for action, name in enumerate(self.actions):
                to = int(self.B[:, state, action].argmax())
                if to != state and self.B[to, state, action] > 0.5:
                    graph.add_edge(state, to, key=name, way=name)
        return graph

    def agent(self, **options: Any) -> Agent:
        """An agent that knows these states as its map, and hopes for what C says; where it is it finds out.

        A way leads where it most probably leads; places have no positions. An action `stay` is added where there is
        none.

        Raises:
            CogmapError: what `Agent` raises.
        """
        names = self.actions if "stay" in self.actions else (*self.actions, "stay")
        sensors = [Sight(name, labels=labels) for name, labels in zip(self.names, self.labels, strict=True)]
        made = Agent(Motions(names), sensors=sensors, pose=NoPose(), map=self.to_networkx(), **options)
        hopes = zip(self.names, self.labels, self.C, strict=True)
        wanted = {name: _some(labels, C) for name, labels, C in hopes}
        made.prefer(sensors={name: values for name, values in wanted.items() if values})
        return made


def _some(labels: Sequence[Hashable], values: Floats) -> dict[Hashable, float]:
    """Those that are not zero."""
    return {label: float(value) for label, value in zip(labels, values, strict=True) if value}


def _listed(given: Any, axes: int) -> list[Floats]:
    """Arrays of so many axes: one alone, or those of a list or of an array of arrays."""
    single = isinstance(given, np.ndarray) and cast(Any, given).dtype != object
    try:
        return [
            np.asarray(each, dtype=np.float64) for each in ([given] if single or np.ndim(given[0]) < axes else given)
        ]
    except (TypeError, ValueError, IndexError, KeyError) as error:
        raise CogmapError(f"pomdp: {type(given).__name__} is no array of {axes} axes, and no list of such") from error


def _check_columns(what: str, table: Floats) -> None:
    fine = bool(np.isfinite(table).all() and (table >= 0.0).all() and (abs(table.sum(axis=0) - 1.0) <= NEARLY).all())
    _check(fine, f"{what} has columns that are no probabilities", "columns that sum to one")


def _check(fine: bool, what: str, remedy: str) -> None:
    if not fine:
        raise CogmapError(f"pomdp: {what}; give {remedy}")
