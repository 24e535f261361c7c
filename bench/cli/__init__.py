"""The command line `friction-bench`: the same verbs as the REST interface, without a service."""

from bench.cli.app import main

__all__ = ["main"]
