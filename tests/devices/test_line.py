import pytest

from sim_backend.devices.link.faults import Direction, LinkFaults, link_fault
from sim_backend.devices.link.line import Line
from sim_backend.errors import ParameterError

TO, FROM = Direction.TO_DEVICE, Direction.FROM_DEVICE


def _line(name: str, baud: int | None = None, **values: object) -> Line:
    return Line(baud, LinkFaults([link_fault(name, 0.0, **values)]))


def test_without_baud_and_faults_bytes_arrive_at_once() -> None:
    assert Line().carry(TO, b"abc", 2.0) == [(2.0, b"abc")]


def test_paced_a_byte_takes_ten_bits_and_waits_for_those_before_it() -> None:
    line = Line(9600)
    assert line.carry(TO, b"abc", 1.0)[0].at_s == pytest.approx(1.0 + 30 / 9600)
    assert line.carry(TO, b"d", 1.0)[0].at_s == pytest.approx(1.0 + 40 / 9600)
    assert line.carry(FROM, b"d", 1.0)[0].at_s == pytest.approx(1.0 + 10 / 9600)


def test_drop_strikes_as_often_as_it_is_told() -> None:
    line = _line("drop", packets=2)
    assert [len(line.carry(TO, b"x", 1.0)) for _ in range(4)] == [0, 0, 1, 1]


def test_fault_of_one_direction_leaves_the_other_alone() -> None:
    line = _line("drop", direction="from-device")
    assert line.carry(TO, b"x", 1.0)
    assert not line.carry(FROM, b"x", 1.0)


def test_delay_comes_late_and_keeps_the_order_on_a_paced_line() -> None:
    line = _line("delay", baud=1_000_000, amount_s=0.5, packets=1)
    late = line.carry(TO, b"x", 1.0)[0]
    assert late.at_s == pytest.approx(1.5 + 1e-5)
    assert line.carry(TO, b"y", 1.0)[0].at_s > late.at_s


def test_corrupt_flips_one_bit() -> None:
    (delivery,) = _line("corrupt").carry(TO, bytes(8), 1.0)
    assert sum(byte.bit_count() for byte in delivery.data) == 1


def test_duplicate_comes_twice() -> None:
    assert [delivery.data for delivery in _line("duplicate").carry(TO, b"ab", 1.0)] == [b"ab", b"ab"]


def test_split_comes_in_two_halves() -> None:
    first, second = _line("split", amount_s=0.03).carry(TO, b"abcd", 1.0)
    assert (first.data, second.data) == (b"ab", b"cd")
    assert second.at_s - first.at_s == pytest.approx(0.03)


def test_silence_ends() -> None:
    line = _line("silent", duration_s=0.5)
    assert line.carry(TO, b"x", 0.4) == []
    assert line.carry(TO, b"x", 0.6) != []


def test_probability_strikes_its_share() -> None:
    line = _line("drop", probability=0.3)
    lost = sum(not line.carry(TO, b"x", 1.0) for _ in range(2000))
    assert 600 - 5 * 21 < lost < 600 + 5 * 21  # five standard deviations of a binomial


@pytest.mark.parametrize("values", [{"direction": "up"}, {"probability": 2.0}, {"size": 3}, {"amount_s": -1.0}])
def test_impossible_fault_is_refused(values: dict[str, object]) -> None:
    with pytest.raises(ParameterError):
        link_fault("drop", 0.0, **values)


def test_unknown_fault_names_the_known() -> None:
    with pytest.raises(ParameterError, match=r"link fault 'fire'.*drop, delay, corrupt, duplicate, split, silent"):
        link_fault("fire", 0.0)
