import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from sim_backend.mechanisms.motor.motor import BRAKE, CURRENT, OPEN, VOLTAGE
from sim_backend.plant import presets
from sim_backend.plant.parameters import PlantParameters
from sim_backend.plant.plant import Plant
from tests.sim_backend.plants import parameters

EVERYTHING = {
    "motor": {"inductance_h": 1e-3},
    "load": {"mass_kg": 0.1},
    "viscous_asymmetry": {"fraction": 0.2},
    "coulomb_asymmetry": {"fraction": -0.1},
    "drag": {"coefficient_n_m_s2_rad2": 1e-7},
    "periodic_friction": {"fraction": 0.2, "cycles_per_turn": 20.0},
    "spring": {"stiffness_n_m_rad": 0.2, "rest_rad": 0.5},
    "centre_of_mass": {"angle_rad": 0.1},
    "lubricant": {"vogel_k": 1000.0},
    "heat": {"present": True},
    "bristle": {"stiffness_n_m_rad": 2.0, "damping_n_m_s_rad": 4e-3, "elastic_fraction": 0.3},
    "arm_bristle": {"stiffness_n_m_rad": 5.0, "damping_n_m_s_rad": 0.02},
    "run_in": {"fraction": 0.5},
    "clutch": {"limit_n_m": 0.6},
    "shaft": {"compliance_rad_n_m": 1e-3},
    "wall": {"present": True, "angle_rad": 1.0, "stiffness_n_m_rad": 3000.0, "damping_n_m_s_rad": 1.0},
    "end_stops": {"present": True, "lower_rad": -2.0, "upper_rad": 1.0005, "damping_n_m_s_rad": 0.0},
    "operator": {"present": True, "grip_s": 5.0, "release_s": 35.0, "amplitude_rad": 0.5, "strength_n": 3.0},
    "dwell": {"rise_fraction": 0.3},
    "arm_dwell": {"rise_fraction": 0.3},
    "load_friction": {"driving": 0.3, "back_driving": 0.2},
    "supply": {"source_resistance_ohm": 0.5},
    "cogging": {"amplitude_n_m": 2e-3},
    "dead_time": {"time_s": 2e-6},
    "hose": {"stiffness_n_m_rad": 0.4, "reach_rad": 0.3},
    "friction_jump": {"fraction": 0.5, "mean_interval_s": 0.5},
    "supply_ripple": {"fraction": 0.1, "frequency_hz": 7.0},
    "thermal_drift": {"resistance_per_k": 0.0039, "torque_constant_per_k": 0.002},
    "current_sensor": {"present": True},
    "current_loop": {"present": True},
}


def _mixed_run(plant: Plant, seed: int, pieces: int) -> tuple[float, float]:
    """Random demands on a plant. Returns (what the energy balance leaves over, the energy that went through) [J]."""
    random = np.random.default_rng(seed)
    began = plant.energy().stored_j
    for _ in range(pieces):
        stage = int(random.choice([OPEN, VOLTAGE, VOLTAGE, VOLTAGE, CURRENT, BRAKE]))
        plant.advance(stage, float(random.uniform(-0.6, 0.6)), round(random.integers(50, 3000) * 1e-4 / plant.step_s))
    energy = plant.energy()
    return energy.supplied_j - energy.lost_j - (energy.stored_j - began), energy.lost_j


def test_energy_balance_closes_over_a_long_mixed_run_with_every_mechanism_on() -> None:
    busy = Plant(PlantParameters.from_dict(EVERYTHING, presets.paper()), seed=3)
    left_over_j, through_j = _mixed_run(busy, seed=3, pieces=400)
    assert through_j > 50.0
    assert abs(left_over_j) < 1e-6 * through_j


@settings(max_examples=60)
@given(
    seed=st.integers(0, 2**32 - 1),
    ratio=st.floats(1.0, 100.0),
    backlash=st.one_of(st.just(0.0), st.floats(0.0, 0.05)),
    stiffness=st.floats(50.0, 3e4),
    damping=st.floats(0.0, 5.0),
    compliance=st.one_of(st.just(0.0), st.floats(0.0, 1e-2)),
    clutch=st.one_of(st.just(0.0), st.floats(0.05, 2.0)),
    load=st.floats(0.0, 0.3),
    coulomb=st.floats(0.0, 0.02),
    rise=st.floats(1.0, 2.0),
    stribeck=st.floats(0.5, 50.0),
    viscous=st.floats(0.0, 1e-3),
    mesh=st.floats(0.0, 0.6),
    dwell=st.floats(0.0, 1.0),
    bristles=st.one_of(st.just(0.0), st.floats(0.01, 50.0)),
    arm_bristles=st.one_of(st.just(0.0), st.floats(0.1, 500.0)),
    micro=st.floats(0.0, 1.0),
    elastic=st.floats(0.0, 0.95),
    inductance=st.floats(0.0, 5e-3),
    source=st.floats(0.0, 2.0),
    dead_s=st.floats(0.0, 1e-5),
    wall=st.booleans(),
    wall_rad=st.floats(0.01, 1.0),
    stops=st.booleans(),
    stop_rad=st.floats(0.01, 1.0),
    surface=st.floats(10.0, 9e5),
    surface_damping=st.floats(0.0, 20.0),
)
def test_no_plant_blows_up_or_makes_energy(
    seed: int, ratio: float, backlash: float, stiffness: float, damping: float, compliance: float, clutch: float,
    load: float, coulomb: float, rise: float, stribeck: float, viscous: float, mesh: float, dwell: float,
    bristles: float, arm_bristles: float, micro: float, elastic: float, inductance: float, source: float,
    dead_s: float, wall: bool, wall_rad: float, stops: bool, stop_rad: float, surface: float, surface_damping: float,
) -> None:  # fmt: skip
    friction = {"coulomb_n_m": coulomb, "static_n_m": rise * coulomb, "stribeck_rad_s": stribeck}
    bristle = {"damping_n_m_s_rad": micro * 9.0 * coulomb / stribeck, "elastic_fraction": elastic}
    surface_of = {"stiffness_n_m_rad": surface, "damping_n_m_s_rad": surface_damping}
    drawn = parameters(
        motor={"inductance_h": inductance, "rotor_inertia_kg_m2": 5e-5},
        supply={"source_resistance_ohm": source},
        dead_time={"time_s": dead_s},
        arm={"inertia_kg_m2": 0.01},
        gear={
            "ratio": ratio,
            "backlash_rad": backlash,
            "stiffness_n_m_rad": min(stiffness, 4e5 * ratio**2 * 5e-5),
            "damping_n_m_s_rad": damping,
        },
        shaft={"compliance_rad_n_m": compliance},
        clutch={"limit_n_m": clutch},
        load={"mass_kg": load},
        friction=friction | {"viscous_n_m_s_rad": viscous},
        arm_friction=friction,
        load_friction={"driving": mesh, "back_driving": mesh},
        dwell={"rise_fraction": dwell},
        bristle=bristle | {"stiffness_n_m_rad": bristles},
        arm_bristle=bristle | {"stiffness_n_m_rad": arm_bristles},
        wall=surface_of | {"present": wall, "angle_rad": wall_rad},
        end_stops=surface_of
        | {"present": stops, "lower_rad": -stop_rad, "upper_rad": 0.9 * stop_rad + wall * wall_rad},
        current_sensor={"present": True},
        current_loop={"present": True},
    )
    # at the coarsest step there is, also for the stiffest contact that it allows
    mixed = Plant(drawn, seed)
    left_over_j, through_j = _mixed_run(mixed, seed, pieces=12)
    truth = mixed.truth()
    assert all(np.isfinite(getattr(truth, name)) for name in truth.__dataclass_fields__)
    assert mixed.energy().stored_j >= 0.0
    assert abs(left_over_j) <= 1e-3 * through_j + 1e-6
    # nothing sticks for ever: a torque that no friction can hold moves the rotor, unless something stands in its way
    before = mixed.truth()
    mixed.advance(VOLTAGE, 1.0, 3000)
    after = mixed.truth()
    assert after.rotor_rad != before.rotor_rad or after.leant_n_m != 0.0
