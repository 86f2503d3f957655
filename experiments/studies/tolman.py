"""The paper's study of remapping: three blocks of runs in Tolman's maze, by the routes that were taken."""

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

from ...agent import Settings
from ...views import GREY, SKY, theme_of
from ...worlds import Position
from . import tolman_maze as maze
from .figures import Axes, Figure, Look, legend_below, panels, plot_bars, plot_line, shares_axis
from .intervals import Share, total_variation, wilson
from .study import Findings, Study
from .tolman_maze import COLOURS, ROUTES, TolmanRun

BLOCKS: dict[str, Position | None] = {"no obstacle": None, "A closed": maze.A, "B closed": maze.B}
"""The three blocks and the room that is closed in each, in their order; the agent keeps its memory."""
PAPER = {"no obstacle": (48, 27, 28, 17), "A closed": (0, 70, 49, 1), "B closed": (0, 36, 48, 36)}
"""Runs by route and all others, paper's table of path counts; with B closed attempts, since B cuts route 2 too."""
PAPER_RUNS = 120
KNOB = "information_weight"
KNOB_VALUES = (0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0)
"""How much finding out is worth beside the goal: the balance of exploring and exploiting."""
KNOB_AGENTS = 4  # at most, for each value of the knob but that of the study
MISSED_OR: dict[int | None, Any] = {**COLOURS, None: GREY}  # colours of the routes, and of a missed goal

Task = tuple[float, int]  # value of the knob, seed
Runs = tuple[TolmanRun, ...]
Counts = dict[str, Any]


@dataclass(frozen=True, slots=True)
class TolmanRow:
    """One agent; the start is the same for all."""

    seed: int
    places: int  # of its map at the end; the maze has 23 rooms
    after_block: dict[str, int | None]  # the route, 2 or 3, first tried after the closed room was first met
    blocks: dict[str, Runs]


@dataclass(frozen=True)
class Tolman(Study[Task, tuple[float, TolmanRow]]):
    """Tolman's maze in three blocks

    Three blocks of runs with one memory: no obstacle, room A closed, room B closed. Which of the three
    routes to the goal is taken?
    """

    name = "tolman"
    notes = (
        "The rooms A and B are inferred from the paper's figures. A closed B cuts route 2 as well, so the "
        "paper's 36 for route 2 with B closed must count attempts; here both are counted.",
        "The paper looks 14 steps ahead; the way round from the block at B takes 15.",
        "Agents fall into two or three walks each: intervals over single runs are too narrow.",
    )
    agents = 10
    settings = maze.SETTINGS

    runs: int = maze.RUNS  # in a block
    knob: tuple[float, ...] = KNOB_VALUES

    def tasks(self, seeds: Sequence[int], settings: Settings) -> list[Task]:
        """Every agent with the value of the study, then a few with each other value."""
        own = settings.information_weight
        others = [(value, seed) for value in sorted({*self.knob} - {own}) for seed in seeds[:KNOB_AGENTS]]
        return [(own, seed) for seed in seeds] + others

    def run(self, task: Task, settings: Settings) -> tuple[float, TolmanRow]:
        value, seed = task
        agent, blocks = maze.new_agent(replace(settings, information_weight=value), seed), dict[str, Runs]()
        for block, closed in BLOCKS.items():
            blocks[block] = tuple(maze.agent_run(agent, closed) for _ in range(self.runs))
        choices = {block: maze.choice_after(runs) for block, runs in blocks.items()}
        after = {block: choice and choice.route for block, choice in choices.items()}
        return value, TolmanRow(seed, len(agent.map.places), after, blocks)

    def summarise(self, rows: Sequence[tuple[float, TolmanRow]]) -> Findings:
        by_value = {value: [row for other, row in rows if other == value] for value, _ in rows}
        agents, knob = by_value[rows[0][0]], [_setting(value, by_value[value]) for value in sorted(by_value)]
        blocks = next(setting["blocks"] for setting in knob if setting["value"] == rows[0][0])
        nearest = min(knob, key=lambda setting: setting["distance"])
        protocol = {"start": maze.START, "goal": maze.GOAL, "steps_a_run": maze.STEPS, "closed": BLOCKS}
        json = {"world": maze.MAZE.name, "protocol": protocol, "rows": agents, "summary": blocks}
        json["paper"] = {block: dict(zip(ROUTES, _paper(block), strict=False)) for block in BLOCKS}
        json["knob"] = {"name": KNOB, "settings": knob, "nearest_to_paper": nearest["value"]}
        figures = {"tolman_flow": partial(_flow, agents, blocks), "tolman_routes": partial(_routes, agents, blocks)}
        figures |= {"tolman_runs": partial(_runs, agents), "tolman_knob": partial(_knob, knob, nearest)}
        failed = [
            f"{block}: goal reached in {counts['goal_reached'].count} of {counts['runs']} runs ({_why(counts)})"
            for block, counts in blocks.items()
            if _why(counts)
        ]
        return Findings(json, _lines(blocks, knob, nearest), figures, failed=failed)


def counted(rows: Sequence[TolmanRow], block: str) -> Counts:
    """The runs of one block, all agents together: shares of all of them by route, and what they missed."""
    runs = [run for row in rows for run in row.blocks[block]]
    missed, after = Counter(run.missed for run in runs), [row.after_block[block] for row in rows]
    return {
        "runs": len(runs),
        "attempted": _shares([run.attempted for run in runs]),  # the first set out on
        "reached": _shares([run.route for run in runs]),
        "goal_reached": wilson(sum(run.route is not None for run in runs), len(runs)),
        "missed": {reason: missed[reason] for reason in maze.MISSED},
        "runs_that_met_the_block": sum(run.met_at is not None for run in runs),
        "agents_by_first_route_after_the_block": {route: after.count(route) for route in ROUTES},
    }


def compared(counts: Counts, block: str) -> tuple[int, ...]:
    """Runs by route and, last, all others, counted as the paper counts that block."""
    shares = counts["attempted" if block == "B closed" else "reached"]
    routes = [0 if block == "B closed" and route == 1 else share.count for route, share in shares.items()]
    return (*routes, counts["runs"] - sum(routes))


def _why(counts: Counts) -> str:
    return ", ".join(f"{count} {reason}" for reason, count in counts["missed"].items() if count)


def _setting(value: float, rows: Sequence[TolmanRow]) -> dict[str, Any]:
    """What was found with one value of the knob; its distance from the paper's table is the mean total variation."""
    blocks = {block: counted(rows, block) for block in BLOCKS}
    apart = [total_variation(compared(counts, block), PAPER[block]) for block, counts in blocks.items()]
    return {"value": value, "agents": len(rows), "distance": sum(apart) / len(apart), "blocks": blocks}


def _shares(routes: Sequence[int | None]) -> dict[int, Share]:
    return {route: wilson(routes.count(route), len(routes)) for route in ROUTES}


def _lines(blocks: dict[str, Counts], knob: Sequence[dict[str, Any]], nearest: dict[str, Any]) -> list[str]:
    lines: list[str] = []
    for block, counts in blocks.items():
        missed = f"; missed: {_why(counts)}" if _why(counts) else ""
        how = "attempts" if block == "B closed" else "reached"
        lines += [
            f"{block}: {counts['goal_reached'].count} of {counts['runs']} runs reached the goal{missed}",
            f"  reached by route 1, 2, 3   {_counted(counts['reached'].values())}",
            f"  set out on route 1, 2, 3   {_counted(counts['attempted'].values())}",
            f"  the paper ({how})".ljust(29) + _counted(_paper(block)[:3]),
        ]
        if BLOCKS[block] is not None:
            after = counts["agents_by_first_route_after_the_block"]
            lines.append(f"  once it was met, {after[2]} agents tried route 2 next and {after[3]} route 3")
    tried = ", ".join(f"{one['value']:g}: {one['distance']:.2f}" for one in knob)
    near = f"{KNOB} nearest to the paper's table: {nearest['value']:g} (total variation by value: {tried})"
    return [*lines, near]


def _paper(block: str) -> list[Share]:
    return [wilson(count, PAPER_RUNS) for count in PAPER[block]]


def _counted(shares: Iterable[Share]) -> str:
    return "  ".join(f"{s.count:3d} ({s.share:4.0%}, {s.low:.0%} to {s.high:.0%})" for s in shares)


def _flow(rows: Sequence[TolmanRow], blocks: dict[str, Counts]) -> Figure:
    title = "Ways to the goal: the wider and darker, the more often (runs that reached it)"
    figure, axes = panels(title, (1, 3), (12.0, 5.2))
    for ax, (block, counts) in zip(axes, blocks.items(), strict=True):
        runs = [run for row in rows for run in row.blocks[block]]
        paths = [run.path[: run.reached_at + 1] for run in runs if run.reached_at is not None]
        maze.plot_tolman(ax, paths, closed=BLOCKS[block])
        ax.set_title(f"{block}: {counts['goal_reached'].count} of {counts['runs']} runs", fontsize=12)
    return figure


def _routes(rows: Sequence[TolmanRow], blocks: dict[str, Counts]) -> Figure:
    title = f"Share of all runs by route ({len(rows)} agent{'s' * (len(rows) > 1)}), with 95 % intervals (Wilson)"
    figure, axes = panels(title, (1, 3), (12.0, 4.6), sharey=True)
    for ax, (block, counts) in zip(axes, blocks.items(), strict=True):
        none = wilson(counts["runs"] - sum(share.count for share in counts["attempted"].values()), counts["runs"])
        missed = wilson(counts["runs"] - counts["goal_reached"].count, counts["runs"])
        paper = {"color": theme_of(ax).paper, "edgecolor": theme_of(ax).shade(0.7), "hatch": "///"}
        for shift, label, shares, look in (
            (-0.27, "first set out on", [*counts["attempted"].values(), none], {"color": SKY}),
            (0.0, "goal reached on it", [*counts["reached"].values(), missed], {"color": COLOURS[1]}),
            (0.27, "the paper", _paper(block), paper),
        ):
            at, texts = [place + shift for place in range(4)], [str(share.count) for share in shares]
            plot_bars(ax, at, shares, texts=texts, width=0.25, label=label, **look)
        ax.set_xticks(range(4), [*(f"route {route}" for route in ROUTES), "none"])
        ax.set_title(f"{block} (paper: attempts)" if block == "B closed" else block, fontsize=12)
    shares_axis(axes[0], "share of the runs")
    legend_below(figure, axes[0], 3)
    return figure


def _runs(rows: Sequence[TolmanRow]) -> Figure:
    title = "Every run: the route on which the goal was reached, and the number of the one first set out on if another"
    figure, (ax,) = panels(title, (1, 1), (12.0, 1.7 + 0.33 * len(rows)))
    length = len(rows[0].blocks["no obstacle"]) + 0.6
    for line, row in enumerate(rows):
        for block, runs in enumerate(row.blocks.values()):
            at, colours = (
                [block * length + number for number in range(len(runs))],
                [MISSED_OR[run.route] for run in runs],
            )
            ax.bar(at, 0.84, 1.0, line - 0.42, color=colours, edgecolor=theme_of(ax).paper)
            for x, run in zip(at, runs, strict=True):
                text = str(run.attempted or "–") if run.attempted != run.route else ""
                ax.text(x, line, text, ha="center", va="center", size=9)
    for route, colour in MISSED_OR.items():
        ax.bar(0, 0, color=colour, label=f"route {route}" if route else "missed")
    for block, name in enumerate(BLOCKS):
        ax.text((block + 0.5) * length - 0.8, -0.75, name, ha="center", va="bottom", size=11)
    ax.set(xlim=(-0.7, 3 * length - 0.5), ylim=(len(rows) - 0.5, -1.5), xticks=[])
    ax.set_yticks(range(len(rows)), [f"seed {row.seed}" for row in rows])
    ax.tick_params(length=0)
    ax.spines[:].set_visible(False)
    legend_below(figure, ax, 4)
    return figure


def _knob(knob: Sequence[dict[str, Any]], nearest: dict[str, Any]) -> Figure:
    title = (
        f"The balance of exploring and exploiting; nearest to the paper's table: {KNOB} = {nearest['value']:g} "
        f"(total variation {nearest['distance']:.2f})"
    )
    figure, axes = panels(title, (1, 3), (12.0, 4.8), sharey=True)
    for ax, block in zip(axes, BLOCKS, strict=True):
        ax.axvline(knob.index(nearest), color=theme_of(ax).shade(0.12), linewidth=14, zorder=0)
        _draw_knob(ax, knob, block)
        ax.set_title(f"{block} (routes 2, 3: attempts)" if block == "B closed" else block, fontsize=12)
        ax.set_xlabel(KNOB)
    shares_axis(axes[0], "share of the runs", -0.03, 1.03)
    legend_below(figure, axes[0], 6)
    return figure


def _draw_knob(ax: Axes, knob: Sequence[dict[str, Any]], block: str) -> None:
    end, counts = len(knob) - 0.25, [setting["blocks"][block] for setting in knob]
    colours = [*COLOURS.values(), theme_of(ax).shade(0.55)]
    for index, (colour, marker, line) in enumerate(zip(colours, "os^x", ("-", "--", "-.", ":"), strict=True)):
        if index == 0 and BLOCKS[block] is not None:
            continue
        values = [wilson(compared(part, block)[index], part["runs"]) for part in counts]
        at, name = [place + 0.06 * (index - 1.5) for place in range(len(knob))], f"route {index + 1}"
        look: Look = {"color": colour, "marker": marker}
        plot_line(ax, at, values, label=name if index < 3 else "none of these", linestyle=line, elinewidth=0.8, **look)
        ax.plot(end, PAPER[block][index] / PAPER_RUNS, markersize=10, clip_on=False, **look)
    goal = [part["goal_reached"].share for part in counts]
    ax.plot(range(len(knob)), goal, color=theme_of(ax).ink, linewidth=1.0, label="goal reached")
    ax.set_xticks([*range(len(knob)), end], [*(f"{setting['value']:g}" for setting in knob), "paper"])
