"""Chirp, multisine and waveforms from a CSV, on the simulated bench of the paper."""

import re

import numpy as np
import pytest

from bench.config.configuration import default_configuration
from bench.errors import LimitError, ParameterError
from bench.experiments.kinds.chirp import ChirpParameters, chirp
from bench.experiments.kinds.multisine import MultisineParameters, frequencies_hz, multisine
from bench.experiments.parts.refusal import refuse_modes
from bench.experiments.parts.waveform_csv import read_waveform
from bench.experiments.registry import find_kind, parse_parameters
from drivers.contract import Mode
from tests.control.fake_drive import FakeDrive
from tests.experiments.bench_run import Ran

CONFIGURATION = default_configuration()
PERIOD_S = 0.005
SHORT = {"duration_s": 4.0, "low_hz": 1.0, "high_hz": 4.0}


def refused(name, parameters):
    kind = find_kind(name)
    with pytest.raises(LimitError) as caught:
        kind.refuse(parse_parameters(kind, parameters), CONFIGURATION)
    return str(caught.value)


def malformed(name, parameters):
    with pytest.raises(ParameterError) as caught:
        parse_parameters(find_kind(name), parameters)
    return str(caught.value)


@pytest.mark.parametrize("spacing", ["logarithmic", "linear"])
def test_a_chirp_runs_through_its_band_and_begins_and_ends_at_rest(spacing):
    parameters = ChirpParameters(duration_s=20.0, low_hz=0.5, high_hz=5.0, spacing=spacing)
    wave = chirp(parameters, PERIOD_S)
    assert np.max(np.abs(wave)) <= 1.0
    assert abs(wave[0]) + abs(wave[-1]) < 1e-3
    crossings_s = np.flatnonzero(np.diff(np.sign(wave))) * PERIOD_S
    rates_hz = 0.5 / np.diff(crossings_s)[:-1]  # the last value is 0
    middles_s = (crossings_s[:-2] + crossings_s[1:-1]) / 2.0
    rise = middles_s / 20.0
    expected_hz = 0.5 * 10.0**rise if spacing == "logarithmic" else 0.5 + 4.5 * rise
    # crossings lie on the grid of control cycles: 5 ms of 100 ms at 5 Hz
    np.testing.assert_allclose(rates_hz, expected_hz, rtol=0.06)


def test_a_multisine_has_its_tones_and_no_other_and_a_low_peak():
    parameters = MultisineParameters(low_hz=0.5, high_hz=5.0, tones=20, wave_s=10.0)
    tones_hz = frequencies_hz(parameters)
    assert np.all(np.diff(tones_hz) > 0.0)
    assert (tones_hz[0], tones_hz[-1]) == (0.5, 5.0)
    np.testing.assert_allclose(tones_hz * 10.0, np.rint(tones_hz * 10.0), atol=1e-9)
    one_wave = multisine(parameters, PERIOD_S)[2100:4100]  # faded in, and past the first period
    power = np.abs(np.fft.rfft(one_wave)) ** 2
    at_tones = np.rint(tones_hz * 10.0).astype(int)
    assert power[at_tones].sum() / power.sum() > 0.999
    np.testing.assert_allclose(power[at_tones], power[at_tones].mean(), rtol=0.02)
    # with all phases alike it would be sqrt(2 N)
    assert np.max(np.abs(one_wave)) / np.sqrt(np.mean(one_wave**2)) < 0.5 * np.sqrt(2.0 * len(tones_hz))


@pytest.mark.parametrize("name", ["chirp", "multisine"])
def test_the_position_is_followed(name):
    parameters = SHORT if name == "chirp" else {"wave_s": 2.0, "waves": 1, "low_hz": 1.0, "high_hz": 4.0, "tones": 4}
    ran = Ran(CONFIGURATION, name, **parameters)
    assert ran.outcomes[0].outcome == "completed"
    results = ran.outcomes[0].results
    assert results["ended_early"] == ""
    assert results["rms_tracking_error_rad"] < 0.015
    assert results["travel_rad"] == pytest.approx(0.1, rel=0.5)
    assert abs(ran.channel(0, "position_rad")[-1]) < 0.01


def test_the_current_is_given_as_it_stands():
    ran = Ran(CONFIGURATION, "chirp", closed="current", amplitude_a=0.2, **SHORT)
    command_a = ran.channel(0, "current_command_a")
    wave_a = 0.2 * chirp(ChirpParameters(**SHORT), PERIOD_S)
    begin = int(np.flatnonzero(np.abs(np.diff(command_a[: len(command_a) - len(wave_a)])) > 0.0)[0])
    shown = [np.array_equal(command_a[k : k + len(wave_a)], wave_a) for k in range(begin, len(command_a) - len(wave_a))]
    assert any(shown)
    assert ran.outcomes[0].results["peak_current_a"] == pytest.approx(0.2, abs=0.03)


def test_a_current_that_drives_the_joint_too_far_ends_early_and_is_braked():
    ran = Ran(CONFIGURATION, "chirp", closed="current", amplitude_a=1.0, low_hz=0.2, excursion_rad=0.5)
    assert ran.outcomes[0].outcome == "completed"
    assert "was used up" in ran.outcomes[0].results["ended_early"]
    assert ran.outcomes[0].results["played_s"] < 5.0
    assert np.max(np.abs(ran.channel(0, "position_rad"))) < 0.6
    assert ran.summary["ended_early"] == 1


CURRENT = "t_s,current_a\n0,0\n0.5,0.2\n0.6,0\n1.2,-0.2\n1.3,0\n"
POSITION = "t_s,position_rad\n" + "\n".join(f"{k / 20},{0.2 * (1 - np.cos(np.pi * k / 20))}" for k in range(41))


@pytest.mark.parametrize("text", [CURRENT, CURRENT.replace("current_a", "duty").replace("0.2", "0.1"), POSITION])
def test_a_waveform_is_played(text):
    ran = Ran(CONFIGURATION, "waveform", csv=text, source="mine.csv")
    assert (ran.outcomes[0].outcome, ran.outcomes[0].results["ended_early"]) == ("completed", "")
    assert ran.outcomes[0].results["travel_rad"] > 0.1
    assert ran.plans[0].conditions["waveform"] == "mine.csv"
    assert abs(ran.channel(0, "position_rad")[-1]) < 0.01


def test_resampling_keeps_rows_and_overshoots_none():
    waveform = read_waveform("t_s,position_rad\n5,0\n5.1,1\n5.3,1\n5.4,0\n", "w.csv")
    values = waveform.resampled(0.01)
    assert len(values) == 41
    assert values[[0, 10, 30, 40]] == pytest.approx([0.0, 1.0, 1.0, 0.0])
    assert (values.min(), values.max()) == (pytest.approx(0.0, abs=1e-12), pytest.approx(1.0))
    straight = read_waveform("current_a,t_s\n0,0\n1,0.1\n", "w.csv").resampled(0.025)
    assert straight == pytest.approx([0.0, 0.25, 0.5, 0.75, 1.0])


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "w.csv: is empty; wanted a header, t_s and one of position_rad, current_a, duty"),
        ("t_s,speed_rad_s\n0,1\n", "w.csv, line 1: found the columns t_s, speed_rad_s; wanted t_s and one of"),
        ("t_s,duty,current_a\n0,0,0\n", "w.csv, line 1: found the columns"),
        ("t_s;duty\n0;0\n", "w.csv, line 1: found the columns t_s;duty"),
        ("t_s,duty\n0,0\n", "w.csv: found 1 rows below the header; wanted at least 2"),
        ("t_s,duty\n0,0\n1\n", "w.csv, line 3: found 1 cells; wanted 2"),
        ("t_s,current_a\n0,0\n1,much\n", "w.csv, line 3, column current_a: found 'much'; wanted a finite number in A"),
        ("t_s,current_a\n0,0\n\n1,nan\n", "w.csv, line 4, column current_a: found 'nan'; wanted a finite number in A"),
        ("t_s,duty\n0,0\n1,20\n", "w.csv, line 3, column duty: found 20; wanted a share of the supply, -1 .. 1"),
        ("t_s,duty\n0,0\n1,0\n0.5,0\n", "w.csv, line 4, column t_s: found a time 0.5 s before that of the row above"),
        ("t_s,duty\n0,0\n5000,0\n", "w.csv, line 3, column t_s: lasts 5000 s; allowed is at most 3600 s"),
        ('t_s,duty\n0,"0\n', "w.csv, line 2: unexpected end of data"),
    ],
)
def test_a_wrong_file_is_named_with_line_and_column(text, message):
    with pytest.raises(ParameterError) as caught:
        read_waveform(text, "w.csv")
    assert str(caught.value).startswith(message)
    assert message in malformed("waveform", {"csv": text, "source": "w.csv"})


REFUSED = [
    ("chirp", {"high_hz": 50.0}, "high_hz is 50 Hz; allowed is at most 25"),
    ("chirp", {"amplitude_rad": 0.2}, "the acceleration of the chirp at "),
    ("chirp", {"amplitude_rad": 2.5, "high_hz": 0.6}, "a position of the chirp is -2."),
    ("chirp", {"closed": "current", "amplitude_a": 3.0}, "the largest current of the chirp is 3 A"),
    ("chirp", {"closed": "current", "excursion_rad": 2.5}, "excursion_rad is -2.5 rad"),
    ("chirp", {"load_kg": 0.2}, "load_kg is 0.2 kg"),
    ("multisine", {"amplitude_rad": 0.3}, "the acceleration of the multisine at "),
    ("multisine", {"low_hz": 0.51, "high_hz": 0.59}, "no multiple of 1 / wave_s, 0.1 Hz, lies within low_hz"),
    ("waveform", {"csv": "t_s,position_rad\n0,0\n1,1\n"}, "the acceleration of waveform.csv at "),
    ("waveform", {"csv": "t_s,position_rad\n0,0\n1,3\n"}, "a position of waveform.csv is 3 rad"),
    ("waveform", {"csv": "t_s,position_rad\n0,0\n0.1,1\n"}, "the speed of waveform.csv at "),
    ("waveform", {"csv": "t_s,current_a\n0,0\n1,2.5\n"}, "the largest current of waveform.csv is 2.5 A"),
    ("waveform", {"csv": "t_s,duty\n0,0\n1,0.9\n"}, "the largest duty of waveform.csv is 0.9; allowed is at most 0.66"),
    ("waveform", {"csv": "t_s,duty\n0,0\n0.001,0\n"}, "waveform.csv lasts less than one control period"),
]


@pytest.mark.parametrize(("name", "parameters", "message"), REFUSED)
def test_what_the_bench_must_not_do_is_refused(name, parameters, message):
    assert refused(name, parameters).startswith(message)


def test_a_band_upside_down_is_malformed():
    assert "low_hz must be below high_hz, 5 Hz" in malformed("chirp", {"low_hz": 6.0})


def test_a_duty_needs_a_drive_that_takes_one():
    kind = find_kind("waveform")
    duty = kind.modes(parse_parameters(kind, {"csv": "t_s,duty\n0,0\n1,0\n"}))
    current = kind.modes(parse_parameters(kind, {"csv": "t_s,current_a\n0,0\n1,0\n"}))
    drive = FakeDrive(modes=frozenset({Mode.CURRENT})).describe()
    refuse_modes("waveform", current, drive)
    with pytest.raises(LimitError, match=re.escape("waveform needs the mode duty of the drive, and drive 'fake' has")):
        refuse_modes("waveform", duty, drive)


@pytest.mark.parametrize("name", ["chirp", "multisine"])
def test_the_duration_is_about_what_it_takes(name):
    parameters = SHORT if name == "chirp" else {"wave_s": 2.0, "waves": 1, "low_hz": 1.0, "high_hz": 4.0}
    ran = Ran(CONFIGURATION, name, **parameters)
    kind = find_kind(name)
    stated_s = kind.duration_s(parse_parameters(kind, parameters), CONFIGURATION)
    assert 0.5 < stated_s / (ran.outcomes[0].cycles * PERIOD_S) < 2.0
