"""A study's material: its definition, its trials as the lab wants them, and its models fitted."""

from collections.abc import Hashable, Sequence
from dataclasses import asdict, dataclass, field, replace
from functools import lru_cache
from typing import Any

import numpy as np

from bench.config.rig import Rig, sensor_turns
from bench.json_types import Values
from bench.store import Store
from bench.store.records import ModelRow, Trial
from bench.study.errors import StudyError, lab_errors
from bench.study.keep import kept_of
from bench.study.models.base import EffortName
from bench.study.models.stages import FILTERING, READING
from bench.study.models.study import StudyTrial
from compensator.lab import progress
from compensator.lab.effects.catalogue import effect_named
from compensator.lab.model.fit import fit_model
from compensator.lab.model.fitted import Fit
from compensator.lab.recordings.facts import STANDARD_GRAVITY_M_S2, Facts
from compensator.lab.recordings.recording import BoolArray, Recording
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Dataset, Processing, RowChoice


@dataclass(frozen=True)
class Definition:
    """What a study fixes once and for all.

    Attributes:
        trial_ids: used, in order; held_out: the same, True where the trial judges the model.
        base: effects of the first model.
        cutoff_hz: of the final low-pass, as chosen at creation.
        rows: which rows count.
        facts: of the joint, from the rig.
        experiment_ids, hold_out, where: as the user wrote them.
        too_short: trials that are not used, since a cut-off that nobody chose leaves nothing of them.
    """

    trial_ids: tuple[int, ...]
    held_out: tuple[bool, ...]
    base: tuple[str, ...]
    cutoff_hz: float
    rows: RowChoice
    facts: Facts
    experiment_ids: tuple[int, ...] = ()
    hold_out: tuple[str, ...] = ()
    where: tuple[str, ...] = field(default=())
    too_short: tuple[int, ...] = ()

    def first(self, trials: int) -> "Definition":
        """As it was when it had so many trials: later ones are added at the end."""
        return replace(self, trial_ids=self.trial_ids[:trials], held_out=self.held_out[:trials])

    def to_json(self) -> Values:
        """For the store."""
        return asdict(self)

    @classmethod
    def from_json(cls, stored: dict[str, Any]) -> "Definition":
        """From the store."""
        lists = {key: tuple(value) for key, value in stored.items() if isinstance(value, list)}
        return cls(**{**stored, **lists, "facts": Facts(**stored["facts"])})


@dataclass(frozen=True)
class Material:
    """A study with its trials, ready to be fitted.

    Attributes:
        trials: of the study, in order.
        source: equal where the recordings are the same ones of the same store; None where they are from none.
    """

    study_id: int
    name: str
    definition: Definition
    trials: tuple[Trial, ...]
    dataset: Dataset
    source: Hashable = None

    @property
    def training(self) -> BoolArray:
        """Rows of the study's choice that models are fitted to, shape (N,)."""
        return self._training(self.dataset.rows)

    def _training(self, rows: RowChoice) -> BoolArray:
        held = np.array(self.definition.held_out)[self.dataset.trial_index]
        chosen: BoolArray = self.dataset.in_regimes(rows) & ~held
        return chosen

    @property
    def effort(self) -> EffortName:
        """Name and unit of the effort."""
        return EffortName(name=self.dataset.effort_definition.title, unit=self.dataset.effort_definition.unit)

    @property
    def study_trials(self) -> list[StudyTrial]:
        """Its trials with their roles."""
        return [
            StudyTrial(
                trial_id=trial.id,
                name=trial.name,
                role="held_out" if held else "training",
                conditions=dict(trial.conditions),
            )
            for trial, held in zip(self.trials, self.definition.held_out, strict=True)
        ]

    def fit(
        self,
        effects: Sequence[str],
        shapes: dict[str, tuple[float, ...]] | None = None,
        beside: Sequence[str] = (),
    ) -> Fit:
        """Fit a model to the training rows; errors of the lab become `StudyError`.

        Effects with memory are fitted to rows near reversals too, whatever the study counts: they live there.

        Args:
            effects: of the model.
            shapes: that are kept; the others are found.
            beside: effects of a model that it is held against: both are then fitted to the rows that either needs.
        """
        with lab_errors():
            rows = self.dataset.choice_for([effect_named(name) for name in (*effects, *beside)])
            return fit_model(self.dataset, effects, self._training(rows), shapes)

    def fit_of(self, model: ModelRow, beside: Sequence[str] = ()) -> Fit:
        """The stored model again, at the very shapes that were found when it was made; `beside` as in `fit`."""
        return self.fit(model.effects, kept_of(model).shapes, beside)


def facts_of(rig: Rig) -> Facts:
    """What the lab is told of a rig."""
    motor, ratio = rig.motor, rig.gear.ratio
    known = motor.torque_constant_n_m_a is not None and ratio is not None
    return Facts(
        joint=rig.joint,
        horizontal=rig.horizontal,
        torque_per_current_n_m_a=(motor.torque_constant_n_m_a or 0.0) * (ratio or 0.0) if known else None,
        back_emf_v_s_rad=_back_emf_v_s_rad(rig),
        gear_ratio=ratio,
        backlash_rad=rig.gear.backlash_rad,
        stiffness_n_m_rad=rig.gear.stiffness_n_m_rad,
        arm_m=rig.arm.length_m,
        arm_inertia_kg_m2=rig.arm.inertia_kg_m2,
        arm_moment_n_m=_arm_moment_n_m(rig),
        supply_is_nominal=rig.supply.is_nominal,
        sensor_at_joint=rig.sensor.at == "joint",
        position_count=_position_count_rad(rig),
        effort=rig.effort.quantity if rig.effort else None,
    )


def _back_emf_v_s_rad(rig: Rig) -> float | None:
    """Back-EMF for each rad/s of the joint; in SI units the constant is that of the torque, where no other is told."""
    constant, ratio = rig.motor.back_emf_v_s_rad or rig.motor.torque_constant_n_m_a, rig.gear.ratio
    return None if constant is None or ratio is None or rig.joint == "linear" else constant * ratio


def _position_count_rad(rig: Rig) -> float | None:
    """What one count of the sensor is at the joint; None of a linear joint, or where the rig does not tell."""
    counts, turns = rig.sensor.counts_per_turn, sensor_turns(rig)
    return None if counts is None or turns is None or rig.joint == "linear" else 2.0 * np.pi / (counts * turns)


def _arm_moment_n_m(rig: Rig) -> float | None:
    """Weight of the arm without load, at 90 degrees; None where the rig does not tell."""
    mass_kg, centre_m = rig.arm.mass_kg, rig.arm.centre_of_mass_m
    return None if mass_kg is None or centre_m is None else mass_kg * STANDARD_GRAVITY_M_S2 * centre_m


def load(store: Store, study_id: int) -> Material:
    """A study's material.

    Raises:
        NotFoundError: no such study, or one of its trials is gone.
        StudyError: the trials cannot be used.
    """
    row = store.study(study_id)
    return material_of(store, study_id, row.name, Definition.from_json(row.definition))


def load_model(store: Store, study_id: int, model_id: int | None) -> tuple[Material, ModelRow]:
    """A model of a study, and the study's material as it was when the model was fitted.

    Raises:
        NotFoundError, StudyError: as `load` and `model_of`.
    """
    row = store.study(study_id)
    model = model_of(store, study_id, model_id)
    return material_of(store, study_id, row.name, trials_of(model, Definition.from_json(row.definition))), model


def trials_of(model: ModelRow, definition: Definition) -> Definition:
    """A study's definition as it was when this model was fitted."""
    return definition.first(kept_of(model).trials or len(definition.trial_ids))


def material_of(
    store: Store, study_id: int, name: str, definition: Definition, read: dict[int, Recording] | None = None
) -> Material:
    """The material of a definition, whether it is kept already or not. Errors as `load`."""
    trials = tuple(store.trials_of(definition.trial_ids))
    source = _Source(store, definition.trial_ids, read)
    return Material(study_id, name, definition, trials, _dataset(source, definition), source)


def model_of(store: Store, study_id: int, model_id: int | None) -> ModelRow:
    """A model of the study; the newest one if None.

    Raises:
        StudyError: the study has no such model.
    """
    models = store.models(study_id)
    chosen = models[-1:] if model_id is None else [model for model in models if model.id == model_id]
    if not chosen:
        if not models:
            raise StudyError(
                f"study {study_id} has no model, since making it was ended; remove it, and create it again"
            )
        known = ", ".join(str(model.id) for model in models)
        raise StudyError(f"study {study_id} has no model {model_id}; its models are: {known}")
    return chosen[0]


class _Source:
    """Where a dataset comes from; equal when store and trials are, so that a dataset is made once."""

    def __init__(self, store: Store, trial_ids: tuple[int, ...], read: dict[int, Recording] | None = None) -> None:
        self.store, self.trial_ids, self._read = store, trial_ids, {} if read is None else read

    def recordings(self) -> list[Recording]:
        """Of the trials; those that were read before are let go of."""
        read = self._read
        found = [read[one] if one in read else self.store.recording(one) for one in progress.each(self.trial_ids)]
        read.clear()
        return found

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Source) and (self.store, self.trial_ids) == (other.store, other.trial_ids)

    def __hash__(self) -> int:
        return hash((id(self.store), self.trial_ids))


@lru_cache(maxsize=4)  # finished trials never change; a study asks for the same rows at every step
def _dataset(source: _Source, definition: Definition) -> Dataset:
    progress.enter(READING)
    recordings = source.recordings()
    progress.enter(FILTERING)
    with lab_errors():
        made = make_dataset(recordings, definition.facts, Processing(definition.cutoff_hz, definition.rows))
    return replace(made, held_out=frozenset(np.flatnonzero(definition.held_out).tolist()))
