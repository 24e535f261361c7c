"""`friction-bench study suggest`: with --start runs what is suggested, adds it to the study, and diagnoses, in rounds;
with --queue has a service run it."""

from collections.abc import Collection, Sequence

import typer
from pydantic import BaseModel

from bench.cli.bench_session import BenchSession
from bench.cli.exit_codes import ExitCode
from bench.cli.lab import diagnosis_tables as tables
from bench.cli.operation.run import carry_out
from bench.cli.operation.service import ask
from bench.cli.operation.signals import stoppable_command
from bench.cli.output import print_json, say
from bench.errors import LimitError, ParameterError
from bench.store import Experiment
from bench.study import extend
from bench.study.diagnosis import diagnose
from bench.study.errors import StudyError
from bench.study.models.diagnosis import Diagnosis
from bench.study.models.study import Extended
from bench.study.suggestion import suggest
from bench.study.suggestion.earlier_trials import in_words, what_came
from bench.study.suggestion.rounds import Ended, in_rounds
from bench.study.suggestion.suggested import Came, Suggested, SuggestedTrial
from drivers.errors import DriveError

REPLACED = ("tripped", "failed", "refused")  # outcomes after which the next best trial is run


def suggested(
    session: BenchSession, study_id: int, model_id: int | None, trials: int, refused: Collection[str] | None = None
) -> Suggested:
    """What to record next; within rounds, which tell themselves what came, without the trials that are refused."""
    with session.open_store() as store:
        return suggest.suggest(
            store, study_id, session.configuration(), model_id, trials, refused or (), refused is None
        )


def carry_out_all(
    session: BenchSession, study_id: int, model_id: int | None, trials: int, at_once: int, as_json: bool
) -> None:
    """Suggest, run, add and diagnose in rounds; what completed is added, also where a later one did not."""
    running = _Running(session, study_id, model_id, as_json)
    with stoppable_command("study suggest --start", session.configuration().name):
        tried = in_rounds(running.ask, running.run, running.learn, trials, at_once)
    running.tell_last()
    if as_json:
        print_json(running.told())
    elif (last := running.rounds[-1].diagnosis) is not None:
        tables.diagnosis(last)
        if open_still := tables.not_settled(last, sum(not one.reason for one in tried)):
            say(session.in_full(open_still))
        say(session.in_full(tables.next_step(last, model_id)))
    if running.signal_code is not None:
        raise typer.Exit(running.signal_code)
    if tried and tried[-1].reason:  # the end of it: what was replaced has others after it
        raise typer.Exit(ExitCode.NOT_COMPLETED)


class _Tried(BaseModel):
    """What became of one suggested trial."""

    experiment_id: int | None
    outcome: str
    reason: str


class _Round(BaseModel):
    """What was suggested, which experiments came of it, and what the study says then."""

    suggested: Suggested
    experiments: list[_Tried] = []
    extended: Extended | None = None
    diagnosis: Diagnosis | None = None
    came: list[Came] | None = None
    end: str | None = None


class _Told(BaseModel):
    """Every round; and what was suggested first, and what the study says at last."""

    suggested: Suggested
    rounds: list[_Round]
    extended: Extended | None = None
    diagnosis: Diagnosis | None = None


class _Running:
    """Rounds on this bench.

    Attributes:
        signal_code: exit code where a signal ended a trial.
    """

    def __init__(self, session: BenchSession, study_id: int, model_id: int | None, quiet: bool) -> None:
        self._session, self._study_id, self._model_id, self._quiet = session, study_id, model_id, quiet
        self.rounds: list[_Round] = []
        self.signal_code: int | None = None

    def told(self) -> dict[str, object]:
        """All of it as JSON; what there was none of is left out."""
        learnt = [one for one in self.rounds if one.diagnosis is not None]
        found = _Told(suggested=self.rounds[0].suggested, rounds=self.rounds)
        if learnt:
            found.extended, found.diagnosis = learnt[-1].extended, learnt[-1].diagnosis
        return _without_none(found)

    def ask(self, most: int, kept_out: Collection[str]) -> Sequence[SuggestedTrial]:
        """What is suggested now."""
        found = self._next(most, kept_out)
        if found is None:
            return []
        self.rounds.append(_Round(suggested=found))
        if not self._quiet:
            tables.suggestion(found)
        return found.trials

    def tell_last(self) -> None:
        """What came of the last round, where nothing was suggested after it."""
        if self.signal_code is None and self.rounds[-1].diagnosis is not None and self.rounds[-1].end is None:
            self._next(1, ())

    def _next(self, most: int, kept_out: Collection[str]) -> Suggested | None:
        """What is suggested now, with what came of the last round; None where the rounds end."""
        try:
            found = suggested(self._session, self._study_id, self._model_id, most, kept_out)
        except StudyError as error:
            if not self.rounds:
                raise
            self.rounds[-1].end = str(error)  # what was recorded since is in the study all the same
            if not self._quiet:
                say(str(error))
            return None
        if self.rounds and self.rounds[-1].diagnosis is not None:
            came = self.rounds[-1].came = what_came(self.rounds[-1].suggested, found)
            if not self._quiet and came:
                say(in_words(came))
        return found

    def run(self, trial: SuggestedTrial) -> str:
        """One trial; however it ends, the joint is powered off."""
        note = self.rounds[-1].suggested.note
        try:
            found, signal_code = carry_out(
                self._session, trial.kind, dict(trial.parameters), "", note, None, quiet=self._quiet
            )
        except (LimitError, ParameterError) as error:
            self._note(None, "refused", str(error))
            return f"refused: {error}"
        except DriveError as error:
            self._note(None, "failed", str(error))
            raise Ended(f"failed: {error}") from error
        self._note(found, found.outcome, found.reason)
        self.signal_code = signal_code
        if found.outcome != "completed" and found.outcome not in REPLACED:
            raise Ended(f"{found.outcome}: {found.reason}")
        return "" if found.outcome == "completed" else f"{found.outcome}: {found.reason}"

    def learn(self) -> None:
        """Add what completed in this round, and diagnose."""
        tried = self.rounds[-1].experiments
        completed = [one.experiment_id for one in tried if one.outcome == "completed" and one.experiment_id is not None]
        with self._session.open_store() as store:
            extended = self.rounds[-1].extended = extend.extend_study(store, self._study_id, completed)
            self.rounds[-1].diagnosis = diagnose.diagnose(store, self._study_id)
        self._model_id = None  # the newest, from now on
        if not self._quiet:
            tables.extended(extended)  # what it says comes with the next suggestion, or at the end

    def _note(self, found: Experiment | None, outcome: str, reason: str) -> None:
        number = None if found is None else found.id
        self.rounds[-1].experiments.append(_Tried(experiment_id=number, outcome=outcome, reason=reason))
        if not self._quiet:
            name = "a trial" if number is None else f"experiment {number}"
            say(f"{name}: {outcome}{f': {reason}' if reason else ''}")


def _without_none(found: _Told) -> dict[str, object]:
    """As JSON, without what a round, or all of them, did not come to."""
    told = {name: value for name, value in found if value is not None}
    told["rounds"] = [{name: value for name, value in one if value is not None} for one in found.rounds]
    return told


def queue_all(session: BenchSession, found: Suggested, url: str, as_json: bool) -> None:
    """Put every suggested trial into the queue of a service: all or none."""
    items = [{"kind": one.kind, "parameters": one.parameters, "note": found.note} for one in found.trials]
    queued = ask(session, "POST", url, "/queue", {"items": items}) if items else {"item_ids": []}
    if as_json:
        print_json({"suggested": found, **queued})
        return
    tables.suggestion(found)
    if items:
        told = f"{len(items)} items are in the queue; when they are done: friction-bench study extend {found.study_id}"
        say(session.in_full(told))
