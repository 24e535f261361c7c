"""Third part: a plant with one more mechanism than the model knows of. The lab finds it from the recordings alone."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from bench.config.configuration import BenchConfiguration
from bench.evaluation.paper.measurements import Measurement, measure, quietly
from bench.report import Bars, Figure, Line, Points, Section, Table
from bench.store import Store
from bench.study.changes import add_effect
from bench.study.compare import compare
from bench.study.create import create_study
from bench.study.diagnosis.diagnose import diagnose
from bench.study.ladder import ladder
from bench.study.models.diagnosis import ORDER, Diagnosis, Ranked
from bench.study.models.ladder import Ladder, Rung

BASE = (
    "inertia", "gravity", "offset", "coulomb", "viscous", "stribeck",
    "weight_friction", "weight_stribeck", "load_friction",
)  # fmt: skip
"""What the paper knows of its joint: General Kinetic Friction that grows with the load."""


@dataclass(frozen=True)
class Hidden:
    """A mechanism of the plant, and what the catalogue calls it."""

    plant: Mapping[str, object]
    name: str


def draw(seed: int) -> Hidden:
    """One of several mechanisms, of a size drawn at random."""
    generator = np.random.default_rng(seed)
    size = float(generator.uniform(0.7, 1.3))
    heat = {"present": True, "winding_j_k": 5.0, "housing_j_k": 20.0}
    choices = [
        Hidden({"viscous_asymmetry": {"fraction": 0.5 * size}}, "viscous_asymmetry"),
        Hidden({"spring": {"stiffness_n_m_rad": 0.06 * size}}, "spring"),
        Hidden({"periodic_friction": {"fraction": 0.3 * size, "cycles_per_turn": 5.0}}, "position_periodic_friction"),
        Hidden({"centre_of_mass": {"angle_rad": 0.12 * size}}, "centre_of_mass_angle"),
        Hidden({"lubricant": {"vogel_k": 800.0 * size}, "heat": heat}, "viscous_temperature"),
    ]
    return choices[int(generator.integers(len(choices)))]


def hidden_effect(configuration: BenchConfiguration, store: Store, seed: int) -> Section:
    """Record, compare, diagnose, add, compare again; then say what was hidden."""
    hidden = draw(seed)
    drive = configuration.drive.model_copy(update={"plant": hidden.plant, "seed": seed})
    bench = configuration.model_copy(update={"drive": drive})
    experiment = measure(bench, store, Measurement("excitation", {}), quietly, "demo")
    made = create_study(store, f"hidden effect, seed {seed}", [experiment.id], hold_out=["load_kg=0.05"], base=BASE)
    study_id = made.study_id
    before = compare(store, study_id)
    found = diagnose(store, study_id)
    first = found.ranking[0]
    change = add_effect(store, study_id, first.effect)
    rungs = ladder(store, study_id)
    assert rungs.floor is not None  # an excitation repeats its trials
    right = "It was." if first.effect == hidden.name else f"It was not: hidden was {hidden.name}."
    return Section(
        title="A hidden effect: compare, learn what is missing, add it",
        sentences=[
            f"{len(made.trials)} recordings of a plant with one more mechanism than the model. The trials with "
            f"50 g are held out. The model's error on them is {before.error.held_out.relative:.2%} of the "
            f"effort; repeated trials differ by {rungs.floor:.2%}, as far as the best model can tell.",
            found.sentence,
            change.sentence,
            f"Named: {first.title.lower()}. {right}",
        ],
        tables=[_ranking(found), _ladder(rungs)],
        figures=[*_picture(first), _errors(rungs)],
    )


def _ranking(diagnosis: Diagnosis) -> Table:
    rows = [
        (
            one.title,
            one.score,
            100 * one.held_out_before,
            100 * one.held_out_after,
            f"{one.gain:.1%} ({one.gain_low:.1%} .. {one.gain_high:.1%})",
            ", ".join(one.confused_with) or "-",
        )
        for one in diagnosis.ranking
    ]
    columns = ["effect", "score#", "held out before [%]#", "then [%]#", "gain, 90 % interval", "rivals"]
    return Table(f"Effects by evidence: {ORDER}", columns, rows)


def _ladder(ladder: Ladder) -> Table:
    rows: list[tuple[object, ...]] = [
        (
            f"+ {rung.added}" if rung.added else "base",
            100 * rung.training,
            100 * rung.held_out,
            f"{rung.held_out_low:.2%} .. {rung.held_out_high:.2%}",
        )
        for rung in ladder.rungs
    ]
    rows.append(("repeatability floor", None, None if ladder.floor is None else 100 * ladder.floor, ""))
    return Table(
        "The ladder: error as a share of the effort", ["model", "training [%]#", "held out [%]#", "90 %"], rows
    )


def _errors(ladder: Ladder) -> Figure:
    names = [f"+ {rung.added}" if rung.added else "base" for rung in ladder.rungs]

    def percent(value: Callable[[Rung], float]) -> list[float]:
        return [100 * value(rung) for rung in ladder.rungs]

    return Figure(
        "Error from model to model",
        "",
        "error [% of the effort]",
        [
            Bars("training", names, percent(lambda rung: rung.training)),
            Bars(
                "held out",
                names,
                percent(lambda rung: rung.held_out),
                percent(lambda rung: rung.held_out_low),
                percent(lambda rung: rung.held_out_high),
            ),
        ],
    )


def _picture(first: Ranked) -> list[Figure]:
    picture = first.picture
    if picture is None:
        return []
    against = ", against the motion" if picture.against_motion else ""
    return [
        Figure(
            f"Why: what the model leaves{against}, and {first.title.lower()} laid over it",
            f"{picture.driver} [{picture.unit}]",
            "residual [N m]",
            [
                Points("residual", picture.x, picture.residual, picture.low, picture.high),
                Line(first.title, picture.curve_x, picture.curve),
            ],
        )
    ]
