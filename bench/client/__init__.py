"""A service in a few lines of Python: start, watch, stop, read trials as arrays, ask a study.

    from bench.client import Bench

    bench = Bench("http://127.0.0.1:8000", token)
    run = bench.start("steps", repeats=3).wait()
    channels = run.trials()[0].channels()  # {"time_s": array([...]), "position_rad": ...}

It needs the address of the service and nothing else of this package.
"""

from bench.client.bench import Bench
from bench.client.errors import ClientError, Refused, Unreachable
from bench.client.live import LiveRows
from bench.client.run import Run
from bench.client.study import Study
from bench.client.trial import Trial

__all__ = ["Bench", "ClientError", "LiveRows", "Refused", "Run", "Study", "Trial", "Unreachable"]
