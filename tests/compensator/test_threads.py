"""Small matrices on one thread, however the lab is imported."""

import os
import subprocess
import sys

import pytest


@pytest.mark.parametrize("module", ["compensator.lab.model.fit", "bench.study.compare", "bench.cli"])
def test_the_lab_works_on_one_thread(module):
    program = f"import {module}, numpy, os; print(os.environ['OPENBLAS_NUM_THREADS'])"
    environment = {name: value for name, value in os.environ.items() if name != "OPENBLAS_NUM_THREADS"}
    words = [sys.executable, "-c", program]
    done = subprocess.run(words, capture_output=True, text=True, check=True, env=environment)
    assert done.stdout.strip() == "1"
