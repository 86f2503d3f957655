"""What a study leaves in its folder: JSON, tables as CSV, figures, and a report as Markdown and HTML."""

from __future__ import annotations

import os
import platform
import tempfile
from collections.abc import Mapping, Sequence
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...model import CogmapError
from ...model.files import write_whole
from .. import check_outputs, write_json, write_picture
from .report import Report, html_page
from .study import AnyStudy, Findings
from .tables import Table, Value, flat, plain, tables_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PICTURES = (".png", ".svg")
REPORTS = (".json", ".md", ".html")
PACKAGES = ("cogmap", "numpy", "scipy", "gtsam")
FACTS = ("agents", "seed", "machine", "versions", "protocol", "settings")
"""What of the JSON the report shows under how to run it again."""


def check_folder(folder: Path, study: str) -> None:
    """Refuse, before anything is computed, a folder in which a study could not be written; make nothing.

    Raises:
        CogmapError: it is a file, or not writable, or cannot be made.
    """
    if folder.is_dir():
        check_outputs([folder / f"{study}{suffix}" for suffix in REPORTS])
        return
    target = above = Path(os.path.realpath(folder))
    while not (above.exists() or above == above.parent):
        above = above.parent
    if not above.is_dir():
        raise CogmapError(f"cannot make folder {folder}: {above} is a file; choose another folder")
    try:
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


def write_study(folder: Path, study: AnyStudy, found: Findings, head: Mapping[str, Any]) -> list[Path]:
    """Write everything into a folder that is there; answers with the files, the JSON first and the report last.

    Args:
        folder: where.
        study: which it was.
        found: what came of it.
        head: what it takes to run it again, plain JSON; stands before what was found.

    Raises:
        CogmapError: a file cannot be written; those before it are whole.
    """
    json = plain(found.json)
    write_json(folder / f"{study.name}.json", {**head, **json})
    tables = tables_of(study.name, json) if found.tables is None else found.tables
    written = [folder / f"{study.name}.json", *write_tables(folder, tables)]
    captions: list[tuple[str, str]] = []
    for stem, draw in found.figures.items():
        figure = draw()
        captions.append((f"{stem}.png", _caption(stem, figure)))
        for suffix in PICTURES:
            written.append(folder / f"{stem}{suffix}")
            write_picture(written[-1], figure)
    report = Report(
        title=f"{study.title} (study {study.name})",
        question=study.question,
        lines=found.lines if found.tables is None else (),
        figures=captions,
        tables=tables,
        failed=found.failed,
        notes=study.notes,
        command=head["command"],
        facts=facts({**head, **json}),
    )
    return written + write_report(folder / study.name, report)


def write_tables(folder: Path, tables: Sequence[Table]) -> list[Path]:
    """Write each table as CSV; answers with the files.

    Raises:
        CogmapError: a file cannot be written.
    """
    written = [folder / f"{table.name}.csv" for table in tables]
    for path, table in zip(written, tables, strict=True):
        write_whole(path, table.csv().encode())
    return written


def write_report(stem: Path, report: Report) -> list[Path]:
    """Write the report as Markdown, and with its pictures inside as HTML; answers with the files.

    Raises:
        CogmapError: a file cannot be written.
    """
    markdown = report.markdown()
    pages = {".md": markdown, ".html": html_page(markdown, stem.parent)}
    for suffix, page in pages.items():
        write_whole(stem.with_name(f"{stem.name}{suffix}"), page.encode())
    return [stem.with_name(f"{stem.name}{suffix}") for suffix in pages]


def facts(values: Mapping[str, Any]) -> list[tuple[str, Value]]:
    """Those of `FACTS` that are there, by dotted name."""
    return list(flat({name: values[name] for name in FACTS if name in values}).items())


def made_with() -> dict[str, Any]:
    """Versions of what computes, and the machine: what else a result may depend on."""
    packages = {name: version(name) for name in PACKAGES}
    return {
        "versions": {**packages, "python": platform.python_version(), "platform": platform.platform()},
        "machine": {
            "processor": processor(),
            "cores": os.cpu_count(),
            "system": f"{platform.system()} {platform.release()}",
            "OMP_NUM_THREADS": os.environ.get("OMP_NUM_THREADS"),
        },
    }


def processor(cpuinfo: Path = Path("/proc/cpuinfo")) -> str:
    """The model of the processor, as far as the system tells."""
    lines = cpuinfo.read_text(errors="replace").splitlines() if cpuinfo.is_file() else []
    models = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return next(iter(models), platform.processor() or platform.machine() or "unknown")


def _caption(stem: str, figure: Figure) -> str:
    titles = [figure.get_suptitle(), *(ax.get_title() for ax in figure.axes)]
    return next((title for title in titles if title), stem.replace("_", " "))
