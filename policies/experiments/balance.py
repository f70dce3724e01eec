"""Balancing as in the paper (4.2.2): equally many pairs of every world, the slowest dropped."""

import polars as pl

from policies.pool_rule import generator


def balanced(rows: pl.DataFrame, seed: int) -> pl.DataFrame:
    """The rows of the pairs that balancing keeps; equally many pairs of each world, maybe none.

    Each world's pairs are ordered by the time of their slowest framework; a pair in which one
    failed (timed out or not arrived) ranks behind all others. As many of the slowest are dropped
    from each world as pairs failed in the world with the most failures. Where worlds then keep
    different numbers (they had different numbers of pairs), the surplus is left out at random.
    """
    pairs = rows.group_by("world", "pair").agg(
        failed=pl.col("failed").any(), time_s=pl.col("time_s").max()
    )
    worlds = [
        world.sort("failed", "time_s", "pair")
        for _, world in sorted(pairs.group_by("world"), key=lambda group: group[0])
    ]
    dropped = max(int(world["failed"].sum()) for world in worlds)
    kept = [world.head(max(0, len(world) - dropped)) for world in worlds]
    fewest = min(map(len, kept))
    chosen = [
        world[sorted(generator(seed, "balance").choice(len(world), fewest, replace=False))]
        for world in kept
    ]
    return rows.join(pl.concat(chosen), on=["world", "pair"], how="semi", maintain_order="left")
