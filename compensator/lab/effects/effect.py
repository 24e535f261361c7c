"""What an effect is: a named physical mechanism that adds columns to the regression of the effort."""

from collections.abc import Callable, Mapping, Sequence
from copy import copy
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Literal

import numpy as np

from compensator.lab.errors import EffectFailedError
from compensator.lab.recordings.facts import STANDARD_GRAVITY_M_S2, Effort, EffortQuantity, Facts
from compensator.lab.recordings.recording import SESSION_START, Condition, FloatArray
from compensator.lab.recordings.reversals import Strokes, since_rest, strokes_of

Shape = tuple[float, ...]
MotionRows = Literal["sliding", "moving"]
Round = Literal["force", "against the motion"]
PEOPLE = ("Coulomb", "Stribeck")
MOST_TURNS = (
    10.0  # over all trials: beyond, nothing winds up with the shaft, and its position is the time it has turned
)


@dataclass(frozen=True)
class Motion:
    """One trial at its full, uniform rate: what columns are computed from. Arrays have shape (n,).

    Attributes:
        facts: of the joint.
        conditions: of the trial.
        time_s: since the start of the trial.
        position, velocity, acceleration, jerk: rad or m, and per s, s^2, s^3; zero-phase filtered.
        direction: smooth sign of the velocity, -1 .. 1.
        load_effort: predicted effort without friction, in the effort's unit (never the measured one).
        inertia_beyond: effort per acceleration of what hangs beyond the gear; 0 before anything is predicted.
        inertia: effort per acceleration of all that moves; 0 before anything is predicted.
        load_inertia: effort per acceleration of the tip load, a part of both; 0 before anything is predicted.
        parting: acceleration at which the motor side would leave what hangs beyond the gear behind, were it not driven.
        carried_slope: what gravity and springs grow by for each unit of position; 0 before anything is predicted.
        predicted, effort_rate: predicted effort, all of it, and its rate of change.
        largest_effort: predicted, of all trials; 0 before anything is predicted.
        bend: what effects of the model with a `slope` add for each unit of effort that is predicted more.
        back_emf: effort per velocity that drives no current; 0 but of a voltage, and before anything is predicted.
        late_s: by how much the position is older than the effort, as far as the model says.
        doubt: by how much these may be wrong for what teeth do in known free play, in the measure of `bend`.
        temperature_c, supply_v: NaN where not measured.
        position_span: range of position over all trials of the study.
        session_span_s: from the first trial's start to the last one's end, as far as the conditions tell.
        slow: speed below which direction is uncertain.
        fast: 95 % quantile of speed over all trials.
        misread_acceleration: what the position sensor adds to the acceleration, as far as the model says; position and
            its rates are without it.
        measured_load: of a torque sensor between gear and load [N m]; NaN where there is none.
        start_rate: at which the effort changed when the joint last stood [effort/s], the usual one before that.
        usual_start_rate: geometric mean over all trials. Both are NaN where it never stood, or no effort is measured.
        travelled: way from the start of the session to that of the trial, as far as the trials tell.
        usual_speed: way over time, of the whole session; 0 where nothing tells.
    """

    facts: Facts
    conditions: Mapping[str, Condition]
    time_s: FloatArray
    position: FloatArray
    velocity: FloatArray
    acceleration: FloatArray
    jerk: FloatArray
    direction: FloatArray
    load_effort: FloatArray
    inertia_beyond: float
    inertia: float
    parting: FloatArray
    predicted: FloatArray
    effort_rate: FloatArray
    largest_effort: float
    bend: FloatArray
    temperature_c: FloatArray
    supply_v: FloatArray
    position_span: float
    session_span_s: float
    slow: float
    fast: float
    doubt: FloatArray | float = 0.0
    late_s: float = 0.0
    back_emf: float = 0.0
    load_inertia: float = 0.0
    carried_slope: FloatArray | float = 0.0
    misread_acceleration: FloatArray | float = 0.0
    measured_load: FloatArray | float = np.nan
    start_rate: FloatArray | float = np.nan
    usual_start_rate: float = np.nan
    travelled: float = 0.0
    usual_speed: float = 0.0

    def condition(self, name: str, default: float) -> float:
        """A numeric condition of the trial, or the default where it is not given."""
        value = self.conditions.get(name, default)
        return float(value) if isinstance(value, int | float) else default

    def having(self, **changed: Any) -> "Motion":
        """The same motion with other values of what a model says of it; what is known of its position is kept.

        Every pass of a fit asks for it in every trial: `dataclasses.replace` would look through all fields, and the
        strokes would be found again.
        """
        motion = copy(self)
        motion.__dict__.update(changed)
        motion.__dict__.pop("is_bent", None)
        return motion

    @property
    def turns_on(self) -> bool:
        """Whether the shaft turns on and on: its angle in the turn is a place of the joint, its position is none."""
        return self.facts.joint == "rotary" and self.position_span > MOST_TURNS * 2.0 * np.pi

    @property
    def place(self) -> FloatArray:
        """Where the joint is: its position; of a shaft that turns on, its angle in the turn, 0 .. 2 pi; shape (n,)."""
        found: FloatArray = self.position % (2.0 * np.pi) if self.turns_on else self.position
        return found

    @cached_property
    def is_bent(self) -> bool:
        """Whether any column carries what an effect with a slope makes of it."""
        return bool(self.bend.any())

    @cached_property
    def strokes(self) -> Strokes:
        """The motion cut at its turning points."""
        return strokes_of(self.position)

    @cached_property
    def last_rest(self) -> tuple[FloatArray, FloatArray]:
        """Length of the last rest [s] and distance travelled since it, shape (n,) each."""
        return since_rest(self.position, self.velocity, self.time_s, self.slow)

    @cached_property
    def log_speed(self) -> FloatArray:
        """Logarithm of the speed, shape (n,): what a search raises to one power after the other."""
        with np.errstate(divide="ignore"):  # at rest
            return np.asarray(np.log(np.abs(self.velocity)))

    @cached_property
    def step_s(self) -> float:
        """Time from sample to sample [s]; 0 of a single moment."""
        return float(self.time_s[1] - self.time_s[0]) if len(self.time_s) > 1 else 0.0

    @property
    def driven(self) -> FloatArray:
        """Predicted effort in proportion to the motor's current: of a voltage, what is not back-EMF; shape (n,)."""
        found: FloatArray = self.predicted - self.back_emf * self.velocity
        return found

    def averaged(self, order: float) -> FloatArray:
        """What an average over one sample leaves of a ripple of an order [rad per unit of position], shape (n,).

        A drive holds its duty, and averages its current, for about as long; a ripple that passes faster would come back
        from beyond the Nyquist rate as large as it is, in no phase that the next trial has again.
        """
        return np.sinc(order * self.velocity * self.step_s / (2.0 * np.pi)).astype(np.float64)

    @property
    def session_s(self) -> FloatArray:
        """Time since the start of the session [s], shape (n,); since the start of the trial where nothing tells."""
        return self.time_s + self.condition(SESSION_START, 0.0)

    @property
    def session_way_s(self) -> FloatArray:
        """The way since the start of the session, as the time that it usually takes [s], shape (n,)."""
        way = self.travelled + np.cumsum(np.abs(self.velocity)) * self.step_s
        return way / self.usual_speed if self.usual_speed > 0.0 else self.session_s

    @property
    def load_kg(self) -> float:
        """Load at the tip [kg]; 0 where not told."""
        return self.condition("load_kg", 0.0)

    @property
    def arm_m(self) -> float:
        """Axis to the tip load [m]; 0 where not told."""
        return self.condition("arm_m", self.facts.arm_m or 0.0)

    @property
    def load_moment_n_m(self) -> float:
        """Gravity moment of the tip load at 90 degrees [N m]; 0 for a balanced arm."""
        if self.conditions.get("balanced"):
            return 0.0
        return self.load_kg * STANDARD_GRAVITY_M_S2 * self.arm_m

    @property
    def moment_n_m(self) -> float:
        """Gravity moment of arm and tip load at 90 degrees [N m], as far as it is told; 0 for a balanced arm."""
        return 0.0 if self.conditions.get("balanced") else self.load_moment_n_m + (self.facts.arm_moment_n_m or 0.0)

    @property
    def load_inertia_kg_m2(self) -> float:
        """Inertia of the tip load about the axis [kg m^2], as a point mass; of a linear joint its mass [kg]."""
        return self.load_kg if self.facts.joint == "linear" else self.load_kg * self.arm_m**2


@dataclass(frozen=True, slots=True)
class Parameter:
    """One coefficient of an effect.

    Attributes:
        name: as shown.
        unit: a template; `{effort}`, `{position}` and `{inertia}` are replaced by the study's units.
        low, high: what is physically possible, in `unit`.
    """

    name: str
    unit: str
    low: float = -np.inf
    high: float = np.inf

    def unit_in(self, effort_unit: str, position_unit: str) -> str:
        """The unit, with the study's own effort and position units."""
        inertia = "kg" if position_unit == "m" else "kg m2"
        return self.unit.format(effort=effort_unit, position=position_unit, inertia=inertia)


def shape_parameters(names: Sequence[str], units: Sequence[str]) -> list[Parameter]:
    """The values of a shape as parameters: those without a unit are numbers."""
    return [Parameter(name, units[at] if at < len(units) else "1") for at, name in enumerate(names)]


def _no_shapes(_: Motion) -> list[Shape]:
    return [()]


def _anywhere(_: Shape) -> bool:
    return True


def _nothing_told(_facts: Facts, _shape: Shape) -> bool:
    return False


@dataclass(frozen=True, slots=True)
class Onset:
    """Moments at which one trial's joint breaks away: what breakaway columns are computed from. Arrays have shape (e,).

    Attributes:
        motion: at these moments: at rest, `direction` that of the motion that follows; `load_effort` at rest.
        rest_s: how long the joint had been at rest.
        rate: at which the effort rose along the motion [effort/s], above 0.
    """

    motion: Motion
    rest_s: FloatArray
    rate: FloatArray


def _no_onset_shapes(_: Onset) -> list[Shape]:
    return [()]


@dataclass(frozen=True, slots=True)
class BreakawayShare:
    """What an effect adds to the effort at which a joint at rest breaks away.

    Attributes:
        columns: (onset, shape) -> array (k, e), one row per parameter.
        parameters: one per column.
        driver: the variable to plot breakaway against; a key of `compensator.lab.rows.drivers.DRIVERS`.
        shapes: nonlinear shape values to scan, given all moments of the study; `shape_names` names them,
            and `shape_units` has their units, as those of a `Parameter`.
        replaces_lag: the column that stands for seeing the motion late would absorb it, and is left out.
    """

    columns: Callable[[Onset, Shape], FloatArray]
    parameters: tuple[Parameter, ...]
    driver: str
    shapes: Callable[[Onset], list[Shape]] = _no_onset_shapes
    shape_names: tuple[str, ...] = ()
    shape_units: tuple[str, ...] = ()
    replaces_lag: bool = False


@dataclass(frozen=True, slots=True)
class Effect:
    """A named physical mechanism.

    Attributes:
        name: identifier, as in commands.
        title: in words.
        physics: one paragraph.
        equation: TeX.
        columns: (motion, shape) -> array (k, n), one row per parameter. Full rate; filtered afterwards.
        parameters: one per column.
        driver: the variable to plot residuals against; a key of `compensator.lab.rows.drivers.DRIVERS`.
        excited_by: what a trial must do so that the effect shows.
        source: paper or book.
        shapes: nonlinear shape values to scan, given any trial's motion; `shape_names` names them, and
            `shape_units` has their units, as those of a `Parameter`; none are numbers.
        smooth_shape: the shape is continuous, so a scan is refined between its values.
        channels: channels that the recordings must have.
        confused_with: effects that trials often cannot tell apart from it.
        carried: part of the load that the gear transmits (see `prediction`).
        pipeline: of the measuring chain, not of the joint: reported as a finding of its own, so that a small skew
            between channels never hides physics.
        builds_on: what of a fitted model's prediction the columns use: "load" (`load_effort`), "inertia", or "effort"
            (`predicted`, `effort_rate`), which is the sum of all effects that do not build on it themselves.
        rows: on which it shows: "moving" where it lives near reversals and starts, which steady sliding cannot see.
        breakaway: its share in that effort; None where it has none, or none that is known.
        facts: attributes of `Facts` that must be known.
        hidden_by: effects in whose free scale it hides: while one of them is in the model, it cannot be judged.
        efforts: quantities of effort that it can show in; empty for all.
        unbounded_in: quantities of effort that hold an error of the same form, of either sign: no bound holds there.
        standing_in: pipeline nuisance columns that would absorb this effect (see `nuisance`).
        varies_with: a quantity that must differ over the data, e.g. "temperature_c", "load_kg".
        dry_friction: it is friction that varies with something else than speed; see `discrepancy`.
        discrepancy: (motion, shape) -> array (k, n): what the truth may differ from the equation by; None for nothing.
        least_of_friction: lowest coefficient over the model's dry friction: what stands in its place is as large as it.
        shape_over: (motions of all trials) -> the one shape that they give, in place of a scan; None: `shapes`.
        provisional: no mechanism, but a curve that stands for one that nobody knows yet.
        misreads: (motion, shape) -> array (k, n): how position is misread per unit of each of its first k coefficients.
        slope: (motion, shape) -> array (k, n): derivative of each column by the predicted effort, where it is so steep
            that the column cannot be taken for fixed while the rest is fitted.
        after: effects that a model must have before this one can be missing.
        grows: its shape is a list of orders, 0 for none; each further one is taken as long as the rows pay for it.
        by_position: it goes by the position itself, which a shaft that turns on and on does not have.
        by_angle: it goes by the angle of an arm, which a linear joint does not have.
        goes_round: its shape is an order of the position, as a force or against the motion: one that its shapes lack
            is found by a periodogram over the position; None: it has no such shape.
        told: (facts, shape) -> whether the owner tells of so much of it that a shape like this is not missing.
        searched: shape -> whether a search for the best one goes there; a scan may, to see what fits better beyond.
        holds: (shape that it takes in a model, what it comes to over all friction there) -> whether that is this effect
            still; None: any is.
        offered_by: package that it comes from, with its version; "" of ours.
        ends_within_scan: so many of the shape's first values end within the scan: what fits best at an upper end goes
            on beyond it, and is something else.
    """

    name: str
    title: str
    physics: str
    equation: str
    columns: Callable[[Motion, Shape], FloatArray]
    parameters: tuple[Parameter, ...]
    driver: str
    excited_by: str
    source: str
    shapes: Callable[[Motion], list[Shape]] = _no_shapes
    shape_names: tuple[str, ...] = ()
    shape_units: tuple[str, ...] = ()
    smooth_shape: bool = False
    channels: tuple[str, ...] = ()
    confused_with: tuple[str, ...] = ()
    carried: bool = False
    pipeline: bool = False
    builds_on: Literal["load", "inertia", "effort"] | None = None
    standing_in: frozenset[str] = field(default_factory=frozenset)
    varies_with: str | None = None
    rows: MotionRows = "sliding"
    facts: tuple[str, ...] = ()
    hidden_by: tuple[str, ...] = ()
    efforts: tuple[EffortQuantity, ...] = ()
    breakaway: BreakawayShare | None = None
    unbounded_in: tuple[EffortQuantity, ...] = ()
    dry_friction: bool = False
    discrepancy: Callable[[Motion, Shape], FloatArray] | None = None
    least_of_friction: float = 0.0
    searched: Callable[[Shape], bool] = _anywhere
    holds: Callable[[Shape, float], bool] | None = None
    ends_within_scan: int = 0
    shape_over: Callable[[Sequence[Motion]], Shape] | None = None
    provisional: bool = False
    misreads: Callable[[Motion, Shape], FloatArray] | None = None
    slope: Callable[[Motion, Shape], FloatArray] | None = None
    by_position: bool = False
    by_angle: bool = False
    after: tuple[str, ...] = ()
    grows: bool = False
    goes_round: Round | None = None
    told: Callable[[Facts, Shape], bool] = _nothing_told
    offered_by: str = ""

    def grid(self, motions: Sequence[Motion]) -> list[Shape]:
        """Shapes to scan, given the motions of all trials."""
        return self.shapes(motions[0]) if self.shape_over is None else [self.shape_over(motions)]

    @property
    def in_sentence(self) -> str:
        """Its title within a sentence: names of people stay as they are written."""
        return self.title if self.title.startswith(PEOPLE) else f"{self.title[0].lower()}{self.title[1:]}"

    @property
    def in_full(self) -> str:
        """Its name, with the package that it comes from."""
        return f"{self.name}, of package {self.offered_by}," if self.offered_by else self.name

    def try_out(self, motions: Sequence[Motion]) -> None:
        """Make all its columns once, as is done with an effect that nobody here has tested.

        Raises:
            EffectFailedError: it cannot, or they cannot be used.
        """
        for shape in self.grid(motions):
            for motion in motions:
                columns = np.asarray(self.columns(motion, shape))
                wanted = (len(self.parameters), len(motion.time_s))
                if columns.shape != wanted:
                    raise EffectFailedError(
                        f"{self.in_full} makes columns of shape {columns.shape}; wanted is {wanted}"
                    )
                if not np.isfinite(columns).all():
                    raise EffectFailedError(
                        f"{self.in_full} makes columns that are not all numbers; `channels` has to name what it needs"
                    )

    def shows_in(self, effort: Effort) -> bool:
        """Whether an effort can hold it; a voltage measured at the motor's terminals holds no supply that sags."""
        sags = "supply_is_nominal" in self.facts and effort.channels == ("voltage_v",)
        return not sags and (not self.efforts or effort.quantity in self.efforts)

    def ranges_in(self, quantity: EffortQuantity) -> list[tuple[float, float]]:
        """Lowest and highest possible coefficient of each parameter, in a quantity of effort."""
        if quantity in self.unbounded_in:
            return [(-np.inf, np.inf)] * len(self.parameters)
        return [(parameter.low, parameter.high) for parameter in self.parameters]

    @property
    def uses_prediction(self) -> bool:
        """Whether a model must be fitted before the columns can be computed."""
        return self.builds_on is not None


def at_rest(
    columns: Callable[[Motion, Shape], FloatArray], parameters: tuple[Parameter, ...], driver: str
) -> BreakawayShare:
    """The share of an effect without shape whose columns hold at rest as they do in motion."""
    return BreakawayShare(lambda onset, shape: columns(onset.motion, shape), parameters, driver)
