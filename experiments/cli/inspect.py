"""`cogmap inspect`: what a saved agent believes, and why it did what it did."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..text import say, say_saved

if TYPE_CHECKING:
    from ...agent import Agent

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
    from ...agent import Agent
    from ...model import CogmapError, growth_between, write_whole
    from ...views import explain
    from .. import check_outputs, write_json
    from . import inspect_facts as told
    from . import inspect_text as text

    if since is not None and not growth:
        raise CogmapError("inspect: --since is for --growth; add it")
    target = _graph_file(map_file, graph, of, out)
    check_outputs([target, json], inputs=[map_file])
    agent = Agent.load(map_file)
    facts: dict[str, Any] = {"summary": told.summary(map_file, agent)}
    if not (places or transitions or place is not None or why or growth or graph):
        text.show_summary(facts["summary"])
    if places:
        facts["places"] = told.place_rows(agent)
        text.show_rows("places", text.PLACES, facts["places"], limit)
    if transitions:
        facts["transitions"] = told.transition_rows(agent.map)
        text.show_rows("transitions", text.TRANSITIONS, facts["transitions"], limit)
    if place is not None:
        facts["place"] = told.place_facts(agent, place)
        text.show_place(facts["place"], limit)
    if why:
        facts["why"] = explain(agent).to_dict()
        say(explain(agent).text)
    if growth:
        facts["growth"] = told.growth_rows(agent.map, since or 0)
        say(growth_between(agent.map, since or 0))
        text.show_rows("growth", text.GROWTH, facts["growth"]["events"], limit)
    if graph is not None and target is not None:
        target = write_whole(target, _drawn(agent, graph, window=of == "window"), new=out is None)
    if json is not None:
        write_json(json, facts)
    say_saved(graph=target, facts=json)


def _graph_file(map_file: Path, graph: str | None, of: str, out: Path | None) -> Path | None:
    """Where the graph goes, if one is asked for."""
    from ...model import CogmapError
    from .. import unused

    if of not in OF:
        raise CogmapError(f"inspect: there is no graph of {of!r}; choose one of {', '.join(OF)}")
    if graph is None and out is not None:
        raise CogmapError("inspect: --out is where a graph goes; add --graph dot, json, png or svg")
    if graph not in (None, *GRAPHS):
        raise CogmapError(f"inspect: no graph format {graph!r}; choose one of {', '.join(GRAPHS)}")
    return out if graph is None or out is not None else unused(map_file.with_suffix(f".{graph}"))


def _drawn(agent: Agent, graph: str, *, window: bool) -> bytes:
    from ...views import plot_factor_graph, plot_map
    from .. import picture_of

    what = agent.graph if window else agent.map
    if graph in ("dot", "json"):
        return (what.to_dot() if graph == "dot" else what.to_json(indent=1)).encode(errors="replace")
    axes = plot_factor_graph(agent.graph) if window else plot_map(agent.map)
    return picture_of(axes.figure, graph)
