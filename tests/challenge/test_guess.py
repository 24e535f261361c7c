from types import SimpleNamespace

import pytest

from bench.errors import ParameterError
from bench.evaluation.challenge import guess as guessing
from bench.evaluation.challenge.answer import Truth
from bench.evaluation.challenge.guess import Guess, score
from bench.evaluation.challenge.hidden_plant import MECHANISMS
from bench.evaluation.challenge.names import ABSORBED, ACCEPTED, accepted
from bench.evaluation.challenge.share import faint, remarks_on, share_in_words


def test_every_mechanism_has_its_names_and_the_lab_knows_them() -> None:
    assert set(ACCEPTED) == set(MECHANISMS)
    for mechanism in ("viscous_asymmetry", "drag", "spring", "load_friction", "weight_growth", "latency"):
        assert accepted(mechanism)
    for mechanism in ("hose", "friction_jump", "supply_ripple"):
        assert not accepted(mechanism)


@pytest.mark.parametrize(
    ("truths", "guess", "right", "missed", "wrong", "points"),
    [
        ((), "nothing", (), (), (), 0.0),
        ((), "spring", (), (), ("spring",), -1.0),
        (("spring",), "spring", ("spring",), (), (), 1.0),
        (("spring",), "nothing", (), ("spring",), (), 0.0),
        (("spring",), "none-of-these", (), ("spring",), ("none-of-these",), -1.0),
        (("drag",), "spring,viscous_quadratic", ("drag",), (), ("spring",), 0.0),
        (("spring",), "spring/centre_of_mass_angle", ("spring",), (), (), 0.5),
        (("spring", "drag"), "viscous_quadratic,spring", ("spring", "drag"), (), (), 2.0),
        (("spring", "drag"), "spring", ("spring",), ("drag",), (), 1.0),
        # one class stands for one mechanism, even if it holds the names of both
        (("spring", "centre_of_mass"), "spring/centre_of_mass_angle", ("spring",), ("centre_of_mass",), (), 0.5),
        (("weight_growth",), "weight_friction,weight_stribeck", ("weight_growth",), (), (), 1.0),  # it has both shares
        (("weight_growth",), "weight_stribeck,spring", ("weight_growth",), (), ("spring",), 0.0),
        (("hose",), "none-of-these", ("hose",), (), (), 1.0),
        (("hose",), "spring", (), ("hose",), ("spring",), -1.0),
        (("spring",), "spring,measurement_delay", ("spring",), (), (), 1.0),  # a delay is in every recording
        (("latency",), "measurement_delay", ("latency",), (), (), 1.0),
        ((), "spring/measurement_delay", (), (), ("spring/measurement_delay",), -1.0),
        (("hose", "spring"), "spring,none-of-these", ("hose", "spring"), (), (), 2.0),
    ],
)
def test_score(
    truths: tuple[str, ...], guess: str, right: tuple[str, ...], missed: tuple[str, ...], wrong: tuple[str, ...],
    points: float,
) -> None:  # fmt: skip
    found = score(truths, Guess.parse(guess))
    assert (found.right, found.missed, found.wrong) == (right, missed, wrong)
    assert found.points == points
    assert found.perfect == (not missed and not wrong)


@pytest.mark.parametrize(
    ("conclusion", "unknown"),
    [("unknown-effect", True), ("unexplained", True), ("nothing", False), ("not-confirmed", False)],
)
def test_what_a_study_leaves_unexplained_is_part_of_its_guess(monkeypatch, conclusion: str, unknown: bool) -> None:
    rungs = [SimpleNamespace(effects=["inertia"]), SimpleNamespace(effects=["inertia", "spring"])]
    last = SimpleNamespace(classes=[], slight=False, conclusion=SimpleNamespace(code=conclusion))
    monkeypatch.setattr(guessing, "ladder", lambda *_: SimpleNamespace(rungs=rungs))
    monkeypatch.setattr(guessing, "diagnose", lambda *_: last)
    assert guessing.guess_of_study(None, 1) == Guess((("spring",),), unknown)  # type: ignore[arg-type]


def test_what_no_motion_can_tell_does_not_count() -> None:
    found = score(("coulomb_asymmetry",), Guess.parse("nothing"), ABSORBED)
    assert found.untold == ("coulomb_asymmetry",)
    assert found.perfect


@pytest.mark.parametrize("guess", ["", " , ", "nothing,spring", "sprin", "spring/foo"])
def test_a_guess_that_cannot_be_read_is_refused(guess: str) -> None:
    with pytest.raises(ParameterError, match="guess"):
        Guess.parse(guess)


def test_a_provisional_curve_stands_for_what_the_catalogue_does_not_have(monkeypatch) -> None:
    """It names a variable and no mechanism: a hidden hose is found, and no false name is added."""
    curve = "curve_of_since_reversal_against_motion"
    rungs = [SimpleNamespace(effects=["inertia"]), SimpleNamespace(effects=["inertia", curve])]
    last = SimpleNamespace(classes=[], slight=False, conclusion=SimpleNamespace(code="nothing"))
    monkeypatch.setattr(guessing, "ladder", lambda *_: SimpleNamespace(rungs=rungs))
    monkeypatch.setattr(guessing, "diagnose", lambda *_: last)
    found = guessing.guess_of_study(None, 1)  # type: ignore[arg-type]
    assert found.text == "none-of-these"
    assert score(["hose"], found).perfect
    assert Guess.parse(f"spring,{curve}") == Guess.parse("spring,none-of-these")


@pytest.mark.parametrize("text", ["nothing", "none-of-these", "spring/centre_of_mass_angle,cogging,none-of-these"])
def test_a_guess_is_told_as_it_is_read(text: str) -> None:
    assert Guess.parse(text).text == text


def test_the_words_that_are_no_effects_are_named_first() -> None:
    assert Guess.parse("spring, none_of_these") == Guess.parse("spring,none-of-these")
    with pytest.raises(ParameterError, match=r"^guess: wanted nothing, none-of-these or effects; "):
        Guess.parse("none_of_them")


def _truth(share: float, at_most: float | None) -> Truth:
    return Truth("spring", "a spring", 1.0, "stiffness", "1", share, {}, at_most)


@pytest.mark.parametrize(
    ("truth", "words", "remark", "no_fault"),
    [
        (_truth(6e-4, 0.02), "0.06 %", None, False),
        (_truth(1e-4, 3e-4), "at most 0.03 %", "a spring: these recordings hold next to nothing of it, at most", True),
        (_truth(0.0, 0.0265), "at most 2.6 %", "no more than two runs of one joint do (at most 2.6 %", False),
        (_truth(0.0, None), "not told", "no more than two runs of one joint do, so that its share is not told", False),
    ],
)
def test_a_share_that_is_not_told_from_the_scatter_of_runs_is_no_proof(
    truth: Truth, words: str, remark: str | None, no_fault: bool
) -> None:
    assert share_in_words(truth) == words
    assert faint([truth]) == ["spring"] * no_fault
    said = remarks_on([truth])
    assert len(said) == (remark is not None)
    assert remark is None or remark in said[0]
    assert not any("no model" in one for one in said)


def test_what_recordings_surely_hold_next_to_nothing_of_is_not_missed() -> None:
    found = score(("spring", "drag"), Guess.parse("nothing"), ABSORBED, ["spring"])
    assert (found.faint, found.missed) == (("spring",), ("drag",))
    named = score(("spring",), Guess.parse("spring"), ABSORBED, ["spring"])
    assert (named.right, named.faint) == (("spring",), ())
