"""What a study leaves in its folder: JSON, tables as CSV, figures, and a report as Markdown and HTML."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...agent import Settings
from ...model.errors import CogmapError
from ...model.files import write_whole
from ..output import check_outputs, write_json, write_picture
from .about import about
from .frame import Result, Study
from .json_tables import flat
from .machine import machine, versions
from .report import Report, Value
from .report_html import html_page

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PICTURES = (".png", ".svg")
REPORTS = (".json", ".md", ".html")


def check_folder(folder: Path, study: str) -> None:
    """Refuse, before anything is computed, a folder in which `save_study` could not write.

    Raises:
        CogmapError: it is a file, or not writable, or cannot be made.
    """
    try:
        if folder.is_dir():
            check_outputs([folder / f"{study}{suffix}" for suffix in REPORTS])
            return
        target = above = Path(os.path.realpath(folder))
        while not (above.exists() or above == above.parent):
            above = above.parent
        if not above.is_dir():
            raise CogmapError(f"cannot make folder {folder}: {above} is a file; choose another folder")
        with tempfile.TemporaryDirectory(dir=above, prefix=".cogmap-") as there:
            (Path(there) / target.relative_to(above)).mkdir(parents=True)  # a name may be too long
    except OSError as error:
        raise CogmapError(f"cannot make folder {folder}: {error.strerror or error}; choose another folder") from error


def make_folder(folder: Path) -> None:
    """Make the folder, and those above it.

    Raises:
        CogmapError: it cannot be made.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise CogmapError(f"cannot make folder {folder}: {error.strerror or error}; choose another folder") from error


def study_report(study: Study, result: Result, *, agents: int, seed: int, settings: Settings) -> dict[str, Any]:
    """What the study found, and all that it takes to run it again, as plain JSON values."""
    own = study.settings()
    look_ahead = "" if settings.look_ahead == own.look_ahead else f" --look-ahead {settings.look_ahead}"
    head = {
        "study": study.name,
        "agents": agents,
        "seed": seed,
        "command": f"cogmap study {study.name} --runs {agents} --seed {seed}{look_ahead}",
        "settings": settings.to_dict(),
        "versions": versions(),
        "machine": machine(),
    }
    return {**head, **result.to_dict()}


def save_study(folder: Path, study: Study, result: Result, report: dict[str, Any]) -> list[Path]:
    """Write everything; answers with the files, the JSON first and the report last.

    Args:
        folder: is made if need be.
        study: which it was.
        result: of the study.
        report: what `study_report` gave.

    Raises:
        CogmapError: a file cannot be written; those before it are whole.
    """
    make_folder(folder)
    written = [folder / f"{study.name}.json"]
    write_json(written[0], report)
    tables, figures = tuple(study.tables(result)), study.figures(result)
    for table in tables:
        written.append(folder / f"{table.name}.csv")
        write_whole(written[-1], table.csv().encode())
    for stem, figure in figures.items():
        for suffix in PICTURES:
            written.append(folder / f"{stem}{suffix}")
            write_picture(written[-1], figure)
    text = about(study.name)
    document = Report(
        title=f"{text.title} (study {study.name})",
        asked=text.asked,
        lines=() if study.has_tables else tuple(study.lines(result)),
        figures=tuple((f"{stem}.png", _caption(stem, figure)) for stem, figure in figures.items()),
        tables=tables,
        failed=study.failed(result),
        notes=text.notes,
        command=report["command"],
        facts=facts(report),
    )
    return written + write_report(folder / study.name, document)


def write_report(stem: Path, document: Report) -> list[Path]:
    """Write the report as Markdown, and with its pictures inside as HTML; answers with the files.

    Raises:
        CogmapError: a file cannot be written.
    """
    markdown = document.markdown()
    pages = {".md": markdown, ".html": html_page(markdown, stem.parent)}
    written = [stem.with_name(f"{stem.name}{suffix}") for suffix in pages]
    for path, page in zip(written, pages.values(), strict=True):
        write_whole(path, page.encode())
    return written


def facts(report: Mapping[str, Any]) -> tuple[tuple[str, Value], ...]:
    """Seed, machine, versions, protocol and settings, by dotted name."""
    named = {
        key: report[key] for key in ("agents", "seed", "machine", "versions", "protocol", "settings") if key in report
    }
    return tuple(flat(named).items())


def _caption(stem: str, figure: Figure) -> str:
    titles = [figure.get_suptitle(), *(ax.get_title() for ax in figure.axes)]
    return next((title for title in titles if title), stem.replace("_", " "))
