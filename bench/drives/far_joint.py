"""The joint behind a simulated device in another process: loads are hung over the device's side channel."""

from bench.errors import ExperimentError


class FarJoint:
    """A simulated device, as far as loads go.

    Args:
        side_channel: host:port, as the device has printed it.
    """

    def __init__(self, side_channel: str) -> None:
        self._side_channel = side_channel

    def hang_load(self, load_kg: float, balanced: bool) -> None:
        """Hang a load.

        Raises:
            ExperimentError: the device says no, or is not there.
        """
        self._ask(f"the load of {load_kg * 1000:g} g was not hung", "hang", load_kg=load_kg, balanced=balanced)

    def hold_arm(self, angle_rad: float) -> None:
        """Turn the arm by hand, and hold it.

        Raises:
            ExperimentError: as `hang_load`.
        """
        self._ask(f"the arm was not turned to {angle_rad:.3g} rad", "hold", angle_rad=angle_rad)

    def release_arm(self) -> None:
        """Let go of the arm.

        Raises:
            ExperimentError: as `hang_load`.
        """
        self._ask("the arm was not let go", "release")

    def _ask(self, failure: str, deed: str, **values: float) -> None:
        from sim_backend.devices.side_channel_client import ask_once
        from sim_backend.errors import ParameterError

        try:
            ask_once(self._side_channel, deed, **values)
        except (ParameterError, OSError, ValueError) as error:
            raise ExperimentError(
                f"{failure}: drive.side_channel '{self._side_channel}': {error}; is the simulated device running, and "
                "is that what it printed?"
            ) from error
