"""Units of one kind beside each other: each has a study of its own, and all are fitted with the same model."""

from collections.abc import Sequence
from dataclasses import replace

from scipy.special import stdtrit

from bench.store import Store
from bench.study.errors import StudyError
from bench.study.keep import kept_of
from bench.study.material import Definition, Material, material_of, model_of
from bench.study.models.base import EffortName
from bench.study.models.stages import FITTING, UNITS
from bench.study.models.units import Unit, UnitComparison, UnitDifference, UnitParameter, UnitValue
from compensator.lab import progress
from compensator.lab.effects.catalogue import effect_named
from compensator.lab.effects.effect import Shape
from compensator.lab.model.fitted import Fit
from compensator.lab.model.held_out_error import relative_error
from compensator.lab.recordings.facts import Facts
from compensator.lab.units.judgement import PAIR, Judged, difference, judge
from compensator.lab.units.quantities import FEWEST_UNITS, Quantity, UnitFit, quantities_of, shared_shapes, unit_fit_of
from compensator.lab.units.random_effects import UPPER

KIND = ("joint", "horizontal", "gear_ratio", "torque_per_current_n_m_a", "effort")
"""Facts that are the same in all units of a kind; backlash, stiffness and arm are measured of each."""
MOST_NAMED = 6


@progress.stages(UNITS)
def compare_units(store: Store, study_id: int, beside: Sequence[int], model_id: int | None = None) -> UnitComparison:
    """What units have in common, what differs between them, and which of them is an outlier; of two, what differs.

    Args:
        store: with the studies.
        study_id: the study whose model is used; its trials are those of one unit.
        beside: a study for each other unit; from two on it is known how units scatter.
        model_id: which model of the first; None takes the newest.

    Raises:
        NotFoundError: no such study, or one of its trials is gone.
        StudyError: fewer than two, not of one kind, or a unit whose trials the model cannot be fitted to.
    """
    study_ids = list(dict.fromkeys((study_id, *beside)))
    if len(study_ids) < PAIR:
        raise StudyError(
            f"1 unit; to see a difference takes {PAIR}, to know how units scatter at least {FEWEST_UNITS}, to find an "
            "outlier takes 4 and better 6: name one study for each"
        )
    names = [store.study(number).name for number in study_ids]
    definitions = _alike(study_ids, [Definition.from_json(store.study(number).definition) for number in study_ids])
    chosen = model_of(store, study_id, model_id).effects
    units = [_Loading(store, *one) for one in zip(study_ids, names, definitions, strict=True)]
    shapes = shared_shapes([one.shapes(chosen) for one in units])
    progress.enter(FITTING)
    found, last = [], None
    for one in progress.each(units):
        fit = one.fit(chosen, shapes)
        _same_effort(study_ids[0], last or fit, one.study_id, fit)
        last = fit
        found.append((one.told(last), unit_fit_of(last)))
    assert last is not None, "two units or more were fitted"
    return _answer(last, [unit for unit, _ in found], [fitted for _, fitted in found])


class _Loading:
    """A unit whose material is read when it is needed: of many units, no two need to be in memory."""

    def __init__(self, store: Store, study_id: int, name: str, definition: Definition) -> None:
        self.study_id, self.name = study_id, name
        self._store, self._definition = store, definition

    @property
    def material(self) -> Material:
        return material_of(self._store, self.study_id, self.name, self._definition)

    def shapes(self, effects: Sequence[str]) -> dict[str, Shape]:
        """As a kept model of the same effects has them, else as found now."""
        if not any(effect_named(name).shape_names for name in effects):
            return {}
        for model in reversed(self._store.models(self.study_id)):
            kept = kept_of(model).shapes
            if set(model.effects) == set(effects) <= set(kept):
                return {name: kept[name] for name in effects}
        return self.fit(effects, None).shapes

    def fit(self, effects: Sequence[str], shapes: dict[str, Shape] | None) -> Fit:
        try:
            return self.material.fit(effects, shapes)
        except StudyError as error:
            raise StudyError(f"study {self.study_id} ({self.name}): {error}") from error

    def told(self, fit: Fit) -> Unit:
        rows = fit.training & fit.dataset.counted
        return Unit(
            study_id=self.study_id,
            name=self.name,
            trials=len(fit.dataset.trials),
            error=relative_error(fit.residual[rows], fit.dataset.effort[rows]),
        )


def _alike(study_ids: Sequence[int], found: Sequence[Definition]) -> list[Definition]:
    """With one low-pass: coefficients depend on it."""
    first = found[0]
    for study_id, one in zip(study_ids, found, strict=True):
        for name in KIND:
            mine, theirs = getattr(one.facts, name), getattr(first.facts, name)
            if mine != theirs:
                raise StudyError(
                    f"studies {study_ids[0]} and {study_id} are not of one kind: {_words(name)} is {theirs} and "
                    f"{mine}; compare units of one rig"
                )
        if one.rows != first.rows:
            raise StudyError(
                f"study {study_ids[0]} counts {first.rows} rows, study {study_id} {one.rows}; make them with the same"
            )
    cutoff_hz = min(one.cutoff_hz for one in found)
    return [replace(one, cutoff_hz=cutoff_hz) for one in found]


def _same_effort(first_id: int, first: Fit, study_id: int, fit: Fit) -> None:
    """Raise where two units are fitted to different quantities: what each measures tells, and no rig needs to."""
    mine, theirs = fit.dataset.effort_definition, first.dataset.effort_definition
    if (mine.quantity, mine.unit) != (theirs.quantity, theirs.unit):
        raise StudyError(
            f"studies {first_id} and {study_id} are not of one kind: the effort is {theirs.title} [{theirs.unit}] and "
            f'{mine.title} [{mine.unit}]; record the same of both, or name it in both rigs ([effort] quantity = "...")'
        )


def _words(fact: str) -> str:
    assert fact in Facts.__dataclass_fields__, fact
    return fact.replace("_", " ")


def _answer(fit: Fit, units: list[Unit], fitted: list[UnitFit]) -> UnitComparison:
    fewest = min(len(units), FEWEST_UNITS)
    quantities, lacking = quantities_of(fit, fitted, fewest)
    if not quantities:
        raise StudyError(
            f"no parameter is determined by the trials of {fewest} units; record longer or more trials, or take fewer "
            "effects"
        )
    pair = [_difference(one) for one in quantities] if fewest == PAIR else []
    parameters = [] if pair else [_parameter(one, units) for one in judge(quantities)]
    definition = fit.dataset.effort_definition
    return UnitComparison(
        effects=list(fit.names),
        effort=EffortName(name=definition.title, unit=definition.unit),
        cutoff_hz=fit.dataset.cutoff_hz,
        units=units,
        parameters=parameters,
        differences=pair,
        undetermined=lacking,
        sentence=_of_two(pair) if pair else _sentence(parameters, len(units)),
        notes=_notes(parameters, units)[: 1 if pair else None],
    )


def _parameter(found: Judged, units: Sequence[Unit]) -> UnitParameter:
    common, quantity, values = found.common, found.quantity, found.quantity.values
    half = values.error * stdtrit(values.freedom, UPPER)
    judged = [unit for unit, inside in zip(units, quantity.inside, strict=True) if inside]
    return UnitParameter(
        effect=quantity.effect,
        name=quantity.parameter,
        unit=quantity.unit,
        mean=common.value,
        mean_low=common.low,
        mean_high=common.high,
        scatter=common.scatter,
        scatter_low=common.scatter_low,
        scatter_high=common.scatter_high,
        next_low=common.next_low,
        next_high=common.next_high,
        p_value=found.chance,
        differs=found.differs,
        values=[
            UnitValue(
                study_id=unit.study_id,
                name=unit.name,
                value=value,
                low=value - width,
                high=value + width,
                deviation=beside.by,
                deviation_low=beside.low,
                deviation_high=beside.high,
                expected_low=beside.expected_low,
                expected_high=beside.expected_high,
                p_value=beside.corrected,
                outlier=beside.is_outlier,
            )
            for unit, value, width, beside in zip(
                judged, values.value.tolist(), half.tolist(), found.deviations, strict=True
            )
        ],
    )


def _difference(found: Quantity) -> UnitDifference:
    by, low, high = difference(found.values)
    first, second = found.values.value.tolist()
    return UnitDifference(
        effect=found.effect,
        name=found.parameter,
        unit=found.unit,
        first=first,
        second=second,
        difference=by,
        low=low,
        high=high,
    )


def _of_two(found: Sequence[UnitDifference]) -> str:
    beyond = [one.name for one in found if not one.low <= 0.0 <= one.high]
    seen = f"The units differ in {', '.join(beyond)}" if beyond else "No difference shows"
    return (
        f"{seen}, by the 90 % interval of each difference; each of the {len(found)} intervals holds by itself. How "
        f"units scatter, and whether one is an outlier, two cannot tell: the one takes {FEWEST_UNITS}, the other 4 "
        "and better 6."
    )


def _sentence(parameters: Sequence[UnitParameter], units: int) -> str:
    odd = [(one, value) for one in parameters for value in one.values if value.outlier]
    told = [
        f"'{value.name}' in {one.name} ({value.value:.3g} {one.unit}; the others let {value.expected_low:.3g} .. "
        f"{value.expected_high:.3g} be expected, p = {value.p_value:.2g})"
        for one, value in odd[:MOST_NAMED]
    ]
    more = f", and {len(odd) - MOST_NAMED} more" if len(odd) > MOST_NAMED else ""
    outliers = f"Outlier: {'; '.join(told)}{more}." if odd else f"None of the {units} units is shown to be an outlier."
    differ = [one.name for one in parameters if one.differs]
    rest = f"Units differ in {', '.join(differ)}." if differ else "Units are not shown to differ otherwise."
    return f"{outliers} {rest}"


def _notes(parameters: Sequence[UnitParameter], units: Sequence[Unit]) -> list[str]:
    notes = [
        "What differs between units holds whatever differed between their recordings: mounting, grease, temperature, "
        "day. A unit that is recorded twice, as two studies, shows how much of it that is."
    ]
    if len(units) < 2 * FEWEST_UNITS:
        notes.append(f"{len(units)} units: intervals are wide, and an outlier is seen only where it is far off.")
    missing = sorted({one.name for one in units} - {value.name for one in parameters for value in one.values})
    if missing:
        notes.append(f"The trials of {', '.join(missing)} determine no parameter.")
    return notes
