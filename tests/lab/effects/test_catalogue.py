"""The catalogue, and an effect that another package offers."""

import re
import sys
from dataclasses import replace

import pytest

from compensator.lab.diagnosis.diagnose import diagnose
from compensator.lab.effects import catalogue as module
from compensator.lab.effects.catalogue import candidates, catalogue, default_effects, effect_named, withheld
from compensator.lab.errors import NotApplicableError, UnknownEffectError
from compensator.lab.model.fit import fit_model
from compensator.lab.recordings.facts import Facts
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from tests.lab.synthetic import FACTS, Joint, at_temperature, plans, recordings

HOSE = """
import numpy as np
from compensator.lab.effects.effect import Effect, Parameter

EFFECT = Effect(
    name="hose",
    title="Hose",
    physics="A hose that stiffens as it bends.",
    equation="c q^3",
    columns=lambda motion, shape: (motion.position**3)[None],
    parameters=(Parameter("stiffening", "{effort}/{position}3"),),
    driver="position",
    excited_by="slow motion over the whole range",
    source="a test",
)
IMPOSTOR = Effect(**{**{n: getattr(EFFECT, n) for n in EFFECT.__dataclass_fields__}, "name": "viscous", "title": "No"})
"""


@pytest.fixture
def offering(tmp_path, monkeypatch):
    """Put a package of some text on the path, with some entry points."""

    def offer(text, *points):
        (tmp_path / "hose_package.py").write_text(text)
        info = tmp_path / "hose_package-1.0.dist-info"
        info.mkdir()
        (info / "METADATA").write_text("Metadata-Version: 2.1\nName: hose-package\nVersion: 1.0\n")
        (info / "entry_points.txt").write_text("\n".join(["[friction_bench.effects]", *points]))
        monkeypatch.syspath_prepend(tmp_path)
        forget()

    yield offer
    forget()


def forget():
    module.catalogue.cache_clear()
    module.offered_beside.cache_clear()
    sys.modules.pop("hose_package", None)


@pytest.fixture
def hose(offering):
    """A package on the path with two effects, one of them under a name of ours."""
    offering(HOSE, "hose = hose_package:EFFECT", "viscous = hose_package:IMPOSTOR")


def test_an_effect_of_another_package_is_known_fitted_and_found(hose):
    assert effect_named("hose").title == "Hose"
    assert effect_named("viscous").title == "Viscous friction"  # ours are not replaced
    assert [one.reason for one in module.left_out()] == ["there is an effect 'viscous' already; give it another name"]
    made = recordings(Joint(extra=lambda x: 0.04 * x.q**3), seed=2)
    dataset = make_dataset(made, FACTS, Processing())
    found = diagnose(fit_model(dataset, default_effects(FACTS)))
    assert found.candidates[0].effect.name == "hose"
    fit = fit_model(dataset, [*default_effects(FACTS), "hose"])
    assert fit.coefficients[-1] == pytest.approx(0.04, rel=0.15)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("raise RuntimeError('boom \\x1b[31m')", "RuntimeError: boom  [31m"),
        ("import sys; sys.exit(3)", "it ends the program (3)"),
        ("EFFECT = None", "it is of type NoneType; wanted is an Effect"),
        ("", "AttributeError: module 'hose_package' has no attribute 'EFFECT'"),
        (HOSE.replace('"Hose"', "None"), "its title is None; wanted is a text"),
        (HOSE.replace('"hose"', '"viscous"'), "there is an effect 'viscous' already; give it another name"),
        (HOSE.replace("{position}3", "{place}3"), "KeyError: 'place'"),
        (
            HOSE.replace('source="a test"', 'source="a test", rows="breakaway"'),
            "its rows are 'breakaway'; wanted is sliding or moving, and `breakaway` for starts from rest",
        ),
    ],
)
def test_a_broken_effect_is_left_out_by_itself(offering, caplog, text, reason):
    ours = {name: effect.title for name, effect in catalogue().items()}
    offering(text, "hose = hose_package:EFFECT")
    assert {name: effect.title for name, effect in catalogue().items()} == ours
    (found,) = module.left_out()
    assert (found.package, found.entry_point) == ("hose-package 1.0", "hose = hose_package:EFFECT")
    assert found.reason == reason
    assert f"effect hose = hose_package:EFFECT of hose-package 1.0 is left out: {reason}" in caplog.text


@pytest.mark.parametrize(
    ("columns", "reason"),
    [
        ("1 / 0", "hose, of package hose-package 1.0, failed: ZeroDivisionError: division by zero"),
        ("exec('import sys; sys.exit(3)')", r"hose, of package hose-package 1.0, failed: it ends the program \(3\)"),
        (
            "motion.position",
            r"hose, of package hose-package 1.0, makes columns of shape \(\d+,\); wanted is \(1, \d+\)",
        ),
        ("np.nan * motion.position[None]", "hose, of package hose-package 1.0, makes columns that are not all numbers"),
    ],
)
def test_an_effect_whose_columns_fail_is_left_out_of_a_diagnosis_and_told(offering, columns, reason):
    offering(HOSE.replace("(motion.position**3)[None]", columns), "hose = hose_package:EFFECT")
    dataset = make_dataset(recordings(Joint(), seed=2), FACTS, Processing())
    found = diagnose(fit_model(dataset, default_effects(FACTS)))
    assert re.match(reason, found.left_out["hose"])
    assert found.verdict == "nothing"
    with pytest.raises(NotApplicableError, match=reason):
        fit_model(dataset, [*default_effects(FACTS), "hose"])


def test_without_that_package_it_is_unknown():
    with pytest.raises(UnknownEffectError, match="'hose' is not in the catalogue"):
        effect_named("hose")


def test_an_unknown_name_brings_near_ones():
    with pytest.raises(UnknownEffectError) as caught:
        effect_named("viscus")
    assert str(caught.value).startswith("effect 'viscus' is not in the catalogue; known are for instance: viscous")


def test_gravity_does_no_work_on_a_horizontal_or_linear_joint():
    assert default_effects(Facts()) == ("inertia", "gravity", "offset", "coulomb", "viscous", "stribeck")
    for facts in (Facts(horizontal=True), Facts(joint="linear")):
        assert "gravity" not in default_effects(facts)
        names = {effect.name for effect in candidates(default_effects(facts), facts)}
        assert not {"gravity", "centre_of_mass_angle"} & names
        assert "spring" in names


def test_candidates_are_what_the_model_does_not_have():
    names = [effect.name for effect in candidates(default_effects(Facts()), Facts())]
    not_yet = ["cogging_orders", "measured_load", "weight_stribeck"]
    assert sorted([*names, *default_effects(Facts()), *not_yet]) == sorted(catalogue())


def test_further_orders_are_looked_for_once_there_is_a_first():
    names = [effect.name for effect in candidates([*default_effects(Facts()), "cogging"], Facts())]
    assert "cogging_orders" in names
    assert "cogging" not in names


@pytest.mark.parametrize(
    ("effect", "temperature_c", "words"),
    [
        ("viscous_temperature", None, "needs channel temperature_c in every trial; record it"),
        ("coulomb_temperature", 30.0, "needs temperature_c to differ over the data, and it does not; record the same"),
        ("weight_friction", 30.0, "needs load_kg to differ over the data, and it does not; record several loads"),
    ],
)
def test_an_effect_that_the_trials_cannot_show_says_why(effect, temperature_c, words):
    trials = at_temperature(plans(loads_kg=(0.1,)), temperature_c)
    dataset = make_dataset(recordings(trials=trials), FACTS, Processing(5.6))
    with pytest.raises(NotApplicableError, match=words):
        dataset.check_applicable(effect_named(effect))
    with pytest.raises(NotApplicableError, match=words):
        fit_model(dataset, ["viscous", effect])


@pytest.mark.parametrize("effect", ["gravity", "centre_of_mass_angle"])
def test_what_goes_by_an_angle_is_refused_to_a_linear_joint(effect):
    facts = Facts(joint="linear")
    (one,) = recordings(trials=plans(loads_kg=(0.1,))[:1])
    channels = {"position_m": one.channels["position_rad"], "force_n": one.channels["torque_n_m"]}
    dataset = make_dataset([replace(one, channels=one.channels | channels)], facts, Processing(5.6))
    with pytest.raises(NotApplicableError, match=f"{effect} goes by the angle of an arm, and this joint is linear"):
        fit_model(dataset, [*default_effects(facts), effect])


def test_a_load_that_nobody_told_is_not_said_to_be_the_same():
    untold = [
        replace(one, conditions={key: value for key, value in one.conditions.items() if key != "load_kg"})
        for one in recordings(trials=plans(loads_kg=(0.1,)))
    ]
    dataset = make_dataset(untold, FACTS, Processing(5.6))
    with pytest.raises(NotApplicableError, match="needs load_kg to differ over the data, and no trial tells it"):
        dataset.check_applicable(effect_named("weight_friction"))
    with pytest.raises(NotApplicableError, match="needs session_s to differ over the data, and no trial tells it"):
        dataset.check_applicable(effect_named("warm_up"))


def test_what_is_withheld_is_no_candidate_and_comes_back():
    def names() -> set[str]:
        return {effect.name for effect in candidates((), FACTS)}

    everything = names()
    with withheld(["spring"]):
        with withheld(["cogging"]):
            assert names() == everything - {"spring", "cogging"}
        assert names() == everything - {"spring"}
        assert effect_named("spring").name == "spring"  # who knows it may still fit it
    assert names() == everything
