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
        from sim_backend.devices.side_channel_client import ask_once
        from sim_backend.errors import ParameterError

        try:
            ask_once(self._side_channel, "hang", load_kg=load_kg, balanced=balanced)
        except (ParameterError, OSError, ValueError) as error:
            raise ExperimentError(
                f"the load of {load_kg * 1000:g} g was not hung: drive.side_channel '{self._side_channel}': {error}; "
                "is the simulated device running, and is that what it printed?"
            ) from error
