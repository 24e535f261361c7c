"""The joint of an item, recorded; where its family asks for an r, with so much of what it hides as makes that r.

And the model that a study of it starts from.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from bench.config.configuration import BenchConfiguration
from bench.config.rig import Rig
from bench.errors import ExperimentError, LimitError
from bench.evaluation.blind.items import FAMILIES, PERIOD_S, Item, draw_item, protocol_of, wanted_ratio
from bench.evaluation.challenge.hidden_plant import MECHANISMS, DrawnPlant
from bench.evaluation.challenge.owner import bench_of, rig_of
from bench.evaluation.challenge.session import record
from bench.json_types import Values
from bench.study.material import facts_of
from compensator.lab.effects.catalogue import default_effects
from compensator.lab.errors import LabError
from compensator.lab.model.fit import fit_model
from compensator.lab.model.fitted import Fit
from compensator.lab.model.held_out_error import rms
from compensator.lab.recordings.recording import Recording
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Dataset, Processing

CHAIN = "measurement_delay"  # a sample is taken at the end of the cycle whose effort it holds: half a cycle, at least
ATTEMPTS = 10
SCALINGS = 7  # sizes that are tried for the r that is wanted
NEAR = 1.25  # factor: an r so near to the wanted one will do
LARGEST_STEP = 2.0  # of the logarithm of a size at once
LEAST_RATIO = 0.01  # a smaller r is none

# faults of the line; the plant itself has the delay
LOST = (0.002, 0.02)  # share of the rows
JITTER = (0.02, 0.2)  # standard deviation, share of the period
DELAY_S = (5e-4, 3e-3)


@dataclass(frozen=True)
class Recorded:
    """What was recorded of an item.

    Attributes:
        drawn: the joint and what it hides.
        recordings: of it.
        attempt: how many joints were drawn before it.
    """

    drawn: DrawnPlant
    recordings: list[Recording]
    attempt: int


def recorded(item: Item) -> Recorded:
    """Draw and record the first joint that completes the protocol.

    Raises:
        ExperimentError: none does.
    """
    reason = ""
    for attempt in range(ATTEMPTS):
        try:
            return _scaled(item, attempt)
        except (ExperimentError, LimitError) as error:
            reason = str(error)
    raise ExperimentError(f"item {item.key}: no joint completes the protocol: {reason}")


def bench_for(item: Item, drawn: DrawnPlant, without: str | None = None) -> BenchConfiguration:
    """The bench that the joint is on; with one of its mechanisms left out where it is named."""
    configuration = bench_of(drawn, item.seed, without)
    control = configuration.control.model_copy(update={"period_s": PERIOD_S})
    return configuration.model_copy(update={"control": control})


def unexplained(item: Item, found: Recorded) -> float | None:
    """What the base model leaves with the mechanism over what it leaves of the same joint without (`Scale`)."""
    try:
        return float(np.hypot(1.0, Scale.of(item, found.drawn, found.attempt).ratio(found.drawn)))
    except (ExperimentError, LimitError):
        return None


def base_fit(recordings: Sequence[Recording], rig: Rig) -> Fit:
    """The model that a study starts from, and the delay that every control loop has, fitted."""
    facts = facts_of(rig)
    dataset: Dataset = make_dataset(recordings, facts, Processing())
    return fit_model(dataset, [*default_effects(facts), CHAIN])


def refitted(fit: Fit, recordings: Sequence[Recording]) -> Fit:
    """The same model, fitted to other recordings of the same joint."""
    return fit_model(make_dataset(recordings, fit.dataset.facts, Processing()), fit.names)


@dataclass(frozen=True)
class Scale:
    """The denominator of r, in the effort's unit: the base model's residual on the joint without the hidden mechanism.

    Scatter of friction changes a recording by as much as a small mechanism does. So the mechanism's own part comes from
    two recordings without scatter and noise, one with the mechanism and one without.

    Attributes:
        item, attempt: whose joint.
        noisy: as it is recorded; quiet: with neither scatter nor noise.
    """

    item: Item
    attempt: int
    noisy: float
    quiet: float

    @classmethod
    def of(cls, item: Item, drawn: DrawnPlant, attempt: int) -> "Scale":
        """Record the joint without what it hides, as it is and quiet."""
        noisy, quiet = (_left(_plain(item, drawn, attempt, quiet=quiet)) for quiet in (False, True))
        return cls(item, attempt, noisy, quiet)

    def ratio(self, drawn: DrawnPlant) -> float:
        """r of what is hidden: its part of what the base model leaves, over what it leaves without."""
        left = _left(Recorded(drawn, _record(self.item, drawn, self.attempt, None, quiet=True), self.attempt))
        return float(np.sqrt(max(left**2 - self.quiet**2, 0.0))) / self.noisy


def _scaled(item: Item, attempt: int) -> Recorded:
    """The joint of an attempt, its size scaled until r is near the wanted one; the nearest where none is."""
    wanted, scale = wanted_ratio(item, attempt), 1.0
    drawn = draw_item(item, attempt)
    if wanted is None:
        return _recorded(item, drawn, attempt)
    measure = Scale.of(item, drawn, attempt)
    tried: list[tuple[float, float, DrawnPlant]] = []
    for _ in range(SCALINGS):
        ratio = max(measure.ratio(drawn), LEAST_RATIO)
        tried.append((float(np.log(scale)), float(np.log(ratio / wanted)), drawn))
        if abs(tried[-1][1]) <= np.log(NEAR):
            break
        scale = _bounded(drawn, scale, float(np.exp(_next([(at, off) for at, off, _ in tried]))))
        drawn = draw_item(item, attempt, scale)
    return _recorded(item, min(tried, key=lambda one: abs(one[1]))[2], attempt)


def _next(tried: list[tuple[float, float]]) -> float:
    """Where to look for a rising function's zero after (place, value), ...: between the nearest ones of either sign."""
    below = max((one for one in tried if one[1] < 0.0), default=None)
    above = min((one for one in tried if one[1] >= 0.0), default=None)
    if below is None or above is None:
        place, value = tried[-1]
        return place - float(np.clip(value, -LARGEST_STEP, LARGEST_STEP))  # r goes with the size, roughly
    share = float(np.clip(-below[1] / (above[1] - below[1]), 0.2, 0.8))
    return below[0] + share * (above[0] - below[0])


def _bounded(drawn: DrawnPlant, scale: float, wanted: float) -> float:
    """The wanted scale, or that which brings the mechanism to the upper end of its range."""
    hidden = drawn.hidden[0]
    return min(wanted, scale * MECHANISMS[hidden.name].size.high / hidden.size)


def _recorded(item: Item, drawn: DrawnPlant, attempt: int) -> Recorded:
    return Recorded(drawn, _record(item, drawn, attempt, None), attempt)


def _plain(item: Item, drawn: DrawnPlant, attempt: int, *, quiet: bool) -> Recorded:
    """The same joint without what it hides."""
    return Recorded(drawn, _record(item, drawn, attempt, drawn.hidden[0].name, quiet=quiet), attempt)


def _left(found: Recorded) -> float:
    """What the base model leaves, root mean square, in the effort's unit."""
    try:
        fit = base_fit(found.recordings, rig_of(found.drawn))
    except LabError as error:
        raise ExperimentError(f"no model can be fitted: {error}") from error
    return rms(fit.residual[fit.training])


def _record(
    item: Item, drawn: DrawnPlant, attempt: int, without: str | None, *, quiet: bool = False
) -> list[Recording]:
    configuration = bench_for(item, drawn, without)
    if quiet:
        configuration = _quiet(configuration)
    random = np.random.default_rng((item.seed, attempt, 1))
    protocol = protocol_of(item, drawn.joint.heaviest_kg, drawn.joint.top_rad_s, configuration)
    if not FAMILIES[item.family].imperfect:
        return record(configuration, protocol)
    return worn(record(_late(configuration, float(random.uniform(*DELAY_S))), protocol), random)


def _late(configuration: BenchConfiguration, delay_s: float) -> BenchConfiguration:
    return _with_plant(configuration, {"latency": {"delay_s": delay_s}})


def _quiet(configuration: BenchConfiguration) -> BenchConfiguration:
    """The same joint, whose friction does not scatter and whose current is measured without noise."""
    plant = configuration.model_dump()["drive"]["plant"]
    still = {**plant["scatter"], "static_fraction": 0.0, "coulomb_fraction": 0.0}
    return _with_plant(configuration, {"scatter": still, "current_sensor": {**plant["current_sensor"], "noise_a": 0.0}})


def _with_plant(configuration: BenchConfiguration, tables: Values) -> BenchConfiguration:
    values = configuration.model_dump()
    values["drive"]["plant"] = {**values["drive"]["plant"], **tables}
    return BenchConfiguration.model_validate(values)


def worn(recordings: Sequence[Recording], random: np.random.Generator) -> list[Recording]:
    """The recordings with rows lost and time stamps jittered, by amounts drawn once for all of them."""
    lost, jitter = float(random.uniform(*LOST)), float(random.uniform(*JITTER))
    return [_worn(recording, lost, jitter, random) for recording in recordings]


def _worn(recording: Recording, lost: float, jitter: float, random: np.random.Generator) -> Recording:
    time_s = recording.channels["time_s"]
    period_s = float(np.median(np.diff(time_s)))
    stamps = time_s + jitter * period_s * np.clip(random.standard_normal(len(time_s)), -2.0, 2.0)
    kept = random.random(len(time_s)) >= lost
    channels = {name: values[kept] for name, values in (recording.channels | {"time_s": stamps}).items()}
    return Recording(recording.name, recording.kind, recording.conditions, channels, recording.events)
