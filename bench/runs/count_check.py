"""Whether the drive's count may have been reset since the last experiment: noticed before anything moves.

An incremental encoder counts from 0 again after each power cycle, wherever the arm stands then. With a wrong zero the
compensated gravity is that of an angle which the arm does not have.
"""

from collections.abc import Callable
from datetime import UTC, datetime, timedelta
from math import degrees, isfinite, pi

from bench.config.configuration import BenchConfiguration
from bench.config.drives.real import RealDriveSettings
from bench.config.rig import resolution_rad
from bench.control.commissioned import IDENTITY
from bench.errors import ConfigurationError
from bench.provenance import provenance
from bench.store import Experiment, Store
from drivers.contract import Description

COUNTS = 2.0  # off 0: a joint that creeps by a count after it was switched on
MOVED_RAD = 0.1  # that the arm is elsewhere by its count; gravity is off by a tenth then
TURN_SHARE = 0.05  # of a motor turn: as near to whole turns no hand puts an arm by chance more than once in ten times
GAP = timedelta(seconds=20.0)  # nobody has switched a supply off and on between two experiments of a queue
LOOKED_AT = 50  # newest experiments
CHANNEL = "position_rad"


def count_doubt(store: Store, bench: BenchConfiguration, found: Description, read_rad: Callable[[], float]) -> str:
    """What a person has to look at before the joint moves; "" where the count is not in doubt.

    The count of an incremental encoder is in doubt where it is 0, the arm stood elsewhere at the end of the last
    experiment, and nobody has set the zero since; that of an absolute one where it is off by whole motor turns. An arm
    that hangs where the drive was switched on has a count of 0, too: only eyes can tell.

    Args:
        store: with the experiments before.
        bench: with the drive's zero.
        found: the drive, as it was opened.
        read_rad: reads the position of the joint now; called only where the records leave room for doubt.
    """
    settings = bench.drive
    last = _last(store, bench, found) if isinstance(settings, RealDriveSettings) else None
    if last is None or not isinstance(settings, RealDriveSettings):
        return ""
    experiment, stood_rad = last
    if settings.homing is not None and settings.homing.method == "absolute":
        return _turn_doubt(bench, found, experiment, stood_rad, read_rad())
    if abs(stood_rad + settings.zero_rad) <= MOVED_RAD:  # it was near 0 before, too
        return ""
    position_rad = read_rad()
    if not _is_zero(bench, position_rad + settings.zero_rad):
        return ""
    return (
        f"The count of drive '{found.device}' is 0, as after its supply was switched off and on. The arm stood at "
        f"{degrees(stood_rad):.0f} degrees at the end of experiment {experiment.id}; by the count it stands at "
        f"{degrees(position_rad):.0f} degrees now. Go on only if it does. If not, stop, let it hang straight down, and "
        "run 'friction-bench doctor --set-zero'."
    )


def _turn_doubt(
    bench: BenchConfiguration, found: Description, experiment: Experiment, stood_rad: float, position_rad: float
) -> str:
    """What is in doubt of an absolute encoder: it knows where in a turn it is, and may have lost count of the turns."""
    ratio = bench.rig.gear.ratio
    if ratio is None or not isfinite(position_rad):
        return ""
    turn_rad = 2.0 * pi / ratio
    turns = round((position_rad - stood_rad) / turn_rad)
    if turns == 0 or abs(position_rad - stood_rad - turns * turn_rad) > TURN_SHARE * turn_rad:
        return ""
    return (
        f"The count of drive '{found.device}' is off by {turns} whole motor turns ({degrees(turns * turn_rad):.0f} "
        f"degrees of the joint) from the end of experiment {experiment.id}, as where an absolute encoder has lost "
        f"its turns. By the count the arm stands at {degrees(position_rad):.0f} degrees now. Go on only if it does. "
        "If not, stop, look after the encoder's battery, let it hang straight down, and run 'friction-bench doctor "
        "--set-zero'."
    )


def _is_zero(bench: BenchConfiguration, counted_rad: float) -> bool:
    """Whether the bare count is 0; not where the rig does not tell what a count is."""
    try:
        return isfinite(counted_rad) and abs(counted_rad) <= COUNTS * resolution_rad(bench.rig)
    except ConfigurationError:
        return False


def _last(store: Store, bench: BenchConfiguration, found: Description) -> tuple[Experiment, float] | None:
    """The last experiment of this drive, and where the arm stood at its end; None where it was just now, or the zero is
    another one by now."""
    wanted = provenance(bench, found)
    for one in store.experiments(limit=LOOKED_AT):
        drive, configuration = one.provenance.get("drive"), one.provenance.get("configuration")
        if one.finished_utc is None or drive is None or configuration is None or one.source == "imported":
            continue
        if any(drive.get(name) != wanted["drive"][name] for name in IDENTITY):  # type: ignore[index, call-overload]
            continue
        stood_rad = _end_rad(store, one)
        if stood_rad is None:
            continue
        same_zero = configuration.get("drive", {}).get("zero_rad", 0.0) == getattr(bench.drive, "zero_rad", 0.0)
        return (one, stood_rad) if same_zero and datetime.now(UTC) - one.finished_utc > GAP else None
    return None


def _end_rad(store: Store, experiment: Experiment) -> float | None:
    """Where the arm stood in the last row of an experiment; None where it has none."""
    for trial in reversed(store.trials(experiment.id)):
        if trial.rows and CHANNEL in trial.channels:
            position_rad = float(store.part(trial, trial.rows - 1, 1)[trial.channels.index(CHANNEL), -1])
            return position_rad if isfinite(position_rad) else None
    return None
