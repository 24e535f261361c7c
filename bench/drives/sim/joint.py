"""What only a simulated joint has: the operator's hand and the environment in software, and torques that are known."""

from math import nan
from typing import TYPE_CHECKING

from drivers.contract import Drive

if TYPE_CHECKING:
    from sim_backend.drive.simulated_drive import SimulatedDrive
    from sim_backend.environment.surroundings import Hand, Surroundings


def wall_torque_n_m(drive: Drive) -> float:
    """Torque [N m] with which a wall or an end stop pushes the arm of a simulated joint; NaN of a real one."""
    from sim_backend.drive.simulated_drive import SimulatedDrive

    return drive.plant.truth().leant_n_m if isinstance(drive, SimulatedDrive) else nan


def beside_arm(drive: "SimulatedDrive") -> "tuple[Hand, Surroundings]":
    """The operator's hand on the arm of a simulated drive, and what that arm meets."""
    from sim_backend.environment.surroundings import Hand, Surroundings

    return Hand(drive.plant), Surroundings(drive.plant)
