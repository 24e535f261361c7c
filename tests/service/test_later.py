"""The service starts without the model lab: its functions are imported where they are called."""

import ast
import pickle
import subprocess
import sys
from copy import copy
from functools import reduce
from pathlib import Path
from pkgutil import resolve_name

import pytest

from bench.service import routes
from bench.service.later import Later, bench

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


def places():
    """What the routes name of the lab, as `bench.study.ladder.ladder`."""
    found = set()
    for path in Path(routes.__path__[0]).rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.Attribute) and ast.unparse(node).startswith("bench.study."):
                found.add(ast.unparse(node))
    return sorted(one for one in found if not any(other.startswith(f"{one}.") for other in found))


@pytest.mark.parametrize("place", places())
def test_each_is_there_and_another_process_finds_it(place):
    later = reduce(getattr, place.split(".")[1:], bench)
    assert later.__name__ == place.rpartition(".")[2]
    assert pickle.loads(pickle.dumps(later)) == Later(place)
    assert copy(later) == later
    assert callable(resolve_name(place))


def test_they_are_those_of_every_answer_of_a_study():
    assert len(places()) > 15


def test_it_has_no_names_of_python_s_own():
    with pytest.raises(AttributeError):
        _ = bench.study.__wrapped__
