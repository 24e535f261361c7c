"""A CiA 402 drive that another master drives, recorded by who only listens: what it says is known from the mapping."""

import threading
import time

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid

from bench.config.drives.registry import drive_kind
from bench.errors import ConfigurationError
from bench.runs.follow import follower_of, record
from drivers.can_bus.port import CanPort
from drivers.can_bus.settings import BusSettings
from drivers.canopen.drive import CanopenDrive
from drivers.canopen.settings import CanopenSettings
from drivers.contract import Command, Mode
from sim_backend.devices.canopen.serve import CanOpenSettings, serve_canopen
from tests.drivers.canopen.conversation import JOINT
from tests.drivers.conformance.benches import configured

PUSH_A = 0.25
# as our own master sets them up: it is the other program here
MAPPING = {"0x185": [0x60410010, 0x60640020, 0x60780010], "0x285": [0x606C0020]}


def section(**further):
    return configured(kind="canopen", interface="virtual", channel="canopen-follow", node_id=5, **further)


def mapping_of(drive):
    """What the other master has set up."""
    return {hex(pdo.cob_id): [entry.mapping for entry in pdo.layout.entries] for pdo in drive._session.data.tpdos}


def swing(drive, stop):
    drive.enable(Mode.CURRENT)
    for number in range(400):
        if stop.is_set():
            break
        drive.exchange(Command(Mode.CURRENT, PUSH_A if number // 30 % 2 == 0 else -PUSH_A))
        time.sleep(0.01)
    drive.disable()


def refuse(*_arguments, **_options):
    raise AssertionError("who listens has sent a frame")


def test_what_another_master_drives_is_recorded_and_nothing_is_sent(tmp_path, monkeypatch):
    monkeypatch.setattr(CanPort, "send_prepared", refuse)
    bus = BusSettings("virtual", "canopen-follow")
    with serve_canopen(CanOpenSettings(interface="virtual", channel="canopen-follow")):
        drive = CanopenDrive(CanopenSettings(bus=bus, node_id=5, watchdog_s=1.0, answer_s=0.6), JOINT)
        drive.open(0.01)
        configuration = section(tpdo_mapping=mapping_of(drive), rated_current_a=1.0, velocity_unit="rpm")
        follower = follower_of(configuration, tmp_path / "unused", 0.01)
        stop = threading.Event()
        thread = threading.Thread(target=swing, args=(drive, stop))
        thread.start()
        try:
            recording = record(follower, configuration, "swing", {}, 0.8, lambda: False)
        finally:
            stop.set()
            thread.join()
            follower.close()
            drive.close()
    found = recording.channels
    assert len(recording) > 30
    assert np.ptp(found["position_rad"]) > 0.05
    # a rate would show how unevenly a busy machine takes the time of the frames
    way = cumulative_trapezoid(found["velocity_rad_s"], found["time_s"], initial=0.0)
    assert np.corrcoef(way, found["position_rad"])[0, 1] > 0.9
    assert np.ptp(found["current_a"]) > 0.1


def test_a_mapping_without_the_position_says_what_is_wanted(tmp_path):
    with pytest.raises(ConfigurationError, match=r"no position actual value .*0x60640020 is wanted"):
        follower_of(section(tpdo_mapping={"0x185": [0x60410010]}), tmp_path / "unused", 0.01)


def test_a_cob_id_that_is_no_number_is_refused(tmp_path):
    with pytest.raises(ConfigurationError, match=r"a COB-ID such as '0x185' is wanted"):
        follower_of(section(tpdo_mapping={"first": [0x60640020]}), tmp_path / "unused", 0.01)


def test_an_entry_within_a_byte_is_refused(tmp_path):
    with pytest.raises(ConfigurationError, match="begins within a byte, at bit 1"):
        follower_of(section(tpdo_mapping={"0x185": [0x60FD0001, 0x60640020]}), tmp_path / "unused", 0.01)


def test_settings_that_contradict_each_other_are_refused_in_the_words_of_who_drives(tmp_path):
    configuration = section(tpdo_mapping=MAPPING, position_min_rad=1.0)
    with pytest.raises(ConfigurationError, match=r"setting position_min_rad = .*: less than") as driven:
        drive_kind("canopen").make(configuration.drive, configuration.rig)
    with pytest.raises(ConfigurationError) as followed:
        follower_of(configuration, tmp_path / "unused", 0.01)
    assert str(followed.value) == str(driven.value)
