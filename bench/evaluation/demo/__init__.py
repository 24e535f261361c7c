"""The main job, end to end, on the simulated bench: steps, load sweep, and a hidden effect found and added."""

from bench.evaluation.demo.run import run_demo

__all__ = ["run_demo"]
