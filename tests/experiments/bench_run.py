"""Runs an experiment through the ordinary loop, into memory."""

import numpy as np

from bench.config.channels import RECORDED
from bench.control.clock import VirtualClock
from bench.control.drive_factory import make_equipment
from bench.control.ending import StopRequest
from bench.control.limits import Guard
from bench.control.loop import joint_loop
from bench.control.servo import CurrentServo
from bench.experiments.registry import FinishedTrial, find_kind, parse_parameters
from tests.control.fake_drive import ListSink


class Ran:
    """One experiment that was run: outcomes, rows and summary."""

    def __init__(self, configuration, kind_name, **parameters):
        kind = find_kind(kind_name)
        checked = parse_parameters(kind, parameters)
        kind.refuse(checked, configuration)
        drive, technician = make_equipment(configuration)
        period_s = configuration.control.period_s
        drive.open(period_s)
        loop = joint_loop(drive, VirtualClock(), Guard(configuration.limits), period_s, CurrentServo(configuration.rig))
        self.plans, self.outcomes, self.rows, self.events = kind.plan(checked, configuration), [], [], []
        for plan in self.plans:
            technician.hang_load(plan.load_kg, plan.balanced)
            sink = ListSink()
            self.outcomes.append(loop.run(plan.procedure(), sink, StopRequest()))
            self.rows.append(np.vstack(sink.blocks))
            self.events.append(sink.events)
        drive.close()
        trials = [
            FinishedTrial(plan.name, plan.conditions, outcome.outcome, outcome.results)
            for plan, outcome in zip(self.plans, self.outcomes, strict=True)
        ]
        self.summary = kind.summarise(checked, trials)

    def channel(self, trial, name):
        return self.rows[trial][:, RECORDED.index(name)]
