from __future__ import annotations

import ast
import importlib
import importlib.util
import json
import re
import shlex
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import pytest
from cogmap.experiments.cli import app
from typer.main import get_command

ROOT = Path(__file__).parent.parent
DOCS = ROOT / "docs"
PAGES = sorted(path for path in DOCS.rglob("*.md"))
MODEL = (DOCS / "model.md").read_text("utf-8")


def hook(name: str) -> ModuleType:
    pytest.importorskip("mkdocs")
    spec = importlib.util.spec_from_file_location(f"docs_{name}", DOCS / "hooks" / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # its dataclasses look there
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def running() -> ModuleType:
    return hook("running")


@pytest.fixture(scope="module")
def reference() -> ModuleType:
    return hook("reference")


@pytest.fixture(scope="module")
def repository() -> ModuleType:
    return hook("repository")


def test_what_stands_beside_a_field_is_in_the_reference() -> None:
    pytest.importorskip("griffe")
    source = """
    @dataclass
    class Record:
        first: int  # one thing
        # another, which is
        # longer to tell
        second: float = 0
        third: str
    """
    told = hook("docstrings").fields_told(source)
    assert told == {"first": "one thing", "second": "another, which is longer to tell"}


def uris(nav: list[object]) -> Iterator[str]:
    for item in nav:
        for page in item.values() if isinstance(item, dict) else [item]:
            yield from uris(page) if isinstance(page, list) else [str(page)]


def test_every_page_is_in_the_navigation(repository: ModuleType) -> None:
    yaml = pytest.importorskip("yaml")
    nav = yaml.safe_load((ROOT / "mkdocs.yml").read_text("utf-8"))["nav"]
    listed = {*uris(nav), *repository.decision_uris()}
    assert {str(page.relative_to(DOCS)) for page in PAGES} <= listed
    made = [*repository.example_uris(), *repository.decision_uris(), *repository.project_uris()]
    assert all((DOCS / uri).exists() for uri in uris(nav))
    assert len(made) == len({str(uri) for uri in made})


def test_every_equation_has_a_function() -> None:
    rows = re.findall(r"^\| (\[?\d.*?) \|.*\| (.*) \|$", MODEL, re.M)
    equations = {int(number) for number, _ in rows for number in re.findall(r"\b\d+\b", number.partition(", line")[0])}
    assert {*range(1, 11), 11, 12, 13} <= equations
    assert all("`cogmap." in function or "the same" in function or "term" in function for _, function in rows)


def test_anchors_that_are_linked_exist() -> None:
    headings = {page: anchors(page.read_text("utf-8")) for page in PAGES}
    for page in PAGES:
        for link, anchor in re.findall(r"\]\(([^):\s]*)#([^)\s]+)\)", page.read_text("utf-8")):
            target = (page.parent / link).resolve() if link else page
            assert anchor in headings.get(target, {anchor}), f"{page.name}: {link}#{anchor}"


def anchors(text: str) -> set[str]:
    text = re.sub(r"^```.*?^```", "", text, flags=re.M | re.S)
    words = (re.sub(r"[^\w\s-]", "", heading.lower()) for heading in re.findall(r"^#+ (.*)$", text, re.M))
    return {re.sub(r"[\s-]+", "-", heading.strip()) for heading in words} | set(re.findall(r'<a id="(.*?)"', text))


def test_every_command_of_the_documents_exists() -> None:
    commands = get_command(app).commands  # type: ignore[attr-defined]
    lines = [line for page in PAGES for line in re.findall(r"^(?:\$ |    )?(cogmap \w+ .*)$", page.read_text(), re.M)]
    assert len(lines) > 10
    for line in lines:
        _, name, *rest = shlex.split(line)
        known = {option for parameter in commands[name].params for option in parameter.opts}
        assert {word for word in rest if word.startswith("--")} <= known, line


def test_what_the_documents_import_is_public() -> None:
    pages = [ROOT / "README.md", *PAGES]
    blocks = [block for page in pages for block in re.findall(r"^```python\n(.*?)^```", page.read_text(), re.M | re.S)]
    blocks += [path.read_text("utf-8") for path in sorted((ROOT / "examples").glob("*.py"))]
    cells = [cell for path in (ROOT / "examples").glob("*.ipynb") for cell in json.loads(path.read_text())["cells"]]
    blocks += ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"]
    found = [node for block in blocks for node in ast.walk(ast.parse(block)) if isinstance(node, ast.ImportFrom)]
    ours = [node for node in found if str(node.module).split(".")[0] == "cogmap"]
    assert len(ours) > 50
    for node in ours:
        public = importlib.import_module(str(node.module)).__all__
        assert {alias.name for alias in node.names} <= set(public), f"from {node.module} import …"


def test_links_of_the_repository_become_links_of_the_site(repository: ModuleType) -> None:
    turned = repository.with_site_links
    assert turned("[a](../README.md) [b](model.md#eq-3)", "sharp_bits.md") == "[a](index.md) [b](model.md#eq-3)"
    assert turned("[a](../../examples/own_maze.py)", "howto/own_maze.md") == "[a](../examples/own_maze.md)"
    assert turned("[a](docs/model.md)", "contributing.md") == "[a](model.md)"
    assert (
        turned("![a](pictures/x.png) [b](https://x.org/a)", "index.md") == "![a](pictures/x.png) [b](https://x.org/a)"
    )


def test_names_become_links_but_not_in_code(reference: ModuleType) -> None:
    text = "see `cogmap.agent.Agent`\n\n```python\n# `cogmap.agent.Agent`\n```\n"
    linked = reference.with_links(text)
    assert linked.startswith("see [`cogmap.agent.Agent`][cogmap.agent.Agent]\n")
    assert linked.endswith("# `cogmap.agent.Agent`\n```\n")


def test_reference_has_all_that_is_public(reference: ModuleType, tmp_path: Path) -> None:
    import cogmap.planning

    page = reference.reference_page("planning", ["cogmap.planning.reference.predicted_places"])
    for name in cogmap.planning.__all__:
        number = isinstance(getattr(cogmap.planning, name), int)
        assert (
            f"#cogmap.planning.{name}" if number else f"::: {reference.at_home(f'cogmap.planning.{name}')}\n"
        ) in page
    assert reference.at_home("cogmap.views.explain") == "cogmap.views.explain.explain"
    assert page.index("Further parts") < page.index("::: cogmap.planning.reference.predicted_places")
    assert reference.owner("cogmap.agent.mapper.Mapper.learn") == "cogmap.agent.mapper.Mapper"
    house = Path(reference.linked_packages(tmp_path)) / "cogmap"
    assert sorted(path.name for path in house.iterdir() if path.is_dir()) == sorted(reference.PACKAGES)


def test_blocks_run_one_after_another_and_show_what_they_do(running: ModuleType) -> None:
    page = "```python\nx = 6\n```\n\n```python\nprint(7 * x)\nopen('a.png', 'wb').close()\n```\n<!-- Seven. -->\nend\n"
    text, pictures = running.with_outcomes(page, "howto/x.md")
    assert "``` { .text .output }\n42\n```" in text
    assert "![Seven.](../drawn/howto/x/a.png)" in text
    assert "<!--" not in text
    assert pictures == {"a.png": b""}
    assert text.endswith("end\n")


def test_pictures_are_drawn_for_both_themes(running: ModuleType) -> None:
    draw = (
        "from matplotlib.figure import Figure\n"
        "figure = Figure(figsize=(1, 1))\nfigure.subplots().plot([1, 2])\nfigure.savefig('a.png')\n"
    )
    text, pictures = running.with_outcomes(f"```python\n{draw}```\n", "howto/x.md")
    assert "(../drawn/howto/x/a.png#only-light)" in text
    assert "(../drawn/howto/x/a.dark.png#only-dark)" in text
    assert sorted(pictures) == ["a.dark.png", "a.png"]
    assert pictures["a.png"] != pictures["a.dark.png"]


def test_commands_run(running: ModuleType) -> None:
    text, _ = running.with_outcomes("```console\n$ cogmap --version\n```\n", "x.md")
    assert text.startswith("```sh\ncogmap --version\n```")
    assert re.search(r"^cogmap \d", text, re.M)


@pytest.mark.parametrize(
    ("page", "words"),
    [
        ("```python\n1 / 0\n```\n", "division by zero"),
        ("```console\n$ cogmap explore nowhere\n```\n", "exit code 2"),
        ("```console\n$ rm -r x\n```\n", r"lines `\$ cogmap …` only"),
        ("```python\nopen('a.png', 'w').close()\n```\n\n```python\nopen('a.png', 'w').close()\n```\n", "drawn twice"),
    ],
)
def test_a_block_that_fails_ends_the_build(running: ModuleType, page: str, words: str) -> None:
    from mkdocs.exceptions import PluginError

    with pytest.raises(PluginError, match=words):
        running.with_outcomes(page, "x.md")
