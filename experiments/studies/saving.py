"""What a study leaves in its folder: JSON, tables as CSV, figures, and a report as Markdown and HTML."""

import os
import platform
import re
from base64 import b64encode
from collections.abc import Mapping
from importlib.metadata import version
from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader

from ...model import write_whole
from .. import write_json, write_picture
from .study import AnyStudy, Findings
from .tables import Table, Value, flat, plain, tables_of

PICTURES = (".png", ".svg")
PACKAGES = ("cogmap", "numpy", "scipy", "gtsam")
FACTS = ("agents", "seed", "machine", "versions", "protocol", "settings")  # of the JSON, to run a study again
CPUINFO = Path("/proc/cpuinfo")
LARGEST = 1_000_000  # bytes of a drawing (SVG) above which a page holds the picture (PNG) instead


def write_study(folder: Path, study: AnyStudy, found: Findings, head: Mapping[str, Any]) -> list[Path]:
    """Write everything into a folder that is there; answers with the files, the JSON first and the report last.

    `head`, what it takes to run the study again, stands before what was found. Where a file cannot be written
    (CogmapError) those before it are whole.
    """
    json, (title, question), figures = plain(found.json), study.asks, list[tuple[str, str]]()
    tables, written = found.tables, [folder / f"{study.name}.json"]
    write_json(written[0], {**head, **json})
    tables = tables_of(study.name, json) if tables is None else tables
    written += [write_whole(folder / f"{table.name}.csv", table.csv().encode()) for table in tables]
    for stem, draw in found.figures.items():
        figure = draw()
        titles = [figure.get_suptitle(), *(ax.get_title() for ax in figure.axes), stem.replace("_", " ")]
        figures.append((stem, next(filter(None, titles))))
        for suffix in PICTURES:
            written.append(folder / f"{stem}{suffix}")
            write_picture(written[-1], figure)
    parts = {"tables": tables, "figures": figures, "failed": found.failed, "notes": study.notes}
    parts |= {"lines": found.lines if found.tables is None else (), "question": question}
    return written + write_report(folder / study.name, f"{title} (study {study.name})", {**head, **json}, **parts)


def write_report(stem: Path, title: str, values: Mapping[str, Any], **parts: Any) -> list[Path]:
    """Write a report as Markdown, and with its pictures inside as HTML; answers with the files.

    Of `values` it shows `command` and those of `FACTS` that are there; its other parts are those of `report.jinja`.
    """
    how: dict[str, Any] = {"trim_blocks": True, "lstrip_blocks": True, "keep_trailing_newline": True}
    templates = Environment(loader=FileSystemLoader(Path(__file__).parent), **how)
    templates.filters |= {"md": escape, "cell": lambda value: escape(shown(value))}
    facts = flat({name: values[name] for name in FACTS if name in values})
    parts |= {"command": values["command"], "facts": Table("", ("what", "value"), list(facts.items()))}
    text = templates.get_template("report.jinja").render(title=title, **parts)
    page = templates.get_template("page.html").render(title=title, body=html_of(text, stem.parent))
    texts = {".md": text, ".html": page}
    return [write_whole(stem.with_name(stem.name + suffix), text.encode()) for suffix, text in texts.items()]


def html_of(text: str, folder: Path) -> str:
    """Markdown (CommonMark with tables) as HTML, with the pictures inside that it links, from `folder`.

    HTML in it is shown, not obeyed; a picture that is not there is left a link.
    """
    from markdown_it import MarkdownIt

    reader = MarkdownIt("commonmark", {"html": False}).enable("table")
    tokens = reader.parse(text)
    for token in [part for parent in tokens for part in (parent, *(parent.children or ()))]:
        if token.type == "image":
            token.attrs["src"] = _inside(folder, str(token.attrs["src"]))
        elif token.type == "link_open":  # a page leads to pages
            token.attrs["href"] = re.sub(r"\.md$", ".html", str(token.attrs["href"]))
    body = str(reader.renderer.render(tokens, reader.options, {}))
    return body.replace("<table>", '<div class="wide"><table>').replace("</table>", "</table></div>")


def escape(text: str) -> str:
    """Text that Markdown shows as it is, on one line."""
    text = re.sub(r"[\\`*<&|]|(?<!\w)_|_(?!\w)", lambda sign: f"\\{sign[0]}", text)
    return " ".join(text.replace("](", "]\\(").split())


def shown(value: Value) -> str:
    """A value for people: yes and no, a dash for none, four digits of what is no whole number."""
    if value is None or isinstance(value, bool):
        return {None: "–", True: "yes", False: "no"}[value]
    if isinstance(value, float):
        return f"{value:.4g}" if abs(value) < 1000.0 else f"{value:.0f}"
    return str(value)


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


def _inside(folder: Path, name: str) -> str:
    """The picture as a data URI, drawn if the drawing beside it is not too large."""
    picture = folder / name
    drawing = picture.with_suffix(".svg")
    if drawing.is_file() and drawing.stat().st_size <= LARGEST:
        picture = drawing
    kind = "svg+xml" if picture.suffix == ".svg" else "png"
    return f"data:image/{kind};base64,{b64encode(picture.read_bytes()).decode()}" if picture.is_file() else name
