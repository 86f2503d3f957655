"""The command `cogmap`: one module a command."""

from __future__ import annotations

from typing import Annotated

import typer

from .explore import explore_command
from .group import CogmapGroup
from .inspect import inspect_command
from .kidnap import kidnap_command
from .navigate import navigate_command
from .replay import replay_command
from .study import study_command
from .worlds import worlds_command

app = typer.Typer(
    name="cogmap",
    cls=CogmapGroup,
    help="Agents that build their own map, as explicit discrete factor graphs.",
    add_completion=False,
    pretty_exceptions_enable=False,
)


def _version(wanted: bool) -> None:
    if wanted:
        from importlib.metadata import version

        typer.echo(f"cogmap {version('cogmap')}")
        raise typer.Exit


@app.callback(invoke_without_command=True)
def _cogmap(  # pyright: ignore[reportUnusedFunction]
    context: typer.Context,
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    if context.invoked_subcommand is None:
        typer.echo(context.get_help())


app.command("worlds")(worlds_command)
app.command("explore")(explore_command)
app.command("navigate")(navigate_command)
app.command("kidnap")(kidnap_command)
app.command("study")(study_command)
app.command("replay")(replay_command)
app.command("inspect")(inspect_command)


def main() -> None:
    """Entry point of the console script."""
    app()
