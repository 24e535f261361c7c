"""Which measured quantity stands for the effort."""

import numpy as np
import pytest

from compensator.lab.errors import UnusableDataError
from compensator.lab.recordings.effort import choose_effort
from compensator.lab.recordings.facts import Facts
from compensator.lab.recordings.recording import Recording

ONE = np.array([0.5, 1.0])


def recording(name: str = "one", **channels: np.ndarray) -> Recording:
    return Recording(name, "x", {}, {"time_s": np.array([0.0, 1.0]), "position_rad": ONE, **channels})


def test_what_is_measured_nearest_the_load_comes_first():
    all_of_them = dict.fromkeys(("torque_n_m", "current_a", "current_estimate_a", "duty", "supply_v"), ONE)
    for quantity in ("torque", "current", "current_estimate", "terminal_voltage"):
        assert choose_effort([recording(**all_of_them)], Facts()).quantity == quantity
        for channel in choose_effort([recording(**all_of_them)], Facts()).channels[:1]:
            del all_of_them[channel]


def test_current_becomes_torque_where_the_constant_is_known():
    made = recording(current_a=ONE)
    plain, known = choose_effort([made], Facts()), choose_effort([made], Facts(torque_per_current_n_m_a=3.0))
    assert (plain.unit, known.unit) == ("A", "N m")
    assert plain.of(made) == pytest.approx(ONE)
    assert known.of(made) == pytest.approx(3.0 * ONE)


def test_terminal_voltage_is_duty_times_supply():
    made = recording(duty=ONE, supply_v=np.array([12.0, 11.0]))
    effort = choose_effort([made], Facts())
    assert effort.unit == "V"
    assert effort.of(made) == pytest.approx([6.0, 11.0])


def test_every_recording_must_have_it():
    pair = [recording("a", torque_n_m=ONE, current_a=ONE), recording("b", current_a=ONE)]
    assert choose_effort(pair, Facts()).quantity == "current"
    nothing = recording("c", torque_n_m=np.full(2, np.nan))
    with pytest.raises(UnusableDataError, match=r"'c' has no effort channel: found .*wanted torque_n_m or force_n or"):
        choose_effort([recording("a", torque_n_m=ONE), nothing], Facts())


def test_a_channel_without_a_value_is_not_said_to_be_found():
    empty = recording("c", torque_n_m=np.full(2, np.nan))
    words = r"found position_rad, time_s, and torque_n_m with no value in any sample; wanted torque_n_m; map"
    with pytest.raises(UnusableDataError, match=words):
        choose_effort([empty], Facts(effort="torque"))


def test_the_wish_of_the_rig_is_honoured_or_refused():
    made = recording(torque_n_m=ONE, current_a=ONE)
    assert choose_effort([made], Facts(effort="current")).quantity == "current"
    with pytest.raises(UnusableDataError, match=r"'one'.*wanted duty x supply_v"):
        choose_effort([made], Facts(effort="terminal_voltage"))


def test_an_effort_that_no_pair_of_trials_shares():
    pair = [recording("a", torque_n_m=ONE), recording("b", current_a=ONE)]
    with pytest.raises(UnusableDataError, match="share"):
        choose_effort(pair, Facts())
