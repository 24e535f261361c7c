"""Speed of the joint from the last few readings; 0 while they stay within what one encoder count can do."""

from typing import NamedTuple

from compensator.motion.load_estimate import EstimatorSettings

READINGS = 5


class SpeedState(NamedTuple):
    """The last readings, the oldest first."""

    positions_rad: tuple[float, ...] = ()

    @property
    def step_rad(self) -> float:
        """Way of the last cycle."""
        return self.positions_rad[-1] - self.positions_rad[-2] if len(self.positions_rad) > 1 else 0.0


def follow(state: SpeedState, settings: EstimatorSettings, position_rad: float) -> tuple[SpeedState, float]:
    """The next state, and the speed [rad/s]."""
    positions = (*state.positions_rad, position_rad)[-READINGS:]
    way_rad = positions[-1] - positions[0]
    if abs(way_rad) <= 1.5 * settings.count_rad:
        return SpeedState(positions), 0.0
    return SpeedState(positions), way_rad / ((len(positions) - 1) * settings.period_s)
