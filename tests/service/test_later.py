"""The service starts without the model lab: its functions are imported where they are called."""

import ast
import pickle
import subprocess
import sys
from pathlib import Path

import pytest

from bench.service import later
from bench.service.later import MODULES, Later

HEAVY = (
    "scipy",
    "numba",
    "compensator.lab.model",
    "compensator.lab.diagnosis.diagnose",
    "compensator.lab.effects.catalogue",
    "plotly",
)


def test_neither_the_lab_nor_scipy_is_imported_by_the_service():
    code = (
        f"import sys, bench.service.app, bench.service.server; print([one for one in {HEAVY!r} if one in sys.modules])"
    )
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == "[]"


@pytest.mark.parametrize("name", MODULES)
def test_each_is_there_and_what_it_is_checked_as(name):
    wanted = f"from bench.study.{MODULES[name]} import {name} as {name}"
    assert any(ast.unparse(one) == wanted for one in ast.walk(ast.parse(Path(later.__file__).read_text())))
    function = getattr(later, name)
    assert function.__name__ == name
    assert pickle.loads(pickle.dumps(function)) == Later(name)
    assert callable(getattr(__import__(f"bench.study.{MODULES[name]}", fromlist=[name]), name))
