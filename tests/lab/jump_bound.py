"""How small jumps of dry friction can be told at all, beside what the lab tells: `python -m tests.lab.jump_bound`.

Eighteen trials of six seconds in cells, as an excitation leaves them, whose friction jumps at moments that nothing
announces. The bound knows all but these moments: height, mean interval, what scatters, and every coefficient of the
base; no test of the same chance has more power than its likelihood ratio (Neyman, Pearson 1933). The lab knows nothing
of that. Beside them stands the evidence that somebody would have who knew every moment.
"""

from typing import NamedTuple

import numpy as np

from compensator.lab.left_over.error_budget import PLAIN
from compensator.lab.left_over.jumps import jumps_of
from compensator.lab.left_over.variance_components import CellsOfTrial, Part, likeliest
from compensator.lab.left_over.wandering import chance_of
from tests.lab.line import Line, print_table

TRIALS, CELLS, LASTS_S, EVERY_S = 18, 16, 6.0, 4.0
SCATTER = (0.6, 0.3, 0.1)  # white, alike for half a second, and in a stroke
HEIGHTS = (0.8, 1.2, 1.6, 2.0)
LAB, BOUND, PORTION = 40, 2000, 200  # draws


class Drawn(NamedTuple):
    """A trial: the course of its jumps, of unit height (c,), and its cells."""

    state: np.ndarray
    cells: CellsOfTrial


def main() -> None:
    """Print power and evidence by the height of the jumps."""
    random = np.random.default_rng(1)
    lines = []
    for height in HEIGHTS:
        evidence, jumps = evidence_of(height, random)
        told = np.mean([lab_tells(height, random) for _ in range(LAB)])
        known = f"2 ln L {evidence:.0f} if all {jumps:.0f} moments were known"
        what = f"jumps of {height:g} of what scatters, {known}: told, of {LAB}"
        lines.append(Line(what, f"bound {bound(height, random):.0%}", f"{told:.0%}", True))
    print_table(lines)


def lab_tells(height: float, random: np.random.Generator) -> bool:
    """Whether it does, of trials of its own."""
    trials = [one.cells for one in draw(height, random)]
    alone, _ = likeliest([one.part.without_last for one in trials])
    return chance_of(jumps_of(trials, alone).gained) <= PLAIN.wandering


def draw(height: float, random: np.random.Generator) -> list[Drawn]:
    """Trials, cells in strokes at moments of their own."""
    found = []
    for index in range(TRIALS):
        time_s = np.sort(random.uniform(0.0, LASTS_S, CELLS))
        kernels = kernels_of(time_s)
        scatter = np.linalg.cholesky(np.tensordot(SCATTER, kernels[:-1], 1)) @ random.standard_normal(CELLS)
        state = states(time_s, 1, random)[0]
        base = np.column_stack([np.ones(CELLS), random.standard_normal((CELLS, 4))])
        cells = CellsOfTrial(index, time_s, np.ones(CELLS), Part(base, scatter + height * state, kernels))
        found.append(Drawn(state, cells))
    return found


def kernels_of(time_s: np.ndarray) -> np.ndarray:
    """Of each component of unit size, what wanders last, shape (4, c, c)."""
    apart_s = np.abs(np.subtract.outer(time_s, time_s))
    stroke = np.floor(time_s)
    return np.array([np.eye(CELLS), np.exp(-apart_s / 0.5), np.equal.outer(stroke, stroke), np.exp(-apart_s / 3.0)])


def states(time_s: np.ndarray, count: int, random: np.random.Generator) -> np.ndarray:
    """Courses of -1/2 and 1/2, shape (count, c)."""
    other = 0.5 * (1.0 - np.exp(-2.0 * np.diff(time_s, prepend=time_s[0]) / EVERY_S))
    turned = np.cumsum(random.uniform(size=(count, CELLS)) < other, axis=1) + random.integers(2, size=(count, 1))
    return turned % 2 - 0.5


def evidence_of(height: float, random: np.random.Generator) -> tuple[float, float]:
    """Expected, for the jumps where every moment is known, and the mean is not; and how many jumps are seen."""
    evidence, jumps = [], []
    for _ in range(20):
        along = square = level = 0.0
        seen = 0
        for state, cells in draw(height, random):
            weighed = np.linalg.solve(
                np.tensordot(SCATTER, cells.part.kernels[:-1], 1), np.column_stack([state, np.ones(CELLS)])
            )
            square += state @ weighed[:, 0]
            along += state @ weighed[:, 1]
            level += weighed[:, 1].sum()
            seen += np.count_nonzero(np.diff(state))
        evidence.append(height**2 * (square - along**2 / level))
        jumps.append(seen)
    return float(np.mean(evidence)), float(np.mean(jumps))


def bound(height: float, random: np.random.Generator) -> float:
    """Power of the likelihood ratio that knows all but the moments, at the lab's chance.

    How often noise alone has so large a ratio is told by draws of jumps, each over its own ratio (importance sampling).
    """
    ratios = np.zeros(BOUND)
    for _, cells in draw(height, random):
        covariance = np.tensordot(SCATTER, cells.part.kernels[:-1], 1)
        root, courses = np.linalg.cholesky(covariance), states(cells.time_s, 4000, random)
        weighed = height * np.linalg.solve(covariance, courses.T)
        power = 0.5 * height * np.einsum("mc,cm->m", courses, weighed)
        jumped = height * courses[random.integers(len(courses), size=BOUND)]
        residuals = random.standard_normal((BOUND, CELLS)) @ root.T + jumped
        found = []
        for some in np.array_split(residuals, -(-BOUND // PORTION)):  # for memory's sake
            exponent = some @ weighed - power
            most = exponent.max(axis=1, keepdims=True)
            found.append(most[:, 0] + np.log(np.mean(np.exp(exponent - most), axis=1)))
        ratios += np.concatenate(found)
    surest = np.sort(ratios)[::-1]
    chance = np.cumsum(np.exp(-surest)) / BOUND
    return float(np.mean(chance <= PLAIN.wandering))


if __name__ == "__main__":
    main()
