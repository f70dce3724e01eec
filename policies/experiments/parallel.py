"""Units of work on several cores of one machine, or of a dask cluster."""

from collections.abc import Callable, Iterable, Iterator
from contextlib import AbstractContextManager, ExitStack
from typing import Any, TypeVar

import joblib

from policies.errors import ModelError

Result = TypeVar("Result")


def as_they_finish(
    work: Callable[..., Result],
    units: Iterable[tuple[Any, ...]],
    workers: int,
    cluster: str | None = None,
) -> Iterator[Result]:
    """Results of work(*unit) in the order in which they finish.

    `workers` processes here, or all workers of the dask cluster whose scheduler's address is
    `cluster` (extra `cluster`); ModelError when there is none.
    """
    with ExitStack() as open_until_done:
        if cluster:
            open_until_done.enter_context(_connect(cluster))
            open_until_done.enter_context(joblib.parallel_config("dask"))
        parallel = joblib.Parallel(
            n_jobs=-1 if cluster else workers, return_as="generator_unordered", batch_size=1
        )
        yield from parallel(joblib.delayed(work)(*unit) for unit in units)


def _connect(cluster: str) -> AbstractContextManager[Any]:
    try:
        from distributed import Client
    except ImportError as error:
        raise ModelError(
            "expected dask for a cluster: install goalguess with its extra `cluster`"
        ) from error
    try:
        connect: Callable[..., AbstractContextManager[Any]] = Client
        return connect(cluster, timeout="10s")
    except (OSError, ValueError) as error:
        raise ModelError(f"expected a dask scheduler at {cluster}, found none: {error}") from error
