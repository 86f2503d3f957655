"""Every package of the library is declared, so that a wheel has it; `cogmap` itself says what most people need."""

from __future__ import annotations

import re
import runpy
import subprocess
import sys
import tomllib
from importlib.metadata import version
from pathlib import Path

import pytest

import cogmap
from cogmap import agent, worlds

ROOT = Path(__file__).resolve().parents[1]
HOUSE = ("worlds", "model", "inference", "planning", "body", "agent", "views", "baselines", "behaviour", "experiments")


def test_every_package_is_declared() -> None:
    declared = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["tool"]["setuptools"]
    folders = {file.parent.relative_to(ROOT).as_posix() for top in HOUSE for file in (ROOT / top).rglob("__init__.py")}
    mapped = {name: folder for name, folder in declared["package-dir"].items() if folder.split("/")[0] in HOUSE}
    assert set(mapped.values()) == folders
    assert mapped == {"cogmap." + folder.replace("/", "."): folder for folder in folders}
    assert set(mapped) <= set(declared["packages"])


def test_the_package_itself_has_what_most_people_need() -> None:
    assert cogmap.__version__ == version("cogmap")
    assert (cogmap.Agent, cogmap.Settings) == (agent.Agent, agent.Settings)
    assert cogmap.load_world is worlds.load_world
    assert set(cogmap.__all__) <= set(dir(cogmap))
    with pytest.raises(AttributeError, match="'Agnet'"):
        cogmap.Agnet  # noqa: B018


@pytest.mark.parametrize(
    ("module", "heavy"),
    [("cogmap", "numpy gymnasium gtsam"), ("cogmap.agent", "scipy networkx gymnasium pandas gtsam matplotlib ssl")],
)
def test_what_is_heavy_is_imported_where_it_is_used(module: str, heavy: str) -> None:
    code = f"import sys, {module}; print(*(name for name in {heavy.split()} if name in sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == ""


def test_every_dependency_has_a_floor_that_can_be_installed_alone() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    pinned = runpy.run_path(str(ROOT / "check.py"))["floors"](project)
    assert {"numpy==2.0", "gtsam==4.3"} <= set(pinned)
    names = {re.split(r"[=\[>]", requirement)[0] for requirement in project["dependencies"]}
    assert names <= {pin.partition("==")[0] for pin in pinned}


def test_the_page_of_the_index_leads_to_the_repository() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    home, page = project["urls"]["Repository"], runpy.run_path(str(ROOT / "setup.py"))["index_page"]
    text = page("![a](docs/x.png) [b](docs/y.md#z) [c](https://d.org) [e](#f)", home)
    assert text == f"![a]({home}/raw/main/docs/x.png) [b]({home}/blob/main/docs/y.md#z) [c](https://d.org) [e](#f)"
    links = re.findall(r"\]\(([^)]+)\)", page((ROOT / "README.md").read_text("utf-8"), home))
    assert links
    assert all(link.startswith(("https://", "#")) for link in links)


def test_what_says_the_version_says_the_same() -> None:
    number = version("cogmap")
    assert f"version: {number}" in (ROOT / "CITATION.cff").read_text("utf-8")
    for page in ("README.md", "docs/citing.md"):
        assert f"version = {{{number}}}" in re.sub(r" +", " ", (ROOT / page).read_text("utf-8"))


def test_pythons_are_those_that_are_tested() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    named = set(re.findall(r"Python :: (3\.\d+)", "\n".join(project["classifiers"])))
    workflow = (ROOT / ".github" / "workflows" / "tests.yml").read_text("utf-8")
    assert named == set(re.findall(r'"(3\.\d+)"', workflow))


WITHOUT = """
import sys
sys.modules.update(dict.fromkeys(("minigrid", "distributed", "dask", "pandas")))  # as if they were not installed
from cogmap.experiments.studies import studies
from cogmap.experiments.cli import main
assert "tolman" in studies()
sys.argv = ["cogmap", "study", "donut", "--runs", "1", "--out", sys.argv[1]]
main()
"""


def test_what_needs_no_extra_goes_without_any(tmp_path: Path) -> None:
    command = [sys.executable, "-c", WITHOUT, str(tmp_path / "donut")]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "donut" / "donut.json").is_file()
