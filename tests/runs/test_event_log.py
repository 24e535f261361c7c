"""The log that machines read: one JSON object a line, from every process of the bench."""

import json
import logging
import os
import subprocess
import sys
from pathlib import Path

import pytest

from bench.config import presets
from bench.errors import ConfigurationError
from bench.runs import event_log
from bench.runs.event_log import JsonLine


def lines_of(file: Path) -> list[dict[str, object]]:
    return [json.loads(line) for line in file.read_text().splitlines()]


def test_a_run_writes_its_start_its_trials_and_its_end(tmp_path):
    file = tmp_path / "bench.log"
    words = [sys.executable, "-m", "bench.cli", "--log", str(file), "run", "steps", "--repeats", "2"]
    subprocess.run(words, cwd=tmp_path, check=True, capture_output=True)
    found = lines_of(file)
    assert [one["event"] for one in found] == ["run started", "trial ended", "trial ended", "run ended"]
    assert found[0]["parameters"] == {"repeats": 2}
    assert found[1]["name"] == "step-001"
    assert found[-1] | {"outcome": "completed", "reason": "", "level": "info"} == found[-1]
    assert {one["experiment_id"] for one in found} == {1}
    assert all(str(one["at_utc"]).endswith("+00:00") for one in found)


def test_what_went_wrong_is_an_error_with_its_reason(tmp_path):
    words = [sys.executable, "-m", "bench.cli", "--log", "-", "--config", "bench.toml", "run", "steps"]
    fault = '[[drive.faults]]\nkind = "drive-failed"\nat_s = 0.5\n'
    (tmp_path / "bench.toml").write_text(Path(presets.__path__[0], "paper.toml").read_text() + fault)
    ended = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True)
    assert ended.returncode == 1
    *_, last = [json.loads(line) for line in ended.stderr.splitlines() if line.startswith("{")]
    assert (last["event"], last["level"]) == ("run ended", "error")
    assert last["outcome"] != "completed"
    assert last["reason"]


def test_without_a_log_nothing_is_printed(tmp_path):
    said = "import logging; from bench.runs import event_log; event_log.note('request', logging.WARNING, status=401)"
    ended = subprocess.run([sys.executable, "-c", said], check=True, capture_output=True, text=True)
    assert (ended.stdout, ended.stderr) == ("", "")


def test_a_process_that_cannot_write_the_chosen_log_says_so(tmp_path):
    begun = "from bench.runs import event_log; event_log.begin_as_chosen()"
    environment = os.environ | {event_log.VARIABLE: str(tmp_path / "none" / "bench.log")}
    ended = subprocess.run([sys.executable, "-c", begun], check=True, capture_output=True, text=True, env=environment)
    assert "choose another file with --log" in ended.stderr


def test_a_file_that_cannot_be_written_is_refused(tmp_path):
    with pytest.raises(ConfigurationError, match="No such file or directory; choose another file with --log"):
        event_log.begin(str(tmp_path / "none" / "bench.log"))
    assert event_log.VARIABLE not in os.environ


def test_an_error_keeps_its_traceback_on_one_line():
    try:
        raise ValueError("two\nlines")
    except ValueError:
        record = logging.LogRecord("bench", logging.ERROR, __file__, 1, "failed: %s", ("so",), sys.exc_info())
    line = JsonLine().format(record)
    assert "\n" not in line
    assert json.loads(line) | {"event": "failed: so", "level": "error"} == json.loads(line)
    assert "ValueError: two\nlines" in json.loads(line)["error"]


def test_only_its_owner_reads_a_new_log(tmp_path):
    file = tmp_path / "bench.log"
    handler = event_log._handler(str(file))
    handler.close()
    assert file.stat().st_mode & 0o777 == 0o600
