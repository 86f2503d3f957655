"""Files of the repository outside `docs/` as pages, and links that work on both sides.

In the documents links are those of the repository, so that they work when files are read as they are. Here they are
turned into links of the site.
"""

from __future__ import annotations

import ast
import posixpath
import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
EXAMPLES = sorted((ROOT / "examples").glob("*.py"))
NOTEBOOKS = sorted((ROOT / "examples").glob("*.ipynb"))
PAGES = {
    "README.md": "index.md",
    "CHANGELOG.md": "changelog.md",
    "CONTRIBUTING.md": "contributing.md",
    "SECURITY.md": "security.md",
    "RELEASING.md": "releasing.md",
    "LICENSE": "licence.md",
    "benchmarks/README.md": "benchmarks.md",
    "examples/README.md": "examples/index.md",
    **{f"examples/{path.name}": f"examples/{path.stem}.md" for path in [*EXAMPLES, *NOTEBOOKS]},
}
"""Where the site has what the repository has outside `docs/`."""

LINK = re.compile(r"\]\((?!https?://|#)([^)\s#]+)(#[^)\s]*)?\)")


def example_uris() -> list[str]:
    """The pages of the examples, in the order of `examples/README.md`; those that it forgot come last."""
    listed = re.findall(r"\((\w+)\.(?:py|ipynb)\)", (ROOT / "examples" / "README.md").read_text("utf-8"))
    names = dict.fromkeys([*listed, *(path.stem for path in [*EXAMPLES, *NOTEBOOKS])])
    return ["examples/index.md", *(f"examples/{name}.md" for name in names)]


def decision_uris() -> list[str]:
    """The pages of the decisions, in order."""
    return ["decisions/index.md", *(f"decisions/{path.name}" for path in decisions())]


def project_uris() -> list[str | dict[str, str]]:
    """The other pages made from files of the repository."""
    return [
        "benchmarks.md",
        "contributing.md",
        "security.md",
        "releasing.md",
        "changelog.md",
        {"Licence": "licence.md"},
    ]


def pages() -> dict[str, str]:
    """Markdown of all of them but the examples, which are run first."""
    made = {uri: (ROOT / path).read_text("utf-8") for path, uri in PAGES.items() if path.endswith(".md")}
    del made["index.md"]  # the site has a start page of its own
    made["licence.md"] = f"# Licence\n\n```text\n{(ROOT / 'LICENSE').read_text('utf-8')}```\n"
    return {**made, "decisions/index.md": decisions_page()}


def decisions() -> list[Path]:
    """Their files, in order."""
    return sorted((ROOT / "docs" / "decisions").glob("0*.md"))


def decisions_page() -> str:
    """All decisions, a line each."""
    lines = ["# Decisions", "", "One short file each; they are added to, never rewritten.", ""]
    for path in decisions():
        number, title = path.read_text("utf-8").splitlines()[0].removeprefix("# ").split(". ", 1)
        lines.append(f"{number}. [{title}]({path.name})")
    return "\n".join(lines) + "\n"


def example_page(path: Path, printed: str, pictures: list[str]) -> str:
    """The docstring, what the script prints and draws, and the script without its docstring."""
    code = path.read_text("utf-8")
    tree = ast.parse(code)
    title, _, rest = (ast.get_docstring(tree) or path.stem).partition("\n")
    body = "\n".join(code.splitlines()[tree.body[0].end_lineno :]).strip()
    lines = [f"# {title.rstrip('.')}", "", rest.strip(), "", f"```python\n{body}\n```", ""]
    lines += [f"`python examples/{path.name}` prints", "", f"``` {{ .text .output }}\n{printed.rstrip()}\n```", ""]
    return "\n".join([*lines, *pictures])


def with_site_links(markdown: str, uri: str) -> str:
    """Markdown of the page `uri`, its links turned into those of the site."""
    source = next((path for path, known in PAGES.items() if known == uri and uri != "index.md"), f"docs/{uri}")
    return LINK.sub(lambda found: f"]({site_link(found[1], source, uri)}{found[2] or ''})", markdown)


def site_link(link: str, source: str, uri: str) -> str:
    """The link that leads from page `uri` to where `link` leads from file `source` of the repository."""
    target = posixpath.normpath(posixpath.join(posixpath.dirname(source), link))
    known = PAGES.get(target) or (target.removeprefix("docs/") if target.startswith("docs/") else None)
    return link if known is None else posixpath.relpath(known, posixpath.dirname(uri) or ".")
