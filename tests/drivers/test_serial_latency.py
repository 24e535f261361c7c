"""USB adapters that hold answers back are noticed, and what to do is said."""

import time

import pytest

from drivers import serial_latency
from drivers.serial_latency import latency_note


@pytest.fixture
def adapter(monkeypatch, tmp_path):
    """Returns a function that gives the adapter of /dev/ttyUSB0 a latency timer [ms]."""
    monkeypatch.setattr(serial_latency, "ADAPTERS", tmp_path)

    def set_timer(timer_ms):
        (tmp_path / "ttyUSB0").mkdir()
        (tmp_path / "ttyUSB0" / "latency_timer").write_text(f"{timer_ms}\n")

    return set_timer


def test_a_timer_at_its_default_is_told_with_the_command_that_sets_it(adapter):
    adapter(16)
    [note] = latency_note("/dev/ttyUSB0", lambda: None)
    assert "holds each answer back for up to 16 ms (its latency_timer)" in note
    assert "echo 1 | sudo tee" in note
    assert "ttyUSB0/latency_timer" in note


def test_a_timer_of_1_ms_is_as_wanted(adapter):
    adapter(1)
    assert latency_note("/dev/ttyUSB0", lambda: time.sleep(0.016)) == ()


def test_a_link_to_the_port_is_followed(adapter, tmp_path):
    adapter(16)
    link = tmp_path / "by-id"
    link.symlink_to("/dev/ttyUSB0")
    assert latency_note(str(link), lambda: None)


def test_without_a_timer_to_read_answers_of_16_ms_are_noticed(adapter):
    [note] = latency_note("/dev/ttyUSB7", lambda: time.sleep(0.016))
    assert "answers on /dev/ttyUSB7 take 16 ms each" in note
    assert latency_note("/dev/ttyUSB7", lambda: None) == ()
