"""What the settings of every simulated device say: the joint behind it, its port, its side channel."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from sim_backend.devices.axis import Device
from sim_backend.devices.joint_tables import behind_a_drive
from sim_backend.devices.process import Port, RunningDevice, Workplace
from sim_backend.plant.parameters import PlantParameters


@dataclass(frozen=True, kw_only=True)
class Served:
    """The joint behind a device, and where the device is found.

    Attributes:
        link: symbolic link to put on the pseudo-terminal; None: none.
        plant: tables that differ from it.
        seed: of the first joint; the others have the next ones.
        side_port: TCP port of the side channel; 0 is any free one.
        patience_s: how far time goes without a word of the host while the joint is at work [s]; None: for ever.
    """

    link: Path | None = None
    preset: str = "paper"
    plant: Mapping[str, Any] | None = None
    seed: int = 1
    side_port: int = 0
    patience_s: float | None = None

    def joint(self, measured: Mapping[str, Any] | None = None) -> PlantParameters:
        """Return the joint.

        Args:
            measured: tables of what this kind of drive measures.

        Raises:
            ParameterError: it cannot be.
        """
        return behind_a_drive(self.preset, measured, self.plant)

    def running(self, device: Device, make_port: Callable[[Workplace], Port]) -> RunningDevice:
        """Return the device at work.

        Raises:
            OSError: the link or the side channel's port is taken.
        """
        return RunningDevice(device, make_port, self.side_port, self.patience_s)
