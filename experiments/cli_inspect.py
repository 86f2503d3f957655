"""`cogmap inspect`: what a saved agent believes, and why it did what it did."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from ..agent import Agent

GRAPHS = ("dot", "json", "png", "svg")
OF = ("map", "window")

File = Annotated[Path, typer.Argument(metavar="MAP.npz", help="What `cogmap explore ... --save` wrote.")]
Places = Annotated[bool, typer.Option("--places", help="A table of the places.")]
Transitions = Annotated[bool, typer.Option("--transitions", help="A table of the transitions.")]
Place = Annotated[int | None, typer.Option(metavar="N", help="Everything about one place.")]
Why = Annotated[bool, typer.Option("--why", help="Explain the last choice.")]
Growth = Annotated[bool, typer.Option("--growth", help="What was added and taken away, and when.")]
Since = Annotated[int | None, typer.Option(metavar="N", min=0, help="With --growth: from step N on.")]
Limit = Annotated[int, typer.Option(metavar="N", min=1, help="Rows of a table at most.")]
Graph = Annotated[str | None, typer.Option(metavar="FORMAT", help="Write a graph as dot, json, png or svg.")]
Of = Annotated[str, typer.Option(metavar="WHAT", help="With --graph: map, or window, the factor graph.")]
Out = Annotated[Path | None, typer.Option(metavar="FILE", help="With --graph: where it goes; MAP.FORMAT unless given.")]
Json = Annotated[
    Path | None, typer.Option(metavar="FILE", help="Write the summary, and all rows of what is asked for, as JSON.")
]


def inspect_command(
    map_file: File,
    places: Places = False,
    transitions: Transitions = False,
    place: Place = None,
    why: Why = False,
    growth: Growth = False,
    since: Since = None,
    limit: Limit = 20,
    graph: Graph = None,
    of: Of = "map",
    out: Out = None,
    json: Json = None,
) -> None:
    """Show what a saved agent believes: a summary, or what is asked for. The file stays as it is."""
    from ..agent import Agent
    from .cli_inspect_facts import summary
    from .cli_inspect_show import show_summary
    from .output import write_json

    target = _graph_file(map_file, graph, of, out)
    _check(map_file, target, json, growth=growth, since=since)
    agent = Agent.load(map_file)
    facts = {"summary": summary(map_file, agent)}
    if not (places or transitions or place is not None or why or growth or graph):
        show_summary(facts["summary"])
    if places:
        facts["places"] = _show_places(agent, limit)
    if transitions:
        facts["transitions"] = _show_transitions(agent, limit)
    if place is not None:
        facts["place"] = _show_place(agent, place, limit)
    if why:
        facts["why"] = _show_why(agent)
    if growth:
        facts["growth"] = _show_growth(agent, since or 0, limit)
    if graph is not None and target is not None:
        _write_graph(agent, graph, of, target)
        _say("graph", target)
    if json is not None:
        write_json(json, facts)
        _say("facts", json)


def _graph_file(map_file: Path, graph: str | None, of: str, out: Path | None) -> Path | None:
    """Where the graph goes, if one is asked for."""
    from ..model.errors import CogmapError

    if of not in OF:
        raise CogmapError(f"inspect: there is no graph of {of!r}; choose one of {', '.join(OF)}")
    if graph is None:
        if out is not None:
            raise CogmapError("inspect: --out is where a graph goes; add --graph dot, json, png or svg")
        return None
    if graph not in GRAPHS:
        raise CogmapError(f"inspect: no graph format {graph!r}; choose one of {', '.join(GRAPHS)}")
    return map_file.with_suffix(f".{graph}") if out is None else out


def _check(map_file: Path, graph: Path | None, json: Path | None, *, growth: bool, since: int | None) -> None:
    from ..model.errors import CogmapError
    from .output import check_outputs

    if since is not None and not growth:
        raise CogmapError("inspect: --since is for --growth; add it")
    for path in (graph, json):
        if path is not None and path.resolve() == map_file.resolve():
            raise CogmapError(f"inspect: {path} is the file that is read; write to another")
    check_outputs([graph, json])


def _show_places(agent: Agent, limit: int) -> Any:
    from .cli_inspect_facts import place_rows
    from .cli_inspect_show import show_places

    rows = place_rows(agent)
    show_places(rows, limit)
    return rows


def _show_transitions(agent: Agent, limit: int) -> Any:
    from .cli_inspect_facts import transition_rows
    from .cli_inspect_show import show_transitions

    rows = transition_rows(agent.map)
    show_transitions(rows, limit)
    return rows


def _show_place(agent: Agent, place: int, limit: int) -> Any:
    from .cli_inspect_facts import place_facts
    from .cli_inspect_show import show_place

    facts = place_facts(agent, place)
    show_place(facts, limit)
    return facts


def _show_why(agent: Agent) -> Any:
    from ..views.explain import explain
    from .cli_table import console

    told = explain(agent)
    console().print(told.text, markup=False, highlight=False, soft_wrap=True)
    return told.to_dict()


def _show_growth(agent: Agent, since: int, limit: int) -> Any:
    from .cli_inspect_facts import growth_rows
    from .cli_inspect_show import show_growth

    facts = growth_rows(agent.map, since)
    show_growth(agent.map, facts, limit)
    return facts


def _write_graph(agent: Agent, graph: str, of: str, target: Path) -> None:
    from ..model.files import write_whole

    write_whole(target, _window(agent, graph) if of == "window" else _map(agent, graph))


def _window(agent: Agent, graph: str) -> bytes:
    from ..model import MOST_DRAWN, graph_svg
    from ..model.errors import CogmapError

    window = agent.graph
    if graph == "png":
        from ..views import plot_factor_graph

        return _picture(plot_factor_graph(window), graph)
    if graph == "svg":
        drawn = graph_svg(window)
        if drawn is None:
            raise CogmapError(
                f"inspect: the window is empty, or has more than {MOST_DRAWN} nodes to draw; use --graph dot"
            )
        return drawn.encode()
    text = window.to_dot() if graph == "dot" else window.to_json(indent=1)
    return text.encode(errors="replace")


def _map(agent: Agent, graph: str) -> bytes:
    if graph in ("dot", "json"):
        text = agent.map.to_dot() if graph == "dot" else agent.map.to_json(indent=1)
        return text.encode(errors="replace")
    from ..views import plot_map

    return _picture(plot_map(agent.map), graph)


def _picture(axes: Any, kind: str) -> bytes:
    """The whole figure of the axes, as a file of that kind."""
    from io import BytesIO

    buffer = BytesIO()
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Glyph")  # signs that the font lacks are drawn as boxes
        axes.figure.savefig(buffer, format=kind)
    return buffer.getvalue()


def _say(what: str, path: Path) -> None:
    from .cli_table import console

    console().print(f"{what} saved: {path}", markup=False, highlight=False, soft_wrap=True)
