import json
import re
from pathlib import Path

import pytest

from bench.errors import ParameterError
from bench.evaluation.challenge import make
from bench.evaluation.challenge.difficulty import Difficulty
from bench.evaluation.challenge.hidden_plant import MECHANISMS, Wanted, draw_plant
from bench.evaluation.challenge.make import make_challenge, write_challenge
from bench.evaluation.challenge.owner import bench_of, rig_of
from bench.evaluation.challenge.seal import SealError, digest_of, read_sealed
from bench.evaluation.challenge.session import protocol_of, record
from bench.evaluation.challenge.share import effort_share
from bench.recording_set import read_recording_set
from compensator.lab.recordings.recording import SESSION_START, Condition, Recording

SEED = 987_654_321


def _texts(folder: Path) -> dict[str, str]:
    return {path.name: path.read_text() for path in folder.iterdir()}


def test_the_same_seed_makes_the_same_bytes_and_another_one_others(tmp_path: Path) -> None:
    sealed = [write_challenge(seed, "easy", tmp_path / name) for name, seed in (("a", 1), ("b", 1), ("c", 2))]
    first, again, other = (digest_of(tmp_path / name) for name in "abc")
    assert first == again != other
    assert sealed[0].read_bytes() == sealed[1].read_bytes() != sealed[2].read_bytes()


def test_the_recordings_carry_no_trace_of_the_answer(tmp_path: Path) -> None:
    sealed = write_challenge(SEED, "easy", tmp_path / "set")
    texts = _texts(tmp_path / "set")
    answer = read_sealed(sealed, tmp_path / "set")
    numbers = {
        repr(value) for truth in answer.truths for table in truth.parameters.values() for value in table.values()
    }
    numbers |= {repr(truth.size) for truth in answer.truths}
    for name, text in texts.items():
        words = set(re.findall(r"[a-z_]+", f"{name} {text}".lower()))
        assert not words & (set(MECHANISMS) - {"shaft", "spring", "drag"} | {"seed", "hidden", "challenge"})
        assert not words & {word for truth in answer.truths for word in truth.parameters}
        assert str(SEED) not in text
        assert not any(number in text for number in numbers)


def as_asked(recording: Recording) -> dict[str, Condition]:
    """The conditions less the time that earlier trials took: joints settle sooner or later, as their columns show."""
    return {name: value for name, value in recording.conditions.items() if name != SESSION_START}


def test_rig_and_columns_are_those_of_the_joint_that_hides_nothing(quick: Difficulty) -> None:
    nothing = draw_plant(7, Wanted(0))
    plain = record(bench_of(nothing, 1), protocol_of(quick, nothing.joint.heaviest_kg, nothing.joint.top_rad_s))
    for name in ("lubricant", "latency", "backlash", "hose"):
        drawn = draw_plant(7, Wanted(1, names=(name,)))
        assert rig_of(drawn) == rig_of(nothing)
        found = record(bench_of(drawn, 1), protocol_of(quick, drawn.joint.heaviest_kg, drawn.joint.top_rad_s))
        assert [(one.name, one.kind, as_asked(one)) for one in found] == [
            (one.name, one.kind, as_asked(one)) for one in plain
        ]
        assert [list(one.channels) for one in found] == [list(one.channels) for one in plain]


def test_the_owner_knows_the_joint_within_the_data_sheet_and_not_better() -> None:
    drawn = draw_plant(3, Wanted(0))
    rig, motor = rig_of(drawn), drawn.joint.tables["motor"]
    for known, true in (
        (rig.motor.resistance_ohm, motor["resistance_ohm"]),
        (rig.motor.torque_constant_n_m_a, motor["torque_constant_n_m_a"]),
    ):
        assert known == pytest.approx(true, rel=0.06)
        assert known != true


def test_what_is_written_can_be_read_and_the_seal_notices_changes(tmp_path: Path) -> None:
    sealed = write_challenge(3, "easy", tmp_path / "set.zip")
    assert sealed == tmp_path / "set.answer"
    recordings = read_recording_set(tmp_path / "set.zip").recordings
    assert len(recordings) == 7
    assert all(one.conditions["recorded_by"] == "control loop" for one in recordings)
    text = sealed.read_text()
    answer = read_sealed(sealed, tmp_path / "set.zip")
    assert answer.seed == 3
    assert not any(truth.name in text or truth.title in text for truth in answer.truths)

    values = json.loads(text)
    letter = values["sealed"][0][5]
    values["sealed"][0] = values["sealed"][0].replace(letter, "A" if letter != "A" else "B", 1)
    changed = tmp_path / "changed.answer"
    changed.write_text(json.dumps(values))
    with pytest.raises(SealError, match="changed after it was sealed"):
        read_sealed(changed)
    (tmp_path / "set.zip").write_bytes(_other_set(tmp_path))
    with pytest.raises(SealError, match="not the recordings"):
        read_sealed(sealed, tmp_path / "set.zip")


def _other_set(folder: Path) -> bytes:
    write_challenge(4, "easy", folder / "other.zip")
    return (folder / "other.zip").read_bytes()


@pytest.mark.parametrize("content", ["", "{}", '{"what": "else"}', "[1]"])
def test_what_is_no_answer_is_refused(tmp_path: Path, content: str) -> None:
    (tmp_path / "x.answer").write_text(content)
    with pytest.raises(SealError, match="no sealed answer"):
        read_sealed(tmp_path / "x.answer")
    with pytest.raises(SealError, match="cannot be read"):
        read_sealed(tmp_path / "missing.answer")


def test_nothing_is_overwritten_and_nothing_made_before_the_place_is_known(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(make, "make_challenge", lambda *_: pytest.fail("recorded in vain"))
    (tmp_path / "set.answer").write_text("mine")
    with pytest.raises(SealError, match="is there already"):
        write_challenge(1, "easy", tmp_path / "set")
    assert (tmp_path / "set.answer").read_text() == "mine"
    with pytest.raises(ParameterError, match="allowed is easy, medium, hard"):
        make_challenge(1, "brutal")


def test_share_of_the_effort_grows_with_the_size_and_is_nothing_of_nothing(quick: Difficulty) -> None:
    shares = []
    for size in (0.5, 1.0):
        drawn = draw_plant(2, Wanted(1, (size, size), names=("spring",)))
        protocol = protocol_of(quick, drawn.joint.heaviest_kg, drawn.joint.top_rad_s)
        with_it, without = (record(bench_of(drawn, 1, name), protocol) for name in (None, "spring"))
        again = record(bench_of(drawn, 2, "spring"), protocol)
        found = effort_share(with_it, without, again)
        assert found.value < found.at_most < 1.2 * found.value
        shares.append(found.value)
        assert effort_share(without, without, again) == (0.0, 0.0)
        scatter = effort_share(again, without, again)  # two runs of one joint: nothing for sure, yet not nothing
        assert scatter.value == 0.0 < scatter.at_most
    sizes = MECHANISMS["spring"].size
    assert shares[1] / shares[0] == pytest.approx(sizes.high / sizes.at(0.5), rel=0.35)  # of effort with the spring
    # a spring of so much torque at one radian, beside a gravity of 1: about that much of the effort
    assert 0.3 * sizes.high < shares[1] < sizes.high
