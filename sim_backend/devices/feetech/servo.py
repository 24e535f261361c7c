"""One STS servo: answers packets, drives in open loop or to a position. It has no watchdog."""

from struct import pack_into, unpack_from

from drivers.contract import Sample
from sim_backend.devices.axis import CURRENT, OFF, VOLTAGE, Axis, Demand
from sim_backend.devices.feetech.packets import EVERYBODY, Instruction, status
from sim_backend.devices.servos.position_hold import PositionHold, count_rad
from sim_backend.faults.script import tripped
from sim_backend.plant.parameters import PlantParameters

SIMULATED_FIRMWARE = (255, 255)
STS3215 = 777
TURN = 4096
VOLTAGE_BIT, HEAT_BIT, CURRENT_BIT, OVERLOAD_BIT = 1, 4, 8, 32
_MEASURED = range(56, 72)
_READ_ONLY = (range(5), _MEASURED)
LOWEST, HIGHEST, MODE, TORQUE, GOAL, GOAL_TIME, LIMIT, LOCK, STATUS = 9, 11, 33, 40, 42, 44, 48, 55, 65
# as delivered: it answers everything, 70 degC, 0.1 V from 4.0 on, gains; what is not here is 0
_DELIVERED = {8: 1, 13: 70, 14: 255, 15: 40, 21: 32, 22: 32, LOCK: 1}
_SIZE = 96
_CURRENT_STEP_A = 0.0065
_STALL_A = 2.7


class StsServo:
    """A servo whose output shaft is the motor's side of the joint.

    Args:
        parameters: the joint; its encoder has 4096 counts.
        servo_id: 0 .. 253.
        seed: of the plant.
        offset: counts by which its position differs from the joint's.
    """

    def __init__(self, parameters: PlantParameters, servo_id: int = 1, seed: int = 0, offset: int = 0) -> None:
        self.axis = Axis(parameters, self, seed)
        self._bytes = bytearray(_SIZE)
        self._bytes[0:2] = bytes(SIMULATED_FIRMWARE)
        self._put(3, "H", STS3215)
        self._bytes[5] = servo_id
        for address, value in _DELIVERED.items():
            self._bytes[address] = value
        for address, value in ((HIGHEST, TURN - 1), (16, 1000), (LIMIT, 1000)):
            self._put(address, "H", value)
        self._offset = offset
        self._hold = PositionHold(parameters)
        self._count_rad = count_rad(parameters)

    @property
    def servo_id(self) -> int:
        """To what it answers."""
        return self._bytes[5]

    def report(self) -> dict[str, object]:
        """Say what the servo is about."""
        return {"kind": "feetech", "torque_enabled": bool(self._bytes[TORQUE]), "status": self._bytes[STATUS]}

    # the real-time half ----------------------------------------------------------------------------------

    def demand(self, seen: Sample) -> Demand:
        """Return what the stage does for the coming tick."""
        trip = self.axis.trip()
        wrong = trip is not None or self.axis.torque_is_disabled()
        self._bytes[STATUS] = tripped(trip, HEAT_BIT, CURRENT_BIT, VOLTAGE_BIT, OVERLOAD_BIT) if wrong else 0
        if wrong:
            self._bytes[TORQUE] = 0
        if self._bytes[TORQUE] != 1:
            return OFF
        limit = self._get(LIMIT, "H") / 1000.0
        if self._bytes[MODE] == 2:
            return Demand(VOLTAGE, max(-limit, min(limit, _magnitude(self._get(GOAL_TIME, "H"), 10) / 1000.0)))
        goal, lowest, highest = (self._get(address, "H") for address in (GOAL, LOWEST, HIGHEST))
        if highest > lowest:  # 0 and 0: any, over several turns
            goal = max(lowest, min(highest, goal))
        target_rad = (goal - self._offset) * self._count_rad
        limit_a = limit * _STALL_A
        return Demand(CURRENT, max(-limit_a, min(limit_a, self._hold.current_a(target_rad, seen))))

    # the packets -----------------------------------------------------------------------------------------

    def hear(self, request: Instruction, time_s: float) -> bytes:  # noqa: ARG002
        """Take a packet, whoever it is for."""
        if request.servo not in (self.servo_id, EVERYBODY):
            return b""
        self._measure()
        parameters = request.parameters
        match request.code:
            case 1:
                return self._status()
            case 2 if len(parameters) == 2 and sum(parameters) <= _SIZE:
                return self._status(self._read(*parameters))
            case 3 if parameters:
                self._write(parameters[0], parameters[1:])
                return self._status() if request.servo != EVERYBODY else b""
            case 0x82 if self.servo_id in parameters[2:] and sum(parameters[:2]) <= _SIZE:
                return self._status(self._read(*parameters[:2]))
            case 0x83:
                address, size = parameters[:2]
                for start in range(2, len(parameters), size + 1):
                    if parameters[start] == self.servo_id:
                        self._write(address, parameters[start + 1 : start + 1 + size])
        return b""

    def _read(self, address: int, size: int) -> bytes:
        return bytes(self._bytes[address : address + size])

    def _write(self, address: int, data: bytes) -> None:
        """Set what may be set; what may not stays as it is, and nobody is told."""
        for offset, byte in enumerate(data):
            place = address + offset
            refused = place >= _SIZE or any(place in span for span in _READ_ONLY)
            if refused or (place == MODE and self.axis.mode_is_refused()):
                continue
            self._bytes[place] = byte

    def _status(self, data: bytes = b"") -> bytes:
        return status(self.servo_id, self._bytes[STATUS], data)

    def _measure(self) -> None:
        """Bring the measured items up to date."""
        seen = self.axis.seen
        self._put(56, "H", (self.axis.counts() + self._offset) % TURN)
        self._put(58, "H", _word(self.axis.counts_per_s(), 15))
        self._put(60, "H", _word(seen.duty * 1000.0, 10))
        self._bytes[62] = min(round(seen.supply_v * 10.0), 255)
        self._bytes[63] = round(self.axis.temperature_c)
        self._bytes[66] = int(seen.velocity_rad_s != 0.0)
        self._put(69, "H", _word(self.axis.current_a / _CURRENT_STEP_A, 15))

    def _put(self, address: int, letter: str, value: int) -> None:
        pack_into("<" + letter, self._bytes, address, value)

    def _get(self, address: int, letter: str) -> int:
        return int(unpack_from("<" + letter, self._bytes, address)[0])


def _word(value: float, sign_bit: int) -> int:
    """Return a number as magnitude and a bit of its own for the sign."""
    magnitude = min(round(abs(value)), (1 << sign_bit) - 1)
    return magnitude + (1 << sign_bit if value < 0.0 and magnitude else 0)


def _magnitude(word: int, sign_bit: int) -> int:
    sign = 1 << sign_bit
    return sign - word if word >= sign else word
