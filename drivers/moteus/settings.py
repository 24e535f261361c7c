"""What has to be known of a moteus controller before it is opened."""

from dataclasses import dataclass

from drivers.can_bus.settings import BusSettings


@dataclass(frozen=True, slots=True)
class MoteusSettings:
    """How to reach one controller.

    Attributes:
        port: serial port of the adapter, or of the UART; "" with a bus.
        bus: CAN-FD bus of python-can; None with a port.
        servo_id: of the controller, 1 .. 126.
        over_uart: True where the port is the controller's own UART: lines have checksums there.
        watchdog_s: silence after which it stops [s]; goes out with every torque.
        answer_timeout_s: longest wait for the answers of a cycle [s].
    """

    port: str = ""
    bus: BusSettings | None = None
    servo_id: int = 1
    over_uart: bool = False
    watchdog_s: float = 0.2
    answer_timeout_s: float = 0.05

    @property
    def device(self) -> str:
        """The name used in messages."""
        return f"{self.place} servo {self.servo_id}"

    @property
    def place(self) -> str:
        """What it is on."""
        return self.port if self.bus is None else str(self.bus)
