import math
import operator

import pytest

from policies import ModelError
from policies.experiments.parallel import as_they_finish


@pytest.mark.parametrize("workers", [1, 2])
def test_every_unit_is_worked_once(workers):
    units = [(i, 10) for i in range(7)]
    assert sorted(as_they_finish(operator.add, units, workers)) == list(range(10, 17))


def test_no_units_give_no_results():
    assert list(as_they_finish(math.sqrt, [], 2)) == []


def test_what_fails_in_a_worker_is_raised():
    with pytest.raises(ValueError, match=r"math domain|nonnegative"):
        list(as_they_finish(math.sqrt, [(1,), (-1,)], 2))


def test_an_address_without_a_scheduler_is_one_clear_error():
    with pytest.raises(ModelError, match="expected a dask scheduler at nowhere, found none"):
        list(as_they_finish(math.sqrt, [(1,)], 1, "nowhere"))
