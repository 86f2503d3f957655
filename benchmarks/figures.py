"""Studies whose figures and tables stand in the documents: run, drawn for both themes, and written there.

`tables.py` asks for them by name. What a page says in words is printed, to be read beside it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from cogmap.experiments import CSCG, walk, write_picture
from cogmap.experiments.studies import Findings, Study, study_named
from cogmap.experiments.studies.exploration import PAPER
from cogmap.views import explore_figure
from cogmap.worlds import parse_maze
from matplotlib import style

ROOT = Path(__file__).resolve().parents[1]
PICTURES = ROOT / "docs" / "pictures"
DARK = ROOT / "docs" / "hooks" / "dark.mplstyle"
HOUSE = "porch hall study library\nkitchen hall hall library\npantry garden . attic\ncellar garden garden shed\n"

Rows = dict[str, Sequence[str]]
Change = Callable[..., None]
"""Writes rows into a page: `tables.change`."""


def study(
    how: Mapping[str, Any], name: str, runs: int | None = None
) -> tuple[Study[Any, Any], Sequence[Any], Findings]:
    """The study with its own number of runs, or with `runs`; what the folder of `how` keeps is not made again."""
    one, folder = study_named(name), how["keep"]
    folder.mkdir(parents=True, exist_ok=True)
    with one.ledger(folder, one.settings) as kept:
        rows = one.rows(how["few"] or runs, executor=how["executor"], ledger=kept)
    found = one.summarise(rows)
    print(*found.lines, *found.failed, sep="\n")
    return one, rows, found


def draw(stem: str, figure: Callable[[], Any]) -> None:
    """The picture `stem` of the documents, for the light theme and for the dark one."""
    write_picture(PICTURES / f"{stem}.png", figure())
    with style.context(DARK):
        write_picture(PICTURES / f"{stem}.dark.png", figure())
    print(f"docs/pictures/{stem}.png")


def own_maze(how: Mapping[str, Any], change: Change) -> None:
    """The picture at the head of README: a house after eight steps."""
    house = parse_maze(HOUSE, name="house")
    done = walk(house, seed=1, max_steps=8)
    known: dict[str, Any] = {"map_": done.walker.map, "trace": done.walker.trace}
    draw("own_maze", lambda: explore_figure(house, done.path, title="house, cogmap, seed 1", **known))


def exploration(how: Mapping[str, Any], change: Change) -> None:
    """Steps to learn, beside CSCG: README, docs/exploring.md, docs/paper.md."""
    one, rows, found = study(how, "exploration", 20)
    draw("exploration_steps", found.figures["exploration_steps"])
    grid: Any = one.grid(rows)  # type: ignore[attr-defined]
    table = next(table for table in found.tables or () if table.name == "exploration_table")
    change(
        "README.md",
        "| maze | Oracle | cogmap |",
        {str(maze): [str(cell) for cell in cells] for maze, *cells in table.rows},
    )
    ratios = {line["world"]: line for line in found.json["ratios"]}
    beside: Rows = {}
    first: Rows = {}
    for maze, line in ratios.items():
        cscg, pose = (short(grid[maze, model]) for model in ("cscg", "cscg_pose"))
        theirs = {model: PAPER[maze, model] for model in ("cogmap", *CSCG)}
        ratio = "–" if line["ratio"] is None else f"{'≥ ' * line['censored']}{line['ratio'].value:.1f}"
        means = [f"{theirs[model][0]:.1f}" for model in ("cscg", "cscg_pose")]
        beside[maze] = [short(grid[maze, "cogmap"]), cscg, means[0], pose, means[1], ratio]
        whole = [f"{theirs[model][0]:.1f} ± {theirs[model][1]:g}" for model in ("cogmap", "cscg", "cscg_pose")]
        own = [grid[maze, "oracle"].mean_text().partition(" ")[0], short(grid[maze, "cogmap"])]
        first[maze] = [*own, whole[0], cscg, whole[1], pose, whole[2]]
    change("docs/exploring.md", "| maze | cogmap | CSCG | paper |", beside)
    change("docs/paper.md", "| maze | oracle | cogmap | paper | CSCG, ours |", first)


def short(steps: Any) -> str:
    """Mean ± standard deviation; of runs that did not all get there the lower bound, and how many did."""
    return f"≥ {steps.bound:.1f} ({steps.got_there}/{steps.runs})" if steps.censored else steps.mean_text()


def rooms(how: Mapping[str, Any], change: Change) -> None:
    """Steps to enter every room, beside CSCG: a picture; its means stand in words in docs/exploring.md."""
    draw("rooms_steps", study(how, "rooms", 20)[2].figures["rooms_steps"])


def distances(how: Mapping[str, Any], change: Change) -> None:
    """Steps to the goal by distance: docs/paper.md."""
    _, _, found = study(how, "distances", 20)
    draw("goal_distances", found.figures["distances"])
    table = next(table for table in found.tables or () if table.name == "distances")
    lines = {
        f"{str(kind).removeprefix('sights ')} | {far}": [str(cell).partition(" ")[0] for cell in cells]
        for kind, far, *cells in table.rows
    }
    change("docs/paper.md", "| sights | shortest | cogmap, its map |", lines, whole=True)


def tolman(how: Mapping[str, Any], change: Change) -> None:
    """Routes in Tolman's maze: docs/changing.md, docs/paper.md."""
    _, _, found = study(how, "tolman")
    for stem in ("tolman_flow", "tolman_knob"):
        draw(stem, found.figures[stem])
    blocks: Mapping[str, Any] = found.json["summary"]
    routes = {block: [str(counts["reached"][route].count) for route in (1, 2, 3)] for block, counts in blocks.items()}
    change("docs/paper.md", "| | route 1 | route 2 | route 3 | paper: 1 |", routes)
    reached = {block: [*cells, str(blocks[block]["goal_reached"].count)] for block, cells in routes.items()}
    change("docs/changing.md", "| | route 1 | route 2 | route 3 | reached of 120 |", reached)


def localisation(how: Mapping[str, Any], change: Change) -> None:
    """Being moved in the aliased T maze: docs/changing.md."""
    _, _, found = study(how, "localisation", 20)
    rows: Rows = {}
    for name, part in found.json["summary"]["conditions"].items():
        first = ", ".join(str(part[kind]) for kind in ("split", "right", "wrong"))
        steps = f"{part['mean_steps_to_localise']:.1f} ± {part['std_steps_to_localise']:.1f}"
        rows[found.json["protocol"]["conditions"][name]] = [first, steps, f"{part['map_intact']}/{part['trials']}"]
    change("docs/changing.md", "| the agent is | first sight: split, right, wrong |", rows)


def donut(how: Mapping[str, Any], change: Change) -> None:
    """A way that is closed: a picture; its counts stand in words in docs/changing.md."""
    draw("donut_frames", study(how, "donut", 20)[2].figures["donut_frames"])


def spoken(name: str) -> Callable[[Mapping[str, Any], Change], None]:
    """A study of which a page tells in words: its lines are printed."""

    def run(how: Mapping[str, Any], change: Change) -> None:
        study(how, name)

    run.__doc__ = f"What the study {name} comes to, to be read beside what the page says in words."
    return run


STUDIES: dict[str, Callable[[Mapping[str, Any], Change], None]] = {
    "own_maze": own_maze,
    "tolman": tolman,
    "localisation": localisation,
    "donut": donut,
    "insight": spoken("insight"),
    "martinet": spoken("martinet"),
    "exploration": exploration,
    "rooms": rooms,
    "distances": distances,
}
