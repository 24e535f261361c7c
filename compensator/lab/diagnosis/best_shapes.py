"""Which shape of every effect stands for it, and which effect comes first."""

from compensator.lab.diagnosis.physical import is_possible
from compensator.lab.effects.catalogue import catalogue
from compensator.lab.screening.candidates import Candidates
from compensator.lab.screening.evidence import Evidence, Screening

TIE = 2.0  # of scores: barely worth a mention (Kass, Raftery 1995)
ALIKE = 0.95  # correlation of what two effects explain


def best_shapes(gathered: Candidates, screening: Screening) -> list[Evidence]:
    """The best shape of every effect, best effect first; of those that tie, the one that the catalogue has first."""
    of_each: dict[str, list[Evidence]] = {}
    for evidence in screening.evidence:
        of_each.setdefault(evidence.block.name, []).append(evidence)
    found = [_best_shape(gathered, shapes) for shapes in of_each.values()]
    ranked = sorted(found, key=lambda item: -item.score)
    order = list(catalogue())
    tied = [item for item in ranked if _ties(item, ranked[0])]
    plainest = min(tied, key=lambda item: order.index(item.block.name), default=None)
    return ranked if plainest is None else [plainest, *(item for item in ranked if item is not plainest)]


def _best_shape(gathered: Candidates, shapes: list[Evidence]) -> Evidence:
    """The best one; near reversals, of those whose size can be: what swings too little, or too much, makes up by it."""
    if gathered.show_in != "moving":
        return shapes[0]
    return next((item for item in shapes if item.score > 0.0 and is_possible(gathered, item)), shapes[0])


def _ties(item: Evidence, best: Evidence) -> bool:
    """Whether two effects explain the same, and about as well: then the rows cannot choose between them."""
    alike = abs(float(item.direction @ best.direction)) >= ALIKE
    return alike and item.score >= best.score - TIE
