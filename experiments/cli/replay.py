"""`cogmap replay`: a recorded walk as a page to step through."""

from pathlib import Path
from typing import Annotated

import typer

from ..text import count, say, say_saved

RunFile = Annotated[Path, typer.Argument(metavar="RUN", help="What --trace wrote.", show_default=False)]
Out = Annotated[
    Path | None, typer.Option(metavar="PAGE.html", help="Where the page goes; RUN with the ending .html unless given.")
]


def replay_command(run: RunFile, out: Out = None) -> None:
    """Make one HTML file of a recorded walk: the maze, the map, belief, plans and factor graph, step by step."""
    from ...model import write_whole
    from ...views import Recording, replay_html
    from .. import check_outputs, unused

    page = out or unused(run.with_name(run.name.removesuffix(".gz")).with_suffix(".html"))
    check_outputs([page], inputs=[run])
    recording = Recording.load(run)
    content = replay_html(recording).encode()
    page = write_whole(page, content, new=out is None)
    say(f"{count(len(recording), 'step')}, {len(content) / 1e6:.1f} MB")
    say_saved(page=page)
