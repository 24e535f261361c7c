"""The text protocols by which hosts reach a CAN bus, byte for byte."""

import pytest
from can.interfaces.socketcand.socketcand import convert_ascii_message_to_can_message

from sim_backend.devices.can.frame import Frame
from sim_backend.devices.can.slcan import SlcanAdapter
from sim_backend.devices.can.socketcand import SocketcandSession


def _opened() -> SlcanAdapter:
    adapter = SlcanAdapter()
    assert adapter.feed(b"S8\rO\r") == (b"\r\r", [])
    return adapter


@pytest.mark.parametrize(
    ("line", "answer"),
    [
        (b"\r", b"\r"),
        (b"V\r", b"V1013\r"),
        (b"N\r", b"NA123\r"),
        (b"F\r", b"\a"),  # closed
        (b"C\r", b"\a"),  # closed already
        (b"O\r", b"\a"),  # no bit rate yet
        (b"S9\r", b"\a"),
        (b"S6\r", b"\r"),
        (b"Z0\r", b"\r"),
        (b"Z1\r", b"\a"),  # no time stamps
        (b"t12320102\r", b"\a"),  # closed
        (b"x\r", b"\a"),
        (b"S8\rO\rF\r", b"\r\rF00\r"),
        (b"S8\rO\rS6\r", b"\r\r\a"),  # open: too late
        (b"S8\rL\rt1230\r", b"\r\r\a"),  # listens only
        (b"a" * 40, b"\a"),
    ],
)
def test_slcan_answers(line: bytes, answer: bytes) -> None:
    assert SlcanAdapter().feed(line) == (answer, [])


def test_slcan_puts_frames_on_the_bus_in_pieces_too() -> None:
    adapter = _opened()
    assert adapter.feed(b"t6058400010") == (b"", [])
    assert adapter.feed(b"0000000000\r") == (b"z\r", [Frame(0x605, bytes.fromhex("40 00 10 00 00 00 00 00"))])
    assert adapter.feed(b"t0800\r") == (b"z\r", [Frame(0x080)])
    assert adapter.feed(b"r7051\r") == (b"z\r", [Frame(0x705, b"\0", remote=True)])


@pytest.mark.parametrize("line", [b"t80000\r", b"t1239\r", b"t12321\r", b"t1231zz\r", b"t123\r"])
def test_slcan_refuses_what_is_no_frame(line: bytes) -> None:
    assert _opened().feed(line) == (b"\a", [])


def test_slcan_tells_of_frames_while_open_only() -> None:
    adapter, frame = _opened(), Frame(0x585, bytes.fromhex("43 00 10 00 92 01 02 00"))
    assert adapter.tell(frame) == b"t58584300100092010200\r"
    assert adapter.feed(b"C\r") == (b"\r", [])
    assert adapter.tell(frame) == b""


@pytest.mark.parametrize("can_id", [0x000, 0x080, 0x585])
def test_socketcand_tells_identifiers_of_11_bits_as_such(can_id: int) -> None:
    session = SocketcandSession()
    session.feed(b"< open can0 >< rawmode >")
    message = convert_ascii_message_to_can_message(session.tell(Frame(can_id, b"\x01")).decode())
    assert (message.arbitration_id, message.is_extended_id) == (can_id, False)


def test_socketcand_hand_shake_and_frames() -> None:
    session = SocketcandSession()
    assert session.greet() == b"< hi >"
    assert session.tell(Frame(0x123)) == b""
    assert session.feed(b"< open can0 >< rawmode >") == (b"< ok >< ok >", [])
    assert session.feed(b"< send 123 2 11 f") == (b"", [])
    assert session.feed(b"1 >< send 80 0 >") == (b"", [Frame(0x123, b"\x11\xf1"), Frame(0x80)])
    assert session.feed(b"< echo >") == (b"< echo >", [])
    words = session.tell(Frame(0x585, b"\x01\x02")).split()
    assert [*words[:3], *words[4:]] == [b"<", b"frame", b"585", b"0102", b">"]
    assert float(words[3]) > 0


@pytest.mark.parametrize(
    "text", [b"< rawmode >", b"< open can9 >", b"< send 123 0 >", b"< dance >", b"< open can0 >< rawmode >< send zz >"]
)
def test_socketcand_refuses(text: bytes) -> None:
    answer, frames = SocketcandSession().feed(text)
    assert answer.split(b">")[-2].startswith(b"< error")
    assert frames == []
