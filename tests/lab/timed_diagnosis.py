"""One diagnosis in a process of its own, timed from its first import: `python -m tests.lab.timed_diagnosis STORE`.

Prints JSON: seconds of the wall clock and of one core for each part, pictures drawn, bytes of the report, peak memory.
With --comparison it ends after the comparison, and prints the seconds alone.
"""

import argparse
import gc
import json
import resource
import time
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any


def main() -> None:
    """Time the diagnosis of the store's first experiment."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("store")
    parser.add_argument("--comparison", action="store_true", help="no more than that")
    arguments = parser.parse_args()
    laps: dict[str, tuple[float, float]] = {}

    def timed(name: str, work: Callable[[], Any]) -> Any:
        gc.collect()  # what the part before left is not this one's
        wall_s, cpu_s = time.perf_counter(), time.process_time()
        result = work()
        laps[name] = (time.perf_counter() - wall_s, time.process_time() - cpu_s)
        return result

    study = timed("import", _imported)
    with study.Store.open(arguments.store) as store:
        study_id = timed("study", lambda: study.create_study(store, "rates", [1])).study_id
        timed("comparison", lambda: study.compare(store, study_id))
        if arguments.comparison:
            print(json.dumps({"laps": laps}))
            return
        found = timed("diagnosis", lambda: study.diagnose(store, study_id))
        page = timed("report", lambda: study.report_html(store, study_id))
    pictures = sum(bool(one.picture) for one in found.ranking)
    peak_mb = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3
    print(json.dumps({"laps": laps, "pictures": pictures, "page": len(page), "peak_mb": peak_mb}))


def _imported() -> Any:
    from bench.store import Store
    from bench.study.compare import compare
    from bench.study.create import create_study
    from bench.study.diagnosis.diagnose import diagnose
    from bench.study.report.report import report_html

    names = {"Store": Store, "create_study": create_study, "compare": compare}
    return SimpleNamespace(**names, diagnose=diagnose, report_html=report_html)


if __name__ == "__main__":
    main()
