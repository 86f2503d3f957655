"""Figures of the study `mice`."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ...behaviour import Ground
from ...views import theme_of
from .figures import Figure, legend_below, panels

COLOURS = {"animals": "#000000", "cogmap": "#0072b2", "biased": "#e69f00", "random": "#999999", "fitted": "#d55e00"}
LABELS = {
    "fitted": "simulated, as fitted",
    "cogmap": "cogmap, exploring",
    "biased": "biased walk",
    "random": "random walk",
}


def exploration_figure(curves: Mapping[str, Sequence[Sequence[int]]]) -> Figure:
    """New ends against ends visited: each walk, and the best that can be."""
    figure, (ax,) = panels("Finding the 64 ends of the labyrinth", (1, 1), (7.5, 5.2))
    for who, walks in curves.items():
        for i, new in enumerate(walks):
            label = LABELS.get(who, who) if i == 0 else None
            ax.plot(range(1, len(new) + 1), new, color=COLOURS[who], alpha=0.7, linewidth=1.0, label=label)
    best = list(range(1, 65))
    ax.plot(best, best, color=theme_of(ax).shade(0.6), linestyle="--", label="no end twice")
    ax.axhline(32, color=theme_of(ax).shade(0.3), linewidth=0.6)
    ax.set_xscale("log")
    ax.set_xlim(1, 1000)
    ax.set_xlabel("ends visited")
    ax.set_ylabel("different ends found")
    legend_below(figure, ax, 3)
    return figure


def choices_figure(made: Mapping[str, Any]) -> Figure:
    """Nats a choice, held out, of each individual under each model, with intervals."""
    figure, (ax,) = panels("How probable are the choices? (held out, 95 % intervals over bouts)", (1, 1), (11.0, 5.2))
    names, individuals = [model["name"] for model in made["models"]], made["individuals"]
    wide = 0.8 / len(names)
    for i, name in enumerate(names):
        at = np.arange(len(individuals) + 1) + (i - (len(names) - 1) / 2) * wide
        entries = [one["models"][i] for one in individuals] + [made["models"][i]]
        values = [entry["held_out_nats_per_choice"] for entry in entries]
        spans = [entry["held_out_interval"] or (value, value) for entry, value in zip(entries, values, strict=True)]
        errors = [
            [v - s[0] for v, s in zip(values, spans, strict=True)],
            [s[1] - v for v, s in zip(values, spans, strict=True)],
        ]
        ax.errorbar(at, values, errors, fmt="o", markersize=4, capsize=1.5, linewidth=0.8, label=name)
    ax.set_xticks(
        range(len(individuals) + 1), [f"{one['individual']}\n{one['choices']}" for one in individuals] + ["all"]
    )
    ax.set_ylabel("nats a choice")
    ax.set_xlabel("individual, choices before it found the port")
    legend_below(figure, ax, len(names))
    return figure


def flows_figure(ground: Ground, flows: Sequence[Sequence[float]]) -> Figure:
    """The labyrinth; each way of each fork by how much more, or less, it was taken than the whole model expects."""
    figure, (ax,) = panels("Where the animals and the whole model differ", (1, 1), (7.5, 6.8))
    where = _positions(ground)
    for at, ways in enumerate(ground.ways):
        for way in ways:
            (x, y), (u, v) = where[at], where[way.target]
            ax.plot([x, u], [y, v], color=theme_of(ax).shade(0.15), linewidth=1.0, zorder=1)
    score = [(taken - expected) / max(expected, 1.0) ** 0.5 for _, _, taken, expected in flows]
    most = max(1.0, *map(abs, score))
    starts = np.array([where[int(at)] for at, *_ in flows])
    ahead = np.array([where[int(to)] for _, to, *_ in flows]) - starts
    shown = ax.quiver(
        *starts.T, *(0.45 * ahead.T), score, cmap="coolwarm", clim=(-most, most), angles="xy", scale_units="xy", scale=1
    )
    figure.colorbar(shown, ax=ax, label="(taken - expected) / √expected", shrink=0.7)
    ax.set_aspect("equal")
    ax.invert_yaxis()
    ax.set_axis_off()
    return figure


def _positions(ground: Ground) -> list[tuple[float, float]]:
    """Where each place is drawn: the second axis across, the first down, from home or the first place."""
    start = ground.home or 0
    where: dict[int, tuple[float, float]] = {start: (0.0, 0.0)}
    queue = [start]
    for at in queue:
        for way in ground.ways[at]:
            if way.target not in where:
                down, across = (*ground.motions[way.action], 0)[:2]
                where[way.target] = (where[at][0] + across, where[at][1] + down)
                queue.append(way.target)
    return [where[i] for i in range(len(ground.places))]
