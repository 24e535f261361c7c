"""The guess at a challenge that a study amounts to: what it added, and what its last diagnosis names."""

from bench.evaluation.challenge.guess import Guess
from bench.store import Store


def guess_of_study(store: Store, study_id: int) -> Guess:
    """What a study says is hidden.

    Raises:
        NotFoundError: there is no such study.
        StudyError: its last model cannot be judged.
    """
    from bench.study import diagnose, ladder  # the lab is imported when it is first needed

    rungs = ladder(store, study_id)["rungs"]
    last = diagnose(store, study_id)
    added = [(name,) for name in rungs[-1]["effects"] if name not in rungs[0]["effects"]]
    named = [tuple(one["effects"]) for one in last["classes"]]
    return Guess((*added, *named), last["verdict"] == "unknown-effect")
