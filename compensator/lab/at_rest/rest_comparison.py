"""A model held against the joint at rest: what lies outside the efforts between which its friction could hold it.

What lies outside on one side only is no friction: the middle of the span is wrong, by gravity, by an offset, or by the
constant that makes an effort of a current. What lies outside on both sides is static friction that the model lacks.
"""

from dataclasses import dataclass

import numpy as np
from scipy.stats import t as student

from compensator.lab.at_rest.breakaway_regression import BreakawayFit, fit_breakaway
from compensator.lab.at_rest.breakaway_rows import enough_starts
from compensator.lab.at_rest.rests import Windows, extrapolated, limits_of, windows_of
from compensator.lab.chance import SIGNIFICANT, chance_in_words
from compensator.lab.model.fitted import Fit
from compensator.lab.model.held_out_error import relative_error, rms
from compensator.lab.recordings.recording import FloatArray

FEWEST_WINDOWS = 5
MOSTLY = 0.1  # more stretches beyond friction than that, though it is no evidence: the model itself is too uncertain


@dataclass(frozen=True)
class Side:
    """What lies beyond one end of the span.

    Attributes:
        outside: share of the windows, 0..1.
        largest: violation, in the effort's unit; 0 where there is none.
        chance: that noise and what the model leaves in sliding bring one as sure, in any window.
        trial, time_s: of the surest one: name, and since the start of the trial.
    """

    outside: float
    largest: float
    chance: float
    trial: str
    time_s: float


@dataclass(frozen=True)
class RestComparison:
    """A model held against all rests.

    Attributes:
        windows: how many stretches of 0.1 s; rests: how many rests they are of.
        above, below: what lies beyond either end.
        rms: of the violations over all windows, in the effort's unit; relative: over the effort there.
        by_starts: whether starts from rest tell static friction; else sliding alone does.
    """

    windows: int
    rests: int
    above: Side
    below: Side
    rms: float
    relative: float
    by_starts: bool

    @property
    def outside(self) -> float:
        """Share of the windows that lie beyond either end."""
        return self.above.outside + self.below.outside

    @property
    def largest(self) -> float:
        """The largest violation, in the effort's unit."""
        return max(self.above.largest, self.below.largest)

    @property
    def is_friction(self) -> bool:
        """Whether both ends are violated for sure: static friction is more than the model has."""
        return max(self.above.chance, self.below.chance) <= SIGNIFICANT

    @property
    def is_evidence(self) -> bool:
        """Whether the violations are no chance."""
        return min(self.above.chance, self.below.chance) <= SIGNIFICANT


def compare_at_rest(fit: Fit) -> RestComparison | None:
    """Hold a fitted model against the joint at rest; None where its trials have next to no rest."""
    windows = windows_of(fit.dataset)
    if len(windows) < FEWEST_WINDOWS:
        return None
    starts = _starts(fit)
    limits = limits_of(fit, windows, starts)
    left = rms(fit.residual[fit.training])  # a model that leaves so much in sliding says no more of rest
    scatter = np.hypot(left, starts.scatter if starts is not None else extrapolated(fit))
    known_from = limits.known_from
    sides = [
        _side(fit, windows, beyond, np.hypot(scatter, deviation), known_from)
        for beyond, deviation in (
            (windows.effort - limits.high, limits.high_sd),
            (limits.low - windows.effort, limits.low_sd),
        )
    ]
    outside = np.maximum(0.0, np.maximum(windows.effort - limits.high, limits.low - windows.effort))
    return RestComparison(
        windows=len(windows),
        rests=len(np.unique(windows.rest)),
        above=sides[0],
        below=sides[1],
        rms=rms(outside),
        relative=relative_error(outside, windows.effort),
        by_starts=starts is not None,
    )


def _starts(fit: Fit) -> BreakawayFit | None:
    rows = enough_starts(fit)
    return None if rows is None else fit_breakaway(rows, fit.effects)


def _side(fit: Fit, windows: Windows, beyond: FloatArray, deviation: FloatArray, known_from: int) -> Side:
    """Judge one end: the surest violation, times as many windows and ends as it could have been (Bonferroni)."""
    surest = int(np.argmax(beyond / deviation))
    single = float(student.sf(beyond[surest] / deviation[surest], known_from))
    trial = fit.dataset.trials[int(windows.trial_index[surest])]
    return Side(
        outside=float(np.mean(beyond > 0.0)),
        largest=max(0.0, float(beyond.max())),
        chance=min(1.0, 2.0 * len(windows) * single),
        trial=trial.signals.recording.name,
        time_s=float(trial.motion.time_s[int(windows.index[surest])]),
    )


def at_rest_in_words(found: RestComparison, unit: str) -> str:
    """One sentence; what to do where the violations are no chance."""
    if not found.is_evidence:
        stretches = f"At rest: of {found.windows} stretches of 0.1 s"
        if found.outside == 0.0:
            return f"{stretches}, all lie within what friction holds."
        beyond = f"{stretches}, {found.outside:.1%} lie beyond what friction holds, by up to {found.largest:.3g} {unit}"
        if found.outside <= MOSTLY:
            return f"{beyond}: no more than chance."
        if not found.by_starts:
            return (
                f"{beyond}: no more than sliding leaves open, which shows static friction down to its slowest speed "
                "only; record breakaway ramps."
            )
        return (
            f"{beyond}: no more than what the model leaves while the joint slides, so that rest tells nothing; mend "
            "the model there first."
        )
    surest = min(found.above, found.below, key=lambda side: side.chance)
    where = "on both sides" if found.is_friction else f"{'above' if surest is found.above else 'below'} only"
    told = (
        f"At rest: of {found.windows} stretches of 0.1 s, {found.outside:.1%} lie beyond what friction holds, {where}, "
        f"by up to {found.largest:.3g} {unit} (trial '{surest.trial}' at {surest.time_s:.3g} s; "
        f"{chance_in_words(surest.chance)})"
    )
    if found.is_friction:
        # starts that tell the static friction are ramps, or as good
        todo = (
            "diagnose it from the starts that are there: it may grow with rest, load or rate"
            if found.by_starts
            else "it may rise at speeds below the slowest that slid: record breakaway ramps at several rates and rests"
        )
        return f"{told}: static friction is more than this model has; {todo}."
    if not found.by_starts:
        return (
            f"{told}: static friction may be more than sliding shows, or gravity or an offset is wrong at rest; record "
            "breakaway ramps, which tell."
        )
    return (
        f"{told}: that is no friction. Gravity, an offset or the constant that makes efforts of currents is wrong at "
        "rest, or the joint leans against a stop; hold it there, come from either side, and compare with the power off."
    )
