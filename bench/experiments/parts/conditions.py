"""What is held constant in a trial."""

from bench.config.configuration import BenchConfiguration
from compensator.lab.recordings.recording import Condition


def conditions(configuration: BenchConfiguration, **held: Condition) -> dict[str, Condition]:
    """The conditions of a trial, with what the rig adds to them: the arm's length, where it is known."""
    length_m = configuration.rig.arm.length_m
    return held if length_m is None else {**held, "arm_m": length_m}
