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


def bench_text(configuration: BenchConfiguration, evidence_name: str) -> str:
    """Text of bench.toml; its first line names the file of the evidence."""
    values = configuration.model_dump(mode="json", exclude_none=True, exclude_defaults=True, exclude=LEFT_OUT)
    values.setdefault("drive", {})["kind"] = configuration.drive.kind
    return HEADER.format(evidence=evidence_name) + tomli_w.dumps(values)


def evidence_text(evidence: Evidence) -> str:
    """Text of the file of the evidence, JSON."""
    return json.dumps([one.model_dump() for one in evidence], indent=2) + "\n"


def write_bench(path: Path, configuration: BenchConfiguration, evidence: Evidence) -> None:
    """Write both files.

    Raises:
        CommissionError: a file cannot be written.
    """
    try:
        path.write_text(bench_text(configuration, evidence_path(path).name), encoding="utf-8")
        evidence_path(path).write_text(evidence_text(evidence), encoding="utf-8")
    except OSError as error:
        raise CommissionError(f"{path}: cannot be written: {error.strerror}") from error
