"""The order of the tests."""

import pytest


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Browser tests come last: Playwright leaves a running event loop in its process."""
    items.sort(key=lambda item: "browser" in item.path.parts)
