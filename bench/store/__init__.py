"""The store: experiments, trials, samples, studies and models in a database."""

from bench.store.records import CalibrationRow, Event, Experiment, ModelRow, StudyRow, Trial
from bench.store.store import Store
from bench.store.trial_store import TrialWriter

__all__ = ["CalibrationRow", "Event", "Experiment", "ModelRow", "Store", "StudyRow", "Trial", "TrialWriter"]
