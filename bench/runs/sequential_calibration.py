"""The experiments of a calibration, one after the other: the search of F_load, then batches where least is known."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from math import inf

from bench.calibration.points import FrictionPoint
from bench.calibration.sequential import Batch, SequentialDesign, loads_of, measured
from bench.calibration.sides import sides_rad
from bench.config.configuration import BenchConfiguration
from bench.json_types import Values
from bench.store import Experiment, Store, Trial

SEARCHES = 3
SEARCH_S = 10.5  # of one load at one angle, roughly
Run = Callable[[str, Values, tuple[float, bool] | None], Experiment]
"""Runs one experiment (kind, parameters, what hangs on the arm) to its completion, or raises."""


@dataclass(frozen=True, slots=True)
class Wish:
    """What a calibration is to reach.

    Attributes:
        loads_kg: under which curves are measured; (): none and the heaviest, and between them if needed.
        accuracy_a: half of the 95 % interval of a curve at which it is known well enough.
        budget_s: time of the joint for the curves.
        duties: constant duties, for the motor's constants.
    """

    loads_kg: tuple[float, ...]
    accuracy_a: float
    budget_s: float
    duties: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Stand:
    """How far it is.

    Attributes:
        sentence: what is done now, and why.
        longest_s: of the joint's time that all takes at most; less where the accuracy is reached before.
        spent_s: of it, in the experiments that have ended.
        load_kg: that is measured, balanced; None while F_load is searched.
        half_width_a: half of the 95 % interval of its curve where it is known least; inf before the first fit.
    """

    sentence: str
    longest_s: float
    spent_s: float
    load_kg: float | None = None
    half_width_a: float = inf


class SequentialCalibration:
    """One calibration on its way.

    Args:
        bench: its configuration.
        store: open.
        wish: what was asked for.
        run: runs an experiment.
        tell: told before each experiment how far it is.
        before: records of a calibration that was broken off, which count along.

    Attributes:
        ids: of all experiments that have completed, those before among them.
    """

    def __init__(
        self,
        bench: BenchConfiguration,
        store: Store,
        wish: Wish,
        run: Run,
        tell: Callable[[Stand], None],
        before: Sequence[int] = (),
    ) -> None:
        self.ids = list(before)
        self._bench, self._store, self._wish, self._run_one, self._tell = bench, store, wish, run, tell
        self._hung: tuple[float, bool] | None = None

    def carry_out(self) -> list[int]:
        """All experiments that are still due; the ids of all. What `run` raises is passed on."""
        design, searched, sides = self._design(self._ends_kg()), self._search_kg(), sides_rad(self._bench)
        search_s = (1 + len(sides)) * len(searched) * SEARCH_S
        if not any("friction_current_a" in trial.results for trial in self._trials()):
            first = (
                f"{len(searched)} loads are searched at rest, {_where(sides)}. Then curves are measured until each is "
                f"known to {1e3 * self._wish.accuracy_a:g} mA"
            )
            self._tell(Stand(first, design.longest_s + search_s, 0.0))
            asked: Values = {"loads_kg": searched, "angles_rad": [0.0, *sides], "searches": SEARCHES}
            self._run("load-sweep", asked, (searched[-1], False))
        design = self._design(self._curves_kg())
        points, spent = self._measured()
        while batch := design.next(points, spent):
            self._tell(_stand(batch, design.longest_s + search_s, search_s + sum(spent.values())))
            self._run("speed-sweep", batch.parameters, (batch.load_kg, True))
            points, spent = self._measured()
        return self.ids

    def _ends_kg(self) -> tuple[float, ...]:
        return self._wish.loads_kg or (0.0, self._bench.limits.load_kg)

    def _search_kg(self) -> list[float]:
        ends_kg = self._ends_kg()
        return list(ends_kg if self._wish.loads_kg else (ends_kg[0], sum(ends_kg) / 2.0, ends_kg[1]))

    def _curves_kg(self) -> tuple[float, ...]:
        """As asked; else both ends, and the middle where friction does not grow straight from one to the other."""
        ends_kg = self._ends_kg()
        return self._wish.loads_kg or loads_of(self._trials(), ends_kg, sum(ends_kg) / 2.0)

    def _design(self, loads_kg: tuple[float, ...]) -> SequentialDesign:
        wish = self._wish
        return SequentialDesign(self._bench, loads_kg, wish.accuracy_a, wish.budget_s, wish.duties)

    def _trials(self) -> list[Trial]:
        return [trial for one in self.ids for trial in self._store.trials(one) if trial.outcome == "completed"]

    def _measured(self) -> tuple[dict[float, list[FrictionPoint]], dict[float, float]]:
        return measured(self._trials(), self._bench.control.period_s)

    def _run(self, kind: str, parameters: Values, hung: tuple[float, bool]) -> None:
        self.ids.append(self._run_one(kind, parameters, self._hung).id)
        self._hung = hung


def _where(sides_rad: Sequence[float]) -> str:
    """On which sides, and what one alone costs."""
    if len(sides_rad) > 1:
        return "hanging and on both sides"
    return (
        f"hanging and at {sides_rad[0]:g} rad, for the limits leave no angle on the other side: there an estimate at "
        "rest will err by more than its interval says"
    )


def _stand(batch: Batch, longest_s: float, spent_s: float) -> Stand:
    """Before a batch; all of it fits into the time, for that is an estimate."""
    speeds = batch.parameters["speeds_rad_s"]
    count = len(speeds) if isinstance(speeds, Sequence) else 0
    known = "nothing is known yet" if batch.half_width_a == inf else f"known to {1e3 * batch.half_width_a:.2g} mA"
    found = Stand(
        f"{1e3 * batch.load_kg:g} g: {known}; {count} speeds next",
        longest_s,
        spent_s,
        batch.load_kg,
        batch.half_width_a,
    )
    return replace(found, longest_s=max(longest_s, spent_s + batch.duration_s))
