"""What became of simulated participants, in a table for the terminal."""

from collections import Counter
from collections.abc import Sequence

from app.bots.crowd import Outcome


def summary(outcomes: Sequence[Outcome]) -> str:
    """A line for each kind: how many, and the pages at which they ended."""
    by_kind: dict[str, Counter[str]] = {}
    for outcome in outcomes:
        by_kind.setdefault(outcome.bot.kind, Counter())[outcome.ended] += 1
    width = max(map(len, by_kind))
    lines = [
        f"{kind:<{width}} {ends.total():5}  "
        + ", ".join(f"{count} at “{end}”" for end, count in ends.most_common())
        for kind, ends in sorted(by_kind.items(), key=lambda item: -item[1].total())
    ]
    answers = sum(len(outcome.answers) for outcome in outcomes)
    return "\n".join([*lines, f"{answers} answers acknowledged"])
