"""ROS 2 bags (MCAP) with `sensor_msgs/JointState`: one joint of a bag is one trial."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any, Literal, NamedTuple, Protocol

import numpy as np

from bench.config.rig import Rig
from bench.recording_set.errors import RecordingSetError, needed
from bench.recording_set.recording_set import RecordingSet
from compensator.lab.recordings.recording import Recording

ENDING = ".mcap"
JOINT_STATE = "sensor_msgs/msg/JointState"
EffortChannel = Literal["torque_n_m", "current_a", "duty"]
_FEWEST_ROWS = 2


class JointState(NamedTuple):
    """One message, of one joint; what it leaves out is NaN."""

    time_s: float
    position_rad: float
    velocity_rad_s: float
    effort: float


class _Stamp(Protocol):
    sec: int
    nanosec: int


class _Header(Protocol):
    stamp: _Stamp


class _Message(Protocol):
    """As the decoder of `mcap-ros2-support` gives it."""

    header: _Header
    name: list[str]
    position: list[float]
    velocity: list[float]
    effort: list[float]


def read_ros2_bags(
    path: Path, rig: Rig, joint: str, effort: EffortChannel = "torque_n_m", topic: str = ""
) -> RecordingSet:
    """Read one joint of a bag, or of every bag in a folder.

    Args:
        path: a file that ends in .mcap, or a folder with such files.
        rig: the joint as its owner knows it; a bag does not say.
        joint: its name in the messages.
        effort: what the publisher puts into `effort`; ROS says N m, and drivers put there what they have.
        topic: of the messages; "": the only one with joint states.

    Raises:
        RecordingSetError: no bag, no such joint or topic, or too few messages; what was found is named.
    """
    files = sorted(path.glob(f"*{ENDING}")) if path.is_dir() else [path]
    if not files:
        raise RecordingSetError(str(path), f"has no file that ends in {ENDING}; name a bag, or a folder of them")
    recordings = [_recording(file, joint, effort, topic) for file in files]
    return RecordingSet(path.stem if path.is_file() else path.name, rig, recordings)


def _recording(file: Path, joint: str, effort: str, topic: str) -> Recording:
    """The trial of one bag. Stamps that do not rise are messages that were sent again, and are left out."""
    rows: list[JointState] = []
    for state in _states(file, joint, topic):
        if not rows or state.time_s > rows[-1].time_s:
            rows.append(state)
    if len(rows) < _FEWEST_ROWS:
        raise RecordingSetError(file.name, f"has {len(rows)} states of joint '{joint}'; {_FEWEST_ROWS} are wanted")
    table = np.array(rows)
    table[:, 0] -= table[0, 0]
    names = ("time_s", "position_rad", "velocity_rad_s", effort)
    channels = {name: column for name, column in zip(names, table.T, strict=True) if not np.all(np.isnan(column))}
    return Recording(file.stem, "ros2 bag", {}, channels)


def _states(file: Path, joint: str, topic: str) -> Iterator[JointState]:
    """The states of a joint, in the order of the log."""
    with needed("ROS 2 bag", "mcap-ros2-support", "ros2", "import CSV"):
        from mcap.reader import make_reader
        from mcap_ros2.decoder import DecoderFactory
    others: set[str] = set()
    found_joint = False
    try:
        with file.open("rb") as stream:
            reader = make_reader(stream, decoder_factories=[DecoderFactory()])
            chosen = topic or _only_topic(file, reader.get_summary())
            for _, _, logged, message in reader.iter_decoded_messages(topics=[chosen]):
                others.update(message.name)
                if joint in message.name:
                    found_joint = True
                    yield _state(message, list(message.name).index(joint), logged.log_time)
    except OSError as error:
        raise RecordingSetError(str(file), f"cannot be read: {error.strerror}; name a bag") from error
    except RecordingSetError:
        raise
    except Exception as error:  # the library has errors of many kinds for a damaged file
        raise RecordingSetError(file.name, f"is no ROS 2 bag in MCAP, or a damaged one: {error}") from error
    if not found_joint:
        raise RecordingSetError(file.name, f"has no joint '{joint}' on {chosen}; it has {', '.join(sorted(others))}")


def _only_topic(file: Path, summary: Any) -> str:
    """The topic with joint states, where there is one."""
    if summary is None:
        raise RecordingSetError(file.name, "has no summary: its writer was killed; `mcap recover` makes one")
    schemas, channels = summary.schemas, summary.channels.values()
    topics = sorted({one.topic for one in channels if schemas[one.schema_id].name == JOINT_STATE})
    if len(topics) != 1:
        known = ", ".join(topics) or "none"
        raise RecordingSetError(file.name, f"has topics with {JOINT_STATE}: {known}; name one with --topic")
    topic: str = topics[0]
    return topic


def _state(message: _Message, place: int, logged_ns: int) -> JointState:
    """One joint of a message; its time is the header's stamp, or where that is 0 the time of the log."""
    stamp = message.header.stamp
    time_s = stamp.sec + 1e-9 * stamp.nanosec
    parts = (message.position, message.velocity, message.effort)
    values = (float(part[place]) if place < len(part) else np.nan for part in parts)
    return JointState(time_s or 1e-9 * logged_ns, *values)
