"""The baseline: what the same campaign gave before, as JSON."""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from bench.errors import BaselineError
from bench.evaluation.bench_report.campaign import SeedValues, fingerprint, metric_names
from bench.evaluation.bench_report.comparison import mean_interval
from bench.provenance import software

HOW = "make it with: friction-bench bench-report --update-baseline"


def write_baseline(path: Path, found: Sequence[SeedValues]) -> None:
    """Keep what was measured as the baseline; the file is complete or as it was.

    Raises:
        BaselineError: an experiment failed, or the file cannot be written.
    """
    failures = [failure for one in found for failure in one.failures]
    if failures:
        raise BaselineError(f"no baseline is made of failures: {'; '.join(failures)}")
    seeds = [{"seed": one.seed, "values": one.values} for one in found]
    kept = {"software": software(), "campaign": fingerprint(), "means": _means(found), "seeds": seeds}
    text = json.dumps(kept, indent=2)
    unfinished = path.with_name(f".{path.name}.part")
    try:
        unfinished.write_text(text + "\n", encoding="utf-8")
        unfinished.replace(path)
    except OSError as error:
        raise BaselineError(f"{path}: cannot be written: {error.strerror or error}") from error


def read_baseline(path: Path) -> list[SeedValues]:
    """What was kept.

    Raises:
        BaselineError: it is not there, is no baseline, or belongs to another campaign.
    """
    try:
        found: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
        seeds = [SeedValues(int(one["seed"]), _numbers(one["values"])) for one in found["seeds"]]
        campaign = found["campaign"]
    except FileNotFoundError as error:
        raise BaselineError(f"{path}: there is no baseline; {HOW}") from error
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise BaselineError(f"{path}: is no baseline ({error}); {HOW}") from error
    if campaign != fingerprint() or any(set(one.values) != set(metric_names()) for one in seeds):
        raise BaselineError(f"{path}: was made with another campaign, which cannot be compared; {HOW}")
    return seeds


def _means(found: Sequence[SeedValues]) -> dict[str, dict[str, float]]:
    """For who reads the file: the mean over the seeds, and its interval."""
    listed = {}
    for name in found[0].values:
        mean, low, high = mean_interval([one.values[name] for one in found])
        listed[name] = {"mean": mean, "low": low, "high": high}
    return listed


def _numbers(values: Mapping[str, float]) -> dict[str, float]:
    return {str(name): float(value) for name, value in values.items()}
