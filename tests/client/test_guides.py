"""What the guides to REST and Python say to paste works when it is pasted."""

import json
import os
import re
import shutil
import subprocess

import pytest

from bench.evaluation.challenge import difficulty
from bench.evaluation.challenge.difficulty import Difficulty
from tests.paths import ROOT
from tests.service.running_service import TOKEN

REST = (ROOT / "docs" / "how-to" / "rest.md").read_text(encoding="utf-8")
PYTHON = (ROOT / "docs" / "how-to" / "python.md").read_text(encoding="utf-8")
ADDRESS = "http://127.0.0.1:8000"
# fails on an answer that is an error, and on one that does not come; -m of the stream is its end
STRICT = """curl() {
    local fail=--fail-with-body
    [[ " $* " = *" -f "* ]] && fail=  # the two exclude each other
    command curl $fail -sS "$@"; code=$?
    [ $code = 28 ] && [[ "$*" == *live* ]] || return $code
}"""


QUICK = Difficulty((0.0, 1.0, 0.0), (0.8, 1.0), 0.001, (1.0,), 3.0, 1, 0)


def test_the_curl_examples(bench, service, study, tmp_path, monkeypatch):
    if shutil.which("curl") is None or shutil.which("bash") is None:
        pytest.skip("needs curl and bash")
    commands = re.findall(r"^    (curl (?:.*\\\n)*.*)$", REST, re.MULTILINE)
    assert len(commands) == 11
    monkeypatch.setitem(difficulty.DIFFICULTIES, "easy", QUICK)
    numbers = {'"difficulty": "easy"': '"difficulty": "easy", "seed": 11'}  # what a new store would have, and ours has
    for command in commands:
        for written, ours in numbers.items():
            command = command.replace(written, ours)
        script = f"{STRICT}\n{command.replace(ADDRESS, service.url)}"
        done = subprocess.run(
            ["bash", "-c", script],
            cwd=tmp_path,
            env=os.environ | {"FRICTION_BENCH_TOKEN": TOKEN},
            capture_output=True,
            timeout=60,
        )
        assert done.returncode == 0, (command, done.stdout, done.stderr)
        numbers |= _numbers_in(done.stdout)
        assert done.stdout or any(file.stat().st_size for file in tmp_path.iterdir())  # or what -o names


def _numbers_in(answer: bytes) -> dict[str, str]:
    """What later lines of the guide call 2 and 1, as the answer of a challenge or of a new study has it."""
    told = json.loads(answer) if answer.startswith(b'{"') else {}
    if "difficulty" in told:
        return {"[2]": f"[{told['experiment_id']}]", "challenges/2/": f"challenges/{told['challenge_id']}/"}
    if "trials" in told and "study_id" in told:
        return {"studies/1/": f"studies/{told['study_id']}/", '"study_id": 1}': f'"study_id": {told["study_id"]}}}'}
    return {}


def test_the_python_example(bench, service, study, capsys):
    [code] = re.findall(r"```python\n(.*?)```", PYTHON, re.DOTALL)
    code = code.replace("Bench()", f"Bench({service.url!r}, {TOKEN!r})")
    names: dict[str, object] = {}
    exec(code, names)
    channels = names["channels"]
    assert isinstance(channels, dict)
    assert len(channels["time_s"]) > 100
    shown = capsys.readouterr().out
    assert "excitation: completed" in shown
    assert "missing" in shown or "nothing" in shown.lower()
    names["bench"].close()  # type: ignore[attr-defined]
