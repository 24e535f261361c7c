"""How often a unit is called an outlier that is none, and how often one is found.

    python -m tests.lab.units.false_alarms --sets 40 --units 8

Each set is of fresh seeds: units of one type, whose friction scatters by 6 %, each moved through trials of its own,
filtered and fitted as a study does. In the second half of the sets one unit has more Coulomb friction than its type.
"""

import argparse
from dataclasses import replace

import numpy as np
from scipy.stats import binomtest

from compensator.lab.model.fit import fit_model
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from compensator.lab.units.judgement import Judged, judge
from compensator.lab.units.quantities import quantities_of, unit_fit_of
from tests.lab.line import Line, print_table
from tests.lab.synthetic import FACTS, Bench, Joint, plans, recordings

MODEL = ("inertia", "gravity", "offset", "coulomb", "viscous")
SCATTER, EXCESS = 0.06, 0.5  # as shares of Coulomb friction
TYPE = Joint(static_excess=0.0)
SHORT = Bench(duration_s=8.0)
CUTOFF_HZ = 6.0


def main() -> None:
    """Draw, judge and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sets", type=int, default=40, help="with an outlier, and as many without")
    parser.add_argument("--units", type=int, default=8)
    parser.add_argument("--seed", type=int, default=1000)
    chosen = parser.parse_args()
    alarms = sum(_others_named(judged(chosen.seed + n, chosen.units, 0.0)) > 0 for n in range(chosen.sets))
    odd = [judged(chosen.seed + chosen.sets + n, chosen.units, EXCESS) for n in range(chosen.sets)]
    found, wrong = sum(map(_is_found, odd)), sum(_others_named(one) > 0 for one in odd)
    print_table(
        [
            _line("no outlier among the units: one is named", "<= 5 %", alarms, chosen.sets, at_most=0.05),
            _line("one outlier: another unit or parameter is named", "<= 5 %", wrong, chosen.sets, at_most=0.05),
            _line(f"one outlier of {100 * EXCESS:.0f} % more friction: it is named", "", found, chosen.sets),
        ]
    )


def judged(seed: int, units: int, excess: float) -> list[Judged]:
    """A set of units; the first has more Coulomb friction, by a share of the type's."""
    random = np.random.default_rng(seed)
    fits = []
    for number in range(units):
        coulomb, viscous = (1.0 + SCATTER * random.standard_normal(2)).tolist()
        more = excess if number == 0 else 0.0
        joint = replace(TYPE, coulomb=TYPE.coulomb * (coulomb + more), viscous=TYPE.viscous * viscous)
        trials = plans(loads_kg=(0.0, 0.1, 0.2), seed=int(random.integers(2**31)))
        made = recordings(joint, SHORT, trials, seed=int(random.integers(2**31)))
        fits.append(fit_model(make_dataset(made, FACTS, Processing(CUTOFF_HZ)), MODEL))
    return judge(quantities_of(fits[-1], [unit_fit_of(fit) for fit in fits])[0])


def _is_found(found: list[Judged]) -> bool:
    return any(one.quantity.effect == "coulomb" and one.deviations[0].is_outlier for one in found)


def _others_named(found: list[Judged]) -> int:
    """Outliers but the first unit's friction."""
    named = sum(deviation.is_outlier for one in found for deviation in one.deviations)
    return named - _is_found(found)


def _line(what: str, wanted: str, count: int, sets: int, at_most: float | None = None) -> Line:
    low, high = binomtest(count, sets).proportion_ci(method="wilson")
    told = f"{count} of {sets} ({100 * low:.0f} .. {100 * high:.0f} %)"
    return Line(what, wanted, told, at_most is None or low <= at_most)


if __name__ == "__main__":
    main()
