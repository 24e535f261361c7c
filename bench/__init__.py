"""Where drives, compensator, store and service are wired into one bench."""

import os

# The matrices here are small: threads that wait for each other cost more than they save, above all on a busy bench PC.
# numpy reads it when it is first imported, so it stands in the package that is imported before any of its modules.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

__version__ = "0.3.0"
