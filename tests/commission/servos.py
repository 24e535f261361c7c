"""`python -m tests.commission.servos N [SEED] [FIRST]`: servos proposed for N drawn rigs, and the best for each load.

Each rig is identified by its pushes, the servo is proposed from that and from the torque per current that a weight
tells, and the joint moves to 0.5 rad and to level and back: without load, with half of the heaviest, and with that. Of
each load are printed the overshoot as a share of the way, the time until the joint stays within 2 % of the way, and
whether it swings at rest. Beside it stands the quickest sound servo that a search over gains finds for this load alone:
what gains that change with the load could reach.
"""

import sys
from dataclasses import dataclass
from math import inf, pi

import numpy as np

from bench.commission.evidence import interval
from bench.commission.proposal import Joint, Proposal, propose
from bench.config.configuration import BenchConfiguration, parse_configuration
from bench.config.sections import ServoSettings
from bench.control.clock import VirtualClock
from bench.control.drive_factory import make_equipment
from bench.control.ending import StopRequest
from bench.control.limits import Guard
from bench.control.loop import joint_loop
from bench.experiments.parts.joint import Joint as Moved
from sim_backend.challenge.joint import Joint as DrawnJoint
from sim_backend.challenge.joint import draw_joint
from tests.control.fake_drive import ListSink
from tests.experiments.bench_run import Ran

ALLOWED_OVERSHOOT, ALLOWED_RATIO, BAND_SHARE = 0.05, 1.5, 0.02
WAYS_RAD = (0.5, pi / 2.0)
HOLD_S = 3.0
SWINGS = 4  # turns of the motion at rest, beyond the dead-band, that make a limit cycle
TRIED = 24
LOADS = (0.0, 0.5, 1.0)  # of the heaviest


@dataclass(frozen=True)
class Quality:
    """How well a servo moves a joint with a load: the worst of all ways.

    Attributes:
        overshoot: as a share of the way.
        settled_s: from the start of the move until the joint stays within the band; inf where it does not.
        swings: whether it goes on moving at rest.
    """

    overshoot: float
    settled_s: float
    swings: bool

    @property
    def is_sound(self) -> bool:
        return self.overshoot <= ALLOWED_OVERSHOOT and not self.swings


def bench_of(joint: DrawnJoint, period_s: float, seed: int, **sections: object) -> BenchConfiguration:
    """The rig in process, its drive with a current mode; nothing is known of it but what turns counts into angles."""
    measured = {
        "current_sensor": {"present": True},
        "current_loop": {"present": True},
        "latency": {"delay_s": period_s},  # on a wire a command answers the sample of the cycle before
    }
    return parse_configuration(
        {
            "name": "drawn",
            "rig": {
                "name": "drawn",
                "gear": {"ratio": joint.ratio},
                "sensor": {"counts_per_turn": joint.tables["encoder"]["counts_per_turn"]},
                "motor": {"resistance_ohm": 1.0, "back_emf_v_s_rad": 1e-6},
            },
            "drive": {"kind": "sim", "seed": seed, "plant": joint.tables | measured},
            "control": {"period_s": period_s},
            **sections,
        },
        "drawn",
    )


def proposed(joint: DrawnJoint, period_s: float, seed: int) -> Proposal:
    """The proposal from pushes alone."""
    limit_a = 1.2 * joint.peak_a
    wide = {"limits": {"current_a": limit_a}, "servo": {"current_a": limit_a}, "search": {"ceiling_a": limit_a}}
    ran = Ran(
        bench_of(joint, period_s, seed, **wide), "identification", ceiling_a=0.8 * limit_a, rate_a_s=limit_a / 6.0
    )
    assert ran.outcomes[0].outcome == "completed", ran.outcomes[0].reason
    results = ran.outcomes[0].results
    inertia = interval(results, "inertia_a_s2_rad").value
    torque_n_m_a = joint.ratio * joint.tables["motor"]["torque_constant_n_m_a"]  # as a weight tells it
    length_m, voltage_v = joint.tables["arm"]["length_m"], joint.tables["supply"]["voltage_v"]
    breakaway_a = results["breakaway_a"]
    return propose(
        Joint(
            motor_current_a=limit_a, travel_rad=2.0, period_s=period_s,
            count_rad=2.0 * pi / (joint.ratio * joint.tables["encoder"]["counts_per_turn"]),
            breakaway_a=breakaway_a, coulomb_a=interval(results, "coulomb_a").value,
            viscous_a_s_rad=interval(results, "viscous_a_s_rad").value, gravity_a=joint.gravity_n_m / torque_n_m_a,
            inertia_a_s2_rad=inertia, loaded_a_s2_rad=inertia + joint.heaviest_kg * length_m**2 / torque_n_m_a,
            no_load_rad_s=voltage_v / torque_n_m_a, velocity_lag_s=results["velocity_lag_s"],
            loaded_breakaway_a=breakaway_a,
        ),
        joint.heaviest_kg,
    )  # fmt: skip


def qualities(joint: DrawnJoint, period_s: float, seed: int, proposal: Proposal, servo: ServoSettings) -> list[Quality]:
    """Move with a servo under each load, and look."""
    limits = proposal.limits.model_copy(update={"tracking_error_rad": 2.0})
    sections = {"motion": proposal.motion, "servo": servo, "limits": limits, "search": proposal.search}
    bench = bench_of(joint, period_s, seed, **{name: one.model_dump() for name, one in sections.items()})
    return [_moved(bench, share * joint.heaviest_kg) for share in LOADS]


def _moved(bench: BenchConfiguration, load_kg: float) -> Quality:
    drive, technician = make_equipment(bench)
    period_s = bench.control.period_s
    drive.open(period_s)
    technician.hang_load(load_kg, False)
    loop = joint_loop(drive, VirtualClock(), Guard(bench.limits), period_s)
    sink, starts = ListSink(), []

    def there_and_back():
        joint, cycles = Moved(bench), 0
        yield from joint.wake()
        for way_rad in WAYS_RAD:
            for target_rad in (way_rad, 0.0):
                starts.append((len(sink_rows), target_rad, way_rad))
                yield from counted(joint.move(target_rad))
                yield from counted(joint.follow([(target_rad, 0.0)] * round(HOLD_S / period_s)))
        return {"cycles": cycles}

    sink_rows: list[float] = []

    def counted(part):
        reply = None
        try:
            action = next(part)
            while True:
                reply = yield action
                sink_rows.append(reply.sample.position_rad)
                action = part.send(reply)
        except StopIteration as end:
            return end.value

    outcome = loop.run(there_and_back(), sink, StopRequest())
    drive.close()
    if outcome.outcome != "completed":
        return Quality(inf, inf, True)
    positions = np.array(sink_rows)
    ends = [start for start, _, _ in starts[1:]] + [len(positions)]
    return _worst(
        [
            _of_move(positions[start:end], target_rad, way_rad, bench)
            for (start, target_rad, way_rad), end in zip(starts, ends, strict=True)
        ]
    )


def _of_move(positions: np.ndarray, target_rad: float, way_rad: float, bench: BenchConfiguration) -> Quality:
    sign = 1.0 if target_rad else -1.0
    error = sign * (positions - target_rad)
    out = np.flatnonzero(np.abs(error) > max(BAND_SHARE * way_rad, bench.servo.dead_band_rad))
    settled = out[-1] + 1 if len(out) else 0
    settled_s = inf if settled == len(error) else settled * bench.control.period_s
    rest = positions[-round(0.5 * HOLD_S / bench.control.period_s) :]
    moving = np.diff(rest)
    turns = np.count_nonzero(np.diff(np.sign(moving[moving != 0.0])))
    return Quality(float(np.max(error)) / way_rad, settled_s, bool(turns > SWINGS and np.ptp(rest) > 5e-4))


def _worst(found: list[Quality]) -> Quality:
    return Quality(
        max(one.overshoot for one in found), sum(one.settled_s for one in found), any(one.swings for one in found)
    )


def best(joint: DrawnJoint, period_s: float, seed: int, proposal: Proposal) -> list[float]:
    """Time of the quickest sound servo for each load [s], of a random search round the proposed gains."""
    random = np.random.default_rng(seed)
    found_s = [inf] * len(LOADS)
    for _ in range(TRIED):
        w, damping, share = (
            np.exp(random.uniform(-0.7, 0.7)),
            np.exp(random.uniform(-0.4, 0.4)),
            np.exp(random.uniform(-1.0, 1.0)),
        )
        servo = proposal.servo.model_copy(
            update={
                "proportional_a_rad": proposal.servo.proportional_a_rad * w**2,
                "derivative_a_s_rad": proposal.servo.derivative_a_s_rad * w * damping,
                "integral_a_rad_s": proposal.servo.integral_a_rad_s * w**3 * share,
            }
        )
        tried = qualities(joint, period_s, seed, proposal, servo)
        found_s = [
            min(one.settled_s, least_s) if one.is_sound else least_s
            for one, least_s in zip(tried, found_s, strict=True)
        ]
    return found_s


def main(count: int, seed: int = 1, first: int = 0) -> int:
    """Propose a servo for so many rigs; returns how many miss the figure."""
    loads = " ".join(f"{f'{share:.0%} load':>24}" for share in LOADS)
    print(f"{'rig':>3} {'period':>6} {'bandwidth':>9} {'margins':>22} {loads}   overshoot, settled (best found)")
    right = 0
    for number in range(first, first + count):
        joint = draw_joint(np.random.default_rng([seed, number]))
        period_s = (0.005, 0.01)[number % 2]
        proposal = proposed(joint, period_s, number)
        mine = qualities(joint, period_s, number, proposal, proposal.servo)
        quickest_s = [
            min(best_s, one.settled_s if one.is_sound else inf)
            for best_s, one in zip(best(joint, period_s, number, proposal), mine, strict=True)
        ]
        good = all(
            one.is_sound and one.settled_s <= ALLOWED_RATIO * best_s
            for one, best_s in zip(mine, quickest_s, strict=True)
        )
        right += good
        margins = ", ".join(f"{one.phase_deg:.0f} deg x{one.gain:.1f}" for one in proposal.design.margins)
        told = " ".join(_cell(one, best_s) for one, best_s in zip(mine, quickest_s, strict=True))
        print(
            f"{number:3} {1e3 * period_s:3.0f} ms {proposal.design.bandwidth_rad_s:5.1f} 1/s {margins:>22} {told}"
            f"{'' if good else '  WRONG'}",
            flush=True,
        )
    print(
        f"{right} of {count}: under every load no limit cycle, overshoot at most 5 %, settled within 1.5 of the best "
        "that was found for this load"
    )
    return count - right


def _cell(one: Quality, best_s: float) -> str:
    swings = " SWINGS" if one.swings else ""
    return f"{f'{100 * one.overshoot:.1f} % {one.settled_s:.2f} s ({best_s:.2f}){swings}':>24}"


if __name__ == "__main__":
    sys.exit(min(main(*(int(word) for word in sys.argv[1:])), 1))
