"""`friction-bench benches`: the benches that share a laboratory's database."""

from collections import Counter
from dataclasses import asdict
from typing import Annotated

import typer

from bench.cli.bench_session import session_of
from bench.cli.output import Json, print_json, say, table


def benches(
    context: typer.Context,
    hand_in: Annotated[
        bool, typer.Option("--hand-in", help="First hand in what this bench recorded, without its service.")
    ] = False,
    as_json: Json = False,
) -> None:
    """List the benches of the laboratory: state, lease, queue, and what is not handed in yet."""
    from bench.errors import ConfigurationError
    from bench.store import Store
    from bench.store.tables.lab_queue import OPEN

    session = session_of(context)
    configuration = session.configuration()
    places = configuration.store
    if hand_in and places.lab_url is None:
        raise ConfigurationError("store.lab_url is not set; set it to the laboratory's database, postgresql://...")
    with Store.open(places.lab_url or places.url) as lab:
        if hand_in:
            with session.open_store() as store:
                hand = store.hand_in_to(lab, configuration.name)
                for experiment_id in hand.waiting():
                    say(f"experiment {experiment_id} is {hand.hand_in(experiment_id)} in the laboratory")
        found, queue = lab.benches.all(), lab.lab_queue.items(*OPEN)
    if as_json:
        told = [asdict(one.word) | {"state": one.state, "silent_s": one.silent_s} for one in found]
        print_json([row | {"seen_utc": one.seen_utc.isoformat()} for row, one in zip(told, found, strict=True)])
        return
    rows = [
        (one.word.name, one.state, one.word.doing, one.word.lease, one.word.queue, one.word.waiting, one.seen_utc)
        for one in found
    ]
    table("Benches", ["name", "state", "doing", "lease", "queue", "to hand in#", "seen"], rows)
    if queue:
        counts = Counter(one.state for one in queue)
        words = ", ".join(f"{count} {state}" for state, count in sorted(counts.items()))
        say(f"queue of the laboratory: {words}; see friction-bench lab-queue list")
