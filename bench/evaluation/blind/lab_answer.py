"""The lab's answer to recordings: what it names first, and what it names one after the other."""

from bench.evaluation.blind.result import LabAnswer
from compensator.lab.diagnosis.diagnose import diagnose
from compensator.lab.diagnosis.search import search
from compensator.lab.model.fit import fit_effects
from compensator.lab.model.fitted import Fit
from compensator.lab.model.validation import held_out

SHOWN = 3  # effects of a ranking that a reader looks at


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
