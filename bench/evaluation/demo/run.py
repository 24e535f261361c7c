"""Runs the demo and writes its report."""

from collections.abc import Callable
from functools import partial
from pathlib import Path

from bench.config.configuration import default_configuration
from bench.evaluation.demo.at_rest import load_sweep, repeated_steps
from bench.evaluation.demo.hidden_effect import hidden_effect
from bench.report import Section, write_html
from bench.store import Store

DEFAULT_SEED = 2
TITLE = "friction-bench: the main job on the simulated bench"


def run_demo(report: Path, show: Callable[[Section], None], seed: int = DEFAULT_SEED) -> Path:
    """Run the main job end to end.

    Args:
        report: HTML file to write; the trials go to a store beside it, made afresh.
        show: called with every section as soon as it is there.
        seed: of the hidden effect.

    Returns:
        The store.
    """
    database = report.with_suffix(".sqlite")
    database.parent.mkdir(parents=True, exist_ok=True)
    for leftover in (database, *(database.with_name(database.name + end) for end in ("-wal", "-shm"))):
        leftover.unlink(missing_ok=True)
    configuration = default_configuration()
    store = Store.open(f"sqlite:///{database}")
    try:
        sections: list[Section] = []
        parts = (repeated_steps, load_sweep, partial(hidden_effect, seed=seed))
        for part in parts:
            sections.append(part(configuration, store))
            show(sections[-1])
    finally:
        store.close()
    write_html(report, TITLE, sections)
    return database
