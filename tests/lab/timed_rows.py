"""A fit to so many streamed rows, in a process of its own: `python -m tests.lab.timed_rows 1000000`.

Prints JSON: samples, seconds of one core, peak memory of this process. Recordings are made as they are asked for: the
same motions under fresh noise, one minute at 200 Hz each.
"""

import json
import resource
import sys
import time
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from compensator.lab.effects.catalogue import default_effects
from compensator.lab.model.fit import fit_model
from compensator.lab.model.streaming import fit_streamed
from compensator.lab.recordings.recording import Recording
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from tests.lab.synthetic import FACTS, Bench, Joint, recordings

BENCH = Bench(duration_s=60.0)


def main() -> None:
    """Stream as many rows as the first argument says."""
    first = recordings(Joint(), BENCH, seed=1)
    fit = fit_model(make_dataset(first, FACTS, Processing()), [*default_effects(FACTS), "load_friction"])
    begun_s = time.process_time()
    found = fit_streamed(fit, _trials(first, int(float(sys.argv[1]))))
    cpu_s = time.process_time() - begun_s
    peak_mb = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3
    print(json.dumps({"samples": found.samples, "rows": found.rows, "cpu_s": cpu_s, "peak_mb": peak_mb}))


def _trials(first: list[Recording], samples: int) -> Iterator[Recording]:
    random, made = np.random.default_rng(2), 0
    while made < samples:
        kept = first[made // len(first[0]) % len(first)]
        torque = kept.channels["torque_n_m"] + BENCH.noise * random.standard_normal(len(kept))
        yield replace(kept, name=f"trial {made}", channels={**kept.channels, "torque_n_m": torque})
        made += len(kept)


if __name__ == "__main__":
    main()
