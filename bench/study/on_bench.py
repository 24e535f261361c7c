"""The third number of the ladder: the error of the reflected load, in grams, with each model at work on the bench."""

from collections.abc import Iterator

from bench.calibration import with_friction
from bench.config.configuration import BenchConfiguration
from bench.store import Store
from bench.study.errors import StudyError
from bench.study.keep import kept_of, stored
from bench.study.models.kept import KeptBench
from bench.study.use import studied_model


def bench_configurations(
    store: Store, study_id: int, configuration: BenchConfiguration
) -> Iterator[tuple[int, BenchConfiguration]]:
    """Every model of a study that was not tried on the bench yet, and the bench that compensates with it.

    Raises:
        StudyError: the bench has no calibration, or a model cannot be used online.
    """
    calibrated = with_friction(store, configuration)
    if calibrated.friction is None:
        raise StudyError("this bench has no calibration to begin with; run `friction-bench calibrate run` first")
    for model in store.models(study_id):
        if kept_of(model).bench is None:
            studied, _ = studied_model(store, study_id, configuration, model.id)
            friction = calibrated.friction.model_copy(update={"study": studied})
            yield model.id, calibrated.model_copy(update={"friction": friction})


def keep_bench_error(store: Store, model_id: int, experiment_id: int) -> None:
    """Keep with a model what the experiment found: how far the reflected load was from the one that hung there.

    Raises:
        StudyError: the experiment has no estimate.
    """
    found = store.experiment(experiment_id).results
    if "rms_error_kg" not in found:
        raise StudyError(f"experiment {experiment_id} has no estimate of the load; look at its trials")
    told = KeptBench(
        experiment_id=experiment_id,
        reflected_error_g=1000.0 * found["rms_error_kg"],
        uncompensated_error_g=1000.0 * found["uncompensated_rms_error_kg"],
    )
    kept = kept_of(store.model(model_id))
    store.change_model(model_id, stored(kept.model_copy(update={"bench": told})))
