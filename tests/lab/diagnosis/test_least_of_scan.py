"""What fits a shape at the lower end of its scan may be what the measuring chain makes of a sign, and has no name."""

from dataclasses import replace

import numpy as np

from compensator.lab.diagnosis.confirmation import is_confirmed
from compensator.lab.diagnosis.diagnose import diagnose
from compensator.lab.effects.catalogue import default_effects
from compensator.lab.model.fit import fit_model
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from tests.lab.diagnosis.test_diagnose import SHAKEN
from tests.lab.synthetic import FACTS, Joint, Truth, plans, recordings

EARLY_S = 0.009


def early(x: Truth) -> np.ndarray:
    """Friction that turns round before the speed does, less the friction that turns round with it."""
    return 0.12 * (np.sign(np.interp(x.time_s + EARLY_S, x.time_s, x.v)) - np.sign(x.v))


def test_what_is_a_lag_but_for_being_the_least_of_its_scan_is_not_named():
    made = recordings(Joint(extra=early), trials=[*plans(), *SHAKEN], seed=4)
    found = diagnose(fit_model(make_dataset(made, FACTS, Processing()), default_effects(FACTS)))
    first = next(one for one in found.candidates if one.effect.name == "frictional_lag")
    assert is_confirmed(replace(first, impossible=""))
    assert (found.verdict, first.physical) == ("nothing", False)
