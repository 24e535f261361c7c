"""What the trials of a study can and cannot tell: a table before any diagnosis, and the trial that would help most."""

from collections.abc import Iterator, Sequence
from math import pi

from bench.store import Store
from bench.study.diagnosis.findings import findings_of_trials
from bench.study.errors import lab_errors
from bench.study.joint import joint_of
from bench.study.material import load_model
from bench.study.models.coverage import Advice, Coverage, Held, JudgedEffect
from compensator.lab.at_rest.breakaway_rows import FEWEST_STARTS, breakaway_rows, starts_counted
from compensator.lab.comparison.judgeable import Judgeable, judgeable, stretches_of
from compensator.lab.diagnosis.data_checks import some_of
from compensator.lab.diagnosis.wording import too_short_in_words
from compensator.lab.effects.effect import Effect
from compensator.lab.rows import coverage as lab
from compensator.lab.rows.dataset import Dataset
from compensator.lab.screening.evidence import too_few_stretches

WIDE = 5.0  # between the slow and the fast: fewer, and friction over speed is a line whatever it is
FEWEST_LOADS = 3  # to tell a line from a curve
WARM_K = 5.0
TURNS = 2.0

LOADS = "the same motion with three loads or more, the largest five times the smallest"
WARMTH = "the drive's temperature beside the other channels, with the same slow trial cold and warm"
WARMER = f"the same slow trial cold and warm, {WARM_K:g} K apart or more"
SESSION = "the same slow trial at the start, in the middle and at the end of a session, with the time of day"
BOTH = "the same motion the other way round"
RAMPS = "breakaway ramps from rest at several rates, both ways"
REVERSALS = "short strokes to and fro: twenty reversals or more"
REPEAT = "one trial again, unchanged: without it nobody knows how well any model could do"
SPEEDS = "a slower and a faster trial: ten times apart"


def coverage(store: Store, study_id: int, model_id: int | None = None) -> Coverage:
    """What the trials of a study can and cannot tell beside a model.

    Raises:
        StudyError: no such model, or the trials cannot be used.
    """
    material, model = load_model(store, study_id, model_id)
    with lab_errors():
        fit = material.fit_of(model)
        found, effects, starts = lab.coverage_of(fit.dataset), judgeable(fit), starts_counted(breakaway_rows(fit))
    held = list(_held(found, fit.dataset, len(material.definition.too_short), effects, starts))
    joint = joint_of(store, material.definition)
    advice = [] if joint == "nowhere" else _advice(found, effects, starts)
    stretches = stretches_of(fit)
    return Coverage(
        study_id=study_id,
        model_id=model.id,
        held=held,
        effects=[_judged(one) for one in effects],
        advice=advice,
        sentence=too_short_in_words(stretches) if too_few_stretches(stretches) else _sentence(effects, advice),
        findings=findings_of_trials(fit, joint),
    )


def _sentence(effects: Sequence[Judgeable], advice: Sequence[Advice]) -> str:
    count = {name: sum(one.standing == name for one in effects) for name in ("judgeable", "confounded")}
    best = f" What would help most: {advice[0].trial}." if advice else ""
    return (
        f"Of {len(effects)} effects that the model does not have, these trials can show {count['judgeable']} by "
        f"themselves and {count['confounded']} only together with others that look alike, as far as their motion "
        f"alone can tell.{best}"
    )


def _judged(one: Judgeable) -> JudgedEffect:
    effect = one.effect
    return JudgedEffect(
        effect=effect.name,
        title=effect.title,
        standing=one.standing,
        reason=one.reason,
        rivals=list(one.rivals),
        smallest=one.smallest,
    )


def _held(
    found: lab.Coverage, dataset: Dataset, left_out: int, effects: Sequence[Judgeable], starts: int
) -> Iterator[Held]:
    unit = dataset.facts.position_unit
    short = f"; {left_out} more too short for the filter at {dataset.cutoff_hz:.3g} Hz" if left_out else ""
    yield Held(
        quantity="trials",
        found=f"{found.trials}, {found.duration_s:.0f} s, {found.usable:.0%} of the samples usable{short}",
        lacking="" if found.trials > 2 else "too few to leave one out: what a model is worth elsewhere is not sure",
    )
    yield Held(
        quantity="directions",
        found=f"{found.forward:.0%} forward, {found.backward:.0%} backward; both ways in {found.reversing} trials",
        lacking="" if found.both_directions else "one way only: friction, offset and asymmetry are one number",
    )
    ratio = found.fast / found.slow if found.slow > 0.0 else 0.0
    yield Held(
        quantity="speeds",
        found=f"{found.slow:.3g} to {found.fast:.3g} {unit}/s, a factor of {ratio:.3g}",
        lacking="" if ratio >= WIDE else "too narrow for the law of friction over speed",
    )
    yield Held(quantity="position", found=_position(found, unit), lacking=_position_lacks(dataset))
    yield Held(quantity="loads", found=_loads(found.loads_kg), lacking=_loads_lack(found.loads_kg, dataset))
    yield Held(quantity="temperature", found=_warmth(found), lacking=_warmth_lacks(found, effects))
    yield Held(
        quantity="starts from rest",
        found=f"{starts} whose effort is known",
        lacking="" if starts >= FEWEST_STARTS else f"{FEWEST_STARTS} are needed for static friction",
    )
    yield Held(
        quantity="repeats",
        found=f"{found.repeats} trials" if found.repeats else "none",
        lacking="" if found.repeats else "how well any model could do is not known",
    )
    if found.driven_s > 0.0:
        yield Held(
            quantity="driven from outside",
            found=f"{found.driven_s:.0f} s: the effort is exactly 0, and the joint does not slow down",
            lacking="something else turns the joint there; these rows are left out",
        )


def _position(found: lab.Coverage, unit: str) -> str:
    text = f"{found.low:.4g} to {found.high:.4g} {unit}"
    if unit == "rad" and found.one_way > 2.0 * pi * TURNS:
        text += f", up to {found.one_way / (2.0 * pi):.0f} turns one way"
    return text


def _position_lacks(dataset: Dataset) -> str:
    if dataset.facts.joint == "rotary" and dataset.turns_on:
        return "the joint turns on: effects go by the angle in the turn, and nothing holds it back"
    return ""


def _loads(loads_kg: Sequence[float]) -> str:
    if not loads_kg:
        return "not told"
    return ", ".join(f"{load:g}" for load in loads_kg[:8]) + (" ..." if len(loads_kg) > 8 else "") + " kg"


def _loads_lack(loads_kg: Sequence[float], dataset: Dataset) -> str:
    loaded = [trial.motion for trial in dataset.trials if trial.motion.load_kg != 0.0]
    if any(motion.facts.joint == "rotary" and motion.arm_m == 0.0 for motion in loaded):
        return "they count as none: where they hang is not told, arm.length_m of the rig"
    if len(loads_kg) < 2:
        return "effects of load cannot be told from others"
    return "" if len(loads_kg) >= FEWEST_LOADS else "two loads cannot tell a line from a curve"


def _warmth(found: lab.Coverage) -> str:
    if found.temperature_c is not None:
        return f"{found.temperature_c[0]:.1f} to {found.temperature_c[1]:.1f} degC"
    without = found.without_temperature
    # in some of the trials only: those who measured it would look for the fault in the others
    return f"no value in {some_of(without)}" if len(without) < found.trials else "not measured"


def _warmth_lacks(found: lab.Coverage, effects: Sequence[Judgeable]) -> str:
    """What the temperature leaves open: by what is said of each effect that goes by it, and of no other rule."""
    asked = [one for one in effects if _goes_by_warmth(one.effect)]
    shown = [one.smallest for one in asked if one.standing in ("judgeable", "confounded")]
    if found.temperature_c is None or (asked and not shown):
        some = 0 < len(found.without_temperature) < found.trials
        remedy = "; record temperature_c in every trial, or leave out those without it" if some else ""
        return f"effects of temperature cannot be seen{remedy}"
    if _warms_up(found.temperature_c) or not shown:  # without any, the model has them all
        return ""
    return f"less than {WARM_K:g} K: effects of temperature show from {min(shown):.2%} of the effort on"


def _goes_by_warmth(effect: Effect) -> bool:
    return "temperature_c" in (*effect.channels, effect.varies_with)


def _warms_up(temperature_c: tuple[float, float] | None) -> bool:
    return temperature_c is not None and temperature_c[1] - temperature_c[0] >= WARM_K


def _advice(found: lab.Coverage, effects: Sequence[Judgeable], starts: int) -> list[Advice]:
    """What the trials lack, what opens most effects first; nothing that is there already."""
    opened: dict[str, list[str]] = {}
    for one in effects:
        if one.standing != "judgeable" and (trial := _opens(one, found)):
            opened.setdefault(trial, []).append(one.effect.name)
    ranked = sorted(opened.items(), key=lambda item: -len(item[1]))
    advice = [Advice(trial=trial, effects=names) for trial, names in ranked]
    ratio = found.fast / found.slow if found.slow > 0.0 else 0.0
    lacking = {
        REPEAT: found.repeats == 0,
        BOTH: not found.both_directions,
        SPEEDS: ratio < WIDE,
        RAMPS: starts < FEWEST_STARTS,
    }
    return [
        *advice,
        *(Advice(trial=trial, effects=[]) for trial, lacks in lacking.items() if lacks and trial not in opened),
    ]


def _opens(one: Judgeable, found: lab.Coverage) -> str:
    """The trial that would let an effect be judged; "" where the trials have it already, or no trial would."""
    effect = one.effect
    if effect.varies_with == "load_kg" and len(found.loads_kg) < FEWEST_LOADS:
        return LOADS
    if _goes_by_warmth(effect) and not _warms_up(found.temperature_c):
        return WARMTH if found.temperature_c is None else WARMER
    if effect.varies_with == "session_s":
        return SESSION
    if one.few:
        return REVERSALS
    if one.standing == "not measured":
        return ""
    if not found.both_directions:
        return BOTH
    if effect.builds_on == "load" and len(found.loads_kg) < FEWEST_LOADS:
        return LOADS
    return ""
