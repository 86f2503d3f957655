"""The factor graph of the window for a recording: what each step added to it, and what is believed of its variables."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from ..inference import infer
from ..model import CognitiveMap, FactorGraph, Slice, encode, window_graph

DIGITS = 4

Window = Sequence[Slice]


def window_frames(map_: CognitiveMap, windows: Iterable[Window]) -> list[dict[str, Any]]:
    """Each of the windows that followed one another, as JSON values.

    Variables and factors are told once, at the step that added them. The graph of a step is the prior of time
    `since`, the other factors of later times, and the variables in their scopes. `tops` has the latent variables whose
    most probable label, or its probability, is not what was told last.
    """
    told: set[str] = set()
    tops: dict[str, list[Any]] = {}
    last = -1
    frames: list[dict[str, Any]] = []
    for window in windows:
        new = next(i for i, slice_ in enumerate(window) if slice_.step > last)
        graph = window_graph(map_, window[max(new - 1, 0) :])
        now = _tops(map_, window)
        frames.append(
            {
                "since": window[0].step,
                "variables": _variables(graph, told),
                "factors": _factors(graph, told),
                "tops": [[name, *top] for name, top in now.items() if tops.get(name) != top],
            }
        )
        tops, last = now, window[-1].step
    return frames


def _variables(graph: FactorGraph, told: set[str]) -> list[list[Any]]:
    """Name and time of those that are new, and the label of those observed."""
    new = [variable for variable in graph.variables if variable.name not in told]
    told.update(variable.name for variable in new)
    return [[v.name, v.time, *([encode(v.domain[0])] if v.observed else [])] for v in new]


def _factors(graph: FactorGraph, told: set[str]) -> list[list[Any]]:
    """Symbol, kind and scope of those that are new."""
    new = [factor for factor in graph.factors if factor.label not in told]
    told.update(factor.label for factor in new)
    return [[factor.name, factor.kind, *(variable.name for variable in factor.scope)] for factor in new]


def _tops(map_: CognitiveMap, window: Window) -> dict[str, list[Any]]:
    """The most probable label of every latent variable, and its probability."""
    graph = window_graph(map_, window)
    posterior, tops = infer(graph), dict[str, list[Any]]()
    for variable in graph.variables:
        if not variable.observed:
            q = posterior.marginal(variable.name)
            best = int(q.argmax())
            tops[variable.name] = [encode(variable.domain[best]), round(float(q[best]), DIGITS)]
    return tops
