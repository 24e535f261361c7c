"""`friction-bench record`: a servo or an actuator that another program moves."""

from pathlib import Path
from typing import Annotated

import typer

from bench.cli.bench_session import session_of
from bench.cli.operation.signals import until_interrupted
from bench.cli.output import Json, print_json, say

_OFFERED = Path("servo.port")


def record(
    context: typer.Context,
    offer: Annotated[
        Path, typer.Option(help="Serial servos: name of the port to offer; the other program opens it.")
    ] = _OFFERED,
    seconds: Annotated[float, typer.Option(min=0.1, max=3600, help="How long, from its first word on.")] = 30.0,
    rate_hz: Annotated[float, typer.Option(min=1, max=1000, help="Serial servos: looks a second, at most.")] = 100.0,
    load_kg: Annotated[
        float | None, typer.Option(min=0, help="Load on the arm meanwhile [kg]; left out: not known.")
    ] = None,
    name: Annotated[str, typer.Option(help="Name of the record.")] = "followed",
    as_json: Json = False,
) -> None:
    """Record a servo or an actuator that another program moves (LeRobot, ROS 2, a vendor's tool).

    Nothing is commanded. On a CAN bus what the actuator tells the other program is heard, and nothing is sent. On a
    serial line the other program opens the port that is offered here: what it says is passed on byte for byte; in its
    pauses the servo is asked what it measures, as long as that program talks. Afterwards bytes are passed on until it
    has been silent for 2 s: power is its own matter, and it may hold a load.
    """
    from bench.control.scheduling import undisturbed
    from bench.recording_set import import_recording_set
    from bench.recording_set.recording_set import RecordingSet
    from bench.runs.follow import EFFORTS, follower_of, pass_on
    from bench.runs.follow import record as recorded

    session = session_of(context)
    configuration = session.configuration()
    # before other programs: who waits for an answer through us waits no longer than a library does
    with until_interrupted() as stopped, session.open_store() as store, undisturbed(paced=True):
        follower = follower_of(configuration, offer, 1.0 / rate_hz)
        try:
            if not as_json:
                say(f"{follower.product}, {follower.device}. Let the other program {follower.wanted}.")
            conditions = {} if load_kg is None else {"load_kg": load_kg}
            recording = recorded(follower, configuration, name, dict(conditions), seconds, stopped)
            recording_set = RecordingSet(name, configuration.rig, [recording])
            further = {"device": follower.device, "product": follower.product, "moved_by": "another program"}
            experiment_id = import_recording_set(store, recording_set, name, further)
            if not as_json:
                rate = (len(recording) - 1) / float(recording.channels["time_s"][-1])
                say(f"recorded as experiment {experiment_id}: {len(recording)} rows, {rate:.0f} a second")
                if not EFFORTS & recording.channels.keys():
                    say("No row tells an effort (current, torque), which the model lab needs: have it reported.")
                if follower.is_between:
                    say("What the other program says is passed on until it has left; Ctrl-C cuts it off.")
            pass_on(follower, stopped)
        finally:
            follower.close()
    if as_json:
        print_json({"experiment_id": experiment_id, "rows": len(recording)})
