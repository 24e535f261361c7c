"""Which ranges an actuator has that does not tell them: its model's, or those that are written down."""

from collections.abc import Mapping

from drivers.errors import DriveConfigurationError
from drivers.mit.frames import Ranges


def chosen_ranges(device: str, model: str, models: Mapping[str, Ranges], written: tuple[float, float, float]) -> Ranges:
    """The ranges of a model, or written ones.

    Args:
        device: name used in messages.
        model: its name; "" where the ranges are written.
        models: ranges by name.
        written: of position [rad], speed [rad/s] and torque [N m]; 0 where they are the model's.

    Raises:
        DriveConfigurationError: neither, or both, or not all three: what a torque means would be a guess.
    """
    if model and not any(written):
        return models[model]
    if not model and all(written):
        return Ranges(*written)
    raise DriveConfigurationError(
        device,
        f"it does not tell what its numbers mean. drive.model is '{model}', position_range_rad, speed_range_rad_s and "
        f"torque_range_n_m are {written[0]:g}, {written[1]:g}, {written[2]:g}; either a model or all three are wanted, "
        "as its manual has them for its firmware: a wrong range is a wrong torque",
    )
