"""The lab's answer to recordings: what it names first, and what it names one after the other."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from bench.config.rig import Rig
from bench.study.material import facts_of
from compensator.lab.diagnosis.diagnose import diagnose
from compensator.lab.diagnosis.search import search
from compensator.lab.effects.catalogue import default_effects
from compensator.lab.model.fit import fit_effects, fit_model
from compensator.lab.model.fitted import Fit
from compensator.lab.model.validation import held_out
from compensator.lab.recordings.recording import Recording
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Dataset, Processing

Classes = tuple[tuple[str, ...], ...]
SHOWN = 3  # effects of a ranking that a reader looks at
CHAIN = "measurement_delay"  # a sample is taken at the end of the cycle whose effort it holds: half a cycle, at least


@dataclass(frozen=True, slots=True)
class LabAnswer:
    """What the lab says.

    Attributes:
        verdict: of the first diagnosis.
        first: the class that it names; empty where it names none.
        named: the class that is named first; where several are searched for, those that are in the model at the end.
        unknown: the last step says that none of the catalogue is it, or that something remains.
        p_value, detectability: of the first diagnosis and its best candidate.
        error: held-out, of the model with all that was named in it.
        ranked: the first three effects of the first diagnosis, named or not; None in older results, which do not tell.
    """

    verdict: str
    first: tuple[str, ...]
    named: Classes
    unknown: bool
    p_value: float
    detectability: float
    error: float
    ranked: tuple[str, ...] | None = None

    @classmethod
    def from_json(cls, values: dict[str, Any]) -> "LabAnswer":
        """From a dict of lists."""
        named = tuple(tuple(names) for names in values["named"])
        lists = {name: tuple(values[name]) for name in ("first", "ranked") if values.get(name) is not None}
        return cls(**{**values, **lists, "named": named})


def base_fit(recordings: Sequence[Recording], rig: Rig) -> Fit:
    """The model that a study starts from, and the delay that every control loop has, fitted."""
    facts = facts_of(rig)
    dataset: Dataset = make_dataset(recordings, facts, Processing())
    return fit_model(dataset, [*default_effects(facts), CHAIN])


def refitted(fit: Fit, recordings: Sequence[Recording]) -> Fit:
    """The same model, fitted to other recordings of the same joint."""
    return fit_model(make_dataset(recordings, fit.dataset.facts, Processing()), fit.names)


def ask_lab(fit: Fit, several: bool) -> LabAnswer:
    """Diagnose; where several effects may be missing, search: forward, swap, backward, as `study search` does.

    Args:
        fit: of the base model.
        several: whether to go on after the first name.
    """
    first = last = diagnose(fit)
    classes = first.classes[:1] if first.verdict == "missing" else []
    named = list(classes)
    if several:
        found = search(fit, first=first)
        fit, last, named = found.fit, found.last, [(name,) for name in found.added]
    elif classes:
        fit = fit_effects(fit.dataset, [*fit.names, classes[0][0]], fit.training)
    return LabAnswer(
        verdict=first.verdict,
        first=classes[0] if classes else (),
        named=tuple(named),
        unknown=last.remains,
        p_value=first.p_value,
        detectability=first.candidates[0].detectability if first.candidates else 0.0,
        error=held_out(fit).relative,
        ranked=tuple(one.effect.name for one in first.candidates[:SHOWN]),
    )
