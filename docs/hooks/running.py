"""Runs the code of the pages, and shows after each block what it prints and draws.

The ```python blocks of a page run one after another in one namespace, in a folder of their own; so do the ```console
blocks, whose lines are `$ cogmap …`. A block that fails ends the build. A comment `<!-- text -->` right after a block
is the caption of its pictures. A page that draws is run again with the style `dark.mplstyle`: so it has each picture
for both themes.
"""

from __future__ import annotations

import contextlib
import io
import os
import posixpath
import re
import shlex
import subprocess
import sys
import tempfile
import traceback
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

from mkdocs.exceptions import PluginError

BLOCK = re.compile(r"^```(python|console)\n(.*?)^```\n(?:<!-- (.*?) -->\n)?", re.M | re.S)
PICTURES = (".png", ".gif", ".svg", ".html")
"""What is shown on the page; of an HTML file, a link to it."""
COMMAND = "from cogmap.experiments.cli import main; main()"
SEEN = {"MPLBACKEND": "Agg", "NO_COLOR": "1", "TERM": "dumb", "COLUMNS": "88", "PYTHONWARNINGS": "error"}
"""Environment of everything that runs."""
DARK = Path(__file__).with_name("dark.mplstyle")
"""Colours of Matplotlib for the dark theme of the site."""

os.environ["MPLBACKEND"] = "Agg"


@dataclass(frozen=True, slots=True)
class Outcome:
    """What a block of code left behind: text that it printed, pictures by file name."""

    text: str
    pictures: dict[str, bytes] = field(default_factory=dict[str, bytes])


def with_outcomes(markdown: str, uri: str) -> tuple[str, dict[str, bytes]]:
    """The page with what its blocks print and draw after them; all pictures by file name."""
    blocks = tuple((found[1], found[2]) for found in BLOCK.finditer(markdown))
    outcomes = run_page(uri, blocks)
    if any(outcome.pictures for outcome in outcomes):
        twins = run_page(uri, blocks, dark=True)
        outcomes = [in_both_themes(*pair) for pair in zip(outcomes, twins, strict=True)]
    rest = iter(outcomes)

    def shown(found: re.Match[str]) -> str:
        outcome = next(rest)
        kind, code = ("sh", re.sub(r"^\$ ", "", found[2], flags=re.M)) if found[1] == "console" else found.group(1, 2)
        lines = [f"```{kind}\n{code}```", ""]
        if outcome.text.strip():
            lines += [f"``` {{ .text .output }}\n{outcome.text.rstrip()}\n```", ""]
        return "\n".join([*lines, *shown_pictures(outcome.pictures, found[3] or "", uri)]) + "\n"

    return BLOCK.sub(shown, markdown), {name: data for each in outcomes for name, data in each.pictures.items()}


@cache  # a page that is served again runs again only where its code has changed
def run_page(uri: str, blocks: tuple[tuple[str, str], ...], *, dark: bool = False) -> list[Outcome]:
    """Run the blocks of one page in order; `dark` draws them for the dark theme.

    Raises:
        PluginError: one of them failed, or drew over the picture of one before.
    """
    outcomes: list[Outcome] = []
    namespace: dict[str, Any] = {"__name__": "__main__"}
    with tempfile.TemporaryDirectory() as name, contextlib.chdir(name), drawn(dark=dark):
        folder = Path(name)
        for kind, code in blocks:
            before = stamps(folder)
            text = run_commands(uri, code, dark=dark) if kind == "console" else run_python(uri, code, namespace)
            outcomes.append(Outcome(text, new_pictures(folder, before)))
            if twice := [name for name in outcomes[-1].pictures if name in before]:
                raise PluginError(f"{uri}: {twice[0]} is drawn twice; give each picture of a page its own name")
    return outcomes


@cache
def run_script(path: Path, *, dark: bool = False) -> Outcome:
    """Run a script in an empty folder; `dark` draws for the dark theme.

    Raises:
        PluginError: it failed.
    """
    with tempfile.TemporaryDirectory() as folder:
        text = _run([sys.executable, str(path)], str(path), folder=folder, dark=dark)
        return Outcome(text, new_pictures(Path(folder), {}))


def run_scripts(paths: list[Path]) -> list[Outcome]:
    """Run scripts, two at a time, and those that draw a second time for the dark theme."""
    with ThreadPoolExecutor(2) as pool:
        light = list(pool.map(run_script, paths))
        dark = pool.map(lambda path, one: run_script(path, dark=True) if one.pictures else one, paths, light)
        return [in_both_themes(*pair) for pair in zip(light, dark, strict=True)]


def run_python(uri: str, code: str, namespace: dict[str, Any]) -> str:
    """Run a block in the namespace, and give back what it printed.

    Raises:
        PluginError: it failed.
    """
    printed = io.StringIO()
    try:
        with contextlib.redirect_stdout(printed):
            exec(compile(code, uri, "exec"), namespace)
    except Exception as error:
        raise PluginError(f"{uri}: its code fails:\n{code}\n{traceback.format_exc()}") from error
    return printed.getvalue()


def run_commands(uri: str, block: str, *, dark: bool = False) -> str:
    """Run the lines `$ cogmap …`, and give back what they printed.

    Raises:
        PluginError: one is no such line, or failed.
    """
    if wrong := [line for line in block.splitlines() if not line.startswith("$ cogmap ")]:
        raise PluginError(f"{uri}: {wrong[0]!r}: a console block has lines `$ cogmap …` only")
    arguments = [shlex.split(line)[2:] for line in block.splitlines()]
    lines = (_run([sys.executable, "-c", COMMAND, *given], f"{uri}: {given}", dark=dark) for given in arguments)
    return "\n".join(lines)


def shown_pictures(pictures: dict[str, bytes], caption: str, uri: str) -> list[str]:
    """Lines of Markdown that show the pictures on page `uri`."""
    lines: list[str] = []
    for name in pictures:
        if ".dark." in name:
            continue
        link = posixpath.relpath(picture_place(name, uri), posixpath.dirname(uri) or ".")
        if name.endswith(".html"):
            lines += [f"[Open {name}]({link})", ""]
            continue
        lines += ['<figure markdown="span">']
        lines += images(caption or name, link, both=twin(name) in pictures)
        lines += [f"<figcaption>{caption}</figcaption>"] if caption else []
        lines += ["</figure>", ""]
    return lines


def picture_place(name: str, uri: str) -> str:
    """Where the site has a picture that was drawn for page `uri`."""
    return f"drawn/{uri.removesuffix('.md')}/{name}"


def images(text: str, link: str, *, both: bool) -> list[str]:
    """Lines of Markdown for a picture: in `both` themes, each reader sees the one of the theme that is on."""
    if not both:
        return [f"![{text}]({link}){{ loading=lazy }}"]
    themes = {"light": link, "dark": twin(link)}
    return [f"![{text}]({where}#only-{theme}){{ loading=lazy }}" for theme, where in themes.items()]


def twin(name: str) -> str:
    """What the dark picture beside a picture is called."""
    stem, kind = posixpath.splitext(name)
    return f"{stem}.dark{kind}"


def in_both_themes(light: Outcome, dark: Outcome) -> Outcome:
    """What the run for the light theme left, and the pictures of the run for the dark theme that differ from these."""
    other = {
        twin(name): data
        for name, data in dark.pictures.items()
        if not name.endswith(".html") and data != light.pictures[name]
    }
    return Outcome(light.text, {**light.pictures, **other})


@contextlib.contextmanager
def drawn(*, dark: bool) -> Iterator[None]:
    """What this process draws meanwhile is drawn for the dark theme, where `dark`."""
    if not dark:
        yield
        return
    from matplotlib import style

    with style.context(DARK):
        yield


def stamps(folder: Path) -> dict[str, int]:
    """When each picture in the folder was written."""
    found = (path for path in sorted(folder.iterdir()) if path.suffix in PICTURES)
    return {path.name: path.stat().st_mtime_ns for path in found}


def new_pictures(folder: Path, before: dict[str, int]) -> dict[str, bytes]:
    """The pictures written since then."""
    return {name: (folder / name).read_bytes() for name, time in stamps(folder).items() if before.get(name) != time}


def _run(command: list[str], what: str, *, folder: str | None = None, dark: bool = False) -> str:
    environment = {**os.environ, **SEEN, **({"MATPLOTLIBRC": str(DARK)} if dark else {})}
    done = subprocess.run(
        command, cwd=folder, env=environment, capture_output=True, text=True, stdin=subprocess.DEVNULL
    )
    if done.returncode:
        raise PluginError(f"{what} fails (exit code {done.returncode}):\n{done.stdout}{done.stderr}")
    return done.stdout
