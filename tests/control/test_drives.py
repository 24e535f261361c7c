"""The [drive] section of bench.toml, and the drive that comes of it."""

from math import isnan, nan

import pytest

from bench.config.channels import RECORDED
from bench.config.configuration import default_configuration, parse_configuration
from bench.config.sections import Limits
from bench.control.cycle import row_of
from bench.control.drive_factory import has_hardware, is_simulated, make_equipment, seed_of
from bench.control.joint import ControlledJoint
from bench.control.limits import Guard
from bench.control.servo import current_servo
from bench.control.technician import PersonTechnician
from bench.errors import ConfigurationError, ExperimentError
from drivers.contract import Mode
from drivers.errors import DriveConnectionError
from sim_backend.devices.roboclaw.serve import RoboClawSettings, serve_roboclaw
from tests.control.fake_drive import RIG, FakeDrive

CANOPEN = {"kind": "canopen", "interface": "slcan", "channel": "/dev/absent", "node_id": 5, "watchdog_s": 0.2}
ROBOCLAW = {"kind": "roboclaw", "port": "/dev/absent", "motor_sign": -1, "watchdog_s": 0.3}
MODBUS = {"kind": "modbus", "map": "roboteq", "port": "/dev/absent"}


def configured(drive, **rig):
    values = default_configuration().model_dump(mode="json", exclude_none=True)
    return parse_configuration(values | {"drive": drive, "rig": values["rig"] | rig}, "bench.toml")


def test_kind_chooses_the_drive():
    configuration = configured(ROBOCLAW)
    assert not is_simulated(configuration)
    assert seed_of(configuration) is None
    drive, technician = make_equipment(configuration, lambda _sentence: True)
    assert isinstance(technician, PersonTechnician)
    assert drive.describe().device == "/dev/absent address 0x80 M1"
    assert drive.describe().watchdog_s == pytest.approx(0.3)
    with pytest.raises(DriveConnectionError, match="could not open port /dev/absent"):
        drive.open(0.01)


def test_a_canopen_drive_is_made_of_flat_settings():
    drive, technician = make_equipment(configured(CANOPEN), lambda _sentence: True)
    assert isinstance(technician, PersonTechnician)
    assert drive.describe().device == "/dev/absent node 5"
    assert drive.describe().watchdog_s == pytest.approx(0.2)
    assert drive.highest_speed_rad_s == configured(CANOPEN).limits.speed_rad_s
    with pytest.raises(DriveConnectionError, match=r"the bus slcan /dev/absent does not open"):
        drive.open(0.01)


def test_settings_that_contradict_each_other_are_a_configuration_error():
    with pytest.raises(ConfigurationError, match=r"answer_s = 0.3: more than 0 s and less than the watchdog"):
        make_equipment(configured(CANOPEN | {"answer_s": 0.3}))


def test_the_simulated_drive_has_a_seed():
    assert seed_of(default_configuration()) == 1


@pytest.mark.parametrize(
    ("drive", "message"),
    [
        (
            {"kind": "roboclaws"},
            r"drive: found .*roboclaws.*; kind should be one of sim, canopen,",
        ),
        ({"kind": "roboclaw"}, r"bench.toml: drive.port: missing"),
        (ROBOCLAW | {"address": 5}, r"address: found 5; should be greater than or equal to 128"),
        (CANOPEN | {"channnel": "can0"}, r"channnel: unknown key; did you mean 'channel'\? \(allowed: kind, .*node_id"),
        (
            CANOPEN | {"homing": {"method": "absolute", "travel": 1}},
            r"drive.homing.travel: unknown key; did you mean 'travel_rad'\? \(allowed: method, ",
        ),
        (CANOPEN | {"bitrate": 123456}, r"bitrate: found 123456"),
        (CANOPEN | {"velocity_unit": "rmp"}, r"velocity_unit: found 'rmp'"),
        (ROBOCLAW | {"seed": 3}, r"seed: unknown key; remove it or correct its spelling \(allowed: kind, .*port"),
        (MODBUS | {"unit": 300}, r"unit: found 300; should be less than or equal to 247"),
        (ROBOCLAW | {"encoder_sign": 2}, r"encoder_sign: found 2; should be 1 or -1"),
    ],
)
def test_a_section_that_is_not_as_wanted(drive, message):
    with pytest.raises(ConfigurationError, match=message):
        configured(drive)


def test_a_real_drive_needs_to_know_the_gear():
    with pytest.raises(ConfigurationError, match=r"needs sensor.counts_per_turn and gear.ratio"):
        make_equipment(configured(ROBOCLAW, gear={"backlash_rad": 0.01}))


def test_a_real_drive_counts_turns_of_its_motor():
    with pytest.raises(ConfigurationError, match=r'sensor.at is "joint"; a real drive counts turns of its motor'):
        make_equipment(configured(ROBOCLAW, sensor={"counts_per_turn": 4096, "at": "joint"}))


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"map": "robotec"}, "drive.map: there is no register map 'robotec'"),
        ({"transport": "tcp"}, "drive.port is '/dev/absent'; with drive.transport = 'tcp' a number is wanted"),
    ],
)
def test_a_modbus_drive_that_cannot_be_made(changes, message):
    with pytest.raises(ConfigurationError, match=message):
        make_equipment(configured(MODBUS | changes))


def test_loads_of_a_simulated_device_are_hung_over_its_side_channel():
    with serve_roboclaw(RoboClawSettings()) as device:
        configuration = configured(ROBOCLAW | {"port": device.path, "side_channel": device.side_channel})
        _, technician = make_equipment(configuration)
        technician.hang_load(0.05, balanced=True)
        load = device.device.axis.plant.parameters.load
        assert (load.mass_kg, load.balanced) == (0.05, True)
    assert not has_hardware(configuration)
    assert not is_simulated(configuration)  # its time is the wall's
    with pytest.raises(ExperimentError, match=r"the load of 20 g was not hung: drive\.side_channel '127.*refused"):
        technician.hang_load(0.02, balanced=True)


def test_a_drive_without_side_channel_is_hardware():
    assert has_hardware(configured(ROBOCLAW))
    assert not has_hardware(default_configuration())


def test_a_drive_that_tells_a_torque_and_no_current_has_an_effort_in_its_record():
    """Else the lab finds none in its trials, and no study can be made of them."""
    told = FakeDrive(
        alter=lambda _cycle, sample: sample._replace(duty=nan, torque_n_m=0.01), modes=frozenset({Mode.TORQUE})
    )
    told.open(0.005)
    joint = ControlledJoint(told, Guard(Limits()), current_servo(RIG), torque_constant_n_m_a=0.02)
    joint.begin()
    row = dict(zip(RECORDED, row_of(joint.action, joint.reading), strict=True))
    assert row["current_a"] == pytest.approx(0.5)
    assert isnan(row["current_estimate_a"])
    assert joint.reading.current_a == pytest.approx(0.5)
