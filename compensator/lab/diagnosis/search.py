"""Several effects at once: forward, swap, backward.

The first name is given while the others are still missing, and may be a mixture of them. So after every effect that is
added, each earlier one is taken out again and its place is judged anew, given all the others; and what no longer helps
on held-out rows is dropped (Efroymson 1960, with held-out error in place of F).

Two effects that are missing at once may look like something that no formula follows: a free curve imitates both, and
each formula but one. Two that differ from trial to trial alone are noise to each other. So where nothing is confirmed,
the search goes on from the likeliest formulas, and has names after all where two or more of them leave nothing.
"""

from dataclasses import dataclass, replace
from typing import Literal

from compensator.lab import progress
from compensator.lab.chance import SIGNIFICANT
from compensator.lab.diagnosis.confirmation import explained_part, slight_one
from compensator.lab.diagnosis.diagnose import best_named, diagnose
from compensator.lab.diagnosis.diagnosis import Diagnosis, JudgedRows
from compensator.lab.effects.catalogue import effect_named, withheld
from compensator.lab.model.fit import fit_effects, widened
from compensator.lab.model.fitted import Fit
from compensator.lab.model.gain import Gain, held_out_gain, predicts_better
from compensator.lab.model.held_out_error import HeldOut, on_even_terms
from compensator.lab.model.validation import held_out
from compensator.lab.rows.dataset import RowChoice
from compensator.lab.screening.evidence import VERY_STRONG

MOST_EFFECTS = 4
MOST_TRIED = 3  # in the place of a curve that has no name

TRYING = "Trying formulas beside each other"

Change = Literal["add", "swap", "drop"]


@dataclass(frozen=True)
class StepGain:
    """What a change did to the held-out error on the rows that it was judged on.

    Attributes:
        rows: which rows these are.
        before, after: relative held-out errors, 0..1, each row counting alike.
        gain: relative fall of the error, each row counting by how well it is known.
    """

    rows: JudgedRows | RowChoice
    before: float
    after: float
    gain: Gain


@dataclass(frozen=True)
class Step:
    """One change of the model.

    Attributes:
        change: what was done; effect: to which effect; instead_of: for a swap, which one gave way.
        fit: the model after it.
        held_out: its error, on the study's rows.
        rivals: effects that it could as well be, of one that is added.
        judged: the gain that it was judged by; None where no diagnosis has one.
    """

    change: Change
    effect: str
    instead_of: str | None
    fit: Fit
    held_out: HeldOut
    rivals: tuple[str, ...] = ()
    judged: StepGain | None = None


@dataclass(frozen=True)
class Search:
    """The way from a model to one that lacks nothing that these trials can show.

    Attributes:
        start: the model that was searched from.
        steps: in order; empty where nothing is missing.
        last: diagnosis of the final model.
    """

    start: Fit
    steps: tuple[Step, ...]
    last: Diagnosis

    @property
    def fit(self) -> Fit:
        """The final model."""
        return self.steps[-1].fit if self.steps else self.start

    @property
    def added(self) -> tuple[str, ...]:
        """Effects that the final model has and the first one had not."""
        return tuple(name for name in self.fit.names if name not in self.start.names)


def stages_of(most: int) -> tuple[str, ...]:
    """Stages of a search that adds so many effects at most, as whoever waits for it is told of them."""
    return (*(_adding(number) for number in range(1, most + 1)), TRYING)


def _adding(number: int) -> str:
    return f"Adding effect {number}, and judging the others anew"


def search(fit: Fit, most: int = MOST_EFFECTS, first: Diagnosis | None = None, outset: float | None = None) -> Search:
    """Add effects while a diagnosis names one that is not slight, and keep the earlier ones honest.

    Args:
        fit: the model to begin with; its own effects stay.
        most: effects that are added at most.
        first: diagnosis of that model, where it is known.
        outset: relative held-out error, 0..1, of the model that effects were added to before; None: of this one. What
            they explain says what is slight.

    Raises:
        UnusableDataError: as `diagnose`.
    """
    outset = held_out(fit).relative if outset is None else outset
    found = _forward(fit, most, first or diagnose(fit), outset)
    room = most - len(found.added)
    further = _from_likeliest(found.fit, room, found.last, outset) if room > 1 else None
    return found if further is None else Search(fit, (*found.steps, *further.steps), further.last)


def _forward(fit: Fit, most: int, diagnosis: Diagnosis, outset: float) -> Search:
    """As long as a diagnosis names an effect that is not slight. Arguments as `search`."""
    start, steps, undecided = fit, [], set[str]()
    explained = explained_part(outset, held_out(fit).relative)
    while _is_to_add(diagnosis, explained) and len(fit.names) < len(start.names) + most:
        progress.enter(_adding(len(fit.names) - len(start.names) + 1))
        name, *rivals = diagnosis.classes[0]
        grown, judged = fit_effects(fit, [*fit.names, name]), _judged_by(diagnosis, name)
        steps.append(_step("add", name, None, grown, judged, tuple(rivals)))
        swapped = _swaps(start, steps[-1].fit)
        dropped = _drops(start, (swapped or steps)[-1].fit, last_too=bool(swapped))
        steps += [*swapped, *dropped]
        if set(steps[-1].fit.names) in [set(start.names), *(set(step.fit.names) for step in steps[:-1])]:
            undecided.add(name)  # the same model again: the trials do not decide, and the search goes on without it
        fit = steps[-1].fit
        explained = explained_part(outset, steps[-1].held_out.relative)
        # what other trials are not predicted better with is not added again before the model has something else
        with withheld(undecided | {step.effect for step in dropped}):
            diagnosis = diagnose(fit)
    return Search(start, tuple(steps), diagnosis)


def _is_to_add(diagnosis: Diagnosis, explained: float) -> bool:
    return diagnosis.verdict == "missing" and slight_one(diagnosis, explained) is None


def _from_likeliest(fit: Fit, most: int, diagnosis: Diagnosis, outset: float) -> Search | None:
    """From a model to which nothing is confirmed: the first way by likely formulas that leaves nothing; None without.

    A single formula is none: it was judged already.

    Args:
        fit: the model.
        most: effects that are added at most.
        diagnosis: of it.
        outset: as `search`.
    """
    # what can be it, by very strong evidence, and helps for sure; the likeliest first
    sure = [
        one
        for one in sorted(diagnosis.candidates, key=lambda one: -one.score)
        if one.physical and one.score >= VERY_STRONG and one.rows == "sliding" and one.gain.low > 0.0
    ]
    if diagnosis.verdict not in ("nothing", "unknown-effect") or not sure:
        return None
    progress.enter(TRYING)
    for one in progress.each(sure[:MOST_TRIED]):
        named = replace(diagnosis, verdict="missing", classes=[(one.effect.name,)])
        found = _forward(fit, most, named, outset)
        if len(found.added) > 1 and _leaves_nothing(found.last):
            return found
    return None


def _leaves_nothing(diagnosis: Diagnosis) -> bool:
    """Whether all that its model leaves is noise."""
    return diagnosis.verdict == "nothing" and not diagnosis.remains and diagnosis.p_value > SIGNIFICANT


def _step(
    change: Change,
    effect: str,
    instead_of: str | None,
    fit: Fit,
    judged: StepGain | None,
    rivals: tuple[str, ...] = (),
) -> Step:
    return Step(change, effect, instead_of, fit, held_out(fit), rivals, judged)


def _judged_by(diagnosis: Diagnosis, name: str) -> StepGain | None:
    """The gain by which a diagnosis names an effect."""
    found = next((one for one in diagnosis.candidates if one.effect.name == name), None)
    return None if found is None else StepGain(found.rows, found.before, found.after, found.gain)


def _gained(rows: RowChoice, before: HeldOut, after: HeldOut) -> StepGain:
    return StepGain(rows, before.relative, after.relative, held_out_gain(before, after))


def _swaps(start: Fit, fit: Fit) -> list[Step]:
    """Exchange added effects, oldest first, for what the rows speak for more now that the others are in the model."""
    steps: list[Step] = []
    for name in [name for name in fit.names if name not in start.names][:-1]:
        without = fit_effects(fit, [other for other in fit.names if other != name])
        better = best_named(without, effect_named(name).rows)
        if better is not None and better not in fit.names:
            swapped = fit_effects(fit, [better if other == name else other for other in fit.names])
            errors = held_out(fit), held_out(swapped)
            before, now = on_even_terms(*errors)
            if now.rms < before.rms:
                fit = swapped
                steps.append(_step("swap", better, name, fit, _gained(fit.dataset.rows, *errors)))
    return steps


def _drops(start: Fit, fit: Fit, last_too: bool) -> list[Step]:
    """Drop added effects that no longer lower the held-out error for sure.

    Args:
        start: the model that was searched from.
        fit: with what was added, the last one last.
        last_too: the last one was named beside another model: it may have made up for a name that has given way.
    """
    steps: list[Step] = []
    added = [name for name in fit.names if name not in start.names]
    for name in added if last_too else added[:-1]:
        without = fit_effects(fit, [other for other in fit.names if other != name])
        rows = fit.dataset.choice_for([effect_named(name)])
        wide = fit.dataset.choice_for(fit.effects)  # else the two are judged on other rows
        having, lacking = (held_out(widened(one, wide), rows) for one in (fit, without))
        if not predicts_better(having, lacking):
            fit = without
            steps.append(_step("drop", name, None, fit, _gained(rows, having, lacking)))
    return steps
