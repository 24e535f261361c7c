"""What the strokes at one level showed, as the results of a trial."""

from collections.abc import Sequence

from bench.experiments.analysis.saturation import Ending
from bench.experiments.parts.stroke import Held, Window
from bench.json_types import Value, known


def steady_speed_results(
    windows: Sequence[Window], ending: Ending, remaining_rad_s: float, held: Held, ratio: float, least_window_s: float
) -> dict[str, Value]:
    """Results along the direction: positive where they go with it. The last stroke's, and what every stroke measured.

    Args:
        windows: of all strokes at this level, one or more.
        ending: why there were no more.
        remaining_rad_s: speed of the joint still to come; NaN where not known.
        held: what was held.
        ratio: of the gear.
        least_window_s: the shortest window that counts where the speed is not steady.

    Returns:
        speed_rad_s, motor_speed_rad_s: steady speed of the joint, of the motor shaft; 0 where it stalled.
        remaining_speed_rad_s: speed still to come, of the joint; None where not known.
        current_a: of the motor, measured or by eq. (3).
        measured_current_a: as the drive measures it; None where it does not.
        duty, supply_v: mean.
        window_s, strokes: length of the window measured, strokes that it took.
        saturated: True where the speed is steady within the tolerance.
        ending: in words.
        windows: what every stroke measured: motor_speed_rad_s, motor_acceleration_rad_s2, current_a, duty, window_s,
            and whether it is `usable` for a friction curve once the inertia of its acceleration is taken off.
    """
    window, saturated = windows[-1], ending is Ending.SATURATED
    return {
        "speed_rad_s": window.stroke.speed_rad_s,
        "motor_speed_rad_s": window.stroke.speed_rad_s * ratio,
        "remaining_speed_rad_s": known(remaining_rad_s),
        "current_a": window.current_a,
        "measured_current_a": known(window.measured_current_a),
        "duty": window.duty,
        "supply_v": known(window.supply_v),
        "window_s": window.seconds,
        "strokes": len(windows),
        "saturated": saturated,
        "ending": ending.value,
        "windows": [
            _shown(one, ratio) | {"usable": (saturated and one is window) or _gains(one, held, least_window_s)}
            for one in windows
        ],
    }


def _shown(window: Window, ratio: float) -> dict[str, Value]:
    return {
        "motor_speed_rad_s": window.stroke.speed_rad_s * ratio,
        "motor_acceleration_rad_s2": known(window.stroke.acceleration_rad_s2 * ratio),
        "current_a": window.current_a,
        "duty": window.duty,
        "window_s": window.seconds,
    }


def _gains(window: Window, held: Held, least_s: float) -> bool:
    """Whether the joint gains speed under what is held, its teeth in contact throughout.

    One that loses speed may have them parted: the arm coasts behind the gap, and the motor brakes itself alone. So may
    one under a servo, and one that has just been run up.
    """
    return held is not Held.SPEED and window.stroke.acceleration_rad_s2 > 0.0 and window.seconds >= least_s
