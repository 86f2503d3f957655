"""What a study leaves in its folder: JSON, tables as CSV, figures, and a report as Markdown and HTML."""

from __future__ import annotations

import os
import platform
from collections.abc import Mapping, Sequence
from importlib.metadata import version
from pathlib import Path
from typing import Any

from ...model import write_whole
from .. import write_json, write_picture
from .report import bullets, code, escape, html_page, markdown, table_markdown
from .study import AnyStudy, Findings
from .tables import Table, flat, plain, tables_of

PICTURES = (".png", ".svg")
CPUINFO = Path("/proc/cpuinfo")
PACKAGES = ("cogmap", "numpy", "scipy", "gtsam")
FACTS = ("agents", "seed", "machine", "versions", "protocol", "settings")  # of the JSON, to run a study again


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
    json, (title, question), pictures = plain(found.json), study.asks, list[str]()
    tables = tables_of(study.name, json) if found.tables is None else found.tables
    written = [folder / f"{study.name}.json"]
    write_json(written[0], {**head, **json})
    written += write_texts(folder, {f"{table.name}.csv": table.csv() for table in tables})
    for stem, draw in found.figures.items():
        figure = draw()
        titles = [figure.get_suptitle(), *(ax.get_title() for ax in figure.axes), stem.replace("_", " ")]
        pictures.append(f"![{escape(next(filter(None, titles)))}](<{stem}.png>)")
        for suffix in PICTURES:
            written.append(folder / f"{stem}{suffix}")
            write_picture(written[-1], figure)
    lines = [code(found.lines)] if found.tables is None else []
    sections = {
        "What came of it": [*lines, *pictures, *(table_markdown(table) for table in tables if table.shown)],
        "What failed": [bullets(found.failed or ["Nothing."])],
        "Notes": [bullets(study.notes)],
    }
    report = report_texts(f"{title} (study {study.name})", question, sections, {**head, **json}, tables, folder)
    return written + write_texts(folder, {f"{study.name}{suffix}": text for suffix, text in report.items()})


def report_texts(
    title: str,
    question: str,
    sections: Mapping[str, Sequence[str]],
    values: Mapping[str, Any],
    tables: Sequence[Table],
    folder: Path,
) -> dict[str, str]:
    """A report by suffix, Markdown and HTML; it ends with how to run it again, `values`, and its tables."""
    facts = flat({name: values[name] for name in FACTS if name in values})
    named = [f"- `{table.name}.csv`" + (f": {escape(table.caption)}" if table.caption else "") for table in tables]
    again = [code([values["command"]]), table_markdown(Table("", ("what", "value"), list(facts.items())))]
    text = markdown(title, question, {**sections, "Run it again": again, "Tables as CSV": ["\n".join(named)]})
    return {".md": text, ".html": html_page(text, folder)}


def write_texts(folder: Path, texts: Mapping[str, str]) -> list[Path]:
    """Write texts by the name of their file; answers with the files.

    Raises:
        CogmapError: a file cannot be written.
    """
    return [write_whole(folder / name, text.encode()) for name, text in texts.items()]


def made_with() -> dict[str, Any]:
    """Versions of what computes, and the machine: what else a result may depend on."""
    packages = {name: version(name) for name in PACKAGES}
    lines = CPUINFO.read_text(errors="replace").splitlines() if CPUINFO.is_file() else []
    models = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    processor = next(iter(models), platform.processor() or platform.machine() or "unknown")
    system = {"cores": os.cpu_count(), "system": f"{platform.system()} {platform.release()}"}
    return {
        "versions": {**packages, "python": platform.python_version(), "platform": platform.platform()},
        "machine": {"processor": processor, **system, "OMP_NUM_THREADS": os.environ.get("OMP_NUM_THREADS")},
    }
