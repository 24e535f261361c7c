"""What comes of the trials that the lab asks for: recorded on the same joint, and diagnosed with all the others."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from bench.blind.lab_answer import refitted
from bench.challenge.session import record
from bench.configuration import BenchConfiguration
from bench.drives.simulated import SimulatedDriveSettings
from bench.errors import ExperimentError, LimitError
from bench.study.next_trial.options import choices
from bench.study.next_trial.predict import choose
from compensator.lab.diagnosis.diagnose import diagnose
from compensator.lab.model.fit import Fit
from compensator.lab.next_trial.suggestion import shows_from_rest
from compensator.lab.recordings.recording import Recording

TRIALS = 6


@dataclass(frozen=True, slots=True)
class Settled:
    """What the lab said before and after the trials that it asked for.

    Attributes:
        rivals: that were to be separated.
        before, predicted: smallest d' of them, predicted on the trials measured and with those suggested.
        by_chance: the same with as many trials drawn at random from the same options.
        trials: suggested.
        named: the class that is named at the end.
    """

    rivals: tuple[str, ...]
    before: float
    predicted: float
    trials: int
    named: tuple[str, ...]
    by_chance: float = 0.0  # not known of older results

    @classmethod
    def from_json(cls, values: dict[str, Any]) -> "Settled":
        """From nested lists."""
        return cls(**{**values, "rivals": tuple(values["rivals"]), "named": tuple(values["named"])})


def settle(configuration: BenchConfiguration, recordings: Sequence[Recording], fit: Fit, name: str) -> Settled | None:
    """Diagnose, suggest, record, diagnose again; None where the truth has no rival, or no trial is suggested.

    Args:
        configuration: of the bench of the drawn joint.
        recordings: so far.
        fit: of the base model to them.
        name: of the truth, for scoring only: what is suggested does not know it.
    """
    first = diagnose(fit)
    if first.verdict == "missing" and len(first.classes[0]) == 1:
        return None
    possible = choices(configuration, hung_by_hand=False, from_rest=shows_from_rest(first))
    found, chosen = choose(fit, first, configuration, possible, TRIALS)
    concerned = [pair for pair in found.pairs if name in (pair.true, pair.rival)]
    if not chosen or not concerned:
        return None
    try:
        more = record(_again(configuration), [(choice.kind, choice.parameters) for choice in chosen])
    except (ExperimentError, LimitError):
        more = []  # the joint does not do what was asked: then nothing was settled
    last = diagnose(refitted(fit, [*recordings, *more]))
    return Settled(
        rivals=tuple(dict.fromkeys(end for pair in found.pairs for end in (pair.true, pair.rival) if end)),
        before=min(pair.before for pair in concerned),
        predicted=min(pair.after for pair in concerned),
        trials=len(chosen),
        named=last.classes[0] if last.verdict == "missing" else (),
        by_chance=min(pair.by_chance for pair in concerned),
    )


def _again(configuration: BenchConfiguration) -> BenchConfiguration:
    """The same joint, with other noise."""
    drive = configuration.drive
    assert isinstance(drive, SimulatedDriveSettings)
    return configuration.model_copy(update={"drive": drive.model_copy(update={"seed": (drive.seed + 1) % 2**31})})
