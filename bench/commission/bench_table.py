"""What goes into bench.toml, as the steps find it out; at any time a configuration that the next step can run with."""

from math import inf, isnan, nan, pi

from bench.commission.evidence import Evidence, interval
from bench.commission.gravity import Weighed
from bench.commission.proposal import CEILING_SHARE, SERVO_SHARE, Joint, Proposal, propose
from bench.commission.questions import Known
from bench.commission.scale import Scale
from bench.config.configuration import BenchConfiguration, parse_configuration
from bench.config.drives.registry import drive_kind
from bench.config.drives.simulated_device import DriveTable
from bench.config.reflected_load import STANDARD_GRAVITY_M_S2
from bench.config.sections import Limits, SearchSettings
from bench.json_types import Value, Values, number
from compensator.line_fit import Interval
from drivers.contract import Description, Mode, Sample

WATCHDOG_S = 0.3
SLOWEST_PERIOD_S = 0.02
SPARE_RATE = {0.005: 2.0, 0.01: 1.3}  # that the line has to carry more cycles than the period asks for
UNKNOWN_COUNTS = 1.0  # per turn of the joint: a position is a number of counts then
FOUND_OUT = ("motor_sign", "encoder_sign", "zero_rad")
MARGIN_RAD = 0.05
GUESSED_GROWTH = 2.0  # of the inertia by the load, before torque per current is known


class BenchTable:
    """The configuration on its way.

    Attributes:
        closes_current: whether the drive has a current mode.
        current_step_a: smallest step of the current that it measures [A]; 0 where it does not tell.
    """

    def __init__(self, name: str, drive: DriveTable, travel_rad: float) -> None:
        self._name, self._travel_rad = name, travel_rad
        self._drive = self._adapted(drive)
        self._period_s = SLOWEST_PERIOD_S
        self._supply_v: float | None = None
        self._found: Values = {}
        self._scale: Scale | None = None
        self._weighed: Weighed | None = None
        self._proposal: Proposal | None = None
        self.closes_current = False
        self.current_step_a = 0.0

    @property
    def known(self) -> Known:
        """What the person knows."""
        return self._known

    @property
    def back_emf(self) -> Interval:
        """Voltage per speed of the joint [V s/rad]; NaN where it did not show."""
        return interval(self._found, "back_emf_v_s_rad") if self._found else Interval(nan)

    def looking(self) -> BenchConfiguration:
        """To look at the drive with the power off: one count is a turn of the joint."""
        more = {"units_from_configuration": True} if "units_from_configuration" in self._fields() else {}
        return self._parsed(
            {
                "rig": {"name": self._name, "gear": {"ratio": 1.0}, "sensor": {"counts_per_turn": UNKNOWN_COUNTS}},
                "drive": {**self._drive, **more},
                "control": {"period_s": SLOWEST_PERIOD_S},
            }
        )

    def counts(self, sample: Sample) -> float:
        """Encoder counts of a sample that was taken while looking."""
        return sample.position_rad / (2.0 * pi)

    def know(self, known: Known, found: Description, supply_v: float) -> None:
        """Take in what the person knows and what the drive can do."""
        self._known, self.closes_current = known, Mode.CURRENT in found.modes
        self.current_step_a = found.resolution.get("current_a", 0.0)
        enough = (one for one, spare in SPARE_RATE.items() if one * found.max_rate_hz >= spare)
        self._period_s = next(enough, SLOWEST_PERIOD_S)
        self._supply_v = known.supply_v if isnan(supply_v) else supply_v
        if "current_limit_a" in self._fields():
            self._drive = {**self._drive, "current_limit_a": known.motor_current_a}

    def scale(self, scale: Scale) -> None:
        """Take in the encoder's sign, zero and scale."""
        self._scale = scale
        self._drive = {**self._drive, "encoder_sign": scale.encoder_sign, "zero_rad": scale.zero_rad}

    def identify(self, results: Values) -> None:
        """Take in what the pushes told."""
        self._found = results
        self._drive = {**self._drive, "motor_sign": int(number(results["demand_sign"]))}

    def weigh(self, found: Weighed) -> None:
        """Take in what the weight told."""
        self._weighed = found

    def angles_rad(self) -> list[float]:
        """Where loads are held: level, or as far as the travel goes."""
        return [min(pi / 2.0, self._travel_rad - SearchSettings().excursion_rad - MARGIN_RAD)]

    def tune(self, evidence: Evidence) -> None:
        """Propose limits, servo, motion and search anew.

        Raises:
            ConfigurationError: the motor is too weak, or the loop too slow.
        """
        self._proposal = found = propose(self._joint(), self._known.load_kg)
        margins = "; ".join(f"{one.phase_deg:.0f} degrees, factor {one.gain:.1f}" for one in found.design.margins)
        how = f"margins without load and with the heaviest: {margins}; of the motor alone: {found.design.free_gain:.1f}"
        evidence.add("servo bandwidth", found.design.bandwidth_rad_s, "rad/s", how)

    def bench(self) -> BenchConfiguration:
        """The configuration by what is known now."""
        return self._parsed({"rig": self._rig(), "drive": self._drive, **self._sections()})

    def _rig(self) -> Values:
        scale = self._scale
        assert scale is not None, "the scale comes before any motion"
        return {
            "name": self._name,
            "gear": {"ratio": scale.gear_ratio},
            "sensor": {"counts_per_turn": scale.counts_per_turn},
            "motor": _there(self._motor(scale.gear_ratio)),
            "arm": {"length_m": self._known.arm_length_m, **self._own_mass()},
            "supply": _there({"voltage_v": self._supply_v}),
        }

    def _motor(self, ratio: float) -> dict[str, float | None]:
        known, back_emf = self._known, self.back_emf.value
        resistance = interval(self._found, "resistance_ohm").value if self._found else nan
        return {
            "resistance_ohm": known.resistance_ohm or _or_none(resistance),
            "back_emf_v_s_rad": known.back_emf_v_s_rad or _or_none(back_emf / ratio),
            "torque_constant_n_m_a": self._torque_n_m_a() / ratio if self._found else None,
        }

    def _torque_n_m_a(self) -> float:
        """At the joint: weighed; before, as the back-EMF has it, or so that half of the current lifts the load."""
        if self._weighed is not None:
            return self._weighed.torque_n_m_a.value
        if not isnan(self.back_emf.value):
            return self.back_emf.value
        known = self._known
        return 2.0 * STANDARD_GRAVITY_M_S2 * known.load_kg * known.arm_length_m / known.motor_current_a

    def _own_mass(self) -> Values:
        """The bare arm as a mass at the place of the load, where its moment shows."""
        if self._weighed is None or not self._weighed.has_own_moment:
            return {}
        moment_kg_m, length_m = self._weighed.own_moment_kg_m.value, self._known.arm_length_m
        return {
            "mass_kg": abs(moment_kg_m) / length_m,
            "centre_of_mass_m": length_m if moment_kg_m > 0.0 else -length_m,
        }

    def _sections(self) -> Values:
        control: Values = {"period_s": self._period_s}
        proposal, known = self._proposal, self._known
        if proposal is not None:
            sections = {name: getattr(proposal, name) for name in ("limits", "motion", "servo", "search")}
            return {"control": control} | {name: one.model_dump(mode="json") for name, one in sections.items()}
        limit_a = known.motor_current_a
        limits = Limits(
            position_min_rad=-self._travel_rad, position_max_rad=self._travel_rad, current_a=limit_a,
            sample_age_s=0.15, load_kg=known.load_kg,
        )  # fmt: skip
        return {
            "control": control,
            "limits": limits.model_dump(mode="json"),
            "servo": {"current_a": SERVO_SHARE * limit_a},
            "search": {"ceiling_a": CEILING_SHARE * limit_a},
        }

    def _joint(self) -> Joint:
        found, known, weighed = self._found, self._known, self._weighed
        assert self._scale is not None
        inertia = interval(found, "inertia_a_s2_rad").value
        breakaway_a = number(found["breakaway_a"])
        loaded = GUESSED_GROWTH * inertia
        if weighed is not None or not isnan(self.back_emf.value):
            loaded = inertia + known.load_kg * known.arm_length_m**2 / self._torque_n_m_a()
        lag_s = found["velocity_lag_s"]
        back_emf = self.back_emf.value
        return Joint(
            motor_current_a=known.motor_current_a,
            travel_rad=self._travel_rad,
            period_s=self._period_s,
            count_rad=self._scale.count_rad,
            breakaway_a=breakaway_a,
            coulomb_a=interval(found, "coulomb_a").value,
            viscous_a_s_rad=interval(found, "viscous_a_s_rad").value,
            gravity_a=0.0 if weighed is None else weighed.gravity_a,
            inertia_a_s2_rad=inertia,
            loaded_a_s2_rad=loaded,
            no_load_rad_s=inf if isnan(back_emf) or self._supply_v is None else self._supply_v / back_emf,
            velocity_lag_s=self._period_s / 2.0 if lag_s is None else number(lag_s),
            loaded_breakaway_a=breakaway_a if weighed is None else weighed.breakaway_a[1],
        )

    def _adapted(self, drive: DriveTable) -> DriveTable:
        """The section as commissioning begins with it.

        Its watchdog waits long enough, its speed is not filtered in the drive, and of signs and zero nothing is known:
        those of an earlier commissioning would turn round what is found now.
        """
        fields = drive_kind(str(drive.get("kind", ""))).settings.model_fields
        more: DriveTable = {"watchdog_s": WATCHDOG_S} if "watchdog_s" in fields else {}
        if "velocity" in fields:
            more["velocity"] = "none"
        return {**more, **{name: value for name, value in drive.items() if name not in FOUND_OUT}}

    def _fields(self) -> frozenset[str]:
        return frozenset(drive_kind(str(self._drive["kind"])).settings.model_fields)

    def _parsed(self, values: Values) -> BenchConfiguration:
        return parse_configuration({"name": self._name, **values}, "commission")


def _there(values: dict[str, float | None]) -> dict[str, Value]:
    return {name: value for name, value in values.items() if value is not None}


def _or_none(value: float) -> float | None:
    return None if isnan(value) or value <= 0.0 else value
