"""One item from draw to result: record, ask the lab, ask the rivals, ask the oracle."""

import time
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np

from bench.blind.imperfections import DELAY_S, worn
from bench.blind.items import FAMILIES, PERIOD_S, Item, draw_item, protocol_of
from bench.blind.lab_answer import LabAnswer, ask_lab, base_fit
from bench.blind.oracle import Standing, standing
from bench.blind.rivals import RIVALS
from bench.blind.settling import Settled, settle
from bench.challenge.hidden_plant import DrawnPlant
from bench.challenge.names import accepted
from bench.challenge.owner import bench_of, rig_of
from bench.challenge.session import record
from bench.configuration import BenchConfiguration
from bench.errors import ExperimentError, LimitError
from compensator.lab.effects.catalogue import effect_named
from compensator.lab.effects.effect import MotionRows
from compensator.lab.errors import LabError, NotApplicableError
from compensator.lab.model.fit import Fit, fit_effects, widened
from compensator.lab.model.validation import held_out, rms
from compensator.lab.recordings.recording import Recording
from compensator.lab.screening.candidates import Candidates, gather

ATTEMPTS = 10
STEPS = 3  # effects that the lab may name where two are hidden


@dataclass(frozen=True, slots=True)
class Result:
    """What came of an item.

    Attributes:
        key, family: of the item.
        truths: mechanisms hidden; names: what the catalogue calls each, "" where it does not.
        sizes: of the mechanisms.
        answer: of the lab; None where it refused the data, and `refusal` says why.
        standings: of the truths, by the oracle; None where it cannot say.
        unexplained: rms that the base model leaves with the mechanisms over that without them, where that was measured.
        oracle_error: held-out, of the model with the truth in it.
        rivals: rival -> what it names.
        seconds: that the lab took.
        settled: what came of the trials that the lab asked for; None where it was not asked, or had no rivals.
    """

    key: str
    family: str
    truths: tuple[str, ...]
    names: tuple[str, ...]
    sizes: tuple[float, ...]
    answer: LabAnswer | None
    standings: tuple[Standing | None, ...]
    unexplained: float | None
    oracle_error: float
    rivals: dict[str, tuple[str, ...]] = field(default_factory=dict)
    seconds: float = 0.0
    refusal: str = ""
    settled: Settled | None = None

    def to_json(self) -> dict[str, Any]:
        """Nested dicts."""
        return asdict(self)

    @classmethod
    def from_json(cls, values: dict[str, Any]) -> "Result":
        """From nested dicts."""
        made: dict[str, Any] = {
            key: tuple(value) if isinstance(value, list) else value for key, value in values.items()
        }
        if values["answer"] is not None:
            answer = values["answer"]
            named = tuple(tuple(names) for names in answer["named"])
            lists = {name: tuple(answer[name]) for name in ("first", "ranked") if answer.get(name) is not None}
            made["answer"] = LabAnswer(**{**answer, **lists, "named": named})
        made["standings"] = tuple(None if one is None else Standing(**one) for one in values["standings"])
        made["settled"] = None if values.get("settled") is None else Settled.from_json(values["settled"])
        made["rivals"] = {name: tuple(found) for name, found in values["rivals"].items()}
        return cls(**made)


def judge(item: Item) -> Result:
    """Draw, record, ask.

    Raises:
        ExperimentError: no joint of the item completes the protocol.
    """
    drawn, recordings = _recorded(item)
    rig = rig_of(drawn)
    truths = tuple(hidden.name for hidden in drawn.hidden)
    names = tuple(next(iter(accepted(truth)), "") for truth in truths)
    sizes = tuple(hidden.size for hidden in drawn.hidden)
    try:
        fit = base_fit(recordings, rig)
        began = time.process_time()
        answer = ask_lab(fit, STEPS if item.family == "pair" else 1)
        seconds = time.process_time() - began
        gathered = gather(fit)
        standings, error = _oracle(fit, gathered, names)
        rivals = {name: rival(gathered) for name, rival in RIVALS.items()}
        unexplained = _unexplained(item, drawn, fit) if names == ("",) else None
        settled = _settled(item, drawn, recordings, fit, names[0]) if FAMILIES[item.family].settled else None
    except LabError as refusal:
        empty = (None,) * len(truths)
        return Result(
            item.key, item.family, truths, names, sizes, None, empty, None, float("nan"), refusal=str(refusal)
        )
    return Result(
        item.key, item.family, truths, names, sizes, answer, standings, unexplained, error, rivals, seconds,
        settled=settled,
    )  # fmt: skip


def _recorded(item: Item) -> tuple[DrawnPlant, list[Recording]]:
    reason = ""
    for attempt in range(ATTEMPTS):
        drawn = draw_item(item, attempt)
        try:
            return drawn, _record(item, drawn, attempt, None)
        except (ExperimentError, LimitError) as error:
            reason = str(error)
    raise ExperimentError(f"item {item.key}: no joint completes the protocol: {reason}")


def _bench(item: Item, drawn: DrawnPlant, without: str | None) -> BenchConfiguration:
    configuration = bench_of(drawn, item.seed, without)
    control = configuration.control.model_copy(update={"period_s": PERIOD_S})
    return configuration.model_copy(update={"control": control})


def _record(item: Item, drawn: DrawnPlant, attempt: int, without: str | None) -> list[Recording]:
    configuration = _bench(item, drawn, without)
    random = np.random.default_rng((item.seed, attempt, 1))
    protocol = protocol_of(item, drawn.joint.heaviest_kg, drawn.joint.top_rad_s, configuration)
    if not FAMILIES[item.family].imperfect:
        return record(configuration, protocol)
    return worn(record(_late(configuration, float(random.uniform(*DELAY_S))), protocol), random)


def _settled(item: Item, drawn: DrawnPlant, recordings: list[Recording], fit: Fit, name: str) -> Settled | None:
    configuration = _bench(item, drawn, None)
    return settle(configuration, recordings, fit, name)


def _late(configuration: BenchConfiguration, delay_s: float) -> BenchConfiguration:
    values = configuration.model_dump()
    values["drive"]["plant"] = {**values["drive"]["plant"], "latency": {"delay_s": delay_s}}
    return BenchConfiguration.model_validate(values)


def _oracle(fit: Fit, base: Candidates, names: tuple[str, ...]) -> tuple[tuple[Standing | None, ...], float]:
    """How far each truth stands out of the model with all the others, and the error of the model with all of them."""
    known = [name for name in names if name and _can_be_seen(fit, name)]
    whole = fit_effects(fit.dataset, [*fit.names, *known], fit.training) if known else fit
    standings = []
    for name in names:
        others = [other for other in known if other != name]
        standings.append(standing(_judged(fit, base, others, name), name) if name in known else None)
    return tuple(standings), held_out(whole).relative


def _judged(fit: Fit, base: Candidates, others: list[str], name: str) -> Candidates:
    """What a model with the others may be missing, on the rows where the effect shows."""
    show_in: MotionRows = "sliding" if effect_named(name).rows == "sliding" else "moving"
    if not others and show_in == base.show_in:
        return base
    rest = fit_effects(fit.dataset, [*fit.names, *others], fit.training)
    return gather(widened(rest, "moving") if show_in == "moving" else rest, show_in)


def _can_be_seen(fit: Fit, name: str) -> bool:
    """Whether these trials have what the effect needs: a temperature that differs, loads that differ."""
    try:
        fit.dataset.check_applicable(effect_named(name))
    except NotApplicableError:
        return False
    return True


def _unexplained(item: Item, drawn: DrawnPlant, fit: Fit) -> float | None:
    """What the base model leaves with the mechanism over what it leaves of the same joint without."""
    try:
        plain = base_fit(_record(item, drawn, 0, drawn.hidden[0].name), rig_of(drawn))
    except (ExperimentError, LimitError):
        return None
    return rms(fit.residual[fit.training]) / rms(plain.residual[plain.training])
