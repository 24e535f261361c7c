from collections.abc import Iterator
from pathlib import Path

import pytest

from bench.config.rig import Rig
from bench.recording_set import import_recording_set
from bench.recording_set.recording_set import RecordingSet
from bench.store import Store
from tests.lab.synthetic import Bench, Joint, Plan, plans, recordings

RIG = Rig.model_validate({"name": "known joint", "arm": {"length_m": 0.3}})
HIDDEN = Joint(extra=lambda x: 0.012 * abs(x.v))
QUICK = Bench(duration_s=9.0)


@pytest.fixture(scope="module")
def store(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Store]:
    with Store.open(f"sqlite:///{Path(tmp_path_factory.mktemp('store')) / 'bench.sqlite'}") as opened:
        yield opened


def imported(store: Store, trials: list[Plan], joint: Joint = HIDDEN, rig: Rig = RIG, bench: Bench = QUICK) -> int:
    made = recordings(joint, bench, trials, seed=3)
    return import_recording_set(store, RecordingSet("set", rig, made), "known joint")


@pytest.fixture(scope="module")
def experiment_id(store: Store) -> int:
    """Twelve trials: two loads, three styles, each twice; viscous friction differs by direction."""
    return imported(store, plans(loads_kg=(0.0, 0.2), repeats=2))
