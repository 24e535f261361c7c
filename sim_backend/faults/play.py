"""Plays a fault script on a plant and on the samples that a drive takes of it."""

from collections import deque

from drivers.contract import Sample
from sim_backend.faults.script import (
    ClutchSlips,
    EncoderJump,
    EncoderStuck,
    FaultScript,
    LoadFalls,
    OverTemperature,
    SamplesLate,
    SupplyLost,
)
from sim_backend.plant.plant import Plant


class FaultPlay:
    """What a script does to plant and samples; what it does to the power stage is the drive's own affair."""

    def __init__(self, script: FaultScript, plant: Plant) -> None:
        self._script = script
        self._plant = plant
        self._clutch_n_m = plant.parameters.clutch.limit_n_m
        self._fallen: LoadFalls | None = None
        self._stuck_rad: float | None = None
        self._past: deque[Sample] = deque()

    def work_on_plant(self) -> None:
        """Let the clutch slip and the load fall, when it is time."""
        time_s = self._plant.time_s
        slips = self._script.holding(ClutchSlips, time_s)
        limit_n_m = slips.limit_n_m if slips else self._clutch_n_m
        if limit_n_m != self._plant.parameters.clutch.limit_n_m:
            self._plant.loosen_clutch(limit_n_m)
        falls = self._script.holding(LoadFalls, time_s)
        # once for each fault: a load that is hung on again stays
        if falls is not None and falls is not self._fallen:
            self._fallen = falls
            self._plant.drop_load()

    def falsify(self, sample: Sample) -> Sample:
        """Return a sample as the faulty drive shows it."""
        seen = self._with_encoder_faults(sample)
        if self._script.holding(SupplyLost, sample.time_s):
            seen = seen._replace(supply_v=0.0)
        hot = self._script.holding(OverTemperature, sample.time_s)
        if hot and sample.temperature_c == sample.temperature_c:  # it measures one
            seen = seen._replace(temperature_c=hot.temperature_c)
        return self._late(seen)

    def _with_encoder_faults(self, sample: Sample) -> Sample:
        jump = self._script.holding(EncoderJump, sample.time_s)
        if jump:
            window_s = self._plant.parameters.encoder.speed_window_s
            news = self._script.time_of(jump, sample.time_s) - jump.start_s < window_s
            sample = sample._replace(
                position_rad=sample.position_rad + jump.jump_rad,
                velocity_rad_s=sample.velocity_rad_s + (jump.jump_rad / window_s if news else 0.0),
            )
        if not self._script.holding(EncoderStuck, sample.time_s):
            self._stuck_rad = None
            return sample
        if self._stuck_rad is None:
            self._stuck_rad = sample.position_rad
        return sample._replace(position_rad=self._stuck_rad, velocity_rad_s=0.0)

    def _late(self, sample: Sample) -> Sample:
        self._past.append(sample)
        late = self._script.holding(SamplesLate, sample.time_s)
        if late is None:
            while len(self._past) > 1 and sample.time_s - self._past[0].time_s > 1.0:
                self._past.popleft()
            return sample
        # the newest sample that is old enough
        while len(self._past) > 1 and sample.time_s - self._past[1].time_s >= late.age_s - 5e-10:
            self._past.popleft()
        old = self._past[0]
        return old._replace(time_s=sample.time_s, age_s=sample.time_s - old.time_s, status=sample.status)
