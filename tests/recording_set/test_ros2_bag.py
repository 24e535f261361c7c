"""ROS 2 bags, written by the library that ROS tools write them with."""

from math import cos, sin

import numpy as np
import pytest
from mcap_ros2.writer import Writer

from bench.config.rig import Rig
from bench.recording_set import RecordingSetError, read_ros2_bags

RIG = Rig(name="elbow of an arm")
DEFINITION = """
std_msgs/Header header
string[] name
float64[] position
float64[] velocity
float64[] effort
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"""
ROWS, PERIOD_NS = 50, 10_000_000


def bag(path, effort=True, topics=("/joint_states",), stamped=True, repeated=False):
    with path.open("wb") as stream:
        writer = Writer(stream)
        schema = writer.register_msgdef("sensor_msgs/msg/JointState", DEFINITION)
        for topic in topics:
            for row in range(ROWS):
                for _ in range(2 if repeated else 1):
                    writer.write_message(topic, schema, message(row, effort, stamped), log_time=(row + 1) * PERIOD_NS)
        writer.finish()
    return path


def message(row, effort, stamped):
    time_s = row * PERIOD_NS * 1e-9
    stamp = {"sec": 100, "nanosec": row * PERIOD_NS} if stamped else {"sec": 0, "nanosec": 0}
    return {
        "header": {"stamp": stamp, "frame_id": ""},
        "name": ["shoulder", "elbow"],
        "position": [0.0, sin(time_s)],
        "velocity": [0.0, cos(time_s)],
        "effort": [0.0, 2.0] if effort else [],
    }


@pytest.mark.parametrize("stamped", [True, False])
def test_one_joint_of_a_bag_is_a_trial(tmp_path, stamped):
    found = read_ros2_bags(bag(tmp_path / "run.mcap", stamped=stamped), RIG, "elbow")
    [trial] = found.recordings
    assert (found.name, trial.name, len(trial)) == ("run", "run", ROWS)
    time_s = np.arange(ROWS) * 0.01
    assert trial.channels["time_s"] == pytest.approx(time_s, abs=1e-6)
    assert trial.channels["position_rad"] == pytest.approx(np.sin(time_s))
    assert trial.channels["velocity_rad_s"] == pytest.approx(np.cos(time_s))
    assert trial.channels["torque_n_m"] == pytest.approx(np.full(ROWS, 2.0))


def test_effort_is_what_its_publisher_says(tmp_path):
    [trial] = read_ros2_bags(bag(tmp_path / "run.mcap"), RIG, "elbow", "current_a").recordings
    assert "torque_n_m" not in trial.channels
    assert trial.channels["current_a"][0] == 2.0
    [without] = read_ros2_bags(bag(tmp_path / "no.mcap", effort=False), RIG, "elbow").recordings
    assert set(without.channels) == {"time_s", "position_rad", "velocity_rad_s"}


def test_what_was_sent_again_is_left_out(tmp_path):
    [trial] = read_ros2_bags(bag(tmp_path / "run.mcap", repeated=True), RIG, "elbow").recordings
    assert len(trial) == ROWS


def test_a_folder_of_bags(tmp_path):
    for name in ("b", "a"):
        bag(tmp_path / f"{name}.mcap")
    assert [one.name for one in read_ros2_bags(tmp_path, RIG, "elbow").recordings] == ["a", "b"]


def test_what_is_not_there_is_named(tmp_path):
    one = bag(tmp_path / "run.mcap")
    with pytest.raises(RecordingSetError, match="has no joint 'wrist' on /joint_states; it has elbow, shoulder"):
        read_ros2_bags(one, RIG, "wrist")
    two = bag(tmp_path / "two.mcap", topics=("/left", "/right"))
    with pytest.raises(RecordingSetError, match="/left, /right; name one with --topic"):
        read_ros2_bags(two, RIG, "elbow")
    assert len(read_ros2_bags(two, RIG, "elbow", topic="/left").recordings) == 1
    damaged = tmp_path / "damaged.mcap"
    damaged.write_bytes(one.read_bytes()[:200])
    with pytest.raises(RecordingSetError, match=r"damaged.mcap"):
        read_ros2_bags(damaged, RIG, "elbow")
    with pytest.raises(RecordingSetError, match="cannot be read"):
        read_ros2_bags(tmp_path / "absent.mcap", RIG, "elbow")
    (tmp_path / "empty").mkdir()
    with pytest.raises(RecordingSetError, match=r"no file that ends in \.mcap"):
        read_ros2_bags(tmp_path / "empty", RIG, "elbow")
