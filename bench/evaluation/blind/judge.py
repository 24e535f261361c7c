"""One item from draw to result: record, ask the lab, ask the rivals, ask the oracle."""

import time
from collections.abc import Sequence

from bench.evaluation.blind.baseline_methods import RIVALS
from bench.evaluation.blind.items import FAMILIES, Item
from bench.evaluation.blind.oracle import standing, standing_at_breakaway
from bench.evaluation.blind.recorded import base_fit, bench_for, recorded, unexplained
from bench.evaluation.blind.result import LabAnswer, Result, Standing
from bench.evaluation.blind.settling import settle
from bench.evaluation.challenge.names import accepted
from bench.evaluation.challenge.owner import rig_of
from compensator.lab.diagnosis.confirmation import nearest_one
from compensator.lab.diagnosis.diagnose import diagnose
from compensator.lab.diagnosis.search import search
from compensator.lab.effects.catalogue import effect_named, withheld
from compensator.lab.effects.effect import MotionRows
from compensator.lab.errors import LabError, NotApplicableError
from compensator.lab.model.fit import fit_effects, widened
from compensator.lab.model.fitted import Fit
from compensator.lab.model.validation import held_out
from compensator.lab.screening.candidates import Candidates
from compensator.lab.screening.gathering import gather

LIKELY = "likely"
SHOWN = 3  # effects of a ranking that a reader looks at


def ask_lab(fit: Fit, several: bool) -> LabAnswer:
    """Diagnose; where several effects may be missing, search: forward, swap, backward, as `study search` does.

    What is said to be likely counts as a name that was given, right or wrong.

    Args:
        fit: of the base model.
        several: whether to go on after the first name.
    """
    first = last = diagnose(fit)
    likely = nearest_one(first.candidates) if first.verdict == "nothing" and not first.too_short else None
    classes = first.classes[:1] if first.verdict == "missing" else []
    if likely is not None:
        classes = [(likely.effect.name, *likely.rivals)]
    named = list(classes)
    if several:
        found = search(fit, first=first)
        fit, last, named = found.fit, found.last, [(name,) for name in found.added]
    elif classes:
        fit = fit_effects(fit, [*fit.names, classes[0][0]])
    return LabAnswer(
        verdict=first.verdict if likely is None else LIKELY,
        first=classes[0] if classes else (),
        named=tuple(named),
        unknown=last.remains,
        p_value=first.p_value,
        detectability=first.candidates[0].detectability if first.candidates else 0.0,
        error=held_out(fit).relative,
        ranked=tuple(one.effect.name for one in first.candidates[:SHOWN]),
    )


def judge(item: Item) -> Result:
    """Draw, record, ask.

    Raises:
        ExperimentError: no joint of the item completes the protocol.
    """
    found = recorded(item)
    drawn, recordings = found.drawn, found.recordings
    rig = rig_of(drawn)
    truths = tuple(hidden.name for hidden in drawn.hidden)
    names = tuple(next(iter(accepted(truth)), "") for truth in truths)
    sizes = tuple(hidden.size for hidden in drawn.hidden)
    try:
        fit = base_fit(recordings, rig)
        began = time.process_time()
        answer = ask_lab(fit, several=FAMILIES[item.family].count > 1)
        seconds = time.process_time() - began
        gathered = gather(fit)
        standings, error = _oracle(fit, gathered, names)
        rivals = {name: rival(gathered) for name, rival in RIVALS.items()}
        more_left = unexplained(item, found) if names == ("",) else None
        catalogued = [name for truth in truths for name in accepted(truth)] if FAMILIES[item.family].withheld else []
        unlisted = ask_without(fit, catalogued) if catalogued else None
        left = None if unlisted is None else left_beside(fit, gathered, names[0], unlisted.first[:1])
        settled = settle(bench_for(item, drawn), recordings, fit, names[0]) if FAMILIES[item.family].settled else None
    except LabError as refusal:
        empty = (None,) * len(truths)
        return Result(
            item.key, item.family, truths, names, sizes, None, empty, None, float("nan"), refusal=str(refusal)
        )
    return Result(
        item.key, item.family, truths, names, sizes, answer, standings, more_left, error, rivals, seconds,
        settled=settled, withheld=unlisted, withheld_left=left,
    )  # fmt: skip


def ask_without(fit: Fit, names: Sequence[str]) -> LabAnswer:
    """What the lab says as if nobody had written these effects yet."""
    with withheld(names):
        return ask_lab(fit, several=False)


def left_beside(fit: Fit, base: Candidates, name: str, named: tuple[str, ...]) -> Standing | None:
    """Evidence for the truth beside the name that was given in its place: what a flag has to rest on."""
    if not can_be_seen(fit, name):
        return None
    return standing(_judged(fit, base, list(named), name), name)


def _oracle(fit: Fit, base: Candidates, names: tuple[str, ...]) -> tuple[tuple[Standing | None, ...], float]:
    """How far each truth stands out of the model with all the others, and the error of the model with all of them."""
    whole, known = with_known(fit, names)
    standings = []
    for name in names:
        others = [other for other in known if other != name]
        standings.append(_best_standing(fit, base, others, name) if name in known else None)
    return tuple(standings), held_out(whole).relative


def with_known(fit: Fit, names: Sequence[str]) -> tuple[Fit, list[str]]:
    """The model with all that is hidden, as far as the catalogue and these trials have it, and what that is."""
    known = [name for name in names if name and can_be_seen(fit, name)]
    return fit_effects(fit, [*fit.names, *known]) if known else fit, known


def _best_standing(fit: Fit, base: Candidates, others: list[str], name: str) -> Standing | None:
    """Where it stands out most: in motion, or, of what memory leaves for the starts from rest, there."""
    found = [standing(_judged(fit, base, others, name), name)]
    if not others and effect_named(name).rows != "sliding":
        found.append(standing_at_breakaway(fit, name))
    known = [one for one in found if one is not None]
    return max(known, key=lambda one: one.detectability, default=None)


def _judged(fit: Fit, base: Candidates, others: list[str], name: str) -> Candidates:
    """What a model with the others may be missing, on the rows where the effect shows."""
    show_in: MotionRows = "sliding" if effect_named(name).rows == "sliding" else "moving"
    if not others and show_in == base.show_in:
        return base
    rest = fit_effects(fit, [*fit.names, *others])
    return gather(widened(rest, "moving") if show_in == "moving" else rest, show_in)


def can_be_seen(fit: Fit, name: str) -> bool:
    """Whether these trials have what the effect needs: a temperature that differs, loads that differ."""
    try:
        fit.dataset.check_applicable(effect_named(name))
    except NotApplicableError:
        return False
    return True
