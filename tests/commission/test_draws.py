"""Some of the drawn rigs, one of each wire; `python -m tests.commission.draws 40` runs more."""

import subprocess
import sys

import pytest

from tests.paths import ROOT


@pytest.mark.timeout(600)  # half a minute by itself; a shared machine may take several
def test_one_rig_of_each_wire_ends_in_its_load_or_in_a_refusal_that_names_its_fault():
    # a process of its own: its clocks are virtual; 12 s of each answer only count
    words = [sys.executable, "-m", "tests.commission.draws", "3", "1", "12", "3"]
    done = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, check=False)
    assert "3 of 3 end with the load within 2 g" in done.stdout, done.stdout + done.stderr
    assert done.returncode == 0
    for wire in ("roboclaw", "modbus", "canopen"):
        assert wire in done.stdout
