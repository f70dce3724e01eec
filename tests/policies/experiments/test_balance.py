import polars as pl
import pytest

from policies.experiments.balance import balanced


def table(**worlds):
    """Rows of two frameworks; each world's pairs as (time of the slower framework, failed)."""
    return pl.DataFrame(
        [
            {
                "world": world,
                "pair": pair,
                "framework": framework,
                "time_s": time_s if framework == "lmdp" else 0.001,
                "failed": failed and framework == "lmdp",
            }
            for world, pairs in worlds.items()
            for pair, (time_s, failed) in enumerate(pairs)
            for framework in ("polmdp", "lmdp")
        ]
    )


def kept(rows, seed=1):
    left = balanced(rows, seed)
    assert left.height == 2 * left.select("world", "pair").unique().height
    return {
        world: sorted(left.filter(pl.col("world") == world)["pair"].unique().to_list())
        for world in rows["world"].unique(maintain_order=True)
    }


def test_the_slowest_of_every_world_go_until_no_failure_is_left():
    rows = table(
        easy=[(3, False), (1, False), (2, False), (4, False)],
        hard=[(1, True), (9, False), (8, True), (2, False)],
    )
    # Two of hard failed, the quick one too: the two slowest of easy go with them.
    assert kept(rows) == {"easy": [1, 2], "hard": [1, 3]}


def test_without_failures_all_stay():
    assert kept(table(a=[(1, False)] * 3, b=[(2, False)] * 3)) == {"a": [0, 1, 2], "b": [0, 1, 2]}


def test_a_world_without_success_leaves_nothing_to_compare():
    assert kept(table(a=[(1, False)] * 2, b=[(1, True)] * 2)) == {"a": [], "b": []}


def test_where_more_remain_they_are_drawn_at_random_from_the_seed():
    rows = table(a=[(i, False) for i in range(20)], b=[(i, False) for i in range(8)])
    drawn = {seed: kept(rows, seed) for seed in range(5)}
    assert all(len(each["a"]) == 8 and each["b"] == list(range(8)) for each in drawn.values())
    assert len({tuple(each["a"]) for each in drawn.values()}) > 1
    assert kept(rows, 3) == drawn[3]


@pytest.mark.parametrize("seed", range(3))
def test_the_order_of_the_rows_does_not_matter(seed):
    rows = table(a=[(i % 5, i == 3) for i in range(12)], b=[(i % 4, i in (2, 5)) for i in range(9)])
    assert kept(rows.sample(fraction=1, shuffle=True, seed=seed)) == kept(rows)
