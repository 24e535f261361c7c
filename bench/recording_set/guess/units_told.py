"""In which unit each quantity is: as the user says, as its name says, as the values tell; or it has to be asked."""

from collections.abc import Sequence

import numpy as np

from bench.recording_set.checks import back_and_forth, question
from bench.recording_set.formats.column_table import Columns
from bench.recording_set.guess.assign import Assigned
from bench.recording_set.guess.clock import clock_of
from bench.recording_set.guess.evidence import NEAR, are_whole, gear_behind, period_of, slope, unit_by_slope
from bench.recording_set.guess.names import UNITS_OF
from bench.recording_set.mapping import Column
from bench.recording_set.units import TURN, UNITS, Unit, unit_named
from compensator.lab.recordings.channel_checks import AGREE
from compensator.lab.recordings.recording import CHANNELS, FloatArray

MOTION = ("position", "velocity", "target")
_CHANNEL = {
    "time": "time_s",
    "current": "current_a",
    "current_command": "current_command_a",
    "voltage": "voltage_v",
    "supply": "supply_v",
    "duty": "duty",
    "torque": "torque_n_m",
    "load_torque": "load_torque_n_m",
    "force": "force_n",
    "temperature": "temperature_c",
    "enabled": "enabled",
}
_PLAIN = "no known unit in its name: taken as SI"
LARGE_RATE = 300.0  # without a unit: rad/s of a motor, or rpm
OUTLINE = 400  # values of a column that are shown


class Units:
    """The units of the columns that were assigned.

    Attributes:
        joint: "rotary" or "linear".
        questions: what has to be asked; each names its option.
        why: column -> why it has its unit, in words.
        gear: ratio of the gear in front of which the speed is, of the motor; None where it is that of the joint.
    """

    def __init__(
        self,
        files: Sequence[Columns],
        assigned: Assigned,
        counts_per_turn: float | None,
        rate_hz: float | None,
        gear_ratio: float | None = None,
    ) -> None:
        self._files, self._assigned, self._counts = files, assigned, counts_per_turn
        self._gear_ratio = gear_ratio
        self.gear: float | None = None
        self.clock = clock_of(files, assigned, rate_hz)
        self.questions, self.notes, self.why = self.clock.questions, self.clock.notes, self.clock.why
        self._place = "m" if self._is_linear() else "rad"
        self.joint = "linear" if self._place == "m" else "rotary"
        self._units: dict[str, Unit] = {}
        self._motion()
        for quantity in assigned.columns:
            if quantity not in ("time", *MOTION):
                self._units[quantity] = self._told(quantity) or self._plain(quantity, UNITS_OF[quantity][0])
        self._check_names()
        self._check_range()

    def column_of(self, quantity: str, names: tuple[str, ...]) -> Column | None:
        """How the channel of a quantity is made; None where it is not known yet, or no channel is made of it."""
        if quantity == "time":
            return self.clock.column
        unit = self._units[quantity]
        if self.channel_of(quantity) not in CHANNELS or (unit.counts and self._counts is None):
            return None
        plain = unit.factor == 1.0 and unit.offset == 0.0 and not unit.counts and not self._is_sure(quantity)
        period = self._period() if quantity in ("position", "target") else None
        said = self._assigned.said.get(names[0])
        sign_from = said.sign_from if said else None
        scale = self._scale(quantity)
        return Column(
            source=names[0], unit=None if plain else unit.name, scale=scale, period=period, sign_from=sign_from
        )

    def channel_of(self, quantity: str) -> str:
        """The name of a quantity's channel."""
        if quantity in MOTION:
            return f"{quantity}_{self._place}" + ("_s" if quantity == "velocity" else "")
        return _CHANNEL[quantity]

    def range_of(self, name: str) -> tuple[float, float] | None:
        """Lowest and highest value of a column over all files; None of text."""
        found = [columns[name] for columns in self._files if name in columns]
        known = [one[np.isfinite(one)] for one in found if not isinstance(one, list)]
        known = [one for one in known if len(one)]
        return (min(float(one.min()) for one in known), max(float(one.max()) for one in known)) if known else None

    def outline_of(self, name: str) -> tuple[float, ...]:
        """Some values of a column over time, of the first file that has it; empty of text."""
        values = next((columns[name] for columns in self._files if name in columns), [])
        if isinstance(values, list) or not np.isfinite(values).any():
            return ()
        picked = values[:: max(1, len(values) // OUTLINE)]
        return tuple(picked[np.isfinite(picked)].tolist())

    def _name(self, quantity: str) -> str:
        return self._assigned.columns[quantity][0]

    def _numbers(self, quantity: str) -> FloatArray | None:
        """Of the first file that has the column."""
        name = self._name(quantity) if quantity in self._assigned.columns else ""
        values = next((columns[name] for columns in self._files if name in columns), None)
        return None if values is None or isinstance(values, list) else values

    def _time_s(self) -> FloatArray | None:
        return self.clock.time_s[0] if self.clock.time_s else None

    def _is_sure(self, quantity: str) -> bool:
        """Whether the user says the unit."""
        said = self._assigned.said.get(self._name(quantity))
        return said is not None and said.unit is not None

    def _told(self, quantity: str) -> Unit | None:
        """As the user says, else as the name does."""
        name = self._name(quantity)
        if self._is_sure(quantity):
            self.why[name] = "as said"
            return unit_named(self._assigned.said[name].unit or "")
        unit = self._assigned.readings[name].unit
        if unit is None or unit.si not in UNITS_OF[quantity]:
            return None
        self.why[name] = "its name"
        return unit

    def _scale(self, quantity: str) -> float:
        """What makes a value one of the joint, beside its unit."""
        return 1.0 / self.gear if self.gear is not None and quantity == "velocity" else 1.0

    def _factor(self, unit: Unit) -> float:
        """Of a unit to SI; NaN of counts where nobody says how many a turn has."""
        return unit.factor * (TURN / (self._counts or np.nan) if unit.counts else 1.0)

    def _plain(self, quantity: str, si: str) -> Unit:
        self.why[self._name(quantity)] = _PLAIN
        return unit_named(si) or Unit(si, si)

    def _is_linear(self) -> bool:
        told = [self._told(one) for one in MOTION if one in self._assigned.columns]
        units = [unit.si for unit in told if unit is not None]
        if units:
            return units[0] in ("m", "m/s")
        return "force" in self._assigned.columns and "torque" not in self._assigned.columns

    def _ask(self, quantity: str, sentence: str, units: Sequence[str], *others: str) -> None:
        name = self._name(quantity)
        options = " or ".join([*(f"--take '{name}={quantity}[{unit}]'" for unit in dict.fromkeys(units)), *others])
        self.questions.append(f"'{name}' {sentence}: say {options}")

    def _motion(self) -> None:
        """Position, speed and set point: what one of them says of the other."""
        there = [one for one in MOTION if one in self._assigned.columns]
        told = {one: unit for one in there if (unit := self._told(one)) and unit.si.split("/")[0] == self._place}
        self._units |= told
        rate = self._rate()
        if "position" in there and "position" not in told:
            self._units["position"] = self._position_unit(told, rate)
        if "velocity" in there and "velocity" not in told:
            self._units["velocity"] = self._velocity_unit(rate)
        if "target" in there and "target" not in told:
            self._units["target"] = self._units.get("position") or UNITS[self._place]
            self.why[self._name("target")] = "as the position"
        self._check_rate(rate, firm="velocity" in told and bool({"position", "target"} & told.keys()))
        if "position" in told:
            self._check_turns()
        counted = [one for one in there if self._units[one].counts]
        if counted and self._counts is None:
            name = self._name(counted[0])
            self.questions.append(
                f"'{name}' is in counts: say --counts-per-turn N (of the joint), or --take '{name}={counted[0]}[deg]'"
            )

    def _rate(self) -> float | None:
        """What the rate of the position is of the speed, in the units of the file."""
        time_s, position, velocity = self._time_s(), self._numbers("position"), self._numbers("velocity")
        if time_s is None or position is None or velocity is None:
            return None
        return slope(time_s, position, velocity) if len(time_s) == len(position) == len(velocity) else None

    def _position_unit(self, told: dict[str, Unit], rate: float | None) -> Unit:
        name, values = self._name("position"), self._numbers("position")
        velocity, target = told.get("velocity"), told.get("target")
        unit = self._by_speed(velocity, rate)
        if unit is not None and velocity is not None:
            self.why[name] = f"its rate is the speed in {velocity.name}"
            return unit
        if target is not None:
            self.why[name] = "as the set point"
            return target
        if self._place == "rad" and values is not None and are_whole(values):
            self.why[name] = "whole numbers: counts"
            return UNITS["counts"]
        if self._place == "rad" and values is not None and back_and_forth(values) and self._period() is None:
            self._ask("position", f"goes back and forth between {_range(values)}, without a unit", ("deg", "rad"))
        return self._plain("position", self._place)

    def _by_speed(self, velocity: Unit | None, rate: float | None) -> Unit | None:
        if velocity is None or rate is None or velocity.counts:
            return None
        return unit_by_slope(rate / velocity.factor, _units_of(self._place))

    def _velocity_unit(self, rate: float | None) -> Unit:
        name, position = self._name("velocity"), self._units.get("position")
        if position is not None and rate is not None:
            for unit in _units_of(f"{self._place}/s"):
                if abs(abs(rate) * self._factor(position) / unit.factor - 1.0) < NEAR:
                    self.why[name] = f"it is the rate of the position in {position.name}"
                    return unit
        values = self._numbers("velocity")
        if self._place == "rad" and values is not None and float(np.nanmax(np.abs(values))) > LARGE_RATE:
            self._ask("velocity", f"lies between {_range(values)}, without a unit", ("rpm", "deg/s", "rad/s"))
        return self._plain("velocity", f"{self._place}/s")

    def _check_rate(self, rate: float | None, firm: bool) -> None:
        """Two units that deny each other, or a speed of the motor; `firm` where both units are told."""
        position, velocity = self._units.get("position"), self._units.get("velocity")
        if rate is None or position is None or velocity is None:
            return
        ratio = abs(rate) * self._factor(position) / self._factor(velocity)
        if np.isnan(ratio) or 1.0 / AGREE < ratio < AGREE:
            return
        # beside counts a ratio may as well be one of another count: only a rig's gear tells
        firm = firm and (self._gear_ratio is not None or not position.counts)
        gear = gear_behind(1.0 / ratio, self._gear_ratio) if firm else None
        near = unit_by_slope(rate / velocity.factor, _units_of(self._place))
        sure = self._is_sure("position") or (gear is not None and gear == self._gear_ratio)
        name, speed = self._name("position"), self._name("velocity")
        counts = f"--counts-per-turn {ratio * self._counts:.5g} or " if position.counts and self._counts else ""
        without = f"{counts}--take '{speed}=ignore', which leaves the speed out"
        found = f"in {position.name} changes {ratio:.3g} times as fast as '{speed}' in {velocity.name}"
        if gear is not None and (sure or near is None):
            self._take_as_motor(gear, f"'{name}' {found}")
        elif not (sure or self._is_sure("velocity")):
            units = [near.name, position.name] if near else [position.name, "deg", "rad"]
            self._ask("position", found, units, without)
        else:
            self.questions.append(f"'{name}' {found}, which no import takes: say {without}")

    def _take_as_motor(self, gear: float, found: str) -> None:
        """The speed as one of the motor."""
        name, self.gear = self._name("velocity"), gear
        self.why[name] = f"{self.why[name]}; of the motor, behind a gear of about {gear:g}"
        self.notes.append(
            f"{found}: that speed is of the motor side, behind a gear of about {gear:g}, and is taken with scale = "
            f"1/{gear:g}; correct the scale where the ratio is another, or say --take '{name}=ignore'"
        )

    def _check_turns(self) -> None:
        """Radians by name that look like degrees."""
        values, sure = self._numbers("position"), self._is_sure("position") or "velocity" in self._assigned.columns
        if sure or values is None or self._units["position"].name != "rad":
            return
        if back_and_forth(values) and self._period() is None:
            self._ask("position", f"goes back and forth between {_range(values)}", ("deg", "rad"))

    def _check_names(self) -> None:
        """Units that names say, and that are none of what their words say."""
        for quantity in self._units:
            name, si = self._name(quantity), self._units[quantity].si
            if (unfit := self._assigned.readings[name].unfit) and not self._is_sure(quantity):
                self.why[name] = "it is asked about"
                self.questions.append(
                    f"'{name}' says {unfit} in its name, which is no unit of {quantity}: say --take "
                    f"'{name}={quantity}[{si}]' where it is {si}, or where a scale in the mapping will make it so, "
                    f"else --take '{name}=ignore'"
                )

    def _check_range(self) -> None:
        """Values outside physics."""
        for quantity, unit in self._units.items():
            found, channel = self.range_of(self._name(quantity)), self.channel_of(quantity)
            if found is None or unit.counts or channel not in CHANNELS:
                continue
            if self._is_sure(quantity) and quantity != "duty":
                continue
            scale = unit.factor * self._scale(quantity)
            low, high = sorted(scale * one + unit.offset for one in found)
            if asked := question(channel, high, low, CHANNELS[channel].unit):
                sentence, _, other = asked.removeprefix(f"{channel} ").partition(". Is the column in ")
                self._ask(quantity, sentence, (other,) if quantity == "duty" else (other, unit.name))

    def _period(self) -> float | None:
        """The period at which the position wraps, of the first file in which it does."""
        name = self._name("position") if "position" in self._assigned.columns else ""
        for columns, time_s in zip(self._files, self.clock.time_s, strict=True):
            values = columns.get(name)
            if time_s is None or values is None or isinstance(values, list) or not (np.diff(time_s) > 0.0).all():
                continue
            if (period := period_of(time_s, values)) is not None:
                note = f"'{name}' wraps every {period:g}: it is unwrapped"
                self.notes += [] if note in self.notes else [note]
                return period
        return None


def _units_of(si: str) -> list[Unit]:
    """Units of a quantity, without those that only the sensor knows."""
    return list({unit.name: unit for unit in UNITS.values() if unit.si == si and not unit.counts}.values())


def _range(values: FloatArray) -> str:
    return f"{float(np.nanmin(values)):.4g} and {float(np.nanmax(values)):.4g}"
