"""Comparing results with golden cases."""

from collections.abc import Mapping
from typing import Any

import pytest

from analysis.statistics.result import TestResult


def holds(case: Mapping[str, Any], found: Mapping[str, Any]) -> None:
    """Compare numbers with the case's, within its tolerance; a failure tells the source."""
    for name, value in found.items():
        expected = case["expected"][name]
        wanted = (
            expected
            if expected is None or isinstance(expected, str)
            else pytest.approx(expected, rel=1e-9, abs=case["tol"])
        )
        assert value == wanted, f"{name} of {case['id']}: {case['source']}"


def closely(case: Mapping[str, Any]) -> Mapping[str, Any]:
    """The case without its absolute tolerance, which says nothing of variances and small p's."""
    return {**case, "tol": 0}


def defined(result: TestResult) -> Any:
    """The result, whose estimate, interval and test are all there."""
    assert None not in (result.estimate, result.low, result.high, result.statistic, result.p)
    return result
