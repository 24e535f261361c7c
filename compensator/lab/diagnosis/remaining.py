"""What no name explains: beside a plain model, or beside a name that is right only in part."""

import numpy as np

from compensator.lab.diagnosis.confirmation import helpful_curve
from compensator.lab.diagnosis.note import Note, Value
from compensator.lab.diagnosis.wording import driver_in_words
from compensator.lab.effects.free_curve import AGAINST_MOTION, FORCE, TIMES_SPEED, way_of
from compensator.lab.left_over.left_over import LeftOver, left_over, unexplained_in_words
from compensator.lab.left_over.orders import recurring_in_words
from compensator.lab.left_over.remainder import ringing_in_words
from compensator.lab.left_over.repeated import recurring_share_in_words
from compensator.lab.left_over.swinging import swinging_in_words
from compensator.lab.left_over.wandering import wandering_in_words
from compensator.lab.model.fitted import Fit
from compensator.lab.rows.drivers import DRIVERS
from compensator.lab.screening.candidates import Candidates
from compensator.lab.screening.evidence import Screening
from compensator.lab.screening.gathering import gather_curves, with_noise


def without_a_name(gathered: Candidates, generic: Screening) -> str | None:
    """What a model leaves in which no effect is confirmed, in words; None where it is no more than noise.

    Args:
        gathered: the model, and what it may be missing, on the rows that are judged.
        generic: evidence for free curves.
    """
    fit = gathered.fit
    left = left_over(gathered)
    if not left.is_more_than_noise:
        return None
    # the best curve, where the evidence pays for it, though it may not hold on other rows
    driver = next((one.block.name for one in generic.evidence[:1] if one.score > 0.0), None)
    facts, wanders = fit.dataset.facts, _wanders(fit, left)
    over = None if driver is None else driver_in_words(driver)
    return unexplained_in_words(left, over, gathered.stretches, facts, wanders)


def what_remains(fit: Fit, before: Candidates, name: str) -> list[Note]:
    """What remains with the effect in the model, beside what its formula leaves open, as the next step sees it.

    Args:
        fit: the model with the effect.
        before: what it was missing without, on the same rows, and the noise.
        name: of the effect.
    """
    grown = gather_curves(fit, before.show_in)
    known = before.noise if np.array_equal(grown.rows, before.rows) else None
    white = with_noise(grown) if known is None else grown.whitened(known)
    if (found := helpful_curve(white, white.screened(white.curves.blocks))) is not None:
        variable, way = way_of(found[0].block.name)
        return [_structure_remains(name, DRIVERS[variable].title, way)]
    left = left_over(grown)
    if not left.is_more_than_noise:
        return []
    if (line := left.line) is not None:
        text = f"After {name}, what is left {recurring_in_words(line, fit.dataset.facts)}."
        return [Note("recurs", text, {"effect": name, "order": line.order, "share": line.share})]
    if (swing := left.swing) is not None:
        text = f"After {name}, what is left {swinging_in_words(swing)}."
        values: dict[str, Value] = {"effect": name, "frequency_hz": swing.frequency_hz, "of_voltage": swing.of_voltage}
        return [Note("swings", text, values)]
    if (wandering := left.wandering) is not None:
        text = f"After {name}, {_wanders(fit, left)}. {recurring_share_in_words(left.recurs)}"
        return [Note("wanders", text, {"effect": name, "what": wandering.what, "share": wandering.share})]
    if (rings := left.remainder.resonance) is not None:
        text = f"After {name}, what is left {ringing_in_words(rings)}."
        return [Note("rings", text, {"effect": name, "frequency_hz": rings.frequency_hz, "denser": rings.denser})]
    text = (
        f"After {name}, what is left is still more than noise, {left.remainder.share:.1%} of the effort, and "
        "has structure over no variable that is measured; add it and diagnose again."
    )
    return [Note("unexplained-remains", text, {"effect": name, "share": left.remainder.share})]


def _wanders(fit: Fit, left: LeftOver) -> str:
    """What is another one for seconds, in words; empty where nothing is."""
    if left.wandering is None:
        return ""
    return wandering_in_words(left.wandering, _trial_names(fit), fit.dataset.effort_definition.unit)


def _trial_names(fit: Fit) -> list[str]:
    return [trial.signals.recording.name for trial in fit.dataset.trials]


def _structure_remains(name: str, driver: str, way: str) -> Note:
    """With an effect in the model, structure over a variable is left."""
    how = {FORCE: "", AGAINST_MOTION: " against the motion", TIMES_SPEED: " times the speed"}[way]
    over = driver_in_words(f"{driver}{how}")
    text = f"After {name}, structure over {over} remains; add it and diagnose again."
    return Note("structure-remains", text, {"effect": name, "driver": driver, "against_motion": way == AGAINST_MOTION})
