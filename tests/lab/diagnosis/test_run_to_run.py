"""Dry friction or a zero that differs from run to run is told with its size, and nothing where neither does."""

import re
from dataclasses import replace

import numpy as np
import pytest

from compensator.lab.diagnosis import run_to_run
from compensator.lab.diagnosis.diagnose import diagnose
from compensator.lab.diagnosis.run_to_run import (
    CONSTANT,
    DRY_FRICTION,
    WEIGHT,
    ByRun,
    by_run_in_words,
    differences_by_run,
)
from compensator.lab.effects.catalogue import default_effects
from compensator.lab.model.fit import fit_model
from compensator.lab.model.fitted import Fit
from compensator.lab.model.validation import held_out
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from tests.lab.synthetic import FACTS, Joint, plans, recordings

COULOMB_N_M = Joint().coulomb


def fitted(
    differences_n_m: dict[int, float], held: tuple[int, ...] = (), zeros_n_m: dict[int, float] | None = None
) -> Fit:
    """Trials with so much more dry friction each, and their effort's zero so far off; those held do not train."""
    made = recordings(trials=plans((0.0, 0.2), temperatures_c=(25.0,)), seed=11)
    for index, difference in differences_n_m.items():
        channels = made[index].channels
        channels["torque_n_m"] += difference * np.tanh(np.gradient(channels["position_rad"], channels["time_s"]) / 0.02)
    for index, zero in (zeros_n_m or {}).items():
        made[index].channels["torque_n_m"] += zero
    dataset = make_dataset(made, FACTS, Processing(8.0))
    return fit_model(dataset, default_effects(FACTS), dataset.counted & ~np.isin(dataset.trial_index, held))


def by_run(fit: Fit) -> ByRun | None:
    """What alone differs; None where nothing does."""
    found = differences_by_run(fit, held_out(fit))
    assert len(found) <= 1
    return found[0] if found else None


def test_one_run_with_more_friction():
    fit = fitted({4: 0.05 * COULOMB_N_M}, held=(4,))
    found, name = by_run(fit), fit.dataset.trials[4].signals.recording.name
    assert (found.what, found.trial) == (DRY_FRICTION, name)
    assert found.difference == pytest.approx(0.05 * COULOMB_N_M, rel=0.2)
    assert found.share == pytest.approx(0.05, rel=0.25)
    assert 0.0 < found.floor < held_out(fit).relative
    assert re.search(
        rf"Dry friction differs from run to run by .* N m, .*% of Coulomb friction, in '{name}' \(\+0.00",
        by_run_in_words(found, "N m"),
    )


def test_one_run_with_another_zero():
    fit = fitted({}, held=(4,), zeros_n_m={4: -0.05})
    found, name = by_run(fit), fit.dataset.trials[4].signals.recording.name
    assert (found.what, found.trial) == (CONSTANT, name)
    # of rows that see all: those beside stops show less of a constant, as of all else
    assert found.difference == pytest.approx(-0.05, rel=0.02)
    words = by_run_in_words(found, "N m")
    assert re.search(rf"^A constant force, or the zero of the effort, differs .* in '{name}' \(-0.0", words)
    assert words.endswith("a floor for any model with one zero for all runs, unless what is missing makes it.")
    assert words in map(str, diagnose(fit).notes)


@pytest.mark.parametrize("told", [True, False])
def test_loads_that_nobody_told_are_asked_for(told):
    made = recordings(trials=plans((0.0, 0.2), temperatures_c=(25.0,)), seed=11)
    if not told:
        made = [replace(one, conditions={k: v for k, v in one.conditions.items() if k != "load_kg"}) for one in made]
    fit = fit_model(make_dataset(made, FACTS, Processing(8.0)), default_effects(FACTS))
    found = [one for one in differences_by_run(fit, held_out(fit)) if one.what == WEIGHT]
    assert bool(found) != told
    if not told:
        # half of the trials carry 0.2 kg more than the others, and all are held against the mean of the others
        moment_n_m = 0.2 * 9.81 * FACTS.arm_m
        assert found[0].scatter == pytest.approx(0.5 * moment_n_m, rel=0.25)
        assert by_run_in_words(found[0], "N m").endswith("Were other loads hung? Tell load_kg of each trial.")


def test_first_what_makes_more_of_the_error():
    fit = fitted({4: 0.004}, held=(4,), zeros_n_m={4: 0.05})
    found = differences_by_run(fit, held_out(fit))
    assert [one.what for one in found] == [CONSTANT, DRY_FRICTION]
    assert found[0].floor > found[1].floor > 0.0


def test_runs_that_scatter_with_each_left_out_in_turn():
    differences = dict(enumerate(0.01 * np.array([1.0, -1.0, 0.5, -0.5, 1.5, -1.5])))
    found = by_run(fitted(differences))
    # a trial that is left out is held against the others' mean, which is 6/5 as far away
    assert found.scatter == pytest.approx(1.2 * np.sqrt(np.mean(np.square(list(differences.values())))), rel=0.15)
    assert f"over {len(differences)} trials" in by_run_in_words(found, "N m")


@pytest.mark.parametrize("held", [(), (4,)], ids=["each in turn", "one held out"])
def test_one_friction_for_all_runs_is_not_told(held):
    assert by_run(fitted({}, held)) is None


def test_what_leaves_more_where_it_is_taken_off_is_no_part_of_the_error(monkeypatch):
    monkeypatch.setattr(run_to_run, "_differences", lambda *_: ((0.05, 0.001), (-0.05, 0.001)))
    assert by_run(fitted({}, held=(4,))) is None


def test_a_model_without_dry_friction_has_none_to_differ():
    fit = fitted({4: 0.01}, held=(4,))
    assert by_run(fit_model(fit.dataset, ("inertia", "gravity", "viscous"), fit.training)) is None


def test_what_a_missing_effect_makes_from_run_to_run_is_not_told_beside_its_name():
    made = recordings(Joint(extra=lambda x: -0.05 * np.abs(x.v)), trials=plans((0.0, 0.2), temperatures_c=(25.0,)))
    fit = fit_model(make_dataset(made, FACTS, Processing(8.0)), default_effects(FACTS))
    assert differences_by_run(fit, held_out(fit))
    answer = diagnose(fit)
    assert answer.candidates[0].effect.name == "viscous_asymmetry"
    assert not any("from run to run" in note.text for note in answer.notes)
