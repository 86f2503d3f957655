from __future__ import annotations

import re
import runpy
from pathlib import Path
from pydoc import locate

import pytest
from cogmap.experiments.cli import app
from cogmap.worlds import MAZES
from typer.main import get_command

ROOT = Path(__file__).parent.parent
README = (ROOT / "README.md").read_text("utf-8")
COMMANDS = [line for block in re.findall(r"^```sh\n(.*?)^```", README, re.M | re.S) for line in block.splitlines()]
INSTALLING = [line for line in COMMANDS if line.startswith("python3 -m venv .venv && ")]
PAGES = [ROOT / name for name in ("README.md", "CHANGELOG.md", "CONTRIBUTING.md")]
PAGES += sorted((ROOT / "docs").rglob("*.md")) + sorted((ROOT / "benchmarks").glob("*.md"))


def test_ci_runs_the_test_command_of_the_readme() -> None:
    commands = [line for line in (ROOT / ".ci" / "run").read_text().splitlines() if line and not line.startswith("#")]
    assert commands[:2] == ["set -euo pipefail", 'cd "$(dirname "$0")/.."']
    assert commands[2:] == [line for line in INSTALLING if "check.py" in line]
    assert len(INSTALLING) == 2


def test_an_example_is_there_to_be_run() -> None:
    code = runpy.run_path(str(ROOT / "check.py"))["python_examples"]()["README.md"]
    assert "Agent(" in code
    compile(code, "README.md", "exec")


def test_every_command_of_the_readme_exists() -> None:
    known: dict[str, set[str]] = {
        name: {option for parameter in command.params for option in parameter.opts}
        for name, command in get_command(app).commands.items()  # type: ignore[attr-defined]
    }
    asked = re.findall(r"\bcogmap (\w+)((?: [^\s`|&]+)*)", "\n".join(COMMANDS))
    assert {"explore"} <= {name for name, _ in asked}
    for name, rest in asked:
        assert set(re.findall(r"--[a-z-]+", rest)) <= known[name]


def test_the_table_has_every_maze() -> None:
    named = [name for name in re.findall(r"^\| `?(\w+)`? +\|", README, re.M) if name in MAZES]
    assert list(dict.fromkeys(named)) == list(MAZES)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_links_lead_somewhere(page: Path) -> None:
    for link in re.findall(r"\]\(([^)#]+)[^)]*\)", page.read_text("utf-8")):
        assert link.startswith("https://") or (page.parent / link).exists(), link


def test_names_in_the_documents_exist() -> None:
    names = {name for page in PAGES for name in re.findall(r"`(cogmap(?:\.\w+)+)`", page.read_text("utf-8"))}
    assert len(names) > 30
    assert not [name for name in sorted(names) if locate(name) is None]


def test_decisions_are_in_the_index_in_their_order() -> None:  # the site numbers a list as its items come
    index = (ROOT / "docs" / "index.md").read_text("utf-8")
    names = sorted(path.name for path in (ROOT / "docs" / "decisions").glob("*.md"))
    assert re.findall(r"\(decisions/([^)]+)\)", index) == names


def test_decisions_are_numbered_without_gaps() -> None:
    names = sorted(path.name for path in (ROOT / "docs" / "decisions").glob("*.md"))
    assert [name[:5] for name in names] == [f"{number:04}-" for number in range(1, len(names) + 1)]
