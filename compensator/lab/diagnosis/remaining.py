"""What no name explains: beside a plain model, or beside a name that is right only in part."""

import numpy as np

from compensator.lab.chance import SIGNIFICANT
from compensator.lab.diagnosis.note import Note, Value
from compensator.lab.effects.free_curve import AGAINST_MOTION, FORCE, TIMES_SPEED, way_of
from compensator.lab.left_over.bursts import Bursts, bursts_in_words, bursts_of, is_rattle
from compensator.lab.left_over.left_over import LeftOver, left_over, unexplained_in_words
from compensator.lab.left_over.orders import Line, recurring_in_words
from compensator.lab.left_over.remainder import LEAST_SHARE
from compensator.lab.left_over.swinging import Swing, swinging_in_words
from compensator.lab.left_over.wandering import Wandering, wandering_in_words
from compensator.lab.model.fitted import Fit
from compensator.lab.model.weights import row_weights
from compensator.lab.recordings.facts import Facts
from compensator.lab.rows.drivers import DRIVERS
from compensator.lab.screening.candidates import Candidates
from compensator.lab.screening.evidence import Screening, screen
from compensator.lab.screening.gathering import gather_curves


def without_a_name(fit: Fit, gathered: Candidates, generic: Screening, p_value: float) -> str | None:
    """What a model leaves in which no effect is confirmed, in words; None where it is no more than noise.

    Args:
        fit: the model.
        gathered: what it may be missing, on the rows that are judged.
        generic: evidence for free curves.
        p_value: of the effects.
    """
    left, bursts = left_over(gathered), _bursts(gathered)
    if bursts is not None and bursts.of_effort > LEAST_SHARE:
        return bursts_in_words(bursts, [_trial_names(fit)[index] for index in bursts.trials], p_value)
    if not left.is_more_than_noise:
        return None
    stretches = len(np.unique(fit.dataset.block_index[gathered.rows]))
    wanders = _wanders(fit, left)
    return unexplained_in_words(left, _nearest_driver(generic), p_value, stretches, fit.dataset.facts, wanders)


def what_remains(fit: Fit, gathered: Candidates, name: str) -> list[Note]:
    """What remains with the effect in the model, beside what its formula leaves open, as the next step sees it."""
    grown = gather_curves(fit, gathered.show_in)
    left = left_over(grown)
    if not left.is_more_than_noise:
        return []
    rest = screen(grown.bases, grown.curves.blocks, grown.fit.dataset.block_index[grown.rows])
    if rest.evidence and rest.p_value <= SIGNIFICANT and rest.evidence[0].score > 0.0:
        variable, way = way_of(rest.evidence[0].block.name)
        return [_structure_remains(name, DRIVERS[variable].title, way)]
    if left.line is not None:
        return [_recurs(name, left.line, fit.dataset.facts)]
    if left.swing is not None:
        return [_swings(name, left.swing)]
    if left.wandering is not None:
        return [_says_wanders(name, left.wandering, _wanders(fit, left))]
    return [_unexplained_remains(name, left.remainder.share)]


def _bursts(gathered: Candidates) -> Bursts | None:
    """Stretches that leave far more than others of like motion; None without any, or where teeth bounce there."""
    dataset, rows, residual = gathered.fit.dataset, gathered.rows, gathered.fit.residual
    weights = row_weights(dataset, residual, rows) * dataset.steadiness[rows]
    found = bursts_of(dataset, residual[rows], weights, rows)
    return found if found.are_there and not is_rattle(found, dataset, residual[rows], rows) else None


def _wanders(fit: Fit, left: LeftOver) -> str:
    """What is another one for seconds, in words; empty where nothing is."""
    if left.wandering is None:
        return ""
    return wandering_in_words(left.wandering, _trial_names(fit), fit.dataset.effort_definition.unit)


def _trial_names(fit: Fit) -> list[str]:
    return [trial.signals.recording.name for trial in fit.dataset.trials]


def _nearest_driver(generic: Screening) -> str | None:
    """The variable whose free curve the evidence pays for, though it may not hold on other rows; None without one."""
    best = generic.evidence[0] if generic.evidence else None
    return best.block.name if best is not None and best.score > 0.0 else None


def _structure_remains(name: str, driver: str, way: str) -> Note:
    """With an effect in the model, structure over a variable is left."""
    how = {FORCE: "", AGAINST_MOTION: " against the motion", TIMES_SPEED: " times the speed"}[way]
    text = f"After {name}, structure over {driver}{how} remains; add it and diagnose again."
    return Note("structure-remains", text, {"effect": name, "driver": driver, "against_motion": way == AGAINST_MOTION})


def _recurs(name: str, line: Line, facts: Facts) -> Note:
    """With an effect in the model, what is left comes back with the position."""
    text = f"After {name}, what is left {recurring_in_words(line, facts)}."
    return Note("recurs", text, {"effect": name, "order": line.order, "share": line.share})


def _swings(name: str, swing: Swing) -> Note:
    """With an effect in the model, what is left swings at one frequency."""
    text = f"After {name}, what is left {swinging_in_words(swing)}."
    values: dict[str, Value] = {"effect": name, "frequency_hz": swing.frequency_hz, "of_voltage": swing.of_voltage}
    return Note("swings", text, values)


def _says_wanders(name: str, wandering: Wandering, words: str) -> Note:
    """With an effect in the model, something constant differs for seconds at a time; `words` say what."""
    text = f"After {name}, {words}; repeat a trial to see whether it comes again."
    values: dict[str, Value] = {
        "effect": name,
        "what": wandering.what,
        "share": wandering.share,
    }
    return Note("wanders", text, values)


def _unexplained_remains(name: str, share: float) -> Note:
    """With an effect in the model, more than noise is left, and over no variable."""
    text = (
        f"After {name}, what is left is still more than noise, {share:.1%} of the effort, and "
        "has structure over no variable that is measured; add it and diagnose again."
    )
    return Note("unexplained-remains", text, {"effect": name, "share": share})
