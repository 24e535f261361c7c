"""The steps of commissioning, in their order; each is refused where the one before has left doubt."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import degrees, isnan, nan, pi, radians

from bench.commission.bench_table import BenchTable
from bench.commission.evidence import Evidence, interval
from bench.commission.gravity import check_back_emf, weighed
from bench.commission.motions import ATTEMPTS, Motions
from bench.commission.proposal import CEILING_SHARE
from bench.commission.questions import FIRST_LOAD, HAND_ANGLE, CommissionError, Known, Person, ask_all, need
from bench.commission.scale import Scale, scale_of
from bench.config.configuration import BenchConfiguration
from bench.config.quantities import unit_of
from bench.json_types import Value, Values, number, numbers, objects
from bench.runs.connection import Connection
from bench.store import Experiment
from compensator.line_fit import Interval
from drivers.contract import Description, Mode

BARE = (0.0, False)
REPEATS = 2  # of each weight at each angle: a joint that stopped at the edge of friction may not be found
LEAST_STEPS = 2.5  # of the current sensor, that breakaway has to be, where no current can be demanded
SMALL_RAD = (0.4, 0.8)  # where a weight is held first
DOWN_RAD = 0.35  # from where the pushes begin: friction may hold the arm off straight down
COAST_S = 30.0  # a joint with little friction swings; one whose motor is shorted creeps down
RATE_SHARE = 1.0 / 6.0  # of the highest current, by which a push rises in a second
UNSURE_SHARE = 0.5  # half of the inertia's interval, over the inertia: beyond, they tell nothing


@dataclass(frozen=True)
class Commissioned:
    """How it ended.

    Attributes:
        first_kg, found_kg: the weight that was hung as a trial, and what the bench found; NaN where none was hung.
    """

    bench: BenchConfiguration
    known: Known
    first_kg: float
    found_kg: float


class Commission:
    """One joint on its way.

    Args:
        table: collects what goes into bench.toml.
        person: who stands at the bench.
        motions: what moves the joint.
        evidence: where findings are kept, also those of a commissioning that is refused.
        on_step: told the key of each step (`steps.STEPS`) as it begins.
    """

    def __init__(
        self,
        table: BenchTable,
        person: Person,
        motions: Motions,
        evidence: Evidence,
        on_step: Callable[[str], None] = lambda _key: None,
    ) -> None:
        self._table, self._person, self._motions, self._evidence = table, person, motions, evidence
        self._on_step = on_step

    def run(self) -> Commissioned:
        """All steps.

        Raises:
            CommissionError: a step left doubt; the joint is without power.
            BenchError, DriveError: a motion is refused, or the drive does not answer.
        """
        self._on_step("look")
        found = self._look()
        self._on_step("know")
        known = ask_all(self._person, found.description.measured, Mode.CURRENT in found.description.modes)
        self._table.know(known, found.description, found.sample.supply_v)
        self._on_step("scale")
        self._table.scale(self._find_scale(known, found))
        self._on_step("push")
        self._identify()
        self._table.tune(self._evidence)
        self._on_step("signs")
        self._try_signs(BARE)
        self._on_step("weigh")
        self._weigh(known)
        self._on_step("signs-again")
        self._try_signs(BARE)
        self._on_step("first-load")
        first_kg, found_kg = self._first_load()
        return Commissioned(self._table.bench(), known, first_kg, found_kg)

    def _look(self) -> Connection:
        found = self._motions.look(self._table.looking())
        described = found.description
        check_modes(described)
        identity = " ".join(filter(None, (described.vendor, described.product, described.firmware, described.serial)))
        self._evidence.add("drive", identity or described.device, "", "what the drive says of itself")
        self._evidence.add("cycle rate", found.rate_hz, "Hz", f"{described.max_rate_hz:.0f} Hz are possible")
        return found

    def _find_scale(self, known: Known, found: Connection) -> Scale:
        """Zero, sign and size of the counts, with the power off."""
        self._do("down", "Take every load off, and let the arm hang straight down. Nothing is powered yet.")
        down = self._counts()
        angle_deg = need(self._person, HAND_ANGLE)
        turned = self._counts()
        scale = scale_of(down, turned, radians(angle_deg), known, found.description.counts_per_turn)
        how = f"the arm turned by hand to {angle_deg:g} degrees"
        self._evidence.add_interval(
            "counts of a joint turn",
            Interval(2.0 * pi / scale.count_rad, scale.low, scale.high, scale.sentence),
            "",
            how,
        )
        self._evidence.add("drive.encoder_sign", scale.encoder_sign, "", how)
        self._evidence.add("drive.zero_rad", scale.zero_rad, "rad", "the arm hung straight down")
        return scale

    def _counts(self) -> float:
        return self._table.counts(self._motions.look(self._table.looking()).sample)

    def _identify(self) -> None:
        """Pushes without load."""
        self._do(
            "clear",
            "Let the arm hang straight down again, free to turn, and stand clear: the motor pushes it by "
            "26 degrees at most, and it moves on by as much again. Keep a hand at the emergency stop.",
        )
        self._refuse_raised()
        limit_a = self._table.known.motor_current_a
        asked: dict[str, Value] = {
            "effort": "current" if self._table.closes_current else "duty",
            "rate_a_s": RATE_SHARE * limit_a,
            "ceiling_a": CEILING_SHARE * limit_a,
            "coast_s": COAST_S,
        }
        ran = self._pushed(asked)
        self._check_current(ran.results)
        self._table.identify(ran.results)
        self._keep(ran.results, ran.id)

    def _pushed(self, asked: dict[str, Value]) -> Experiment:
        """Pushes from which the inertia is sure; again where a late host has drawn them out."""
        bench = self._table.bench()
        for _ in range(ATTEMPTS):
            ran = self._motions.run(bench, "identification", asked, BARE)
            inertia, lost = interval(ran.results, "inertia_a_s2_rad"), self._motions.lost_cycles(ran, bench)
            if inertia.high - inertia.value <= UNSURE_SHARE * inertia.value:
                return ran
            if not lost:
                break
        late = f" The host lost {lost} cycles in one of the pushes: see what kept it busy." if lost else ""
        raise CommissionError(
            f"inertia is {inertia.value:.3g} A s2/rad, sure to {inertia.high - inertia.value:.2g} only; half of it "
            f"is allowed. Is the arm free, and does nothing but the motor move it?{late}"
        )

    def _refuse_raised(self) -> None:
        """Refuse to push an arm that still stands level: with much friction it stays where the hand has left it."""
        at_rad = self._motions.look(self._table.bench()).sample.position_rad
        if abs(at_rad) > DOWN_RAD:
            raise CommissionError(
                f"the arm stands at {degrees(at_rad):.0f} degrees, and the pushes begin within {degrees(DOWN_RAD):.0f} "
                "degrees of straight down; bring it there by hand, let go of it, then start again"
            )

    def _check_current(self, results: Values) -> None:
        if number(results["current_sign"]) < 0.0:
            raise CommissionError(
                "the measured current has the sign against the demand; correct how the drive's settings take the sign "
                "of its current, then start again"
            )
        step_a, breakaway_a = self._table.current_step_a, number(results["breakaway_a"])
        if not self._table.closes_current and breakaway_a < LEAST_STEPS * step_a:
            raise CommissionError(
                f"the joint lets go at {breakaway_a:.3g} A, and the drive measures its current in steps of "
                f"{step_a:.3g} A; at least {LEAST_STEPS:g} steps are wanted to tell the motor's resistance. The drive "
                "is too large for this motor; use one that measures smaller currents"
            )

    def _keep(self, results: Values, experiment_id: int) -> None:
        how = "pushes of the unloaded joint"
        self._evidence.add("drive.motor_sign", number(results["demand_sign"]), "", how, experiment_id)
        self._evidence.add("breakaway", number(results["breakaway_a"]), "A", how, experiment_id)
        for name in INTERVALS:
            found = interval(results, name)
            if not isnan(found.value):
                self._evidence.add_interval(name, found, unit_of(name), how, experiment_id)

    def _try_signs(self, hung: tuple[float, bool]) -> None:
        """The commissioning move: signs, scales and watchdog of the whole, as every start of an experiment asks for."""
        asked = {"coast_s": COAST_S, "rate_a_s": RATE_SHARE * self._table.known.motor_current_a}
        ran = self._motions.run(self._table.bench(), "commissioning", asked, hung)
        for sentence in ran.results["sentences"]:
            self._evidence.add("commissioning move", str(sentence), "", "signs and scales of the whole", ran.id)

    def _weigh(self, known: Known) -> None:
        """Torque per current by the weight; near the bottom first, so that a wrong scale of the angles is found there.

        With the torque per current the servo is tuned anew.
        """
        hung, rows, numbers = BARE, [], []
        for loads_kg, angles_rad in (
            ((0.0, known.load_kg), SMALL_RAD),
            ((known.load_kg, 0.0), self._table.angles_rad()),
        ):
            asked: dict[str, Value] = {"loads_kg": loads_kg, "angles_rad": angles_rad, "repeats": REPEATS}
            ran = self._motions.run(self._table.bench(), "load-sweep", asked, hung)
            hung = (known.load_kg, False)
            numbers.append(ran.id)
            rows += objects(ran.results["rows"])
            found = weighed(rows, known.load_kg, known.arm_length_m)
        check_back_emf(found.torque_n_m_a, self._table.back_emf)
        how = f"{1e3 * known.load_kg:g} g at {known.arm_length_m:g} m, held at three angles"
        self._evidence.add_interval("torque at the joint", found.torque_n_m_a, "N m/A", how, numbers[-1])
        self._evidence.add_interval("moment of the bare arm", found.own_moment_kg_m, "kg m", how, numbers[-1])
        self._evidence.add("breakaway under the load", found.breakaway_a[1], "A", how, numbers[-1])
        self._table.weigh(found)
        self._table.tune(self._evidence)

    def _first_load(self) -> tuple[float, float]:
        """A weight that took no part in the calibration; 0 skips it."""
        first_kg = need(self._person, replace(FIRST_LOAD, most=self._table.known.load_kg))
        if first_kg == 0.0:
            return nan, nan
        asked: dict[str, Value] = {"loads_kg": [first_kg], "angles_rad": self._table.angles_rad(), "repeats": REPEATS}
        ran = self._motions.run(self._table.bench(), "load-sweep", asked, (first_kg, False))
        rows = objects(ran.results["rows"])
        found = numbers(rows, "reflected_load_kg")
        if not found:
            raise CommissionError(f"the trial load was not found: {rows[0]['search_failure']}")
        how = (
            f"{1e3 * first_kg:g} g hung as a trial; mean of {len(found)}, which differ by {max(found) - min(found):.2g}"
        )
        self._evidence.add("first load", sum(found) / len(found), "kg", how, ran.id)
        return first_kg, sum(found) / len(found)

    def _do(self, key: str, sentence: str) -> None:
        if not self._person.done(key, sentence):
            raise CommissionError(f"given up at: {sentence}")


INTERVALS = (
    "inertia_a_s2_rad", "coulomb_a", "viscous_a_s_rad", "gravity_a", "resistance_ohm", "back_emf_v_s_rad", "supply_ohm",
)  # fmt: skip


def check_modes(described: Description) -> None:
    """Raise CommissionError where a drive cannot push with a known current or duty: nothing would be found out."""
    if not described.modes & {Mode.CURRENT, Mode.DUTY}:
        raise CommissionError(
            f"drive '{described.device}': modes: found {', '.join(sorted(mode.value for mode in described.modes))}; "
            "commissioning pushes with a current or a duty: put it on the bench step by step. Write its section and "
            "its maker's rig.motor.torque_constant_n_m_a into bench.toml. "
            "Next: friction-bench --config bench.toml doctor"
        )
