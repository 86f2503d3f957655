"""The MkDocs hook of this site: what each event of the build asks of the modules beside this one."""

from __future__ import annotations

import posixpath
import re
import tempfile
from pathlib import Path
from typing import Any

import equations
import notebooks
import reference
import repository
import running
from mkdocs.config.defaults import MkDocsConfig
from mkdocs.plugins import event_priority
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page

_folder = tempfile.TemporaryDirectory(prefix="cogmap-docs-")


@event_priority(100)  # before mkdocstrings reads its options
def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """Tell mkdocstrings where the packages are, and add the made pages to the navigation."""
    packages = reference.linked_packages(Path(_folder.name))
    config.plugins["mkdocstrings"].config["handlers"]["python"]["paths"] = [packages]
    made = {
        "Examples": repository.example_uris(),
        "Decisions": repository.decision_uris(),
        "Reference": reference.uris(),
        "Project": repository.project_uris(),
    }
    for section in config.nav or []:
        for name, pages in section.items():
            pages.extend(made.get(name, []))
    return config


def on_files(files: Files, *, config: MkDocsConfig) -> Files:
    """Add the pages made from the repository and from the docstrings."""
    texts = [file.content_string for file in files.documentation_pages()]
    for uri, text in [*repository.pages().items(), *reference.pages(texts).items()]:
        files.append(File.generated(config, uri, content=text))
    for path, outcome in zip(repository.EXAMPLES, running.run_scripts(repository.EXAMPLES), strict=True):
        uri = repository.PAGES[f"examples/{path.name}"]
        text = repository.example_page(path, outcome.text, running.shown_pictures(outcome.pictures, "", uri))
        files.append(File.generated(config, uri, content=text))
        _add_pictures(outcome.pictures, uri, files, config)
    for path in repository.NOTEBOOKS:
        uri, page = repository.PAGES[f"examples/{path.name}"], notebooks.notebook_page(path)
        files.append(File.generated(config, uri, content=page.markdown))
        files.append(File.generated(config, f"examples/{path.name}", content=path.read_bytes()))
        _add_pictures(page.pictures, uri, files, config)
    return files


def on_page_markdown(markdown: str, *, page: Page, config: MkDocsConfig, files: Files) -> str:
    """Mend the links, run the code, link the names."""
    uri = page.file.src_uri
    if uri.startswith("reference/"):
        return markdown
    markdown = with_dark_pictures(repository.with_site_links(markdown, uri))
    if not uri.startswith(("examples/", "decisions/")):
        markdown, pictures = running.with_outcomes(markdown, uri)
        _add_pictures(pictures, uri, files, config)
    return equations.with_equations(reference.with_links(markdown), uri)


def with_dark_pictures(markdown: str) -> str:
    """Each picture of `docs/pictures` that has a dark twin there, in the theme of the reader."""

    def both(found: re.Match[str]) -> str:
        there = (repository.ROOT / "docs" / "pictures" / running.twin(posixpath.basename(found[2]))).is_file()
        return "\n".join(running.images(found[1], found[2], both=there))

    return re.sub(r"!\[([^\]]*)\]\(([./]*pictures/[\w.]+)\)", both, markdown)


def _add_pictures(pictures: dict[str, bytes], uri: str, files: Files, config: Any) -> None:
    for name, content in pictures.items():
        place = running.picture_place(name, uri)
        if (known := files.get_file_from_path(place)) is not None:
            files.remove(known)
        files.append(File.generated(config, place, content=content))
