"""How places are dealt to many people, 500 at once, in several processes on one database.

Example: python -m tests.benchmarks.dealing --participants 10000 --processes 4 --seed 1

Part of the people drop out before the first frame, so that their places are dealt again; half of
them come back. Prints what the tables then say beside its bounds; exit code 1 if one is broken.
"""

import argparse
import sys
import tempfile
from pathlib import Path

from app.sqlite import sqlite_engine
from app.study import PARTICIPANT, load_study
from tests.app.arrivals import arrive_at_once, settings_of
from tests.app.dealing_bounds import bounds, read_dealings


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--participants", type=int, default=10_000)
    parser.add_argument("--processes", type=int, default=4)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        settings = settings_of(Path(folder) / "dealing.sqlite", given.seed)
        arrived = arrive_at_once(settings, given.participants, given.processes, given.seed)
        study = load_study(settings)
        with sqlite_engine(settings.database_url, "BEGIN").connect() as connection:
            dealings = read_dealings(connection, PARTICIPANT)
            kept = bounds(connection, dealings, study, settings.block_size, arrived.players)
    print(f"{arrived.people} people in {given.processes} processes, {arrived.players} of them play")
    print(f"all had been dealt a place after {arrived.seconds:.2f} s: ", end="")
    print(f"{arrived.people / arrived.seconds:.0f} arrivals/s")
    print(f"{len(dealings.places)} places dealt, {dealings.again} times one given back, again")
    print(f"{'':40} {'measured':>8} {'bound':>6}")
    for bound in kept:
        print(f"{bound.name:40} {bound.measured:8} {bound.most:6}")
    if not all(bound.holds for bound in kept):
        sys.exit("A bound of the dealing is broken.")


if __name__ == "__main__":
    main()
