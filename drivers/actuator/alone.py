"""Two actuators of one id on a bus: both would turn, and be taken for one."""

from collections.abc import Callable

from drivers.errors import DriveConfigurationError


def check_alone(device: str, addresses: str, answers: Callable[[], int]) -> None:
    """See that one answers.

    Args:
        device: name used in messages.
        addresses: its addresses as the settings name them.
        answers: asks one question that moves nothing; how many answers came. Asked again where there are several: one
            that was late is no second actuator.

    Raises:
        DriveConfigurationError: more than one does.
    """
    count = answers()
    if count > 1:
        count = answers()
    if count > 1:
        raise DriveConfigurationError(
            device,
            f"{count} answers came to one question: there are two actuators with {addresses} on the bus. Give each an "
            "id of its own",
        )
