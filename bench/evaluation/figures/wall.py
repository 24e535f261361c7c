"""What a master is given while its slave hits a wall and lets go of it; up to which force scale the pair is calm."""

from functools import partial
from math import inf, nan

from bench.config.configuration import BenchConfiguration
from bench.evaluation.figures.rows import Asked, Numbers, mean, median, most, summary
from bench.evaluation.figures.trials import SeedResults

MS = 1e3
TRIED = 0.01  # least force scale that a ratio is taken to


_of = partial(summary, "wall")
_compensated, _raw = (summary("margin", f"{way}_stability_margin") for way in ("compensated", "raw"))


def _margins(seed: SeedResults, configuration: BenchConfiguration) -> Numbers:
    ours, raw = _compensated(seed, configuration), _raw(seed, configuration)
    return [one / max(other, TRIED) for one, other in zip(ours, raw, strict=False)]


ASKED_AT_A_WALL = (
    Asked(
        "wall, reflected: largest error that no delay up to 30 ms explains", "g", 0.0, 60.0, "-",
        _of("compensated_late_error_max_g"), mean,
        "a hit is over within a control cycle; the largest error at any moment, and what bounds it, stand below",
    ),
    Asked("wall, reflected: delay", "ms", 0.0, 30.0, "-", _of("compensated_latency_s", MS), mean),
    Asked(
        "wall: torque that drives the hand on", "N m", -inf, 0.03, "-", _of("compensated_drag_n_m", -1.0), mean,
        "mean over the hand's way, beyond what the load does; the master's own friction takes 0.07 N m and more",
    ),
    Asked(
        "force scale up to which the pair is calm, compensated / raw", "", 1.5, inf, "-", _margins, median,
        "of changes of a weight of 100 g, after a nudge; the master may make any torque at once. Tried up to 20: what "
        "is calm there counts as 20",
    ),
    Asked(
        "wall, reflected: largest error at any moment", "g", 0.0, 60.0, "-",
        _of("compensated_reflected_error_max_g"), most,
        "nobody reaches it who learns of a hit a control cycle after it: see its bound, the next row",
    ),
    Asked(
        "bound of it: the truth itself, a cycle late", "g", 0.0, nan, "-", _of("compensated_least_error_max_g"), most,
        "and changed no faster than the master may change it",
    ),
)  # fmt: skip
BESIDE_A_WALL = (
    Asked("the same of the raw current: it drags", "N m", 0.0, nan, "-", _of("raw_drag_n_m", -1.0), mean),
    Asked(
        "wall, raw current: largest error that no delay up to 30 ms explains", "g", 0.0, nan, "-",
        _of("raw_late_error_max_g"), mean,
    ),
    Asked("wall, reflected: time to half of a hit", "ms", 0.0, nan, "-", _of("compensated_rise_s", MS), mean),
    Asked("the force scale itself, compensated", "", TRIED, nan, "-", _compensated, median),
    Asked("the force scale itself, raw current", "", TRIED, nan, "-", _raw, median),
    Asked(
        "the largest error of the raw current at a wall", "g", 0.0, nan, "-", _of("raw_reflected_error_max_g"), most,
        "in a trial of its own: what drags slows the hand, and the hit is softer",
    ),
)  # fmt: skip
"""Shown beside, for what bounds the others, or to tell the raw current apart."""
