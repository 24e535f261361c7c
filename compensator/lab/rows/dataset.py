"""The rows of a study: every trial's signals, and columns of any effect filtered and thinned like the effort."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import accumulate, pairwise
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from compensator.lab.effects.effect import Effect, Motion, Shape
from compensator.lab.errors import NotApplicableError
from compensator.lab.recordings.differentiation import later, rates_of_change
from compensator.lab.recordings.effort import EFFORTS, in_rig
from compensator.lab.recordings.facts import Effort, Facts
from compensator.lab.recordings.low_pass import low_pass_thinned
from compensator.lab.recordings.processing import Signals
from compensator.lab.recordings.recording import BoolArray, FloatArray, IntArray
from compensator.lab.recordings.regimes import Regime

RowChoice = Literal["sliding", "moving", "all"]
ROW_CHOICES: tuple[RowChoice, ...] = ("sliding", "moving", "all")  # each holds the one before

AT_ONCE = 2**18  # values at the full rate that are filtered at once: what a processor's own cache holds
SIDE_BY_SIDE = 32  # columns that are filtered at once, at least
EFFORT: tuple[str, Shape] = ("the effort itself", ())  # kept: the same whatever is predicted or misread
SLOPE_STEP = 1e-5  # of the span of position, over which something is differenced
BLOCK_S = 2.0  # rows closer than this are not independent
LEAST_SEEN = 0.01  # of the noise's power: a filter that sees so little rings
FEWEST_ROWS = 20  # of a trial that is judged by itself
UNTOLD = {
    "gear_ratio": "needs the gear ratio, which the rig does not tell; put [gear] ratio into rig.toml",
    "sensor_turns": (
        "needs the turns of the position sensor, which the rig does not tell; put [gear] ratio, or [sensor] at = "
        '"joint", into rig.toml'
    ),
    "supply_is_nominal": (
        "cannot hide behind a supply voltage that is measured, as one that changes is; if nobody measured it, put "
        "[supply] is_nominal = true into rig.toml"
    ),
}
"""Facts that effects need -> what is to be said where they are not told."""
UNTOLD_FACT = "needs {}, which the rig does not tell"  # of effects that others bring


@dataclass(frozen=True, slots=True)
class Processing:
    """How recordings become rows.

    Attributes:
        cutoff_hz: of the final low-pass; None lets the data choose (see `bandwidth`).
        rows: which rows a model is fitted to and judged on.
    """

    cutoff_hz: float | None = None
    rows: RowChoice = "sliding"


@dataclass(frozen=True, slots=True)
class Scales:
    """What all trials of a dataset are measured by, so that the columns of any two of them are alike.

    Attributes:
        noise: standard deviation of the velocity's noise.
        slow: speed below which direction is uncertain; fast: 95 % quantile of speed.
        position_span: range of position.
        session_span_s: from the first trial's start to the last one's end.
        start_rate: geometric mean of the rates at which the effort changes when the joint starts [effort/s].
        largest_effort: that the model predicts for trials of the dataset that these ones come to; 0: of these ones.
    """

    noise: float
    slow: float
    fast: float
    position_span: float
    session_span_s: float
    start_rate: float = np.nan
    largest_effort: float = 0.0


@dataclass(frozen=True)
class Trial:
    """One recording, ready: its motion at the full rate and which of its samples are rows.

    Attributes:
        signals, motion: of n samples.
        picked: samples that are rows, thinned to the Nyquist rate.
        regimes: of every sample, shape (n,).
        window: weights of the samples that rows in steady sliding see, shape (n,); all others see all samples.
    """

    signals: Signals
    motion: Motion
    picked: IntArray
    regimes: NDArray[np.uint8]
    window: FloatArray

    @property
    def regime(self) -> NDArray[np.uint8]:
        """Of each row."""
        return self.regimes[self.picked]


@dataclass(frozen=True)
class Dataset:
    """All rows of a study's trials. N rows in all.

    Attributes:
        trials: in the order given.
        effort_definition: what `effort` holds, with its unit.
        facts: of the joint.
        cutoff_hz: of the final low-pass.
        rows: which regimes count.
        scales: of all trials.
        crosses_free_play: rows near a crossing of the free play are counted, since nearly all are.
        sees_all: rows in steady sliding see all samples, too (see `seen_by`).
        held_out: trials that no model is fitted to, as far as the owner says, by their index.
        uncorrected: the same rows at the position that the sensor reads; None: these are.
    """

    trials: tuple[Trial, ...]
    effort_definition: Effort
    facts: Facts
    cutoff_hz: float
    rows: RowChoice
    scales: Scales
    crosses_free_play: bool = False
    sees_all: bool = False
    held_out: frozenset[int] = frozenset()
    uncorrected: "Dataset | None" = None
    cache: dict[tuple[str, Shape], FloatArray] = field(default_factory=dict, repr=False, compare=False)
    unfiltered: dict[tuple[str, Shape], FloatArray] = field(default_factory=dict, repr=False, compare=False)

    @cached_property
    def effort(self) -> FloatArray:
        """Filtered effort, shape (N,)."""
        if EFFORT not in self.cache:
            self.cache[EFFORT] = self.stack([trial.signals.effort[None] for trial in self.trials])[:, 0]
        return self.cache[EFFORT]

    @cached_property
    def effort_gained_in_step(self) -> FloatArray:
        """The effort at the time of the motion that it makes, less that recorded then, filtered, shape (N,).

        By the delay that the model has: what else the joint does is recorded as late as all that the model knows of it.
        Held against an effort of another moment, what swings, or turns round, would be out of step.
        """
        signals, late_s = [trial.signals for trial in self.trials], self.trials[0].motion.late_s
        if late_s == 0.0:
            return np.zeros(len(self.effort))
        return self.stack((later(s.effort, -late_s, s.rate_hz) - s.effort)[None] for s in signals)[:, 0]

    @cached_property
    def bent_effort(self) -> FloatArray:
        """What the model's bend adds for all of the predicted effort, filtered, shape (N,); see `with_bend`."""
        if not self.is_bent:
            return np.zeros(len(self.effort))
        return self.stack([(trial.motion.bend * trial.motion.predicted)[None] for trial in self.trials])[:, 0]

    @cached_property
    def target(self) -> FloatArray:
        """Filtered effort that columns are fitted to, shape (N,): where the model bends, that of its tangent."""
        return self.effort + self.bent_effort

    @cached_property
    def steadiness(self) -> FloatArray:
        """Weight of each row, shape (N,): where the model bends, whatever it misses comes multiplied."""
        if not self.is_bent:
            return np.ones(len(self.effort))
        motions = [trial.motion for trial in self.trials]
        bends = self.stack([np.maximum(np.abs(motion.bend), motion.doubt)[None] for motion in motions])[:, 0]
        return 1.0 / (1.0 + np.maximum(bends, 0.0))

    @property
    def scales_for_others(self) -> Scales:
        """By which other trials have columns as these ones have them, or some of these alone."""
        return replace(self.scales, largest_effort=self.trials[0].motion.largest_effort)

    @cached_property
    def constant(self) -> FloatArray:
        """1 as the rows see it, shape (N,): less where their filter sees less than all."""
        return self.stack([np.ones((1, len(trial.motion.time_s))) for trial in self.trials])[:, 0]

    @cached_property
    def noise_seen(self) -> FloatArray:
        """Of white noise in the effort, what each row sees over what one sees that sees all, about; shape (N,)."""
        if self.sees_all or self.rows != "sliding":
            return np.ones(len(self.effort))
        power = self.stack([trial.window[None] for trial in self.trials])[:, 0]  # by their windows once more
        seen: FloatArray = np.sqrt(np.clip(power, LEAST_SEEN, 1.0))
        return np.where(self.regime == Regime.SLIDING, seen, 1.0)

    @property
    def is_predicted(self) -> bool:
        """Whether a model's prediction is in the motions (see `with_prediction`)."""
        return any(trial.motion.largest_effort > 0.0 for trial in self.trials)

    @cached_property
    def is_bent(self) -> bool:
        """Whether any column carries what an effect with a slope makes of it."""
        return any(trial.motion.is_bent for trial in self.trials)

    @cached_property
    def trial_index(self) -> IntArray:
        """Which trial each row belongs to, shape (N,)."""
        return np.concatenate([np.full(len(t.picked), i, dtype=np.int64) for i, t in enumerate(self.trials)])

    @cached_property
    def trial_rows(self) -> list[slice]:
        """Where each trial's rows are among all rows (N,)."""
        return _side_by_side(len(trial.picked) for trial in self.trials)

    @cached_property
    def block_index(self) -> IntArray:
        """Which stretch of BLOCK_S each row belongs to, shape (N,); stretches never cross trials."""
        labels, start = [], 0
        for trial in self.trials:
            block = (self.time_of(trial) // BLOCK_S).astype(np.int64)
            _, dense = np.unique(block, return_inverse=True)
            labels.append(dense + start)
            start += int(dense.max()) + 1 if len(dense) else 0
        return np.concatenate(labels)

    @cached_property
    def regime(self) -> NDArray[np.uint8]:
        """`Regime` of each row, shape (N,)."""
        return np.concatenate([trial.regime for trial in self.trials])

    @cached_property
    def counted(self) -> BoolArray:
        """Rows that a model is fitted to and judged on, shape (N,)."""
        return self.in_regimes(self.rows)

    def stretches(self, rows: BoolArray) -> int:
        """How many stretches of BLOCK_S rows (N,) are of."""
        return len(np.unique(self.block_index[rows]))

    def in_regimes(self, choice: RowChoice) -> BoolArray:
        """Rows of these regimes, shape (N,)."""
        if choice == "all":
            return np.ones(len(self.regime), dtype=bool)
        chosen: BoolArray = self.regime == Regime.SLIDING if choice == "sliding" else self.regime != Regime.STUCK
        return chosen

    def seen_by(self, choice: RowChoice) -> "Dataset":
        """The same rows, of which a filter sees no more than the choice asks for; those of a wider study see all.

        In steady sliding that is nothing of other regimes. A stuck joint has any effort, and near reversals teeth fly:
        what the filter carried of it into steady sliding would be told as friction there.
        """
        sees_all = choice != "sliding"
        if self.sees_all == sees_all or self.rows != "sliding":
            return self
        uncorrected = None if self.uncorrected is None else self.uncorrected.seen_by(choice)
        return replace(self, sees_all=sees_all, uncorrected=uncorrected, cache={})

    def choice_for(self, effects: Sequence[Effect]) -> RowChoice:
        """The rows that a model of these effects is fitted to: wider than the study's where an effect needs it."""
        wanted: RowChoice = "moving" if any(effect.rows == "moving" for effect in effects) else "sliding"
        return max(self.rows, wanted, key=ROW_CHOICES.index)

    @staticmethod
    def time_of(trial: Trial) -> FloatArray:
        """Time of the trial's rows since its start [s]."""
        time: FloatArray = trial.signals.time_s[trial.picked] - trial.signals.time_s[0]
        return time

    def columns(self, effect: Effect, shape: Shape) -> FloatArray:
        """The effect's columns over all rows, filtered like the effort; shape (N, k).

        Raises:
            NotApplicableError: a channel or a varying condition that the effect needs is not there.
        """
        return self.columns_of_shapes(effect, [shape])[0]

    def columns_of_shapes(self, effect: Effect, shapes: Sequence[Shape]) -> list[FloatArray]:
        """The effect's columns for each shape, (N, k) each; all shapes are filtered in one pass per trial.

        Columns that do not depend on the predicted load are kept: shape searches ask for them again and again.

        Raises:
            NotApplicableError: as `columns`.
        """
        self.check_applicable(effect)
        return self.unchecked_columns(effect, shapes)

    def unchecked_columns(self, effect: Effect, shapes: Sequence[Shape]) -> list[FloatArray]:
        """As `columns_of_shapes`, where it is known that the effect can be judged, or other trials decide that."""
        return self.columns_of_effects([(effect, shapes)])[0]

    def columns_of_model(self, effects: Sequence[Effect], shapes: Mapping[str, Shape]) -> FloatArray:
        """The columns of a model's effects, each of its shape, beside each other; shape (N, K).

        Raises:
            NotApplicableError: as `columns`.
        """
        for effect in effects:
            self.check_applicable(effect)
        made = self.columns_of_effects([(effect, [shapes.get(effect.name, ())]) for effect in effects])
        return np.concatenate([block for (block,) in made], axis=1)

    def columns_of_effects(self, wanted: Sequence[tuple[Effect, Sequence[Shape]]]) -> list[list[FloatArray]]:
        """The columns of many effects, for each of their shapes, (N, k) each: all are filtered in one pass per trial.

        A filter's call costs more than its work on a short trial, so that many columns cost little more than one.
        Unchecked: see `unchecked_columns`.
        """
        cache = {} if self.is_bent else self.cache  # what is kept knows of no bend
        missing = [(e, shape) for e, shapes in wanted for shape in shapes if (e.name, shape) not in cache]
        made: dict[tuple[str, Shape], FloatArray] = {}
        for some in self._portions(missing):
            ends = np.cumsum([len(effect.parameters) for effect, _ in some])[:-1]
            blocks = np.split(self.stack(_passed_on(some, trial.motion) for trial in self.trials), ends, axis=1)
            made.update({(effect.name, shape): block for (effect, shape), block in zip(some, blocks, strict=True)})
            cache.update({(e.name, shape): made[e.name, shape] for e, shape in some if not e.uses_prediction})
        return [
            [made[e.name, shape] if (e.name, shape) in made else cache[e.name, shape] for shape in shapes]
            for e, shapes in wanted
        ]

    def at_full_rate(self, effect: Effect, shape: Shape) -> FloatArray:
        """The effect's columns (k, m) over all trials' motions, one after the other, before they are filtered.

        Those that do not depend on the predicted load are kept: each pass of a fit asks for them.
        """
        kept = self.unfiltered.get((effect.name, shape))
        if kept is not None:
            return kept
        made = np.concatenate([effect.columns(trial.motion, shape) for trial in self.trials], axis=1)
        if not effect.uses_prediction:
            self.unfiltered[effect.name, shape] = made
        return made

    def slopes_at_full_rate(self, effect: Effect, shape: Shape) -> FloatArray:
        """What the columns of an effect of the position alone grow by for each unit of it, as `at_full_rate`."""
        key = (f"slope of {effect.name}", shape)
        if key not in self.unfiltered:
            step = SLOPE_STEP * max((trial.motion.position_span for trial in self.trials), default=1.0)
            motions = [trial.motion for trial in self.trials]
            ahead, behind = (
                np.concatenate(
                    [effect.columns(replace(one, position=one.position + way), shape) for one in motions], axis=1
                )
                for way in (0.5 * step, -0.5 * step)
            )
            self.unfiltered[key] = (ahead - behind) / step
        return self.unfiltered[key]

    @cached_property
    def samples(self) -> list[slice]:
        """Where each trial's samples are in an array (m,) over all trials' motions."""
        return _side_by_side(len(trial.motion.time_s) for trial in self.trials)

    def at_samples(self, by_trial: FloatArray) -> FloatArray:
        """Numbers of the trials (trials,) at every sample of theirs, shape (m,)."""
        return np.repeat(by_trial, [len(trial.motion.time_s) for trial in self.trials])

    @cached_property
    def tip_kg_m2(self) -> FloatArray:
        """Inertia of each trial's tip load about the axis [kg m^2], shape (trials,)."""
        return np.array([trial.motion.load_inertia_kg_m2 for trial in self.trials])

    def _portions(self, wanted: Sequence[tuple[Effect, Shape]]) -> Iterator[Sequence[tuple[Effect, Shape]]]:
        """So many at a time that one trial's columns at the full rate are filtered at once."""
        longest = max((len(trial.motion.time_s) for trial in self.trials), default=1)
        at_once = max(SIDE_BY_SIDE, AT_ONCE // longest)
        some: list[tuple[Effect, Shape]] = []
        columns = 0
        for effect, shape in wanted:
            if some and columns + len(effect.parameters) > at_once:
                yield some
                some, columns = [], 0
            some.append((effect, shape))
            columns += len(effect.parameters)
        if some:
            yield some

    def stack(self, full_rate: Iterable[FloatArray]) -> FloatArray:
        """Filter and thin arrays (k, n) given per trial, one after the other; shape (N, k)."""
        parts: list[FloatArray] = []
        waiting: list[FloatArray] = []
        values = done = 0
        for rows in full_rate:
            waiting.append(rows)
            values += rows.size
            if values >= max(AT_ONCE, SIDE_BY_SIDE * rows.shape[1]):
                parts.append(self._filtered(done, waiting))
                done += len(waiting)
                waiting, values = [], 0
        if waiting:
            parts.append(self._filtered(done, waiting))
            done += len(waiting)
        assert done == len(self.trials)
        return np.concatenate(parts) if len(parts) > 1 else parts[0]

    def rows_of(self, full_rate: Sequence[FloatArray]) -> FloatArray:
        """Thin arrays (n,) given per trial, without filtering; shape (N,)."""
        return np.concatenate([rows[trial.picked] for trial, rows in zip(self.trials, full_rate, strict=True)])

    def with_prediction(
        self,
        load_effort: FloatArray,
        predicted: FloatArray,
        parting: FloatArray,
        carried_slope: FloatArray,
        inertias: FloatArray,
        late_s: float = 0.0,
        back_emf: float = 0.0,
    ) -> "Dataset":
        """The same rows, with the predicted load and effort in every trial's motion.

        Args:
            load_effort: of all trials' motions, one after the other, shape (m,).
            predicted: the same.
            parting: the same.
            carried_slope: the same.
            inertias: `inertia_beyond`, `inertia` and `load_inertia` of each trial's motion, shape (3, trials).
            late_s: of every trial's motion.
            back_emf: of every trial's motion.
        """
        nothing, largest = np.zeros(len(predicted)), self.scales.largest_effort
        largest = largest or float(np.abs(predicted).max(initial=0.0))
        rates = rates_of_change(predicted, self.samples, [trial.signals.rate_hz for trial in self.trials])
        trials = tuple(
            replace(
                trial,
                motion=trial.motion.having(
                    load_effort=load_effort[own],
                    inertia_beyond=beyond,
                    inertia=whole,
                    load_inertia=tip,
                    parting=parting[own],
                    carried_slope=carried_slope[own],
                    predicted=predicted[own],
                    effort_rate=rates[own],
                    largest_effort=largest,
                    bend=nothing[own],
                    doubt=0.0,
                    late_s=late_s,
                    back_emf=back_emf,
                ),
            )
            for trial, own, (beyond, whole, tip) in zip(self.trials, self.samples, inertias.T.tolist(), strict=True)
        )
        return replace(self, trials=trials)

    def with_bend(self, bends: Sequence[FloatArray], doubts: Sequence[FloatArray | float] | None = None) -> "Dataset":
        """The same rows of a model f(p) + p that is steep in what it predicts, p, linearised about that (Gauss-Newton).

        Every column that p is made of carries 1 + f'(p), and f'(p) p is added to the effort that they are fitted to.

        Args:
            bends: f'(p) of each trial's motion, shape (n,).
            doubts: `Motion.doubt` of each trial's; None: none.
        """
        doubts = doubts or [0.0] * len(self.trials)
        each = zip(self.trials, bends, doubts, strict=True)
        motions = [trial.motion.having(bend=bend, doubt=doubt) for trial, bend, doubt in each]
        trials = tuple(replace(trial, motion=motion) for trial, motion in zip(self.trials, motions, strict=True))
        return replace(self, trials=trials)

    def as_read(self) -> "Dataset":
        """The same rows at the position that the sensor reads."""
        return self.uncorrected or self

    def corrected(self, motions: Sequence[Motion]) -> "Dataset":
        """The same rows with other motions, at the position that each trial's joint has rather than seems to have."""
        trials = tuple(replace(trial, motion=motion) for trial, motion in zip(self.trials, motions, strict=True))
        return replace(self, trials=trials, uncorrected=self.as_read(), cache={EFFORT: self.effort}, unfiltered={})

    def straightened(self) -> "Dataset":
        """The same rows, for a model that is still to be fitted: nothing bends."""
        return self.with_bend([np.zeros(len(trial.motion.time_s)) for trial in self.trials]) if self.is_bent else self

    @property
    def turns_on(self) -> bool:
        """Whether the shaft turns on and on (see `Motion.turns_on`)."""
        return any(trial.motion.turns_on for trial in self.trials)

    def check_applicable(self, effect: Effect) -> None:
        """Raise NotApplicableError, in words, where the recordings lack what the effect needs."""
        if why := self._never_shows(effect):
            raise NotApplicableError(f"{effect.name} {why}")
        for fact in effect.facts:
            if not getattr(self.facts, fact):
                raise NotApplicableError(f"{effect.name} {UNTOLD.get(fact, UNTOLD_FACT.format(fact))}")
        for channel in effect.channels:
            if not all(channel in trial.signals.recording.channels for trial in self.trials):
                raise NotApplicableError(f"{effect.name} needs channel {channel} in every trial; record it")
        if effect.varies_with and not self._varies(effect.varies_with):
            lacks = self._lacking(effect)
            raise NotApplicableError(f"{effect.name} needs {effect.varies_with} to differ over the data, and {lacks}")
        if effect.offered_by and effect.name not in self._tried_out:
            effect.try_out([trial.motion for trial in self.trials])
            self._tried_out.add(effect.name)

    def _never_shows(self, effect: Effect) -> str:
        """Why trials of this joint and effort cannot show an effect, whatever they hold; empty where they could."""
        effort = self.effort_definition
        if not effect.shows_in(effort):
            return f"does not show in {effort.title}, but in {in_rig([one for one in EFFORTS if effect.shows_in(one)])}"
        if effect.by_angle and self.facts.joint == "linear":
            return (
                "goes by the angle of an arm, and this joint is linear: what it lifts weighs the same everywhere; add "
                'offset, which does, or, if the joint turns, put joint = "rotary" into rig.toml'
            )
        if effect.by_position and self.turns_on:
            turns = self.scales.position_span / (2.0 * np.pi)
            return f"goes by the position, and the shaft turns on for {turns:.0f} turns; record motion that comes back"
        return ""

    def _lacking(self, effect: Effect) -> str:
        """Why what an effect varies with does not differ, and what to do."""
        if effect.varies_with == "temperature_c":
            empty = [t.signals.recording.name for t in self.trials if not np.isfinite(t.motion.temperature_c).all()]
            if empty:
                return f"it is empty, in part or all the time, in {', '.join(empty[:3])}; leave such trials out"
        elif effect.varies_with is not None and not self._is_told(effect.varies_with):
            return f"no trial tells it; put it into trials.csv where it was known, or record {effect.excited_by}"
        return f"it does not; record {effect.excited_by}"

    @cached_property
    def _tried_out(self) -> set[str]:
        """Effects of other packages whose columns could be made."""
        return set()

    def _is_told(self, condition: str) -> bool:
        return any(condition in trial.signals.recording.conditions for trial in self.trials)

    def _varies(self, quantity: str) -> bool:
        if quantity == "temperature_c":
            values = self.rows_of([trial.motion.temperature_c for trial in self.trials])
            return bool(np.isfinite(values).all() and np.ptp(values) >= 1.0)
        values = np.array([trial.motion.condition(quantity, 0.0) for trial in self.trials])
        return bool(np.ptp(values) > 0.0)

    def _filtered(self, start: int, full_rate: Sequence[FloatArray]) -> FloatArray:
        """Filter and thin arrays (k, n) of some trials in a row, from the one of an index on; shape (rows, k).

        Effort and columns are seen alike, so that the equation holds (modulating functions: Shinbrot 1957).
        """
        trials = self.trials[start : start + len(full_rate)]
        rates_hz, picked = [trial.signals.rate_hz for trial in trials], [trial.picked for trial in trials]
        whole = low_pass_thinned(full_rate, self.cutoff_hz, rates_hz, picked)
        if self.sees_all or self.rows != "sliding":
            return whole
        sliding = np.concatenate([trial.regime for trial in trials]) == Regime.SLIDING
        windowed = [trial.window * rows for trial, rows in zip(trials, full_rate, strict=True)]
        return np.where(sliding[:, None], low_pass_thinned(windowed, self.cutoff_hz, rates_hz, picked), whole)


def _side_by_side(lengths: Iterable[int]) -> list[slice]:
    """Where parts of such lengths are in an array of all of them."""
    return [slice(first, end) for first, end in pairwise(accumulate(lengths, initial=0))]


def _passed_on(wanted: Sequence[tuple[Effect, Shape]], motion: Motion) -> FloatArray:
    """The columns (k, n) of effects in one trial, and what the model makes of them where it bends."""
    columns = [effect.columns(motion, shape) for effect, shape in wanted]
    if motion.is_bent:
        bent = [effect.builds_on != "effort" for effect, _ in wanted]
        columns = [own * (1.0 + motion.bend) if some else own for own, some in zip(columns, bent, strict=True)]
    return np.concatenate(columns) if len(columns) > 1 else columns[0]
