"""The lesson on the command line, done as it is written."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.docs.documents import text_of
from tests.paths import ROOT

LESSON = text_of(ROOT / "docs" / "tutorial" / "study.md")
BLOCKS = re.findall(r"```sh\n(.*?)```", LESSON, re.DOTALL)


@pytest.mark.timeout(900)  # a minute or two by itself; a shared machine may take several
def test_the_study_of_the_tutorial(tmp_path: Path) -> None:
    assert len(BLOCKS) == 7
    environment = os.environ | {"PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}"}
    done = subprocess.run(
        ["bash", "-e", "-c", "\n".join(BLOCKS)], cwd=tmp_path, env=environment, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert "weight_friction" in done.stdout
    assert (tmp_path / "study-1.html").stat().st_size > 10_000
