"""What a simulated drive says of itself."""

from collections.abc import Iterable
from functools import cache
from importlib.metadata import version
from math import pi

from drivers.contract import Description, Mode
from sim_backend.plant.parameters import PlantParameters
from sim_backend.plant.plant import COARSEST_STEP_S


def describe(
    device: str, parameters: PlantParameters, seed: int, modes: Iterable[Mode], watchdog_s: float
) -> Description:
    """Return identity and capabilities of a simulated drive."""
    count_rad = 2.0 * pi / (parameters.encoder.counts_per_turn * parameters.gear.ratio)
    resolution = {
        "position_rad": count_rad,
        "velocity_rad_s": count_rad / parameters.encoder.speed_window_s,
        "duty": 1.0 / parameters.supply.duty_counts,
    }
    if parameters.current_sensor.present and parameters.current_sensor.resolution_a > 0.0:
        resolution["current_a"] = parameters.current_sensor.resolution_a
    return Description(
        device=device,
        vendor="friction-bench",
        product="simulated joint",
        firmware=_firmware(),
        serial=f"seed {seed}",
        simulated=True,
        modes=frozenset(modes),
        measured=frozenset(_measured(parameters)),
        resolution=resolution,
        max_rate_hz=1.0 / COARSEST_STEP_S,
        watchdog_s=watchdog_s,
    )


@cache
def _firmware() -> str:
    """Version of this software; looking for it among what is installed takes longer than starting the drive."""
    return version("friction-bench")


def _measured(parameters: PlantParameters) -> set[str]:
    measured = {"time_s", "position_rad", "velocity_rad_s", "duty", "supply_v"}
    if parameters.current_sensor.present:
        measured.add("current_a")
    if parameters.heat.present:
        measured.add("temperature_c")
    return measured
