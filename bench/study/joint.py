"""Where the joint of a study is, and so whether more can be recorded of it."""

from bench.config.rig import CHALLENGE
from bench.recording_set.transfer import CONTROL_LOOP
from bench.store import Store
from bench.study.material import Definition
from bench.study.models.diagnosis import Joint


def joint_of(store: Store, definition: Definition) -> Joint:
    """Where the joint of a study's trials is."""
    experiment = store.experiment(store.trial(definition.trial_ids[0]).experiment_id)
    if experiment.source != "imported":
        return "here"
    drawn = experiment.rig.get("name") == CHALLENGE and CONTROL_LOOP in experiment.parameters
    return "nowhere" if drawn else "elsewhere"
