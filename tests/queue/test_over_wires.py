"""The queue and a campaign over wires, with every kind of experiment that has no conformance test of its own."""

import subprocess
import sys

import pytest

from tests.paths import ROOT


@pytest.mark.timeout(300)  # ten seconds by itself
def test_every_kind_runs_from_the_queue_and_a_campaign_after_it() -> None:
    # a process of its own: its clocks are virtual
    words = [sys.executable, "-m", "tests.queue.over_wires"]
    done = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, check=False)
    for wire in ("modbus", "canopen"):
        assert f"{wire}: all completed" in done.stdout, done.stdout + done.stderr
    assert done.returncode == 0
