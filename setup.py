"""The page of the package index: README.md with links that lead to the repository: the index has no other files."""

import re
import tomllib
from pathlib import Path

ROOT = Path(__file__).parent
HOME = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]["urls"]["Repository"]


def index_page(markdown: str, home: str) -> str:
    """The Markdown with links and pictures of the repository at `home`; those that lead elsewhere stay."""
    pictures = re.sub(r"!\[([^\]]*)\]\((?!https?:)([^)]+)\)", rf"![\1]({home}/raw/main/\2)", markdown)
    return re.sub(r"(?<!!)(\[[^\]]*\])\((?!https?:|#)([^)]+)\)", rf"\1({home}/blob/main/\2)", pictures)


if __name__ == "__main__":
    from setuptools import setup  # here, since a test reads this file where there is none

    page = index_page((ROOT / "README.md").read_text("utf-8"), HOME)
    setup(long_description=page, long_description_content_type="text/markdown")
