"""Searches that something disturbs, through the whole bench: a named reason on record, and no number as a result."""

import csv
import zipfile
from math import isfinite, nan, pi, sin

import pytest

from bench.config.configuration import default_configuration
from bench.control import station
from bench.control.drive_factory import Equipment, make_equipment
from bench.recording_set.transfer import export_experiment
from bench.runs.runner import Runner
from bench.store import Store
from compensator.rest.zero_speed_search import Reason
from drivers.contract import Mode
from tests.experiments.calibrated import calibrated_configuration

METHODS = ("paper", "improved")
ESTIMATES = (
    "min_current_a", "max_current_a", "load_current_a", "friction_current_a", "load_currents_a", "load_interval_a",
    "friction_interval_a", "arm_angle_rad", "reflected_load_kg", "reflected_interval_kg", "breakaways", "search_s",
    "search_travel_rad",
)  # fmt: skip
SETTLED_S = 0.15  # of a search: by then it has settled, and its first ramp is under way


class DisturbedDrive:
    """A simulated drive with something wrong from a time on: what it is told, and what it tells.

    Args:
        drive: the true one.
        begin_s: when it begins, by the drive's own stamps.
        push: duty that acts in addition, at a time since then [s]; nobody is told of it.
        tell: what becomes of a sample, at a time since then [s].
    """

    def __init__(self, drive, begin_s, push=lambda _time_s: 0.0, tell=lambda sample, _time_s: sample):
        self._drive, self._begin_s, self._push, self._tell = drive, begin_s, push, tell
        self._time_s = 0.0

    def __getattr__(self, name):
        return getattr(self._drive, name)

    def exchange(self, command):
        wrong = self._time_s >= self._begin_s and command.mode is Mode.DUTY
        more = self._push(self._time_s - self._begin_s) if wrong else 0.0
        sample = self._drive.exchange(command._replace(value=command.value + more) if wrong else command)
        self._time_s = sample.time_s
        sample = sample._replace(duty=sample.duty - more)
        return self._tell(sample, self._time_s - self._begin_s) if self._time_s >= self._begin_s else sample


def with_method(configuration, method):
    return configuration.model_copy(update={"search": configuration.search.model_copy(update={"method": method})})


class Recorded:
    """One experiment on a bench with a disturbed drive, in a store.

    Args:
        store: of its own.
        configuration: of the bench.
        kind, parameters: of the experiment.
        disturbed: as for `DisturbedDrive`.
    """

    def __init__(self, store, configuration, kind="load-sweep", parameters=None, **disturbed):
        def equipment(given, ask):
            drive, technician = make_equipment(given, ask)
            return (
                Equipment(DisturbedDrive(drive, **disturbed), technician) if disturbed else Equipment(drive, technician)
            )

        chosen = {"loads_kg": [0.05], "angles_rad": [pi / 2]} if parameters is None else parameters
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(station, "make_equipment", equipment)
            runner = Runner(configuration, store)
            try:
                self.experiment_id = runner.start(kind, chosen, pace="fast")
                assert runner.wait(120.0)
            finally:
                runner.close()
        self.store = store
        self.experiment = store.experiment(self.experiment_id)
        (self.trial,) = store.trials(self.experiment_id)

    def search_begins_s(self):
        """When the first search left its settled phase, since the drive was made."""
        stamps = [event.time_s for event in self.store.recording(self.trial.id).events if event.name == "search"]
        return stamps[0]


@pytest.fixture(scope="module")
def begins_s(tmp_path_factory):
    """When the search of an undisturbed trial begins its first ramp; the simulation repeats it to the bit."""
    found = {}
    for method in METHODS:
        with Store.open(f"sqlite:///{tmp_path_factory.mktemp(method) / 'bench.sqlite'}") as store:
            whole = Recorded(store, with_method(calibrated_configuration(), method))
            assert whole.trial.results["search_failure"] == ""
            found[method] = whole.search_begins_s()
    return found


@pytest.fixture
def store(tmp_path):
    with Store.open(f"sqlite:///{tmp_path / 'bench.sqlite'}") as opened:
        yield opened


def trembling(time_s):
    """A shaken table: friction is overcome at every swing."""
    return 0.2 * sin(2.0 * pi * 3.0 * time_s)


def blind(sample, _time_s):
    return sample._replace(duty=nan, current_a=nan)


def creeping(sample, time_s):
    """A coupling that slips, slowly: the motor turns, whatever it is told."""
    return sample._replace(position_rad=sample.position_rad + 0.06 * time_s)


def glance(sample, time_s):
    """One sample from far off: counts misread."""
    return sample._replace(position_rad=sample.position_rad - 0.2) if 0.1975 <= time_s < 0.2025 else sample


def thrown(time_s):
    """Somebody leans on the arm, soon after the first ramp began."""
    return 0.3 * (0.1 <= time_s < 0.5)


DISTURBED = {
    "loses the current": ({"tell": blind}, {Reason.LOST_SAMPLE}),
    "shows a place beyond its guard once": ({"tell": glance}, {Reason.EXCURSION}),
    "does not settle": ({"push": trembling}, {Reason.NOT_SETTLED, Reason.MOVED_EARLY, Reason.WRONG_WAY}),
    # these two only several breakaways can tell from one
    "is thrown against its guard": ({"push": thrown}, {Reason.EXCURSION}),
    "moves by itself": ({"tell": creeping}, {Reason.MOVED_EARLY, Reason.NOT_SETTLED, Reason.EXCURSION}),
}  # fmt: skip
TOLD_BY_ONE = list(DISTURBED)[:3]
CASES = [*((name, "paper") for name in TOLD_BY_ONE), *((name, "improved") for name in DISTURBED)]


@pytest.mark.parametrize(("name", "method"), CASES)
def test_a_search_that_is_disturbed_has_a_reason_on_record_and_no_number(store, begins_s, name, method):
    disturbed, reasons = DISTURBED[name]
    configuration = with_method(calibrated_configuration(), method)
    ran = Recorded(store, configuration, begin_s=begins_s[method], **disturbed)
    results = ran.trial.results
    assert ran.trial.outcome == "completed"
    assert results["search_failure"] in {reason.value for reason in reasons}
    assert {name: results[name] for name in ESTIMATES} == dict.fromkeys(ESTIMATES)
    check_nothing_is_told(ran)


def check_nothing_is_told(ran):
    """Neither the summary, nor the samples, nor what is exported holds an estimate."""
    summary = ran.experiment.results
    assert not summary.get("estimates")
    assert not [name for name in summary if "error" in name or "load_current" in name or "reflected" in name]
    recording = ran.store.recording(ran.trial.id)
    given = recording.channels.get("current_load_a")
    assert given is None or not any(map(isfinite, given))


@pytest.mark.parametrize("method", METHODS)
def test_nothing_of_it_is_exported(store, begins_s, method, tmp_path):
    ran = Recorded(store, with_method(calibrated_configuration(), method), begin_s=begins_s[method], tell=blind)
    export_experiment(store, ran.experiment_id, tmp_path / "set.zip")
    with zipfile.ZipFile(tmp_path / "set.zip") as archive:
        names = {name.rsplit("/", 1)[-1]: name for name in archive.namelist()}
        (row,) = csv.DictReader(archive.read(names["trials.csv"]).decode().splitlines())
        samples = list(csv.DictReader(archive.read(names[row["file"].rsplit("/", 1)[-1]]).decode().splitlines()))
    assert not [column for column in row if column in ESTIMATES and row[column]]
    assert len(samples) > 100
    assert not [line for line in samples if line.get("current_load_a")]


def test_samples_that_do_not_come_end_the_trial_without_a_result(store, begins_s):
    plain = default_configuration()
    drive = plain.drive.model_validate(
        {**plain.drive.model_dump(), "faults": [{"kind": "samples-lost", "at_s": begins_s["improved"] + SETTLED_S}]}
    )
    ran = Recorded(store, plain.model_copy(update={"drive": drive}))
    assert ran.trial.outcome == "failed"
    assert "no answer to the command" in ran.trial.reason
    assert set(ran.trial.results) <= {"cycles", "overruns"}
    check_nothing_is_told(ran)


@pytest.mark.parametrize(
    ("kind", "parameters"),
    [
        ("steps", {"repeats": 1}),
        ("sinusoid", {"periods": 1}),
        ("steady-speeds", {"speeds_rad_s": [2.0]}),
    ],
)
def test_every_kind_that_searches_says_so_and_tells_nothing(store, kind, parameters):
    # from its first sample on the drive tells of no current
    ran = Recorded(store, calibrated_configuration(), kind, parameters, begin_s=0.0, tell=blind)
    assert ran.trial.outcome == "completed"
    assert ran.trial.results["search_failure"] == Reason.LOST_SAMPLE.value
    numbers = {name: value for name, value in ran.trial.results.items() if isinstance(value, float)}
    assert set(numbers) <= {"steady_position_rad", "steady_current_a"}
    check_nothing_is_told(ran)
