"""Options of the test suite."""

from __future__ import annotations

import pytest


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--study", action="store_true", help="run the behavioural studies at full size")


@pytest.fixture(scope="session")
def study(request: pytest.FixtureRequest) -> bool:
    """Whether studies run at full size."""
    return bool(request.config.getoption("--study"))
