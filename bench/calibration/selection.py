"""Which calibration a bench compensates with: the one that was named, or the newest that fits."""

from bench.config.configuration import BenchConfiguration
from bench.config.friction_curves import FrictionCurve, FrictionSettings, StudiedModel
from bench.config.sections import RestSettings
from bench.errors import ConfigurationError
from bench.json_types import Value, Values
from bench.store import CalibrationRow, Experiment, Store

# settings of a drive that say nothing about the joint's friction
_NOT_THE_JOINT = ("seed", "faults", "brake", "homing", "torque_off")


def in_use(store: Store, configuration: BenchConfiguration) -> CalibrationRow | None:
    """The calibration that a bench uses; None where none fits.

    A calibration fits when rig and drive are those of the bench. One that was named needs only the rig to be the same.
    """
    found = store.calibrations.find()
    named = [one for one in found if one.chosen_utc is not None and one.rig == _rig(configuration)]
    if named:
        return max(named, key=lambda one: one.chosen_utc or one.created_utc)
    return next((one for one in found if _fits(one, configuration)), None)


def use(store: Store, configuration: BenchConfiguration, calibration_id: int | None) -> None:
    """Name the calibration that this bench is to use from now on; None: the newest that fits.

    Raises:
        NotFoundError: no such calibration.
        ConfigurationError: it is of another rig.
    """
    if calibration_id is None:
        rig = _rig(configuration)
        store.calibrations.unchoose([one.id for one in store.calibrations.find() if one.rig == rig])
        return
    found = store.calibrations.get(calibration_id)
    if found.rig != _rig(configuration):
        raise ConfigurationError(
            f"calibration {calibration_id} is of rig '{found.rig.get('name')}' with other values than rig "
            f"'{configuration.rig.name}' of this bench; allowed is one of the same rig. Calibrate this bench, or "
            "correct its rig"
        )
    store.calibrations.choose(calibration_id)


def with_friction(store: Store, configuration: BenchConfiguration) -> BenchConfiguration:
    """The configuration with what it names itself, or what the calibration in use has told of the joint, if any.

    That is the friction curves, and the corrections of the joint at rest.
    """
    if configuration.friction is not None:
        return configuration
    found = in_use(store, configuration)
    return configuration if found is None else with_calibration(configuration, found)


def with_calibration(configuration: BenchConfiguration, row: CalibrationRow) -> BenchConfiguration:
    """The configuration with the curves of a calibration, and its corrections at rest where it names none itself."""
    rest = configuration.rest or rest_settings_of(row)
    return configuration.model_copy(update={"friction": friction_of(row), "rest": rest})


def rest_settings_of(row: CalibrationRow) -> RestSettings | None:
    """The corrections at rest of a calibration; None where its searches did not tell."""
    told = row.result.get("rest")
    return None if told is None else RestSettings.model_validate(told)


def friction_of(row: CalibrationRow) -> FrictionSettings:
    """The curves of a calibration."""
    names = FrictionCurve.model_fields
    # a calibration kept by an older version knows fewer of them
    curves = tuple(FrictionCurve(**{name: one[name] for name in names if name in one}) for one in row.result["curves"])
    studied = row.result.get("study")
    study = None if studied is None else StudiedModel.model_validate(studied)
    return FrictionSettings(calibration_id=row.id, curves=curves, study=study)


def drive_of_experiment(experiment: Experiment) -> dict[str, Value]:
    """The drive that an experiment was run on, as far as its friction goes; {} where it is not known."""
    return _joint_of(experiment.provenance.get("configuration", {}).get("drive", {}))


def _joint_of(drive: Values) -> dict[str, Value]:
    return {name: value for name, value in drive.items() if name not in _NOT_THE_JOINT}


def _rig(configuration: BenchConfiguration) -> dict[str, Value]:
    return configuration.rig.model_dump(mode="json", exclude_none=True)


def _fits(row: CalibrationRow, configuration: BenchConfiguration) -> bool:
    drive = configuration.model_dump(mode="json", exclude_none=True)["drive"]
    return (row.rig, row.drive) == (_rig(configuration), _joint_of(drive))
