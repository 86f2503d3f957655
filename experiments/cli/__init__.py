"""The command `cogmap`: one module a command."""

from typing import Annotated

import typer

from .explore import explore_command
from .fit import fit_command
from .group import CogmapGroup
from .inspect import inspect_command
from .kidnap import kidnap_command
from .navigate import navigate_command
from .replay import replay_command
from .show import show_command
from .study import study_command
from .walk import walk_command
from .worlds import worlds_command

ABOUT = "Agents that build their own map, as explicit discrete factor graphs."
app = typer.Typer(name="cogmap", cls=CogmapGroup, help=ABOUT, add_completion=False, pretty_exceptions_enable=False)


def _version(wanted: bool) -> None:
    if wanted:
        from importlib.metadata import version

        typer.echo(f"cogmap {version('cogmap')}")
        raise typer.Exit


Version = Annotated[bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version.")]


@app.callback(invoke_without_command=True)
def _cogmap(context: typer.Context, version: Version = False) -> None:  # pyright: ignore[reportUnusedFunction]
    if context.invoked_subcommand is None:
        typer.echo(context.get_help())


for _command in (
    worlds_command,
    show_command,
    walk_command,
    explore_command,
    navigate_command,
    kidnap_command,
    study_command,
    fit_command,
    replay_command,
    inspect_command,
):
    app.command(_command.__name__.removesuffix("_command"))(_command)


def main() -> None:
    """Entry point of the console script."""
    app()
