"""A study's model handed to the online compensator: kept as a calibration that the bench can choose."""

from collections.abc import Iterator

from bench import calibration
from bench.calibration import with_friction
from bench.calibration.selection import in_use
from bench.config.configuration import BenchConfiguration
from bench.config.friction_curves import StudiedEffect, StudiedModel
from bench.config.rig import Rig
from bench.provenance import software
from bench.store import Store
from bench.study.errors import StudyError
from bench.study.keep import kept_of, stored
from bench.study.material import Material, facts_of, load_model
from bench.study.models.kept import KeptBench, Used
from compensator.lab.model.fitted import Fit
from compensator.lab.online import left_out, works_online


def use(store: Store, study_id: int, configuration: BenchConfiguration, model_id: int | None = None) -> Used:
    """Keep a model as a calibration, and choose it: from now on the load in motion is estimated with it.

    At rest, and to select what hangs on the arm, the calibration in use so far stays: a study of motion tells neither.

    Raises:
        StudyError: no such model, one of another rig, no calibration to begin with, or an effort that is no torque.
    """
    studied, names = studied_model(store, study_id, configuration, model_id)
    base = in_use(store, configuration)
    if base is None:
        raise StudyError(
            f"this bench has no calibration: a study of motion does not tell what hangs on the arm at rest. Run "
            f"`friction-bench calibrate run`, then `friction-bench study use {study_id}` again"
        )
    note = f"model {studied.model_id} of study {study_id}, on calibration {base.id}"
    kept = store.calibrations.add(
        note=note, source=base.source, rig=base.rig, drive=base.drive, provenance={"software": software()},
        experiment_ids=base.experiment_ids, trial_ids=base.trial_ids,
        result={**base.result, "study": studied.model_dump(mode="json")},
    )  # fmt: skip
    calibration.use(store, configuration, kept)
    left = f" Left out, as they need more than the motion of the moment: {', '.join(names)}." if names else ""
    return Used(
        calibration_id=kept,
        study_id=study_id,
        model_id=studied.model_id,
        effects=[one.effect for one in studied.effects],
        left_out=names,
        sentence=f"Calibration {kept} is in use: {note}.{left}",
    )


def studied_model(
    store: Store, study_id: int, configuration: BenchConfiguration, model_id: int | None = None
) -> tuple[StudiedModel, list[str]]:
    """A study's model as part of a configuration, and the effects that cannot be. Errors as `use`."""
    material, model = load_model(store, study_id, model_id)
    if facts_of(configuration.rig) != material.definition.facts:
        raise StudyError(
            f"study {study_id} is of another rig than this bench, '{configuration.rig.name}'; name the configuration "
            "of its bench with --config"
        )
    _check_effort(material, configuration.rig)
    fit = material.fit_of(model)
    return _studied(study_id, model.id, fit), left_out(fit.effects)


def _check_effort(material: Material, rig: Rig) -> None:
    effort = material.dataset.effort_definition
    if effort.unit != "N m" or rig.joint != "rotary":
        raise StudyError(
            f"study {material.study_id} predicts {effort.title} [{effort.unit}]; the compensator takes joint torque of "
            "a rotary joint: add motor.torque_constant_n_m_a and gear.ratio to the rig, and study current or torque"
        )


def _studied(study_id: int, model_id: int, fit: Fit) -> StudiedModel:
    scales = fit.dataset.scales
    inertia = next((term.coefficients for term in fit.terms if term.effect.name == "inertia"), (0.0, 1.0))
    return StudiedModel(
        study_id=study_id,
        model_id=model_id,
        effects=tuple(
            StudiedEffect(effect=term.effect.name, shape=term.shape, coefficients=tuple(term.coefficients.tolist()))
            for term in fit.terms
            if works_online(term.effect)
        ),
        slow_rad_s=scales.slow,
        fast_rad_s=scales.fast,
        position_span_rad=scales.position_span,
        inertia_n_m_s2_rad=float(inertia[0]),
        load_inertia_scale=float(inertia[1]),
        largest_effort_n_m=fit.dataset.trials[0].motion.largest_effort,
    )


def bench_configurations(
    store: Store, study_id: int, configuration: BenchConfiguration
) -> Iterator[tuple[int, BenchConfiguration]]:
    """Every model of a study that was not tried on the bench yet, and the bench that compensates with it.

    Raises:
        StudyError: the bench has no calibration, or a model cannot be used online.
    """
    calibrated = by_curves_alone(store, configuration)
    for model in store.models(study_id):
        if kept_of(model).bench is None:
            studied, _ = studied_model(store, study_id, configuration, model.id)
            yield model.id, _with_study(calibrated, studied)


def by_curves_alone(store: Store, configuration: BenchConfiguration) -> BenchConfiguration:
    """The bench that compensates by the friction curves of its calibration, without a study's model.

    Raises:
        StudyError: the bench has no calibration.
    """
    return _with_study(with_friction(store, configuration), None)


def _with_study(configuration: BenchConfiguration, studied: StudiedModel | None) -> BenchConfiguration:
    if configuration.friction is None:
        raise StudyError("this bench has no calibration to begin with; run `friction-bench calibrate run` first")
    friction = configuration.friction.model_copy(update={"study": studied})
    return configuration.model_copy(update={"friction": friction})


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
