"""A scan of servos through a slow adapter: what is answered late is found all the same."""

import os
import threading
import tty

from drivers.feetech import frames
from drivers.servos.bus import answering
from sim_backend.devices.feetech import packets


def late_servos(line, ids, over):
    """Servos behind an adapter that hands an answer over when the next question comes."""
    reader, held = packets.InstructionReader(), b""
    while not over.is_set():
        for asked in reader.feed(os.read(line, 64), 0.0):
            os.write(line, held)
            held = packets.status(asked.servo, 0, b"") if asked.servo in ids else b""


def test_an_answer_that_comes_with_the_next_question_counts():
    line, port = os.openpty()
    tty.setraw(port)
    over = threading.Event()
    thread = threading.Thread(target=late_servos, args=(line, (3, 4, 7), over))
    thread.start()
    try:
        found = [one.servo_id for one in answering(os.ttyname(port), 1_000_000, frames.SCS, range(10))]
    finally:
        over.set()
        os.write(port, b"\0")  # it is waiting for a word
        thread.join()
        os.close(port)
        os.close(line)
    assert found == [3, 4, 7]
