"""What is judged of a fitted model."""

from compensator.lab.diagnosis.constants import Constants
from compensator.lab.model.fit import Fit
from compensator.lab.screening.candidates import gather


def constants_of(fit: Fit) -> Constants:
    """On the rows where steady effects show."""
    gathered = gather(fit)
    rows = gathered.rows
    static = fit.static_friction[rows]
    return Constants(fit.dataset, rows, gathered.bases[0], gathered.weights, fit.dry_friction, static)
