"""The control loop in a process of its own, apart from the server: nothing that is served holds it up."""

from bench.runs.bench_process.remote_runner import RemoteRunner

__all__ = ["RemoteRunner"]
