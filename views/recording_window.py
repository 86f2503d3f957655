"""The factor graph of the window for a recording: what each step added to it, and what is believed of its variables."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..model import FactorGraph
from ..model import CognitiveMap
from ..model.labels import encode
from ..model.slices import Slice, window_graph

DIGITS = 4

Floats = NDArray[np.float64]
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
    tops: dict[str, list[Any]] = {}
    for slice_, (joint, moved) in zip(window, smoothed(window), strict=True):
        places, positions = joint.sum(axis=1), joint.sum(axis=0)
        s, p = int(places.argmax()), int(positions.argmax())
        position = map_.positions[int(slice_.positions[p])]
        tops[f"s{slice_.step}"] = [int(slice_.places[s]), round(float(places[s]), DIGITS)]
        tops[f"p{slice_.step}"] = [encode(position), round(float(positions[p]), DIGITS)]
        if slice_ is not window[0]:
            tops[f"moved{slice_.step}"] = [moved >= 0.5, round(max(moved, 1.0 - moved), DIGITS)]
    return tops


def smoothed(window: Window) -> list[tuple[Floats, float]]:
    """Q(s_t, p_t) `[n, m]` and P(moved_t) for each slice, given all of the window.

    Sum-product there and back along the factors of `window_graph`, the same posterior as `infer` gives of it, without
    building the graph: a recording asks for it at every step.
    """
    forward = [window[0].joint / window[0].joint.sum()]
    for slice_ in window[1:]:
        message = _local(slice_) * _ahead(slice_, forward[-1])
        forward.append(message / message.sum())
    results: list[tuple[Floats, float]] = []
    back = np.ones_like(forward[-1])
    for slice_, here, before in zip(window[:0:-1], forward[:0:-1], forward[-2::-1], strict=True):
        joint = here * back
        into = _local(slice_) * back
        stays = slice_.displacement[0] * (slice_.transition.T @ into @ slice_.motion)
        moves = slice_.displacement[1] * float((slice_.arrival[:, None] * into).sum())
        moved = moves / (float((before * stays).sum()) + moves)
        results.append((joint / joint.sum(), moved))
        back = stays + moves
        back /= back.max()
    joint = forward[0] * back
    results.append((joint / joint.sum(), 0.0))
    return results[::-1]


def _local(slice_: Slice) -> Floats:
    """`[n, m]` the factors on s_t and p_t alone."""
    return slice_.place.T * (slice_.sight_likelihood * slice_.doors_likelihood)[:, None]


def _ahead(slice_: Slice, before: Floats) -> Floats:
    """`[n, m]` what the step before predicts, `before` being its message of mass one."""
    stays = slice_.transition @ before @ slice_.motion.T
    return slice_.displacement[0] * stays + slice_.displacement[1] * slice_.arrival[:, None]
