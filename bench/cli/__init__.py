"""The command line `friction-bench`: the same verbs as the REST interface, without a service."""

import os

# The matrices here are small: threads that wait for each other cost more than they save, above all on a busy bench PC.
# Read when numpy is first imported, so it stands before everything else.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from bench.cli.app import main

__all__ = ["main"]
