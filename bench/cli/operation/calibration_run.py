"""The experiments of `calibrate run`, one after the other: the search of F_load, then batches where least is known."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import typer

from bench.cli.bench_session import BenchSession
from bench.cli.exit_codes import ExitCode
from bench.cli.operation.run import Pace, carry_out
from bench.cli.output import say

if TYPE_CHECKING:  # imported when needed: `--help` starts at once
    from bench.calibration.points import FrictionPoint
    from bench.calibration.sequential import Batch, SequentialDesign
    from bench.json_types import Values
    from bench.store import Store, Trial

SEARCHES, RIGHT_ANGLE_RAD = 3, 1.5708
SEARCH_S = 10.5  # of one load at one angle, roughly


@dataclass(frozen=True)
class Wish:
    """What was asked for; see the options of the command."""

    loads_kg: tuple[float, ...]
    accuracy_a: float
    budget_s: float
    duties: tuple[float, ...]
    pace: Pace | None
    note: str
    quiet: bool


class CalibrationRun:
    """One calibration on its way.

    Args:
        session: of the command.
        store: open.
        wish: what was asked for.
        before: records of a calibration that was broken off, which count along.
    """

    def __init__(self, session: BenchSession, store: "Store", wish: Wish, before: list[int]) -> None:
        self._session, self._store, self._wish, self._ids = session, store, wish, list(before)
        self._bench = session.configuration()
        self._hung: tuple[float, bool] | None = None

    def carry_out(self) -> list[int]:
        """All experiments; their ids, those before among them.

        Raises:
            typer.Exit: one did not complete; how to go on is said.
        """
        design = self._design(self._ends_kg())
        searched = self._search_kg()
        if not self._wish.quiet:
            longest_s = design.longest_s + 2 * len(searched) * SEARCH_S
            say(
                f"{len(searched)} loads are searched at rest, then curves are measured until each is known to "
                f"{1e3 * self._wish.accuracy_a:g} mA: at most about {longest_s / 60.0:.0f} minutes of the joint's time."
            )
        if not any("friction_current_a" in trial.results for trial in self._trials()):
            asked: Values = {"loads_kg": searched, "angles_rad": [0.0, RIGHT_ANGLE_RAD], "searches": SEARCHES}
            self._run("load-sweep", asked, (searched[-1], False))
        design = self._design(self._curves_kg())
        while batch := design.next(*self._measured()):
            self._announce(batch, design)
            self._run("speed-sweep", batch.parameters, (batch.load_kg, True))
        return self._ids

    def _ends_kg(self) -> tuple[float, ...]:
        return self._wish.loads_kg or (0.0, self._bench.limits.load_kg)

    def _search_kg(self) -> list[float]:
        ends_kg = self._ends_kg()
        return list(ends_kg if self._wish.loads_kg else (ends_kg[0], sum(ends_kg) / 2.0, ends_kg[1]))

    def _curves_kg(self) -> tuple[float, ...]:
        """As asked; else both ends, and the middle where friction does not grow straight from one to the other."""
        from bench.calibration.sequential import loads_of

        ends_kg = self._ends_kg()
        return self._wish.loads_kg or loads_of(self._trials(), ends_kg, sum(ends_kg) / 2.0)

    def _design(self, loads_kg: tuple[float, ...]) -> "SequentialDesign":
        from bench.calibration.sequential import SequentialDesign

        wish = self._wish
        return SequentialDesign(self._bench, loads_kg, wish.accuracy_a, wish.budget_s, wish.duties)

    def _trials(self) -> "list[Trial]":
        return [trial for one in self._ids for trial in self._store.trials(one) if trial.outcome == "completed"]

    def _measured(self) -> "tuple[dict[float, list[FrictionPoint]], dict[float, float]]":
        from bench.calibration.sequential import measured

        return measured(self._trials(), self._bench.control.period_s)

    def _announce(self, batch: "Batch", design: "SequentialDesign") -> None:
        if self._wish.quiet:
            return
        _, spent_s = self._measured()
        left_s = max(design.longest_s - sum(spent_s.values()), batch.duration_s)
        known = (
            "nothing is known yet"
            if batch.half_width_a == float("inf")
            else f"known to {1e3 * batch.half_width_a:.2g} mA"
        )
        say(
            f"{1e3 * batch.load_kg:g} g: {known}; {len(batch.parameters['speeds_rad_s'])} speeds next. "  # type: ignore[arg-type]
            f"At most {left_s / 60.0:.1f} minutes are left."
        )

    def _run(self, kind: str, parameters: "Values", hung: tuple[float, bool]) -> None:
        wish = self._wish
        found, signal_code = carry_out(
            self._session, kind, parameters, "", wish.note, wish.pace, quiet=wish.quiet, hung=self._hung
        )
        if found.outcome != "completed":
            after = " ".join(f"--after {one}" for one in self._ids)
            go_on = f" Go on with 'calibrate run {after}'" if self._ids else ""
            say(f"experiment {found.id} ({kind}): {found.outcome}: {found.reason}. Nothing was calibrated.{go_on}")
            raise typer.Exit(signal_code or ExitCode.NOT_COMPLETED)
        self._ids.append(found.id)
        self._hung = hung
