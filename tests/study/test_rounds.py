"""Trials in rounds: what does not complete is replaced, and each round knows what the ones before it told."""

from dataclasses import dataclass, field

import pytest

from bench.study.suggestion.earlier_trials import in_words, what_came
from bench.study.suggestion.rounds import MOST_FAILED, Ended, Tried, in_rounds
from bench.study.suggestion.suggested import Came, PairOfRivals, Suggested


@dataclass(frozen=True)
class Named:
    name: str


@dataclass
class Bench:
    """Knows what trips, and writes down what happens."""

    trips: tuple[str, ...] = ()
    ends_at: str = ""
    sure_after: int = 100
    seen: list[str] = field(default_factory=list)

    def ask(self, most, kept_out):
        self.seen.append(f"ask {most}")
        done = sum(one.startswith("ran") for one in self.seen)
        return [] if done >= self.sure_after else [Named(n) for n in "abcdefgh" if n not in kept_out][:most]

    def run(self, trial):
        if trial.name == self.ends_at:
            raise Ended("stopped: by hand")
        self.seen.append(f"tripped {trial.name}" if trial.name in self.trips else f"ran {trial.name}")
        return "speed" if trial.name in self.trips else ""

    def learn(self):
        self.seen.append("learn")

    def go(self, most, at_once=2):
        return in_rounds(self.ask, self.run, self.learn, most, at_once)


def test_every_round_is_asked_for_with_what_was_learnt_before():
    bench = Bench()
    assert bench.go(5) == [Tried(name) for name in "ababa"]  # the same again tells more
    assert bench.seen == [
        "ask 2", "ran a", "ran b", "learn", "ask 2", "ran a", "ran b", "learn", "ask 1", "ran a", "learn",
    ]  # fmt: skip


def test_what_trips_is_kept_out_and_replaced():
    bench = Bench(trips=("a", "c"))
    tried = bench.go(3)
    assert tried == [Tried("a", "speed"), Tried("b"), Tried("b"), Tried("c", "speed"), Tried("b")]
    assert bench.seen.count("learn") == 3


def test_nothing_is_learnt_from_a_round_in_which_all_trips():
    bench = Bench(trips=("a", "b"))
    assert bench.go(1)[-1] == Tried("c")
    assert bench.seen == ["ask 1", "tripped a", "ask 1", "tripped b", "ask 1", "ran c", "learn"]


def test_after_some_that_trip_somebody_should_look():
    bench = Bench(trips=tuple("abcdefgh"))
    tried = bench.go(6)
    assert len(tried) == MOST_FAILED
    assert "learn" not in bench.seen


def test_what_was_recorded_before_the_end_is_learnt():
    bench = Bench(ends_at="b")
    assert bench.go(6) == [Tried("a"), Tried("b", "stopped: by hand")]
    assert bench.seen == ["ask 2", "ran a", "learn"]


@pytest.mark.parametrize("enough", [0, 2])
def test_it_ends_where_nothing_more_is_to_be_told(enough):
    bench = Bench(sure_after=enough)
    assert len(bench.go(6)) == enough


def suggested(*pairs, hopeless=()):
    found, hopeless = (
        [PairOfRivals(true=true, rival=None, before=before, after=after, promised=0.0) for true, before, after in some]
        for some in (pairs, hopeless)
    )
    return Suggested.model_construct(pairs=found, hopeless=hopeless)


def test_what_was_predicted_is_held_against_what_came():
    first = suggested(("spring", 1.0, 8.0), ("spring", 2.0, 6.0), ("cogging", 0.5, 5.0))
    came = what_came(first, suggested(("spring", 5.5, 9.0), ("spring", 7.0, 9.0), ("warm_up", 1.0, 4.0)))
    assert came == [
        Came(effect="spring", before=1.0, predicted=6.0, came=5.5),
        Came(effect="cogging", before=0.5, predicted=5.0, came=None),
    ]
    told = in_words(came)
    assert "6.0 was predicted, 5.5 came" in told
    assert told.endswith("5.0 was predicted, it is no rival any more.")


@pytest.mark.parametrize(
    ("before", "came", "what", "closer"),
    [
        (1.0, 5.7, "5.7 was predicted, 5.7 came.", False),
        (1.0, 5.4, "5.7 was predicted, 5.4 came.", False),
        (1.0, 2.4, "5.7 was predicted, 2.4 came. The rivals are closer than the model said.", True),
        (5.6, 5.5, "5.7 was predicted, 5.5 came, less than the 5.6 before. The rivals are closer", True),
        (1.0, None, "5.7 was predicted, it is no rival any more.", False),
    ],
)
def test_a_d_prime_that_falls_short_says_so_and_what_to_do(before, came, what, closer):
    told = in_words([Came(effect="spring", before=before, predicted=5.7, came=came)])
    assert what in told
    assert ("take the rivals as one class" in told) == closer


def test_a_rival_that_no_further_trial_tells_is_a_rival_all_the_same():
    (one,) = what_came(suggested(("spring", 1.0, 6.0)), suggested(hopeless=[("spring", 1.5, 1.8)]))
    assert one.came == 1.5
