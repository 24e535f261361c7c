"""The bench behind a service."""

import os
import threading
import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from types import TracebackType
from typing import Any, Self

from bench.client.answer import Answer, Answers
from bench.client.connection import Connection
from bench.client.errors import ClientError
from bench.client.live import LiveRows, live_rows
from bench.client.run import Run
from bench.client.study import Study
from bench.client.trial import Trial
from bench.own_service import local_port, own_file, read_token


class Bench:
    """A service, and the bench behind it.

    Args:
        url: of the service.
        token: of `friction-bench token new`; None: FRICTION_BENCH_TOKEN, else what this user's service on this machine
            has left for the user's programs while it runs.
        timeout_s: for an answer [s].
        ca_file: certificate, in PEM, that vouches for a service that speaks https; None: those of the system.

    Raises:
        ConfigurationError: others can read the file of the token that the service has left.
    """

    def __init__(
        self,
        url: str = "http://127.0.0.1:8000",
        token: str | None = None,
        timeout_s: float = 120.0,
        ca_file: str | None = None,
    ) -> None:
        token = token or os.environ.get("FRICTION_BENCH_TOKEN") or _left_token(url)
        self._connection = Connection(url, token, timeout_s, ca_file)

    def status(self) -> Answer:
        """Drive, limits, rig, and what it is doing."""
        return Answer(self._connection.get("/bench"))

    def kinds(self) -> Answers:
        """What can be started; `parameters` is the JSON schema of each."""
        return Answers(self._connection.items("/experiment-kinds"))

    def start(
        self, kind: str, *, operator: str = "", note: str = "", pace: str | None = None, **parameters: Any
    ) -> Run:
        """Start an experiment: the joint moves. Sent again where no answer comes, it starts once.

        Args:
            kind: one of `kinds()`.
            operator: who stands at the bench.
            note: kept with the record.
            pace: "real-time" or "fast"; None: as the drive allows.
            **parameters: what differs from the defaults, SI.

        Raises:
            Refused: outside the limits (422), busy or held by somebody else (409), the drive fails (502).
            Unreachable: no answer came; nobody knows whether it runs: look at `status()`.
        """
        body = {"kind": kind, "parameters": parameters, "operator": operator, "note": note, "pace": pace}
        started = self._connection.post("/experiments", body, key=uuid.uuid4().hex)
        return Run(self._connection, started["experiment_id"])

    def stop(self, reason: str = "") -> str:
        """Stop the joint and power it off, whoever started it. Returns what the service says."""
        return str(self._connection.post("/stop", {"reason": reason})["detail"])

    def drive_state(self) -> Answer:
        """What each drive says of itself, and `fault`: all their faults in words; nothing may run meanwhile."""
        return Answer(self._connection.post("/drive/state"))

    def clear_fault(self, fault: str) -> Answer:
        """Clear a fault; the power stays off.

        Args:
            fault: as `drive_state()["fault"]` told it: what was seen is cleared, and nothing else.

        Raises:
            Refused: it is another one by now (409), or its cause is still there (502).
        """
        return Answer(self._connection.post("/drive/clear-fault", {"fault": fault}))

    def run(self, experiment_id: int) -> Run:
        """One experiment, as `start` returns it."""
        return Run(self._connection, experiment_id)

    def experiments(self, kind: str | None = None, outcome: str | None = None) -> list[Run]:
        """What has been run, newest first."""
        found = self._connection.items("/experiments", kind=kind, outcome=outcome)
        return [Run(self._connection, one["experiment_id"], one) for one in found]

    def trials(
        self, experiment_id: int | None = None, kind: str | None = None, outcome: str | None = None
    ) -> list[Trial]:
        """Trials, in the order in which they were made."""
        found = self._connection.items("/trials", experiment_id=experiment_id, kind=kind, outcome=outcome)
        return [Trial(self._connection, one) for one in found]

    def trial(self, trial_id: int) -> Trial:
        """One trial."""
        return Trial(self._connection, self._connection.get(f"/trials/{trial_id}"))

    def live(self) -> Iterator[LiveRows]:
        """Rows as they are recorded, without loss over a broken connection; never ends by itself."""
        return live_rows(self._connection)

    def study(self, study_id: int) -> Study:
        """One study."""
        return Study(self._connection, study_id)

    def new_study(self, name: str, experiments: list[int | Run], **options: Any) -> Study:
        """Fix the trials and fit the base model.

        Args:
            name: of the study.
            experiments: numbers, or what `start` returned.
            **options: `hold_out=["load_kg=0.1"]`, `where`, `rows`, `cutoff_hz`, `base`; see POST /studies.
        """
        numbers = [one.experiment_id if isinstance(one, Run) else one for one in experiments]
        made = self._connection.post("/studies", {"name": name, "experiment_ids": numbers, **options})
        return Study(self._connection, made["study_id"])

    @contextmanager
    def lease(self, holder: str = "", duration_s: float = 60.0) -> Iterator[None]:
        """Have the bench for oneself while the block runs; a thread renews the lease, the end gives it back."""
        self._connection.post("/lease", {"duration_s": duration_s, "holder": holder})
        over = threading.Event()
        heart = threading.Thread(target=self._beat, args=(over, duration_s), daemon=True)
        heart.start()
        try:
            yield
        finally:
            over.set()
            heart.join()
            self._connection.send("DELETE", "/lease")

    def _beat(self, over: threading.Event, duration_s: float) -> None:
        while not over.wait(duration_s / 3):
            try:
                self._connection.send("PUT", "/lease", {"duration_s": duration_s})
            except ClientError:
                continue  # the next beat may get through; else the lease runs out, as it should

    def close(self) -> None:
        """Let go of the service. What runs goes on."""
        self._connection.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<Bench {self._connection.url}>"


def _left_token(url: str) -> str | None:
    """The token of this user's service on this machine; None where it left none, or the address is none of it."""
    try:
        port = local_port(url)
    except ValueError:  # no address at all: the connection says so
        return None
    file = None if port is None else own_file(port)
    return None if file is None else read_token(file)
