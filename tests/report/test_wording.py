"""Reports in words: signs, intervals and units, and tables that are read on a phone."""

import pytest

from bench.report import Section, Table, html_page
from bench.report.wording import spoken
from bench.study.report.model_sections import gain_cell
from bench.study.report.wording import condition_text, in_words


@pytest.mark.parametrize(
    ("written", "read"),
    [
        ("1.69% to 0.49% (gain 71%, 90 % interval 69% .. 73%; p <= 0.001)",
         "1.69 % to 0.49 % (gain 71 %, 90 % interval 69 % to 73 %; p ≤ 0.001)"),
        ("-1.2% .. -0.3%", "-1.2 % to -0.3 %"),
        ("velocity [rad/s2]", "speed [rad/s²]"),
        ("trial velocity_sweep-2", "trial velocity_sweep-2"),
    ],
)  # fmt: skip
def test_signs_are_those_of_print(written, read):
    assert spoken(written) == read


def test_a_gain_of_nothing_is_none_and_nothing_has_no_sign():
    assert gain_cell(-1e-5, -3e-4, 2e-5) == "none"
    assert gain_cell(0.12, -1e-4, 0.2) == "12.0% (0.0% .. 20.0%)"


def test_names_that_are_made_for_programs_become_words_and_those_of_people_stay():
    table = Table("Trials", ["name"], [["run_2_b"], ["coulomb_asymmetry hides in run_2_b"], [3.0]])
    section = Section(
        "x",
        ['warm_up needs session_s; put motor.torque_constant_n_m_a into rig.toml, or effort = "current_estimate"'],
        [table],
    )
    (found,) = in_words([section], ["run_2_b"])
    assert found.sentences == [
        'warm up needs session; put motor.torque_constant_n_m_a into rig.toml, or effort = "current_estimate"'
    ]
    assert found.tables[0].rows == [["run_2_b"], ["coulomb asymmetry hides in run_2_b"], [3.0]]


def test_conditions_have_their_units():
    assert condition_text("load_kg", 0.2) == "load 200 g"
    assert condition_text("arm_m", 0.3) == "arm 0.3 m"
    assert condition_text("balanced", value=False) == "not balanced"
    assert condition_text("repeat", 2) == "repeat 2"


def test_a_cell_says_its_column_and_a_column_of_nothing_is_left_out():
    table = Table("T", ["name", "gain#", "empty"], [["a", 1.0, ""], ["b", 2.0, None]])
    page = html_page("R", [Section("One", tables=[table])])
    assert '<td class="number" data-title="gain">1</td>' in page
    assert 'data-title="empty"' not in page
