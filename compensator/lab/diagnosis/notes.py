"""What a diagnosis says beside its answer: the words and the numbers of every note."""

from compensator.lab.at_rest.rest_comparison import RestComparison, at_rest_in_words
from compensator.lab.diagnosis.diagnosis import Note, Value
from compensator.lab.diagnosis.run_to_run import ByRun, by_run_in_words
from compensator.lab.diagnosis.wording import LOOK_AT_HOSES
from compensator.lab.left_over.constancy import Change, changing_in_words
from compensator.lab.left_over.swinging import Swing, swinging_in_words
from compensator.lab.left_over.wandering import Wandering


def structure_remains(name: str, driver: str, against_motion: bool) -> Note:
    """With an effect in the model, structure over a variable is left."""
    how = " against the motion" if against_motion else ""
    text = f"After {name}, structure over {driver}{how} remains; add it and diagnose again."
    return Note("structure-remains", text, {"effect": name, "driver": driver, "against_motion": against_motion})


def varies_by_stretch(name: str, change: Change) -> Note:
    """With an effect in the model, something constant differs from one stretch to the next."""
    text = f"After {name}, {changing_in_words(change)}; repeat a trial to see whether it comes again."
    return Note("varies-by-stretch", text, {"effect": name, "what": change.what, "share": change.share})


def swings(name: str, swing: Swing) -> Note:
    """With an effect in the model, what is left swings at one frequency."""
    text = f"After {name}, what is left {swinging_in_words(swing)}."
    values: dict[str, Value] = {"effect": name, "frequency_hz": swing.frequency_hz, "of_voltage": swing.of_voltage}
    return Note("swings", text, values)


def wanders(name: str, wandering: Wandering, words: str) -> Note:
    """With an effect in the model, something constant differs for seconds at a time; `words` say what."""
    text = f"After {name}, {words}; repeat a trial to see whether it comes again."
    values: dict[str, Value] = {
        "effect": name,
        "what": wandering.what,
        "share": wandering.share,
        "jumps": wandering.jumps,
    }
    return Note("wanders", text, values)


def unexplained_remains(name: str, share: float) -> Note:
    """With an effect in the model, more than noise is left, and over no variable."""
    text = (
        f"After {name}, what is left is still more than noise, {share:.1%} of the effort, and "
        "has structure over no variable that is measured; add it and diagnose again."
    )
    return Note("unexplained-remains", text, {"effect": name, "share": share})


def bends_along(name: str) -> Note:
    """What an effect that is named imitates in part."""
    text = (
        f"{name} describes it in part: beside it, what is left varies with where the joint has turned back, as what "
        f"bends along and slides does. {LOOK_AT_HOSES}"
    )
    return Note("bends-along", text, {"effect": name})


def at_rest(found: RestComparison, unit: str) -> Note:
    """What rests say against the model."""
    values: dict[str, Value] = {
        "stretches": found.windows,
        "outside": found.outside,
        "largest": found.largest,
        "unit": unit,
    }
    return Note("at-rest", at_rest_in_words(found, unit), values)


def differs_by_run(found: ByRun, unit: str) -> Note:
    """A constant that differs from run to run."""
    values: dict[str, Value] = {
        "what": found.what,
        "scatter": found.scatter,
        "unit": unit,
        "trial": found.trial,
        "difference": found.difference,
        "floor": found.floor,
    }
    return Note("differs-by-run", by_run_in_words(found, unit), values)
