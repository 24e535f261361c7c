"""Every way in which a run can end, what is done for it, and what has to come of it."""

import os
import resource
import signal
import subprocess
import time
from collections.abc import Callable
from dataclasses import dataclass

from bench.control.late_cycles import BRAKING_S
from bench.control.recorder import Recorder
from bench.own_processes import own_processes
from bench.runs.stoppable import ask_to_stop
from bench.store.upkeep.custody import LEFT_RUNNING
from tests.drivers.conformance.benches import ANSWER_TIMEOUT_S, PERIOD_S
from tests.stopping.bench import PATIENCE_S, WATCHDOG_S, Bench, Service, busy, wait_for

HOST_S = 0.15  # that an ordinary operating system keeps a process, or our own look at the clock, waiting
STOP_S = PERIOD_S + BRAKING_S + HOST_S  # the cycle that sees the wish, and the braking
REST_S = 0.5  # for a request to a busy service
LAST_ANSWER_S = 2.0 * ANSWER_TIMEOUT_S  # the driver asks twice
BLOCK_S = Recorder.BLOCK_S
FEW_PAGES = 16384  # bytes of a database's log: less than a block of rows
LOCKED_S = Recorder.STALL_S + 2.0 * BLOCK_S  # at one block, till the next one asks after it


@dataclass(frozen=True)
class Scene:
    """Where something is to be done.

    Attributes:
        bench: store and device.
        process: what was started at the terminal.
        service: its clients' view, where it is one.
    """

    bench: Bench
    process: "subprocess.Popen[bytes]"
    service: Service | None

    @property
    def served(self) -> Service:
        assert self.service is not None
        return self.service

    def loop_process(self) -> int:
        """The process of the control loop."""
        return self.process.pid if self.service is None else self.service.bench_process()


Deed = Callable[[Scene], float]
"""Does it, and returns when, by `time.monotonic()` [s]."""


@dataclass(frozen=True)
class Way:
    """A way to end a run.

    Attributes:
        deed: called at a random moment.
        outcome, reason: what the record has to say; the reason as a pattern.
        off_s: the motor is off by then, counted from the deed [s].
        served: whether a service runs it, else a command at the terminal.
        survives: whether the service is there afterwards.
        keeps_all: whether every sample up to the power-off is kept, else those up to the deed.
        of_file: whether it can only be done to a store that is a file.
    """

    name: str
    deed: Deed
    outcome: str
    reason: str
    off_s: float = STOP_S
    served: bool = False
    survives: bool = False
    keeps_all: bool = True
    of_file: bool = False


def _signals(*numbers: signal.Signals) -> Deed:
    def send(scene: Scene) -> float:
        now_s = time.monotonic()
        for number in numbers:
            scene.process.send_signal(number)
        return now_s

    return send


def _kill_the_loop(scene: Scene) -> float:
    process = scene.loop_process()
    now_s = time.monotonic()
    os.kill(process, signal.SIGKILL)
    return now_s


def _end_the_loop(scene: Scene) -> float:
    process = scene.loop_process()
    now_s = time.monotonic()
    os.kill(process, signal.SIGTERM)
    return now_s


def _stop_over_rest(scene: Scene) -> float:
    now_s = time.monotonic()
    scene.served.client.post("/stop", json={"reason": "cable is caught"})
    return now_s


def _stop_when_busy(scene: Scene) -> float:
    with busy(scene.served), scene.served.another_client() as client:
        now_s = time.monotonic()
        client.post("/stop", json={"reason": "cable is caught"})
        return now_s


def _stop_from_another_terminal(scene: Scene) -> float:
    """As `friction-bench stop` does, to this process alone."""
    (path,) = (path for path, told in own_processes() if told.process_id == scene.process.pid)
    now_s = time.monotonic()
    ask_to_stop(path, "friction-bench stop")
    return now_s


def _fill_the_disk(scene: Scene) -> float:
    """No file may grow beyond what the program has said at the terminal: what a full disk is to the database.

    Its log begins anew now and then, within the length that it has had: more than that has to be forbidden.
    """
    size = scene.bench.output_file.stat().st_size + FEW_PAGES
    now_s = time.monotonic()
    resource.prlimit(scene.loop_process(), resource.RLIMIT_FSIZE, (size, resource.RLIM_INFINITY))
    return now_s


def _raise(scene: Scene) -> float:
    now_s = time.monotonic()
    (scene.bench.folder / "raise").touch()
    return now_s


def _trip(scene: Scene) -> float:
    """The encoder jumps to where the joint may not be."""
    now_s = time.monotonic()
    scene.bench.device.side.ask("fault", name="encoder-jump", jump_rad=3.0)
    return now_s


def _pull_the_cable(scene: Scene) -> float:
    now_s = time.monotonic()
    scene.bench.device.side.ask("link", name="disconnect", duration_s=5.0)
    return now_s


def _lock_for_a_moment(scene: Scene) -> float:
    """Another program writes for a second: the rows wait, and none is lost. Then a signal ends the run."""
    with scene.bench.records.locked():
        time.sleep(1.0)
    return _signals(signal.SIGTERM)(scene)


def _lock_until_the_end(scene: Scene) -> float:
    """Another program never lets go while the run lasts: the run ends, and its end is written later."""
    with scene.bench.records.locked():
        now_s = time.monotonic()
        if scene.service is None:
            scene.process.wait(PATIENCE_S)
        else:
            wait_for(lambda: not scene.served.runs(), scene.bench)
    return now_s


KILLED = f"^{LEFT_RUNNING[:20]}"
INT, TERM, KILL = signal.SIGINT, signal.SIGTERM, signal.SIGKILL
CTRL_C, ENDED = "Ctrl-C at the terminal", "the service was ended"
FULL_S = 2.0 * BLOCK_S + STOP_S  # until the block that does not fit is written, and the next one asks after it
WAYS = (
    # the service
    Way("stop by REST", _stop_over_rest, "stopped", "cable is caught", served=True, survives=True),
    Way("stop by REST, busy", _stop_when_busy, "stopped", "caught|over REST", STOP_S + REST_S, True, True),
    Way("limit trip", _trip, "tripped", "position is .* allowed is", served=True, survives=True),
    Way("drive gone", _pull_the_cable, "failed", "check the cable", WATCHDOG_S + HOST_S, True, True, False),
    Way("kill -9 of the loop", _kill_the_loop, "interrupted", "SIGKILL", WATCHDOG_S + HOST_S, True, True, False),
    Way("SIGTERM to the loop", _end_the_loop, "stopped", "ended by a signal", served=True, survives=True),
    Way("locked until the end", _lock_until_the_end, "failed", "locked|keep up", LOCKED_S + STOP_S, True, True, False),
    Way("disk full", _fill_the_disk, "failed", "disk|full", FULL_S, True, False, False, True),
    Way("kill -9 of the service", _signals(KILL), "stopped", "service .* is gone", served=True),
    Way("Ctrl-C to the service", _signals(INT), "stopped", ENDED, served=True),
    Way("Ctrl-C twice to the service", _signals(INT, INT), "stopped", ENDED, served=True),
    Way("SIGTERM to the service", _signals(TERM), "stopped", ENDED, served=True),
    # a command at the terminal
    Way("run: Ctrl-C", _signals(INT), "stopped", CTRL_C),
    Way("run: Ctrl-C twice", _signals(INT, INT), "stopped", CTRL_C),
    Way("run: SIGTERM", _signals(TERM), "stopped", "SIGTERM at the terminal"),
    Way("run: stop from another terminal", _stop_from_another_terminal, "stopped", "friction-bench stop"),
    Way("run: kill -9", _signals(KILL), "interrupted", KILLED, WATCHDOG_S + HOST_S, keeps_all=False),
    Way("run: exception in the trial", _raise, "failed", "a fault of the software"),
    Way("run: limit trip", _trip, "tripped", "position is .* allowed is"),
    Way("run: disk full", _fill_the_disk, "failed", "disk|full", FULL_S, keeps_all=False, of_file=True),
    Way("run: drive gone", _pull_the_cable, "failed", "check the cable", WATCHDOG_S + HOST_S, keeps_all=False),
    Way("run: locked for a second", _lock_for_a_moment, "stopped", "SIGTERM at the terminal"),
)
