"""What goes into the estimate of a joint's load, cycle after cycle, and what comes out."""

from dataclasses import dataclass
from enum import Enum
from math import inf, nan
from typing import NamedTuple

from compensator.motion.joint_model import JointUnderLoad


class Branch(Enum):
    """Where the estimate comes from."""

    LOST = "no measurement"
    REST = "at rest"
    SEARCHING = "zero-speed search under way"
    STUCK = "stuck against something"
    STRUCK = "has struck something"
    LEAVING = "leaving what it leant on"
    MOVING = "in motion"
    TURNING = "turning, or setting off"


@dataclass(frozen=True, slots=True)
class EstimatorSettings:
    """How the estimate is made. Cycles are control cycles.

    Attributes:
        period_s: of the control loop.
        count_rad: one encoder count, at the joint.
        free_play_rad: backlash, at the joint.
        dead_band_rad: position error within which the servo counts as arrived.
        window: readings that speed and acceleration are taken from.
        rest_cycles: the joint is at rest when it has stood for more than this.
        stuck_cycles: it is stuck when it has stood for more than this outside of the dead-band.
        onset_cycles: by then a current that moves the joint has been seen to move it.
        blend_s: time constant with which the difference between two branches dies away.
    """

    period_s: float
    count_rad: float
    free_play_rad: float
    dead_band_rad: float
    window: int = 40
    rest_cycles: int = 20
    stuck_cycles: int = 40
    onset_cycles: int = 6
    blend_s: float = 0.1

    @property
    def latency_s(self) -> float:
        """Age of the estimate in motion [s]."""
        return (self.window - 1) / 2.0 * self.period_s


class RestResult(NamedTuple):
    """What a zero-speed search found.

    Attributes:
        load_current_a: I_load, eq. (9) [A].
        half_width_a: half of its 95 % interval [A].
        selector: what selects the friction curve: F_load of eq. (10), or the load; see `FrictionLookup.quantity`.
    """

    load_current_a: float
    half_width_a: float
    selector: float


class Observation(NamedTuple):
    """One control cycle.

    Attributes:
        position_rad: of the joint, as measured.
        current_a: of the motor, measured or by eq. (3).
        target_rad: the servo's set point; NaN where there is none, and nothing is called stuck.
        searching: a zero-speed search moves the joint.
        rest: what it found, in the cycle in which it ended.
        temperature_c: of the drive; NaN where it is not measured.
    """

    position_rad: float
    current_a: float
    target_rad: float = nan
    searching: bool = False
    rest: RestResult | None = None
    temperature_c: float = nan


class LoadEstimate(NamedTuple):
    """What the master may follow.

    Attributes:
        load_current_a: motor current of the load alone [A]; NaN before anything is known.
        half_width_a: half of the 95 % interval [A].
        branch: where it comes from.
        friction_current_a: what was taken for friction [A]; NaN where the branch takes none.
    """

    load_current_a: float
    half_width_a: float
    branch: Branch
    friction_current_a: float = nan


class Hit(NamedTuple):
    """What a joint struck, and what that left.

    Attributes:
        way: of the motion that it ended, 1 or -1.
        load_a: what teeth and wall, once pressed, hold between them [A].
        position_rad: where the joint came to rest.
        holds_rad: way from there, either way, within which it is still pressed.
        cycles: since it was seen.
    """

    way: float
    load_a: float
    position_rad: float
    holds_rad: float
    cycles: int = 0


class ArmState(NamedTuple):
    """The arm after a control cycle.

    Attributes:
        angle_rad, speed_rad_s: of the arm.
        motor_rad, motor_rad_s: of the motor's side, as measured.
        teeth_a: what the teeth passed on to the arm, mean over the cycle [A].
        side: flank that they touch on: 1 where the motor pushes forwards, -1 backwards, 0 between them.
    """

    angle_rad: float
    speed_rad_s: float
    motor_rad: float
    motor_rad_s: float
    teeth_a: float
    side: float


class EstimatorState(NamedTuple):
    """Everything the estimator remembers between cycles."""

    selector: float
    joint: JointUnderLoad | None = None  # the model at the selector
    positions_rad: tuple[float, ...] = ()
    currents_a: tuple[float, ...] = ()
    arms: tuple[ArmState, ...] = ()  # where the arm was, behind the free play
    mores_a: tuple[float, ...] = ()  # load beyond the weight that it was taken to have then
    extreme_rad: float = nan  # farthest in the present direction
    direction: float = 0.0  # of the last motion
    turned_rad: float = nan  # where it last turned back
    came_rad: float = 0.0  # way of the motion before that
    moving_cycles: int = 0  # in one direction, without a rest
    still_cycles: int = 0
    rest: RestResult | None = None  # of the present rest
    estimate: LoadEstimate = LoadEstimate(nan, inf, Branch.LOST)
    known_a: float = nan  # what was given out, less the load's gravity by the model
    offset_a: float = 0.0  # of the output over the present branch's own value
    hit: Hit | None = None  # that ended the last motion, while it holds
    leant: bool = False  # it has been stuck, and not come into motion since
    mean_a: float = nan  # of `known_a` in motion, and its variance, over the last few windows
    variance_a2: float = 0.0
