"""More of what goes wrong on a bench, while the joint moves or is about to: a mode that is refused, a fault on the way
up a ramp, answers that come late, another joint or drive than configured. Each ends as in `test_faults`: motor off
within a stated time of the device's own clock, the run marked with the reason, no call that hangs, and a drive that
opens again.
"""

import time

import pytest

from bench.control.cycle import OFF, Action
from bench.control.drive_factory import make_equipment
from bench.control.ending import StopRequest
from bench.experiments.kinds.commissioning import CommissioningParameters, commission
from drivers.contract import Command, Mode
from drivers.errors import DriveConfigurationError, DriveError
from tests.drivers.conformance.benches import PERIOD_S, TCP, configured, run
from tests.drivers.conformance.test_faults import GENTLE_PUSH_A, LAST_WORDS_S, MARGIN_S, Swinging, opens_again

RAMP_A_S, RAMP_S = 0.2, 1.0
FRESH_S = 0.1  # oldest sample that a bench at 100 Hz acts on, as in the configuration that comes with the package
TOO_LATE_S = 2.0 * LAST_WORDS_S  # nobody waits for an answer any more
DELAY_S = 0.15  # of each answer: half of what is waited for one, more than a fresh sample is old


def swing_then(mode):
    """Push the joint, then ask for another mode while it moves."""
    yield Action(OFF)
    for _ in range(30):
        yield Action(Command(Mode.CURRENT, 0.2))
    for _ in range(30):
        yield Action(Command(mode, 0.0))
    return {}


@pytest.mark.parametrize("_again", range(2))  # the first leaves nothing behind that would spoil the second
def test_a_mode_that_is_refused_in_mid_motion(wired, _again):
    with wired.opened() as drive:
        mode = wired.variant.refused_mode
        if mode in drive.describe().modes:  # it would take it: here it does not
            wired.device.side.ask("fault", name="mode-refused", delay_s=0.2)
        began_s = time.monotonic()
        outcome, _ = run(wired, drive, swing_then(mode), StopRequest())
        ended_s = time.monotonic()
        assert outcome.outcome == "failed"
        assert "mode" in outcome.reason or "refused" in outcome.reason
        assert outcome.cycles >= 30, "it had not moved yet"
        # the run itself has taken the power away; no watchdog was needed for that
        assert began_s < wired.device.wait_for_power(False) < ended_s
        opens_again(wired, drive)


@pytest.mark.parametrize("name", ["over-temperature", "over-current", "torque-disabled"])
def test_a_fault_on_the_way_up_a_ramp(wired, name):
    with wired.opened() as drive:
        halfway = Halfway(wired, name)
        outcome, _ = run(wired, drive, halfway.procedure(), StopRequest())
        assert outcome.outcome in ("failed", "tripped"), outcome
        assert outcome.reason
        assert 0.4 * RAMP_S / PERIOD_S < outcome.cycles < 2.0 * RAMP_S / PERIOD_S
        assert wired.device.wait_for_power(False) - halfway.broken_s < MARGIN_S  # the drive itself, at once
        opens_again(wired, drive)


class Halfway:
    """A ramp, half-way up which something breaks."""

    def __init__(self, bench, name):
        self._side, self._name = bench.device.side, name
        self.broken_s = 0.0

    def procedure(self):
        yield Action(OFF)
        for cycle in range(round(2.0 * RAMP_S / PERIOD_S)):
            if cycle * PERIOD_S >= 0.5 * RAMP_S and not self.broken_s:
                self.broken_s = time.monotonic()
                self._side.ask("fault", name=self._name)
            yield Action(Command(Mode.CURRENT, RAMP_A_S * cycle * PERIOD_S))
        return {}


@pytest.mark.real_wire(*TCP)
def test_answers_that_come_late_trip_the_limit_of_the_samples_age(wired):
    """Each answer is late, and none too late: the feedback is stale. What is old must not be acted on."""
    strict = wired.configuration.limits.model_copy(update={"sample_age_s": FRESH_S})
    bench = wired.changed(limits=strict)
    with wired.opened() as drive:
        swinging = Swinging(bench, drive, push_a=0.15)
        before_s = time.monotonic()
        wired.device.side.ask("link", name="delay", amount_s=DELAY_S, direction="from-device")
        outcome = swinging.join()
        assert outcome.outcome == "tripped", outcome
        assert "age" in outcome.reason
        assert f"{FRESH_S:g}" in outcome.reason
        assert wired.device.wait_for_power(False) - before_s < LAST_WORDS_S + wired.watched_s + MARGIN_S
        opens_again(wired, drive)


# over the network an answer is known by its number; a frame on a bus is late alike on every adapter
@pytest.mark.real_wire("modbus-tcp")
def test_answers_that_come_too_late_are_no_answers(watched):
    with watched.opened() as drive:
        swinging = Swinging(watched, drive, GENTLE_PUSH_A)  # the demand stands: a hard push ends at a limit
        before_s = time.monotonic()
        watched.device.side.ask("link", name="delay", amount_s=TOO_LATE_S, direction="from-device")
        outcome = swinging.join()
        assert outcome.outcome == "failed", outcome
        assert any(word in outcome.reason for word in ("found", "answer", "heartbeat", "SYNC"))
        assert watched.device.wait_for_power(False) - before_s < LAST_WORDS_S + watched.watched_s + MARGIN_S
        time.sleep(TOO_LATE_S)  # what is still under way comes in, and must not be taken for an answer
        opens_again(watched, drive)


def with_lines_for_counts(bench):
    """The bench whose rig has the lines of the encoder, 1024, in the place of its counts, four times as many."""
    rig = bench.configuration.rig
    wrong = rig.model_copy(update={"sensor": rig.sensor.model_copy(update={"counts_per_turn": 1024})})
    return bench.changed(rig=wrong)


def test_lines_counted_for_counts_do_not_pass_the_commissioning_move(wired):
    if wired.variant.knows_counts is not False:
        pytest.skip("it says itself how many it has: see the next test")
    bench = with_lines_for_counts(wired)
    wired.device.side.hang_load(0.0, False)  # puts the arm back to angle 0
    with bench.opened() as drive:
        procedure = commission(CommissioningParameters(), bench.configuration)
        outcome, _ = run(bench, drive, procedure, StopRequest())
        assert outcome.outcome == "failed"
        assert "ratio" in outcome.reason
        assert "counts_per_turn" in outcome.reason
        wired.device.wait_for_power(False)


def test_a_drive_that_knows_its_encoder_is_not_opened_with_another(wired):
    if not wired.variant.knows_counts:
        pytest.skip("it does not say how many counts it has: see the test before")
    refusal = r"counts per .* 4096 .* the rig says 1024"
    with with_lines_for_counts(wired).drive() as drive, pytest.raises(DriveConfigurationError, match=refusal):
        drive.open(PERIOD_S)
    assert not wired.device.truth()["powered"]


def test_the_map_of_another_drive_is_refused_before_anything_moves(wired):
    if not wired.name.startswith("modbus"):
        pytest.skip("it has no map: identity and units are asked for, see its own tests")
    other = wired.configuration.drive.model_dump() | {"map": "roboteq", "watchdog_is_set_in_drive": True}
    drive = make_equipment(configured(**other)).drive
    with pytest.raises(DriveError, match="register"):
        drive.open(PERIOD_S)
    drive.close()
    assert not wired.device.truth()["powered"]
    with wired.opened() as right:
        opens_again(wired, right)
