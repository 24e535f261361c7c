"""What comes of the trials that the lab asks for: recorded on the same joint, and diagnosed with all the others."""

from collections.abc import Collection, Sequence

from bench.config.configuration import BenchConfiguration
from bench.control.drive_factory import seed_of, with_seed
from bench.errors import ExperimentError, LimitError
from bench.evaluation.blind.recorded import refitted
from bench.evaluation.blind.result import Settled
from bench.evaluation.challenge.session import record
from bench.study.suggestion.options import Choice, choices
from bench.study.suggestion.predict import choose
from bench.study.suggestion.rounds import in_rounds
from compensator.lab.diagnosis.diagnose import diagnose
from compensator.lab.model.fitted import Fit
from compensator.lab.next_trial.confounded import shows_from_rest
from compensator.lab.next_trial.suggest import d_prime_of
from compensator.lab.next_trial.suggestion import Suggestion
from compensator.lab.recordings.recording import Recording

TRIALS = 6


def settle(configuration: BenchConfiguration, recordings: Sequence[Recording], fit: Fit, name: str) -> Settled | None:
    """Diagnose, suggest, record, diagnose again, in rounds; None where a name is sure before, or nothing is suggested.

    Args:
        configuration: of the bench of the drawn joint.
        recordings: so far.
        fit: of the base model to them.
        name: of the truth, for scoring only: what is suggested does not know it.
    """
    rounds = _Rounds(configuration, recordings, fit, name)
    if rounds.is_sure or rounds.diagnosis.verdict == "data-problem":
        return None
    planned, _ = rounds.planned(TRIALS)
    if not planned.picks:
        return None
    before, predicted, by_chance, promised = _of_truth(planned, name)
    tried = in_rounds(rounds.ask, rounds.run, rounds.learn, TRIALS)
    return Settled(
        rivals=tuple(dict.fromkeys(end for pair in planned.pairs for end in (pair.true, pair.rival) if end)),
        before=before,
        predicted=predicted,
        trials=sum(not one.reason for one in tried),
        named=rounds.named,
        by_chance=by_chance,
        promised=promised,
        failed=sum(bool(one.reason) for one in tried),
        stated=tuple(rounds.stated),
    )


def _of_truth(suggestion: Suggestion, name: str) -> tuple[float, float, float, float]:
    """Smallest d' of the truth: measured, with what is suggested, with as much by chance, promised; 0 for no rival."""
    own = [pair for pair in (*suggestion.pairs, *suggestion.hopeless) if pair.true == name]
    if not own:
        return 0.0, 0.0, 0.0, 0.0
    before, after, by_chance, promised = zip(
        *((one.before, one.after, one.by_chance, one.promised) for one in own), strict=True
    )
    return min(before), min(after), min(by_chance), min(promised)


class _Rounds:
    """A joint that is recorded as the lab asks.

    Attributes:
        fit, diagnosis: of all recordings so far.
        stated: of each round, smallest d' of the truth as it was predicted, and as it came.
    """

    def __init__(self, configuration: BenchConfiguration, recordings: Sequence[Recording], fit: Fit, name: str) -> None:
        self._configuration, self._recordings = configuration, list(recordings)
        self._first, self.fit, self.diagnosis = fit, fit, diagnose(fit)
        self._name, self._started, self._predicted = name, 0, 0.0
        self.stated: list[tuple[float, float]] = []

    @property
    def named(self) -> tuple[str, ...]:
        """The class that is named."""
        return self.diagnosis.named

    @property
    def is_sure(self) -> bool:
        """Whether one effect is named alone."""
        return len(self.named) == 1

    def planned(self, most: int, kept_out: Collection[str] = ()) -> tuple[Suggestion, list[Choice]]:
        """What would be suggested, were so much recorded at once."""
        possible = choices(self._configuration, hung_by_hand=False, from_rest=shows_from_rest(self.diagnosis))
        possible = [choice for choice in possible if choice.name not in kept_out]
        return choose(self.fit, self.diagnosis, self._configuration, possible, most)

    def ask(self, most: int, kept_out: Collection[str]) -> list[Choice]:
        """What is suggested now."""
        if self.diagnosis.verdict == "data-problem":
            return []
        suggestion, chosen = self.planned(most, kept_out)
        self._predicted = _of_truth(suggestion, self._name)[1]
        return chosen

    def run(self, choice: Choice) -> str:
        """Record one."""
        self._started += 1
        try:
            self._recordings += record(_again(self._configuration, self._started), [(choice.kind, choice.parameters)])
        except (ExperimentError, LimitError) as error:
            return str(error)
        return ""

    def learn(self) -> None:
        """Diagnose again, with all that was recorded."""
        self.fit = refitted(self._first, self._recordings)
        self.diagnosis = diagnose(self.fit)
        self.stated.append((self._predicted, d_prime_of(self.fit, self.diagnosis, self._name)))


def _again(configuration: BenchConfiguration, times: int) -> BenchConfiguration:
    """The same joint, with other noise."""
    return with_seed(configuration, ((seed_of(configuration) or 0) + times) % 2**31)
