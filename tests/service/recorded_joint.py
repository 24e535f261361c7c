"""A recording set of a joint whose equation is known: viscous friction that differs by direction is in it."""

import io
import zipfile

import numpy as np

from tests.service.running_service import RunningService

RIG = 'name = "known joint"\nhorizontal = true\n'
INERTIA_KG_M2, VISCOUS_N_M_S, ASYMMETRY_N_M_S, COULOMB_N_M, NOISE_N_M = 0.02, 0.03, 0.012, 0.05, 0.004
RATE_HZ, DURATION_S = 200.0, 8.0
AMPLITUDES_RAD = (0.6, 0.9, 1.2)
REPEATS = (1, 2)


def recording_set_zip() -> bytes:
    """Six trials: three amplitudes, twice each."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        archive.writestr("rig.toml", RIG)
        rows = ["file,kind,amplitude_rad,repeat"]
        for number, (amplitude_rad, repeat) in enumerate((a, r) for a in AMPLITUDES_RAD for r in REPEATS):
            name = f"swing-{amplitude_rad:g}-{repeat}.csv"
            rows.append(f"{name},swing,{amplitude_rad:g},{repeat}")
            archive.writestr(name, _trial(amplitude_rad, seed=number))
        archive.writestr("trials.csv", "\n".join(rows) + "\n")
    return buffer.getvalue()


def _trial(amplitude_rad: float, seed: int) -> str:
    random = np.random.default_rng(seed)
    time_s = np.arange(0.0, DURATION_S, 1.0 / RATE_HZ)
    position, velocity, acceleration = (np.zeros_like(time_s) for _ in range(3))
    for frequency_hz, share in ((0.25, 0.7), (0.65, 0.3)):
        omega, phase = 2 * np.pi * frequency_hz, random.uniform(0, 2 * np.pi)
        position += amplitude_rad * share * np.sin(omega * time_s + phase)
        velocity += amplitude_rad * share * omega * np.cos(omega * time_s + phase)
        acceleration -= amplitude_rad * share * omega**2 * np.sin(omega * time_s + phase)
    torque = INERTIA_KG_M2 * acceleration + VISCOUS_N_M_S * velocity + ASYMMETRY_N_M_S * np.abs(velocity)
    torque += COULOMB_N_M * np.sign(velocity) + NOISE_N_M * random.standard_normal(len(time_s))
    lines = [f"{row[0]:.4f},{row[1]!r},{row[2]!r}" for row in np.column_stack([time_s, position, torque]).tolist()]
    return "time_s,position_rad,torque_n_m\n" + "\n".join(lines) + "\n"


def study_path(service: RunningService, name: str) -> str:
    """Import the set, make a study of it, and return the study's path."""
    headers = {"Content-Type": "application/zip"}
    made = service.client.post(f"/recording-sets?name={name}", content=recording_set_zip(), headers=headers).json()
    body = {"name": name, "experiment_ids": [made["experiment_id"]]}
    return f"/studies/{service.client.post('/studies', json=body).json()['study_id']}"
