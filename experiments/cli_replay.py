"""`cogmap replay`: a recorded walk as a page to step through."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

Run = Annotated[Path, typer.Argument(metavar="RUN", help="What --trace wrote.", show_default=False)]
Out = Annotated[
    Path | None, typer.Option(metavar="PAGE.html", help="Where the page goes; RUN with the ending .html unless given.")
]


def replay_command(run: Run, out: Out = None) -> None:
    """Make one HTML file of a recorded walk: the maze, the map, belief, plans and factor graph, step by step."""
    from ..model.errors import CogmapError
    from ..model.files import write_whole
    from ..views.recording import Recording
    from ..views.replay import replay_html
    from .cli_table import count, show_lines
    from .output import check_outputs

    page = out or run.with_name(run.name.removesuffix(".gz")).with_suffix(".html")
    check_outputs([page])
    if page.resolve() == run.resolve():
        raise CogmapError(f"{page} is the recording itself; give the page another name with --out")
    recording = Recording.load(run)
    content = replay_html(recording).encode()
    write_whole(page, content)
    show_lines(None, [f"{count(len(recording), 'step')}, {len(content) / 1e6:.1f} MB", f"page saved: {page}"])
