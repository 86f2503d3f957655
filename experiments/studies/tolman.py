"""The paper's study of remapping: three blocks of runs in Tolman's maze, by the routes that were taken."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Any

from ...agent import Settings
from ...views import GREY, SKY, theme_of
from ...worlds import Position
from .figures import errors, legend_below, panels, plot_bars, shares_axis
from .intervals import Share, total_variation, wilson
from .study import Findings, Study, at_least, short
from .tolman_maze import (
    COLOURS,
    GOAL,
    MAZE,
    MISSED,
    ROUTES,
    RUNS,
    SETTINGS,
    START,
    STEPS,
    A,
    B,
    TolmanRun,
    agent_run,
    choice_after,
    new_agent,
    new_world,
    plot_tolman_flow,
    set_closed,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

BLOCKS: dict[str, Position | None] = {"no obstacle": None, "A closed": A, "B closed": B}
"""The three blocks and the room that is closed in each, in their order; the agent keeps its memory."""
PAPER: dict[str, tuple[int, int, int]] = {
    "no obstacle": (48, 27, 28),
    "A closed": (0, 70, 49),
    "B closed": (0, 36, 48),
}
"""Runs of 120 by route, paper's table of path counts; with B closed they are attempts, since B cuts route 2 too."""
PAPER_RUNS = 120
KNOB = "information_weight"
KNOB_VALUES = (0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0)
"""How much finding out is worth beside the goal: the balance of exploring and exploiting."""
KNOB_AGENTS = 4
"""At most, for each value of the knob but that of the study."""

Task = tuple[float, int]
"""Value of the knob, seed."""


@dataclass(frozen=True, slots=True)
class TolmanRow:
    """One agent; the start is the same for all.

    Attributes:
        seed: of the agent.
        places: places of its map at the end; the maze has 23 rooms.
        after_block: by block, route 2 or 3, whichever was tried first after the closed room was first met; None if
            neither.
        blocks: the runs of each block.
    """

    seed: int
    places: int
    after_block: dict[str, int | None]
    blocks: dict[str, tuple[TolmanRun, ...]]


@dataclass(frozen=True, slots=True)
class Counts:
    """The runs of one block, all agents together.

    Attributes:
        runs: how many.
        attempted: shares of all runs by route, the first set out on.
        reached: the same, the goal reached on it.
        goal_reached: the goal reached on any.
        missed: runs that missed the goal, by reason.
        runs_that_met_the_block: in which the closed room was met.
        agents_by_first_route_after_the_block: by the route tried first after the closed room was first met.
    """

    runs: int
    attempted: dict[int, Share]
    reached: dict[int, Share]
    goal_reached: Share
    missed: dict[str, int]
    runs_that_met_the_block: int
    agents_by_first_route_after_the_block: dict[int, int]

    @classmethod
    def of(cls, rows: Sequence[TolmanRow], block: str) -> Counts:
        """The counts of a block."""
        runs = [run for row in rows for run in row.blocks[block]]
        missed = Counter(run.missed for run in runs)
        after = [row.after_block[block] for row in rows]
        return cls(
            runs=len(runs),
            attempted=_by_route([run.attempted for run in runs]),
            reached=_by_route([run.route for run in runs]),
            goal_reached=wilson(sum(run.route is not None for run in runs), len(runs)),
            missed={reason: missed[reason] for reason in MISSED},
            runs_that_met_the_block=sum(run.met_at is not None for run in runs),
            agents_by_first_route_after_the_block={route: after.count(route) for route in ROUTES},
        )

    def compared(self, block: str) -> tuple[int, ...]:
        """Runs by route and, last, all others, counted as the paper counts that block."""
        if block == "B closed":
            routes = (0, self.attempted[2].count, self.attempted[3].count)
        else:
            routes = tuple(share.count for share in self.reached.values())
        return (*routes, self.runs - sum(routes))


@dataclass(frozen=True, slots=True)
class Setting:
    """All that was found with one value of the knob.

    Attributes:
        value: of the knob.
        agents: how many took part.
        distance: from the paper's table: total variation of the shares by route and of missed runs, mean of the blocks.
        blocks: the counts of each.
    """

    value: float
    agents: int
    distance: float
    blocks: dict[str, Counts]

    @classmethod
    def of(cls, value: float, rows: Sequence[TolmanRow]) -> Setting:
        """What these agents come to."""
        blocks = {block: Counts.of(rows, block) for block in BLOCKS}
        apart = [total_variation(counts.compared(block), paper_counts(block)) for block, counts in blocks.items()]
        return cls(value, len(rows), sum(apart) / len(apart), blocks)


@dataclass(frozen=True)
class Tolman(Study[Task, tuple[float, TolmanRow]]):
    """Each agent runs three blocks with one memory; a few do so with other values of the knob.

    Attributes:
        runs: in a block.
        knob: values of `KNOB` that a few agents are tried with as well.
    """

    name = "tolman"
    title = "Tolman's maze in three blocks"
    question = (
        "Three blocks of runs with one memory: no obstacle, room A closed, room B closed. Which of the three "
        "routes to the goal is taken?"
    )
    notes = (
        "The rooms A and B are inferred from the paper's figures. A closed B cuts route 2 as well, so the "
        "paper's 36 for route 2 with B closed must count attempts; here both are counted.",
        "The paper looks 14 steps ahead; the way round from the block at B takes 15.",
        "Agents fall into two or three walks each: intervals over single runs are too narrow.",
    )
    agents = 10
    settings = SETTINGS

    runs: int = RUNS
    knob: tuple[float, ...] = KNOB_VALUES

    def __post_init__(self) -> None:
        at_least(self.name, 1, runs=self.runs)

    def tasks(self, seeds: Sequence[int], settings: Settings) -> list[Task]:
        """Every agent with the value of the study, then a few with each other value."""
        own = settings.information_weight
        others = [(value, seed) for value in sorted({*self.knob} - {own}) for seed in seeds[:KNOB_AGENTS]]
        return [(own, seed) for seed in seeds] + others

    def run(self, task: Task, settings: Settings) -> tuple[float, TolmanRow]:
        """The agent with this value of the knob and this seed."""
        value, seed = task
        agent, world = new_agent(replace(settings, information_weight=value), seed), new_world()
        blocks: dict[str, tuple[TolmanRun, ...]] = {}
        for block, closed in BLOCKS.items():
            set_closed(world, room=closed)
            blocks[block] = tuple(agent_run(agent, world) for _ in range(self.runs))
        after = {block: choice.route if (choice := choice_after(runs)) else None for block, runs in blocks.items()}
        return value, TolmanRow(seed, len(agent.map.places), after, blocks)

    def summarise(self, rows: Sequence[tuple[float, TolmanRow]]) -> Findings:
        """The counts of the study's own value, and how near each value comes to the paper's table."""
        values = list(dict.fromkeys(value for value, _ in rows))
        by_value = {value: [row for other, row in rows if other == value] for value in sorted(values)}
        settings = {value: Setting.of(value, part) for value, part in by_value.items()}
        own, agents = settings[values[0]], by_value[values[0]]
        knob, nearest = list(settings.values()), min(settings.values(), key=lambda setting: setting.distance)
        return Findings(
            json={
                "world": MAZE.name,
                "protocol": {"start": START, "goal": GOAL, "steps_a_run": STEPS, "closed": BLOCKS},
                "rows": agents,
                "summary": own.blocks,
                "paper": {block: _paper_shares(block) for block in BLOCKS},
                "knob": {"name": KNOB, "settings": knob, "nearest_to_paper": nearest.value},
            },
            lines=[*_lines(own.blocks), _knob_line(knob, nearest)],
            figures={
                "tolman_flow": partial(_flow, agents, own.blocks),
                "tolman_routes": partial(_routes, len(agents), own.blocks),
                "tolman_runs": partial(_runs, agents),
                "tolman_knob": partial(_knob, knob, nearest),
            },
            failed=[line for block, counts in own.blocks.items() for line in _failed(block, counts)],
        )


def paper_counts(block: str) -> tuple[int, ...]:
    """The paper's runs by route and, last, all others."""
    return (*PAPER[block], PAPER_RUNS - sum(PAPER[block]))


def _by_route(routes: Sequence[int | None]) -> dict[int, Share]:
    return {route: wilson(routes.count(route), len(routes)) for route in ROUTES}


def _paper_shares(block: str) -> dict[int, Share]:
    return {route: wilson(count, PAPER_RUNS) for route, count in zip(ROUTES, PAPER[block], strict=True)}


def _failed(block: str, counts: Counts) -> list[str]:
    goal, why = counts.goal_reached, _why(counts)
    return [
        f"{line} ({why})" if why else line for line in short(f"{block}: goal reached in", goal.count, goal.of, "runs")
    ]


def _why(counts: Counts) -> str:
    return ", ".join(f"{count} {reason}" for reason, count in counts.missed.items() if count)


def _lines(blocks: dict[str, Counts]) -> list[str]:
    lines: list[str] = []
    for block, counts in blocks.items():
        first, why = "attempts" if block == "B closed" else "reached", _why(counts)
        lines += [
            f"{block}: {counts.goal_reached.count} of {counts.runs} runs reached the goal{f'; missed: {why}' * bool(why)}",
            f"  reached by route 1, 2, 3   {_counted(counts.reached)}",
            f"  set out on route 1, 2, 3   {_counted(counts.attempted)}",
            f"  the paper ({first})".ljust(29) + _counted(_paper_shares(block)),
        ]
        if BLOCKS[block] is not None:
            after = counts.agents_by_first_route_after_the_block
            lines.append(f"  once it was met, {after[2]} agents tried route 2 next and {after[3]} route 3")
    return lines


def _counted(shares: dict[int, Share]) -> str:
    return "  ".join(f"{s.count:3d} ({s.share:4.0%}, {s.low:.0%} to {s.high:.0%})" for s in shares.values())


def _knob_line(knob: Sequence[Setting], nearest: Setting) -> str:
    tried = ", ".join(f"{setting.value:g}: {setting.distance:.2f}" for setting in knob)
    return f"{KNOB} nearest to the paper's table: {nearest.value:g} (total variation by value: {tried})"


def _flow(rows: Sequence[TolmanRow], blocks: dict[str, Counts]) -> Figure:
    title = "Ways to the goal: the wider and darker, the more often (runs that reached it)"
    figure, axes = panels(title, len(BLOCKS), (12.0, 5.2))
    for ax, (block, closed) in zip(axes, BLOCKS.items(), strict=True):
        runs = [run for row in rows for run in row.blocks[block]]
        paths = [run.path[: run.reached_at + 1] for run in runs if run.reached_at is not None]
        plot_tolman_flow(ax, paths, closed=closed)
        ax.set_title(f"{block}: {blocks[block].goal_reached.count} of {blocks[block].runs} runs", fontsize=12)
    return figure


def _routes(agents: int, blocks: dict[str, Counts]) -> Figure:
    title = f"Share of all runs by route ({agents} agent{'s' if agents > 1 else ''}), with 95 % intervals (Wilson)"
    figure, axes = panels(title, len(BLOCKS), (12.0, 4.6), sharey=True)
    for ax, (block, counts) in zip(axes, blocks.items(), strict=True):
        none = wilson(counts.runs - sum(share.count for share in counts.attempted.values()), counts.runs)
        missed = wilson(counts.runs - counts.goal_reached.count, counts.runs)
        paper = [wilson(count, PAPER_RUNS) for count in paper_counts(block)]
        ink, open_ = theme_of(ax).shade(0.7), {"color": theme_of(ax).paper, "hatch": "///"}
        for shift, shares, label, style in (
            (-0.27, [*counts.attempted.values(), none], "first set out on", {"color": SKY}),
            (0.0, [*counts.reached.values(), missed], "goal reached on it", {"color": COLOURS[1]}),
            (0.27, paper, "the paper", {**open_, "edgecolor": ink}),
        ):
            at, texts = [place + shift for place in range(len(shares))], [str(share.count) for share in shares]
            plot_bars(ax, at, shares, texts=texts, width=0.25, label=label, **style)
        ax.set_xticks(range(len(ROUTES) + 1), [*(f"route {route}" for route in ROUTES), "none"])
        ax.set_title(f"{block} (paper: attempts)" if block == "B closed" else block, fontsize=12)
    shares_axis(axes[0], "share of the runs")
    legend_below(figure, axes[0], 3)
    return figure


def _runs(rows: Sequence[TolmanRow]) -> Figure:
    from matplotlib.patches import Patch, Rectangle

    title = "Every run: the route on which the goal was reached, and the number of the one first set out on if another"
    figure, (ax,) = panels(title, 1, (12.0, 1.7 + 0.33 * len(rows)))
    colours: dict[int | None, Any] = {**COLOURS, None: GREY}
    length = len(rows[0].blocks["no obstacle"])
    for line, row in enumerate(rows):
        for number, run in enumerate(run for runs in row.blocks.values() for run in runs):
            across = number + 0.6 * (number // length)
            ax.add_patch(Rectangle((across, line + 0.08), 1.0, 0.84, facecolor=colours[run.route], edgecolor="white"))
            if run.attempted != run.route:
                ax.text(across + 0.5, line + 0.5, str(run.attempted or "–"), ha="center", va="center", size=9)
    for number, block in enumerate(BLOCKS):
        ax.text(number * (length + 0.6) + length / 2, -0.25, block, ha="center", va="bottom", size=11)
    ax.set_xlim(-0.2, len(BLOCKS) * (length + 0.6))
    ax.set_ylim(len(rows), -1.0)
    ax.set_yticks([line + 0.5 for line in range(len(rows))], [f"seed {row.seed}" for row in rows])
    ax.set_xticks([])
    ax.tick_params(length=0)
    ax.spines[:].set_visible(False)
    patches = [Patch(color=c, label=f"route {route}" if route else "missed") for route, c in colours.items()]
    figure.legend(handles=patches, loc="outside lower center", ncols=len(patches), frameon=False)
    return figure


def _knob(knob: Sequence[Setting], nearest: Setting) -> Figure:
    title = (
        f"The balance of exploring and exploiting; nearest to the paper's table: {KNOB} = {nearest.value:g} "
        f"(total variation {nearest.distance:.2f})"
    )
    figure, axes = panels(title, len(BLOCKS), (12.0, 4.8), sharey=True)
    for ax, block in zip(axes, BLOCKS, strict=True):
        ax.axvline(knob.index(nearest), color=theme_of(ax).shade(0.12), linewidth=14, zorder=0)
        _draw_knob(ax, knob, block)
        ax.set_title(f"{block} (routes 2, 3: attempts)" if block == "B closed" else block, fontsize=12)
        ax.set_xlabel(KNOB)
    shares_axis(axes[0], "share of the runs")
    axes[0].set_ylim(-0.03, 1.03)
    legend_below(figure, axes[0], 6)
    return figure


def _draw_knob(ax: Axes, knob: Sequence[Setting], block: str) -> None:
    end, ink = len(knob) - 0.25, theme_of(ax).shade(0.55)
    looks = ((1, COLOURS[1], "o", "-"), (2, COLOURS[2], "s", "--"), (3, COLOURS[3], "^", "-."), (None, ink, "x", ":"))
    for index, (route, colour, marker, line) in enumerate(looks):
        if route == 1 and BLOCKS[block] is not None:
            continue
        counts = [setting.blocks[block] for setting in knob]
        values = [wilson(part.compared(block)[index], part.runs) for part in counts]
        at = [place + 0.06 * (index - 1.5) for place in range(len(knob))]
        look: dict[str, Any] = {"color": colour, "marker": marker, "markersize": 6}
        shown = {"label": f"route {route}" if route else "none of these", "linestyle": line}
        ax.errorbar(at, [v.share for v in values], errors(values), capsize=2, elinewidth=0.8, **shown, **look)
        ax.plot(end, paper_counts(block)[index] / PAPER_RUNS, **{**look, "markersize": 10}, clip_on=False)
    goal = [setting.blocks[block].goal_reached.share for setting in knob]
    ax.plot(range(len(knob)), goal, color=theme_of(ax).ink, linewidth=1.0, label="goal reached")
    ax.set_xticks([*range(len(knob)), end], [*(f"{setting.value:g}" for setting in knob), "paper"])


STUDY = Tolman()
