"""One reference page a package, from the docstrings.

A page has what the package lists in `__all__`, and after that whatever else the documents name as `cogmap.…`. Such
names in running text become links.
"""

from __future__ import annotations

import importlib
import pydoc
import re
import tomllib
from collections.abc import Iterable
from functools import cached_property
from pathlib import Path

ROOT = Path(__file__).parents[2]
PACKAGES = (
    "worlds",
    "model",
    "inference",
    "planning",
    "body",
    "agent",
    "views",
    "baselines",
    "behaviour",
    "experiments",
)
NAME = re.compile(r"(?<!\[)`(cogmap(?:\.\w+){2,})`(?!\])")


def linked_packages(folder: Path) -> str:
    """A package `cogmap` in `folder` that holds links to the folders of the repository.

    mkdocstrings reads sources, and looks for them by folder: it does not know what setuptools has mapped where.
    """
    house = folder / "cogmap"
    if not house.exists():
        house.mkdir()
        (house / "__init__.py").write_text('"""Agents that build their own map."""\n')
        setup = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["tool"]["setuptools"]
        for name, place in setup["package-dir"].items():
            if name.count(".") == 1:
                (house / name.removeprefix("cogmap.")).symlink_to(ROOT / place, target_is_directory=True)
    return str(folder)


def uris() -> list[dict[str, str]]:
    """The pages, for the navigation."""
    return [{f"cogmap.{package}": f"reference/{package}.md"} for package in PACKAGES]


def pages(texts: Iterable[str]) -> dict[str, str]:
    """Markdown of each page; `texts` are those of all other documents."""
    named = sorted({name for text in texts for name in NAME.findall(text)})
    return {f"reference/{package}.md": reference_page(package, named) for package in PACKAGES}


def reference_page(package: str, named: Iterable[str]) -> str:
    """Markdown of the page of one package."""
    module = importlib.import_module(f"cogmap.{package}")
    public = sorted((f"cogmap.{package}.{name}" for name in module.__all__), key=_rank)
    lines = [f"# cogmap.{package}", "", str(module.__doc__), ""]
    lines += [line for name in public for line in _entry(name, 2)]
    owners = {owner(name) for name in named if name.startswith(f"cogmap.{package}.")}
    further = sorted(name for name in owners if name not in public)
    if further:
        lines += ["## Further parts", "", "Not public, but named in the documents.", ""]
        lines += [line for name in further for line in _entry(name, 3)]
    return "\n".join(lines) + "\n"


def owner(name: str) -> str:
    """The class, function or value at the top of its module that has to be shown for `name` to be found."""
    parts = name.split(".")
    for length in range(len(parts) - 1, 1, -1):
        try:
            importlib.import_module(".".join(parts[:length]))
        except ModuleNotFoundError:
            continue
        return ".".join(parts[: length + 1])
    raise LookupError(f"the documents name `{name}`, which is not there")


def with_links(markdown: str) -> str:
    """The names of this library become links to the reference, but for those in code blocks."""
    parts = re.split(r"(^ *```.*?^ *```$)", markdown, flags=re.M | re.S)
    parts[::2] = [NAME.sub(lambda found: f"[`{found[1]}`][{shown(found[1])}]", text) for text in parts[::2]]
    return "".join(parts)


def shown(name: str) -> str:
    """What the reference has an entry for: `name`, or its class, whose docstring tells of its fields."""
    found = pydoc.locate(name)
    is_field = pydoc.locate(name.rpartition(".")[0]).__class__ is type and not callable(found)
    documented = isinstance(found, property | cached_property) and found.__doc__
    return name.rpartition(".")[0] if is_field and not documented else at_home(name)


def _rank(name: str) -> tuple[int, str]:
    """Classes first, then functions, then values."""
    found = pydoc.locate(name)
    return (0 if isinstance(found, type) else 1 if callable(found) else 2), name


def _entry(name: str, level: int) -> list[str]:
    value, last = pydoc.locate(name), name.rpartition(".")[2]
    if isinstance(value, int | str):  # several are set in one line, which is more than mkdocstrings can read
        return [f"{'#' * level} {last} {{ #{name} }}", "", f"```python\n{last} = {value!r}\n```", ""]
    options = ["    options:", f"      heading_level: {level}"]
    if level > 2:
        options.append("      show_root_full_path: true")
    return [f"::: {at_home(name)}", *options, ""]


def at_home(name: str) -> str:
    """Where a function really is, if that is a module of the same name: mkdocstrings would take it for the module."""
    package, _, last = name.rpartition(".")
    home = getattr(getattr(pydoc.locate(package), last, None), "__module__", "")
    return f"{home}.{last}" if home.endswith(f".{last}") else name
