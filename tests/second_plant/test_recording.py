"""Drawn joints and what is recorded of them."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from sim_backend.second_plant import oracle
from sim_backend.second_plant.columns import Rows, base_columns
from sim_backend.second_plant.draw import draw_joint
from sim_backend.second_plant.joint import MECHANISMS, DrawnJoint
from sim_backend.second_plant.oracle import evidence, floor_of, laws_ratio
from sim_backend.second_plant.recording import SecondRecording, record, simulated

NOTHING = 0.04  # r of a joint that lacks nothing: within a tick it is led at an even speed


def short(joint: DrawnJoint, trials: int = 8) -> DrawnJoint:
    """Its first trials: the kinds come in turn, so that eight hold each kind of motion once."""
    return replace(joint, trials=joint.trials[:trials])


def test_the_same_seed_records_the_same_and_another_seed_another_joint():
    first, again, other = (record(short(draw_joint(seed), 2)) for seed in (5, 5, 6))

    for one, two in zip(first, again, strict=True):
        assert all(np.array_equal(one.channels[name], two.channels[name]) for name in one.channels)
    assert not np.array_equal(first[0].effort[:50], other[0].effort[:50])


@cache
def recorded(complete: DrawnJoint) -> list[SecondRecording]:
    """Most mechanisms are hidden in one and the same joint."""
    return record(complete)


@pytest.mark.parametrize("name", list(MECHANISMS))
def test_every_mechanism_changes_what_is_recorded_and_can_be_left_out(name):
    joint = short(draw_joint(3, (name,), (1.0,)), trials=3)
    joint = replace(joint, trials=tuple(replace(trial, seconds=2.5) for trial in joint.trials))
    complete = replace(joint, hidden=())

    hidden, without, plain = record(joint), record(joint, without=frozenset({name})), recorded(complete)

    assert any(not np.array_equal(a.effort, b.effort) for a, b in zip(hidden, plain, strict=True))
    assert all(np.array_equal(a.effort, b.effort) for a, b in zip(without, plain, strict=True))
    assert all(np.isfinite(values).all() for one in hidden for values in one.channels.values())


@pytest.mark.parametrize("seed", range(4))
def test_a_textbook_joint_obeys_the_rigid_joint_formula_once_its_bristles_are_bent(seed):
    joint = draw_joint(seed)
    for trial in joint.trials[:8]:
        p, true = simulated(joint, trial)
        speed = true.speed_rad_s
        film = np.exp(-((np.abs(speed) / p.stribeck_rad_s) ** p.stribeck_power))
        friction = np.sign(speed) * (p.coulomb_n_m + (p.static_n_m - p.coulomb_n_m) * film) + p.viscous_n_m * speed
        inertia = p.rotor_kg_m2 + p.arm_kg_m2
        needed = inertia * true.acceleration_rad_s2 + p.moment_n_m * np.sin(true.reading_rad) + friction
        # steady sliding: long since any reversal, and no step of the current
        sliding = np.convolve(np.abs(speed) > 0.05 * joint.scales.top_rad_s, np.ones(201), mode="same") > 200
        off = (p.torque_per_a * true.current_a - needed)[sliding]

        assert np.linalg.norm(off) <= 0.03 * p.coulomb_n_m * np.sqrt(len(off))


def test_stamps_rise_and_the_encoder_counts():
    joint = draw_joint(11)
    for one in record(short(joint)):
        counts = one.channels["position_rad"] / joint.control.count_rad

        assert (np.diff(one.channels["time_s"]) > 0.0).all()
        assert counts == pytest.approx(np.round(counts), abs=1e-6)


def test_a_measured_supply_hides_nothing_of_the_sag_and_a_nominal_one_all():
    joint = short(draw_joint(3, ("sag",), (3.0,)))
    measured = replace(joint, sensors=replace(joint.sensors, effort="duty", supply_measured=True))
    nominal = replace(joint, sensors=replace(joint.sensors, effort="duty", supply_measured=False))

    assert evidence(nominal, "sag").ratio > 3.0 * evidence(measured, "sag").ratio


def test_what_holds_a_joint_fast_is_too_large_to_be_measured(monkeypatch):
    """No row moves, as with a cogging that the motor cannot pass: no size can be made of what is left of none."""
    joint = short(draw_joint(9), 4)
    floor = floor_of(joint, "")
    held = [
        replace(one, channels={**one.channels, "position_rad": np.zeros(len(one.effort))})
        for one in record(joint, quiet=True)
    ]
    monkeypatch.setattr(oracle, "record_beside", lambda *_: (held, held))
    assert evidence(joint, "", floor).ratio == np.inf


def test_the_evidence_grows_with_the_size_and_is_none_without_the_channel():
    loose, tight = (short(draw_joint(9, ("tooth_loss",), (size,))) for size in (0.02, 0.2))
    floor = floor_of(loose, "tooth_loss")  # of the same joint without it
    small, large = (evidence(one, "tooth_loss", floor).ratio for one in (loose, tight))
    winding = short(draw_joint(9, ("hot_winding",), (1.0,)))
    control = winding.control._replace(voltage_drive=False)
    by_current = replace(winding, sensors=replace(winding.sensors, effort="current"), control=control)

    assert large > 3.0 * small
    assert evidence(winding, "hot_winding").detectability > 10.0
    assert evidence(by_current, "hot_winding").ratio < NOTHING


def test_an_unknown_mechanism_is_refused_by_name():
    with pytest.raises(ValueError, match="nonsense"):
        draw_joint(1, ("nonsense",), (1.0,))


@pytest.mark.parametrize("seed", range(200, 204))
def test_a_joint_led_along_its_own_motion_needs_the_effort_that_it_had(seed):
    joint = short(draw_joint(seed, level="foreign" if seed % 2 else "textbook"))

    assert evidence(joint, "").ratio < NOTHING


def test_a_mechanism_too_small_to_show_has_no_evidence_though_each_run_sticks_at_other_moments():
    joint = short(draw_joint(9, ("backlash",), (1e-6,)))
    found, without = record(joint, quiet=True), record(joint, quiet=True, without=frozenset({"backlash"}))

    assert any(np.abs(one.effort - two.effort).max() > 0.0 for one, two in zip(found, without, strict=True))
    assert evidence(joint, "backlash").ratio < 0.1  # flanks give way a little, however small the gap


@pytest.mark.parametrize("held", [0.0, 1.0])
def test_of_a_difference_counts_what_the_recording_itself_has_of_it(monkeypatch, held):
    """What a joint without the mechanism would have needed, and nobody has measured, is no evidence."""
    joint = short(draw_joint(9), 4)
    plain = record(joint, quiet=True)
    random = np.random.default_rng(1)
    unlike = [0.2 * np.std(one.effort) * random.standard_normal(len(one.effort)) for one in plain]
    with_it = [replace(one, effort=one.effort + held * by) for one, by in zip(plain, unlike, strict=True)]
    without = [replace(one, effort=one.effort - (1.0 - held) * by) for one, by in zip(plain, unlike, strict=True)]
    monkeypatch.setattr(oracle, "record_beside", lambda *_: (with_it, without))
    ratio = evidence(joint, "").ratio
    assert (ratio > 1.0) if held else (ratio < 0.1)


def test_a_spring_stands_out_by_what_the_weight_does_not_take_of_its_torque():
    joint = draw_joint(77, ("spring",), (2.0,))
    floor, spring = floor_of(joint, "spring"), joint.physics_of(joint.trials[0]).spring_n_m_rad
    rows = Rows.of(record(joint, quiet=True), joint.scales)
    weight = (1.0 / floor.left[rows.stratum])[rows.moving]
    base = base_columns(rows, joint.scales)[rows.moving] * weight[:, None]
    # what the effort channel makes of a torque: of a current, or of a voltage, by the motor's constant
    torque_per_effort = {
        "torque": 1.0 / joint.told.tolerance,
        "duty": joint.physics.torque_per_a / joint.physics.resistance_ohm,
    }
    per_n_m = 1.0 / torque_per_effort.get(joint.sensors.effort, joint.physics.torque_per_a)
    share = spring * per_n_m * rows.angle[rows.moving] * weight
    left = share - base @ np.linalg.lstsq(base, share, rcond=None)[0]

    assert evidence(joint, "spring", floor).ratio == pytest.approx(
        float(np.sqrt(np.mean(left**2))), rel=0.1, abs=NOTHING
    )


def test_the_laws_of_a_joint_stand_out_where_no_textbook_has_them():
    foreign, textbook = short(draw_joint(205, level="foreign")), short(draw_joint(205))

    assert laws_ratio(foreign, floor_of(foreign, "")) > 2.0 * NOTHING
    assert laws_ratio(textbook, floor_of(textbook, "")) == 0.0
