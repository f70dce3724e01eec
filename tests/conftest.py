"""What holds for all tests: their order, and how hypothesis runs."""

import hypothesis
import pytest

# A busy machine is no failure.
hypothesis.settings.register_profile("untimed", deadline=None)
hypothesis.settings.load_profile("untimed")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Browser tests come last: Playwright leaves a running event loop in its process."""
    items.sort(key=lambda item: "browser" in item.path.parts)
