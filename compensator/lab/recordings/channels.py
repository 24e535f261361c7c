"""The channels a recording may have: one table of names, units and meanings.

The unit is part of the name and is SI (angles in rad, temperature in deg C).
"""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Channel:
    """One column of a recording: its name, its unit, and what it means."""

    name: str
    unit: str
    meaning: str


CHANNELS: dict[str, Channel] = {
    channel.name: channel
    for channel in (
        Channel("time_s", "s", "time since the start of the trial"),
        Channel("target_rad", "rad", "position set point, joint side"),
        Channel("target_m", "m", "position set point of a linear joint"),
        Channel("position_rad", "rad", "motor-side position / gear ratio; 0 is vertically down"),
        Channel("position_m", "m", "position of a linear joint"),
        Channel("velocity_rad_s", "rad/s", "motor-side speed / gear ratio"),
        Channel("velocity_m_s", "m/s", "speed of a linear joint"),
        Channel("duty", "1", "signed PWM duty applied, -1 .. 1"),
        Channel("current_a", "A", "motor current measured by the drive"),
        Channel("current_estimate_a", "A", "motor current from duty and speed, eq. (3)"),
        Channel("current_command_a", "A", "motor current asked for"),
        Channel("current_load_a", "A", "friction-compensated current, what the master is given"),
        Channel("current_load_half_width_a", "A", "half of the 95 % interval of the friction-compensated current"),
        Channel("voltage_v", "V", "voltage at the motor terminals"),
        Channel("supply_v", "V", "supply voltage"),
        Channel("temperature_c", "degC", "temperature that the drive reports"),
        Channel("torque_n_m", "N m", "joint torque of the motor"),
        Channel("force_n", "N", "motor force of a linear joint"),
        Channel("load_torque_n_m", "N m", "what a torque sensor measures between gear and load: the load on the joint"),
        Channel("enabled", "1", "power stage on (1) or off (0)"),
        Channel("age_s", "s", "age of the sample when it was received"),
        # of a pair: the others are the slave's
        Channel("master_position_rad", "rad", "the master's motor-side position / gear ratio"),
        Channel("master_velocity_rad_s", "rad/s", "the master's motor-side speed / gear ratio"),
        Channel("master_duty", "1", "signed PWM duty applied to the master, -1 .. 1"),
        Channel("master_current_a", "A", "the master's motor current measured by its drive"),
        Channel("master_current_estimate_a", "A", "the master's motor current from duty and speed, eq. (3)"),
        Channel("master_current_command_a", "A", "the master's motor current asked for"),
        Channel("master_supply_v", "V", "the master's supply voltage"),
        Channel("master_temperature_c", "degC", "temperature that the master's drive reports"),
        Channel("master_enabled", "1", "the master's power stage on (1) or off (0)"),
        Channel("master_age_s", "s", "age of the master's sample when it was received"),
        Channel("reflected_n_m", "N m", "load of the slave that is reflected to the operator"),
        Channel(
            "interaction_n_m", "N m", "what truly holds up load and arm and presses on a wall; simulated pairs only"
        ),
        Channel("hand_n_m", "N m", "what the operator's hand truly does to the master; simulated pairs only"),
    )
}
EVENT_COLUMN = "event"
