"""bench.toml of a commissioned joint, and its evidence beside it."""

import json
from pathlib import Path

import tomli_w

from bench.commission.evidence import Evidence
from bench.commission.questions import CommissionError
from bench.config.configuration import BenchConfiguration

HEADER = "# Made by `friction-bench commission`. How each value was found, and how sure it is: {evidence}\n"
LEFT_OUT = {"rest", "friction", "master"}


def evidence_path(path: Path) -> Path:
    """Where the evidence of a bench.toml is."""
    return path.with_suffix(".evidence.json")


def refuse_taken(path: Path) -> None:
    """Raise `CommissionError` where a file would be overwritten; before anything moves."""
    for one in (path, evidence_path(path)):
        if one.exists():
            raise CommissionError(f"{one}: is there already; name another file with --out, or remove it")
    if not path.parent.is_dir():
        raise CommissionError(f"{path.parent}: is no folder; make it, or name another with --out")


def write_bench(path: Path, configuration: BenchConfiguration, evidence: Evidence) -> None:
    """Write both files.

    Raises:
        CommissionError: a file cannot be written.
    """
    values = configuration.model_dump(mode="json", exclude_none=True, exclude_defaults=True, exclude=LEFT_OUT)
    values.setdefault("drive", {})["kind"] = configuration.drive.kind
    head = HEADER.format(evidence=evidence_path(path).name)
    found = [one.model_dump() for one in evidence]
    try:
        path.write_text(head + tomli_w.dumps(values), encoding="utf-8")
        evidence_path(path).write_text(json.dumps(found, indent=2) + "\n", encoding="utf-8")
    except OSError as error:
        raise CommissionError(f"{path}: cannot be written: {error.strerror}") from error
