"""What every real drive's settings share: signs and zero, and the joint that comes of them and the rig."""

from typing import Literal

from pydantic import model_validator

from bench.config.drives.kind import DriveSettings
from bench.config.quantities import quantity
from bench.config.rig import Rig, Section
from bench.errors import ConfigurationError
from drivers.joint import JointScale

Sign = Literal[1, -1]


class HomingSettings(Section):
    """How `friction-bench doctor --home` finds the zero again: bounded in way, speed, current and time."""

    method: Literal["end-stop", "absolute", "drive"] = quantity(
        ...,
        "",
        "'end-stop': the joint is moved slowly against a stop; 'absolute': nothing moves, the encoder keeps its count, "
        "and one that is off by whole motor turns is noticed; 'drive': the drive homes by itself (CANopen, mode 6)",
    )
    drive_method: int | None = quantity(
        None,
        "",
        "With 'drive': number of its homing method (0x6098), by its manual; 33 and 34 look for the index pulse",
        ge=-128,
        le=127,
    )
    angle_rad: float = quantity(0.0, "rad", "Joint angle at the end stop, or where the drive is at home; 0 hangs down")
    direction: Sign = quantity(1, "", "Which way the joint turns to the end stop: 1 to positive angles")
    speed_rad_s: float = quantity(0.2, "rad/s", "Speed of the search", gt=0, le=2)
    slow_speed_rad_s: float = quantity(
        0.05, "rad/s", "With 'drive': towards index pulse or edge (0x6099:02)", gt=0, le=2
    )
    acceleration_rad_s2: float = quantity(2.0, "rad/s2", "With 'drive': acceleration of the search (0x609A)", gt=0)
    current_a: float = quantity(0.5, "A", "Highest motor current of the search, so also against the stop", gt=0)
    travel_rad: float = quantity(3.0, "rad", "Longest way of the search", gt=0, le=12)
    back_off_rad: float = quantity(0.1, "rad", "Way back from the stop before it is approached again", gt=0, le=1)
    stand_s: float = quantity(0.2, "s", "Standstill under that current that counts as the stop", ge=0.05, le=5)
    repeat_rad: float = quantity(0.02, "rad", "Most that two approaches of the stop may differ by", gt=0, le=0.2)

    @model_validator(mode="after")
    def _check_number(self) -> "HomingSettings":
        if self.method == "drive" and self.drive_method is None:
            raise ValueError("method is 'drive': say which by drive_method, the number that its manual has for 0x6098")
        return self


class RealDriveSettings(DriveSettings):
    """Signs, zero, loads. `friction-bench doctor` prints what stands now, and checks it with a small move."""

    motor_sign: Sign = quantity(1, "", "-1 where a positive demand turns the joint to negative angles")
    encoder_sign: Sign = quantity(1, "", "-1 where the count falls while the joint turns to positive angles")
    zero_rad: float = quantity(0.0, "rad", "Joint angle by the drive's count while the arm hangs straight down")
    homing: HomingSettings | None = quantity(None, "", "How the zero is found again after a power cycle")
    side_channel: str = quantity(
        "", "", "Only of a simulated device: where its loads are hung, as host:port; left out: a person is asked"
    )


def joint_scale(settings: RealDriveSettings, rig: Rig) -> JointScale:
    """The joint as a drive has to know it.

    Raises:
        ConfigurationError: the rig leaves out the encoder's counts or the gear ratio, or tells of one at the joint.
    """
    if rig.sensor.at == "joint":
        raise ConfigurationError(
            f"rig '{rig.name}': sensor.at is \"joint\"; a real drive counts turns of its motor: "
            "leave sensor.at out, and give the counts of a motor turn"
        )
    if rig.sensor.counts_per_turn is None or rig.gear.ratio is None:
        raise ConfigurationError(
            f"rig '{rig.name}': a real drive needs sensor.counts_per_turn and gear.ratio to turn counts into joint "
            "angles; add them to the rig"
        )
    return JointScale(
        counts_per_turn=rig.sensor.counts_per_turn,
        gear_ratio=rig.gear.ratio,
        motor_sign=settings.motor_sign,
        encoder_sign=settings.encoder_sign,
        zero_rad=settings.zero_rad,
    )
