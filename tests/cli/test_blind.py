"""What `friction-bench blind` prints of results that a file holds already."""

import json

from bench.evaluation.blind.items import items_of
from bench.evaluation.blind.result import LabAnswer, Result


def test_what_was_not_asked_is_neither_reached_nor_missed(command, tmp_path):
    flagged = LabAnswer("nothing", (), (), True, 0.5, 0.0, 0.02)  # no name, and a flag that more is missing
    results = [
        Result(item.key, "complete", (), (), (), flagged, (), None, 0.02) for item in items_of(1, 1, ["complete"])
    ]
    (tmp_path / "kept.jsonl").write_text("".join(json.dumps(one.to_json()) + "\n" for one in results))
    found = command("blind", "--plants", "1", "--seed", "1", "--only", "complete", "--results", "kept.jsonl")
    assert found.exit_code == 0, found.output
    rows = [[cell.strip() for cell in line.strip("│").split("│")] for line in found.stdout.splitlines() if "│" in line]
    told = {row[0]: row[-1] for row in rows}
    assert told["false alarms, complete models (a name or a flag)"] == "no"
    assert told["named first where d' >= 6"] == "-"
    assert "first answers, flags not counted" in found.stdout
    assert "false alarms by first answer, flags not counted" in found.stdout
