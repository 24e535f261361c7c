"""The model that a study starts from, as its recordings were made."""

from collections.abc import Sequence

from bench.store import Store
from compensator.lab.effects.catalogue import default_effects
from compensator.lab.recordings.facts import Facts

SAMPLING_DELAY = "measurement_delay"
CONTROL_LOOP = "recorded_by_control_loop"
"""Parameter of an imported experiment whose rows our own control loop recorded."""
OWN_SOURCES = ("simulated", "real")


def base_model(store: Store, experiment_ids: Sequence[int], facts: Facts) -> tuple[str, ...]:
    """Rigid joint with General Kinetic Friction; of our own control loop, with its sampling delay.

    The loop samples the position at the end of the cycle whose effort stands in the same row: on average the effort
    is half a period older. That is how the rows are made, no property of the joint that a diagnosis should name.

    Args:
        store: with the experiments.
        experiment_ids: whose trials are used.
        facts: of their rig.
    """
    experiments = [store.experiment(number) for number in experiment_ids]
    own = all(one.source in OWN_SOURCES or CONTROL_LOOP in one.parameters for one in experiments)
    return (*default_effects(facts), SAMPLING_DELAY) if own else default_effects(facts)
