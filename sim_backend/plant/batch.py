"""Many plants at once, on all cores: each at demands that are known beforehand."""

import os
from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sim_backend.plant.parameters import PlantParameters
from sim_backend.plant.plant import COARSEST_STEP_S, Energy, Plant, Truth


@dataclass(frozen=True, kw_only=True, eq=False)
class Course:
    """What is done to one plant, from rest at angle 0.

    Attributes:
        parameters: of the plant.
        seed: of its own randomness; part of the course, so that no other course has a say in the result.
        stage: OPEN, VOLTAGE, CURRENT or BRAKE of `motor`.
        demands: duty -1 .. 1, or current [A]; shape (n,).
        steps: integration steps at each demand.
        step_s: length of a step [s].
    """

    parameters: PlantParameters
    stage: int
    demands: NDArray[np.float64]
    steps: int
    seed: int = 0
    step_s: float = COARSEST_STEP_S


@dataclass(frozen=True, kw_only=True, eq=False)
class Outcome:
    """What came of a course.

    Attributes:
        measured: what the drive measures after each demand, columns as of `Plant.advance`; shape (n, 5).
        truth: the state at the end.
        energy: the balance over the course.
    """

    measured: NDArray[np.float64]
    truth: Truth
    energy: Energy


def run_course(course: Course) -> Outcome:
    """Run one course.

    Raises:
        ParameterError: the step is too coarse for something stiff.
    """
    plant = Plant(course.parameters, course.seed, course.step_s)
    measured = plant.follow(course.stage, course.demands, course.steps)
    return Outcome(measured=measured, truth=plant.truth(), energy=plant.energy())


def run_batch(courses: Iterable[Course], workers: int | None = None) -> Iterator[Outcome]:
    """Run courses side by side; the outcomes come in the order of the courses.

    The kernel runs without the interpreter's lock: threads do, and nothing is copied between processes. A course has
    the same bytes for outcome in any batch, with any number of workers.

    Args:
        courses: what to run.
        workers: threads; one for each core where left out.
    """
    with ThreadPoolExecutor(workers or os.cpu_count()) as pool:
        yield from pool.map(run_course, courses)
