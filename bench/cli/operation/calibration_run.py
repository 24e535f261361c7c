"""The experiments of `calibrate run` at the terminal: what is said between them, and how to go on after a pause."""

from typing import TYPE_CHECKING

import typer

from bench.cli.bench_session import BenchSession
from bench.cli.exit_codes import ExitCode
from bench.cli.operation.run import Pace, carry_out
from bench.cli.output import say

if TYPE_CHECKING:  # imported when needed: `--help` starts at once
    from bench.json_types import Values
    from bench.runs.sequential_calibration import Stand, Wish
    from bench.store import Experiment, Store


class CalibrationRun:
    """One calibration on its way."""

    def __init__(
        self,
        session: BenchSession,
        store: "Store",
        wish: "Wish",
        before: list[int],
        pace: Pace | None,
        note: str,
        again: str,
        quiet: bool,
    ) -> None:
        from bench.runs.sequential_calibration import SequentialCalibration

        self._session, self._pace, self._note, self._again, self._quiet = session, pace, note, again, quiet
        bench = session.configuration()
        self._calibration = SequentialCalibration(bench, store, wish, self._run, self._announce, before)

    def carry_out(self) -> list[int]:
        """All experiments; their ids, those before among them.

        Raises:
            typer.Exit: one did not complete; how to go on is said.
        """
        return self._calibration.carry_out()

    def _announce(self, stand: "Stand") -> None:
        if not self._quiet:
            left_s = stand.longest_s - stand.spent_s
            say(f"{stand.sentence}. At most about {left_s / 60.0:.1f} minutes of the joint's time are left.")

    def _run(self, kind: str, parameters: "Values", hung: tuple[float, bool] | None) -> "Experiment":
        found, signal_code = carry_out(
            self._session, kind, parameters, "", self._note, self._pace, quiet=self._quiet, hung=hung
        )
        if found.outcome != "completed":
            after = "".join(f" --after {one}" for one in self._calibration.ids)
            go_on = f" Go on with: friction-bench calibrate run{self._again}{after}" if after else ""
            message = f"experiment {found.id} ({kind}): {found.outcome}: {found.reason}. Nothing was calibrated.{go_on}"
            say(self._session.in_full(message))
            raise typer.Exit(signal_code or ExitCode.NOT_COMPLETED)
        return found
