"""The modules of the page that compute, called in the browser itself."""

import json
import math
from collections import Counter
from pathlib import Path

import pytest

from bench.config.channels import CHANNELS
from bench.service.http.page import WEB
from tests.browser.browser import imported

pytestmark = pytest.mark.browser


@pytest.fixture(scope="module")
def opened(shared_pages):
    """One page for all: what is called computes, and changes nothing that another test would see."""
    return shared_pages()


@pytest.fixture
def page(opened, shared_pages):
    yield opened
    assert shared_pages.complaints == []


@pytest.fixture
def call(page):
    def called(module: str, expression: str):
        """What an expression makes of a module, there called `m`."""
        return page.evaluate(f"{imported(module)}.then((m) => {expression})")

    return called


def test_a_ring_keeps_the_newest_rows_and_never_grows(call):
    kept = call(
        "bench/ring",
        "{ const ring = new m.Ring(['t', 'v'], 10);"
        " for (let n = 0; n < 1000; n++) ring.append([[n, n % 7 ? n : null]]);"
        " const bytes = ring.column('v').buffer.byteLength, none = ring.column('w') === undefined;"
        " return [ring.length, [...ring.column('t')], [...ring.column('v')], bytes, none]; }",
    )
    assert kept[0] == 10
    assert kept[1] == list(range(990, 1000))
    assert [math.isnan(value) for value in kept[2]] == [n % 7 == 0 for n in range(990, 1000)]
    assert kept[3] == 2 * 10 * 8
    assert kept[4] is True


def test_rows_of_a_block_are_handed_on_evenly_and_all_of_them(call):
    block = "{rows: Array(100), from: 0, begin_ms: 1000, until_ms: 1060}"
    assert [call("app/pour", f"m.dueOf({block}, {at})") for at in (900, 1000, 1030, 1060, 9000)] == [0, 0, 50, 100, 100]


@pytest.mark.parametrize(("status", "fresh"), [("null", False), ("{state: 'idle'}", True)])
def test_nothing_is_known_of_a_bench_that_has_said_nothing_of_its_state(call, status, fresh):
    live = f"Object.assign(new EventTarget(), {{status: {status}, heard_ms: performance.now(), retry_ms: 0}})"
    assert call("app/state", f"new m.BenchState({live}).now.fresh") is fresh


def test_words_of_the_service_begin_with_a_capital_and_names_stay(call):
    assert call("ui/format", "m.capital('the bench is busy')") == "The bench is busy"
    assert call("ui/format", "m.capital('load_kg is 5 kg')") == "load_kg is 5 kg"


def test_sentences_of_the_lab_have_the_words_and_signs_of_the_page(call):
    said = "it varies with velocity; 1.69% to 0.49% (gain 71%, 90 % interval 69% .. 73%; p <= 0.001)"
    named = "viscous_asymmetry needs session_s; put motor.torque_constant into rig.toml, see out/a_b"
    assert call("ui/format", f"m.spoken('{named}')") == (
        "viscous asymmetry needs session; put motor.torque_constant into rig.toml, see out/a_b"
    )
    assert call("ui/format", f"m.spoken('{said}')") == (
        "it varies with speed; 1.69 % to 0.49 % (gain 71 %, 90 % interval 69 % to 73 %; p ≤ 0.001)"
    )


def test_a_small_effort_is_shown_in_thousandths(call):
    assert call("ui/units", "m.milli(0.002, 'N m')") == {"unit": "mN m", "factor": 1000}
    assert call("ui/units", "m.milli(2, 'A')") == {"unit": "A", "factor": 1}


def test_a_copy_of_a_ring_stays_as_it_was(call):
    assert call(
        "bench/ring",
        "{ const ring = new m.Ring(['t'], 3); ring.append([[1], [2]]); const copy = ring.copy();"
        " ring.append([[3], [4], [5], [6], [7]]); return [...copy.column('t')]; }",
    ) == [1, 2]  # fmt: skip


def test_thinning_keeps_extremes_gaps_and_order(call):
    found = call(
        "plots/thin",
        "{ const n = 100000; const x = Float64Array.from({length: n}, (_, i) => i);"
        " const y = x.map((v) => Math.sin(v / 1000));"
        " y[777] = 50; y[70001] = -50; y[5000] = NaN; const found = m.thinned(x, y, [0, n], 500);"
        " const rising = found.filter((i) => i >= 0).every((v, i, all) => !i || v > all[i - 1]);"
        " return [found.length, found.includes(777), found.includes(70001), found.includes(m.GAP), rising]; }",
    )
    assert found[0] <= 4 * 501
    assert found[1:] == [True, True, True, True]


def test_few_points_are_all_drawn_and_the_line_leaves_the_picture(call):
    assert call("plots/thin", "m.thinned([0, 1, 2, 3, 4], [0, 1, NaN, 3, 4], [1.5, 3.5], 100)") == [1, -1, 3, 4]
    assert call("plots/thin", "m.firstFrom([1, 2, 2, 5], 2)") == 1
    assert call("plots/thin", "m.firstFrom([1, 2, 2, 5], 6)") == 4


def test_a_line_becomes_bars_that_join_and_keep_its_gaps(call):
    box = "{left: 10, right: 20}"
    low, high = call(
        "plots/trace", f"(({{low, high}}) => [[...low], [...high]])(m.columns({{x: [10, 13.5], y: [0, 7]}}, {box}))"
    )
    # a slope of 2: each column reaches from where the line comes in to where it goes out
    assert low[:4] == [0, 2, 4, 6]
    assert high[:4] == [2, 4, 6, 7]
    assert all(low[at] > high[at] for at in range(4, 10))
    interrupted = "{x: [10.5, NaN, 14.5], y: [1, NaN, 1]}"
    gap = call(
        "plots/trace", f"(({{low, high}}) => [...low].map((v, i) => v <= high[i]))(m.columns({interrupted}, {box}))"
    )
    assert gap == [at in (0, 4) for at in range(10)]
    outside = call(
        "plots/trace", f"(({{low, high}}) => [low[0], high[9]])(m.columns({{x: [0, 30], y: [0, 30]}}, {box}))"
    )
    assert outside == [10, 20]


def test_a_spike_of_one_sample_is_drawn_however_many_there_are(call):
    painted = call(
        "plots/trace",
        "{ const canvas = document.createElement('canvas'); canvas.width = 100; canvas.height = 100;"
        " const context = canvas.getContext('2d', {willReadFrequently: true});"
        " const x = Float64Array.from({length: 5000}, (_, i) => i / 50);"
        " const y = x.map((_, i) => 50 + 5 * (i % 2)); y[2510] = 5;"
        " m.drawTrace(context, {x, y}, {colour: '#000'}, {left: 0, right: 100});"
        " const dark = (at, row) => context.getImageData(at, row, 1, 1).data[3] > 200;"
        " return [dark(50, 20), dark(52, 20), dark(10, 52), dark(10, 60)]; }",
    )
    assert painted == [True, False, True, False]


def test_a_band_is_drawn_between_its_edges_and_not_where_it_is_unknown(call):
    painted = call(
        "plots/paint",
        f"{imported('bench/load')}" + ".then((load) => {"
        " const canvas = document.createElement('canvas'); canvas.width = 300; canvas.height = 200;"
        " const context = canvas.getContext('2d', {willReadFrequently: true});"
        " const x = Float64Array.from({length: 20000}, (_, i) => i / 20000);"
        " const half = x.map((at) => (at < 0.5 ? 0.5 : NaN));"
        " const band = load.around(0, x, x.map(() => 0), half, '#ff0000');"
        " const line = {row: 0, name: '', x, y: x.map((at) => 2 * Math.sign(at - 0.5)), colour: '#000'};"
        " const content = {rows: [{title: ''}], lines: [line], bands: [band], xTitle: ''};"
        " const theme = {text: '#000', soft: '#000', line: '#fff', font: '12px sans-serif'};"
        " m.paint(context, {width: 300, height: 200, view: [0, 1], content, theme, pointer: null});"
        " const box = m.frame(0, 1, 300, 200), red = (at, share) => { const [r, g] = context.getImageData("
        " Math.round(m.xOf(at, [0, 1], box)), Math.round(box.bottom - share * (box.bottom - box.top)), 1, 1).data;"
        " return r > 200 && g < 50; };"
        " return [red(0.25, 0.55), red(0.25, 0.45), red(0.25, 0.75), red(0.75, 0.55)]; })",
    )
    assert painted == [True, True, False, False]


@pytest.mark.parametrize("width", [260, 90])
def test_titles_of_axes_are_not_cut(call, width):
    long = "travel since the last reversal [°]"
    written = call(
        "plots/paint",
        "{ const canvas = document.createElement('canvas');"
        " const context = canvas.getContext('2d'), written = [];"
        " context.fillText = (text, x, y, most) => { const { e, f, b } = context.getTransform();"
        " const length = Math.min(context.measureText(text).width, most ?? Infinity);"
        " written.push({text, along: b ? f - x : e + x, length}); };"
        f" const content = {{rows: [{{title: '{long}'}}], lines: [], xTitle: '{long}'}};"
        " const theme = {text: '#000', soft: '#000', line: '#fff', font: '12px sans-serif'};"
        f" m.paint(context, {{width: {width}, height: 120, view: [0, 1], content, theme, pointer: null}});"
        f" return written.filter(({{text}}) => text === '{long}'); }}",
    )
    assert len(written) == 2
    for one, room in zip(written, (120, width), strict=True):  # up the left side, and below
        assert one["along"] - one["length"] / 2 >= 0
        assert one["along"] + one["length"] / 2 <= room


RANKED = {
    "gain": 0.2, "gain_low": 0.1, "gain_high": 0.3, "p_value": 0.5, "why_not": [], "confused_with": [], "d_prime": 7.3,
}  # fmt: skip


@pytest.mark.parametrize(
    ("changed", "said", "unsaid"),
    [
        ({}, "would fall by 20 % (10 % to 30 %). All of the interval is a gain.", "No change"),
        ({"why_not": ["may be luck (p = 0.5)"]}, "Not named: may be luck (p = 0.5).", "chance would do as well"),
        ({"gain": -3.8e-7, "gain_low": -1e-6, "gain_high": 2e-7}, "No change of the held-out error.", "rise"),
        (
            {"gain": 1e-7, "gain_low": -0.01, "gain_high": 0.02},
            "No change of the held-out error (−1 % to 2 %",
            "fall",
        ),
        (
            {"confused_with": ["frictional_lag"]},
            "speaks for frictional lag; its own curve is told from theirs",
            "confuse",
        ),
        (
            {"confused_with": ["frictional_lag"], "d_prime": 4.9},
            "These data confuse it with frictional lag",
            "told from",
        ),
    ],
)
def test_evidence_in_words_does_not_contradict_itself(call, changed, said, unsaid):
    words = call("studies/diagnosis", f"m.evidence({json.dumps({**RANKED, **changed})})")
    assert said in words
    assert unsaid not in words


@pytest.mark.parametrize(("rows", "labelled"), [("near reversals too", True), ("steady sliding", False)])
def test_a_change_says_which_rows_its_errors_are_of_where_the_ladder_counts_others(call, rows, labelled):
    result = {
        "sentence": "", "gain": 0.2, "gain_low": 0.1, "gain_high": 0.3, "rows": rows, "ladder_rows": "steady sliding",
        "before": {"training": 0.05, "held_out": 0.0888}, "after": {"training": 0.04, "held_out": 0.0707},
        "ladder_before": 0.0616, "ladder_after": 0.0466,
    }  # fmt: skip
    text = call(
        "studies/beforeafter",
        f"{{ const place = document.createElement('div'); m.beforeAfter(place, {json.dumps(result)}, {{}});"
        " return place.textContent; }",
    )
    for said in ("after, near reversals too7.07 %", "after, steady sliding4.66 %"):
        assert (said in text) == labelled
    assert ("held-out error after7.07 %" in text) != labelled


def test_the_load_current_is_read_as_it_was_found_last(call):
    read = (
        "((values, half) => m.newest({column: (name) => (name === m.LOAD ? values : half)}))"
        "(Float64Array.from(%s), Float64Array.from(%s))"
    )
    assert (
        call("bench/load", read % ("[NaN, 0.4, -0.4931, NaN, NaN]", "[NaN, 0.1, 0.0034, NaN, NaN]"))
        == "−0.493 ± 0.003 A"
    )
    assert call("bench/load", read % ("[0.5]", "[NaN]")) == "0.500 A"
    assert call("bench/load", read % ("[NaN, NaN]", "[NaN, NaN]")) is None


def test_ticks_are_round_and_inside(call):
    assert call("plots/axis", "m.ticks(-0.31, 1.02, 5)") == [0.0, 0.5, 1.0]
    assert call("plots/axis", "m.ticks(0, 0.007, 5)") == [0, 0.002, 0.004, 0.006]
    assert call("plots/axis", "m.widened(-0.31, 1.02, 5)") == [-0.5, 1.5]
    low, high = call("plots/axis", "m.widened(2, 2, 5)")
    assert low < 2 < high
    assert call("plots/axis", "m.label(-0.5, 0.1)") == "−0.5"
    assert call("plots/axis", "m.label(1500000, 500000)") == "1.5e+6"


def test_a_view_stays_within_what_there_is(call):
    assert call("plots/axis", "m.moved([0, 2], 1, [0, 3])") == [1, 3]
    assert call("plots/axis", "m.moved([1, 3], -2, [0, 3])") == [0, 2]
    assert call("plots/axis", "m.zoomed([0, 4], 0.5, 1, [0, 4])") == [0.5, 2.5]
    assert call("plots/axis", "m.zoomed([1, 3], 10, 2, [0, 4])") == [0, 4]
    assert call("plots/axis", "m.whole([{x: [1, 5]}, {x: [0, 2]}, {x: []}])") == [0, 5]


def test_what_a_kind_shows_is_made_from_its_trials(call):
    broken = {
        "breakaways": [
            {"direction": 1, "current_a": 0.2},
            {"direction": -1, "current_a": -0.1},
            {"direction": 1, "current_a": None},
        ]
    }
    trial = {"conditions": {"rate_a_s": 0.3, "dwell_s": 2}, "results": broken}
    groups = call("trials/figurekinds", f"m.FIGURES['breakaway-ramps']([{json.dumps(trial)}]).groups")
    assert [(one["name"], one["x"], one["y"]) for one in groups] == [
        ("after 2 s at rest, up", [0.3], [0.2]),
        ("after 2 s at rest, down", [0.3], [0.1]),
    ]
    swept = [
        {"conditions": {"load_kg": 0.1}, "results": {"motor_speed_rad_s": 9, "current_a": 0.2, "saturated": steady}}
        for steady in (True, False)
    ]
    assert call("trials/figurekinds", f"m.FIGURES['speed-sweep']({json.dumps(swept)}).groups[0].symbol") == [
        "circle",
        "circle-open",
    ]
    told = [
        {"conditions": {"reflect": "raw", "repeat": 1}, "results": {"reflected_error_rms_g": 50}},
        {"conditions": {}, "results": {}},
    ]
    assert call("trials/figurekinds", f"m.FIGURES.teleoperation({json.dumps(told)}).groups.map((one) => one.y)") == [
        [50]
    ]
    for kind in call("trials/figurekinds", "Object.keys(m.FIGURES)"):
        assert call("trials/figurekinds", f"m.FIGURES['{kind}']([]).groups.every((one) => !one.x.length)"), kind


def test_trials_are_chosen_by_what_they_differ_in(call):
    trials = [{"name": f"t{n}", "kind": "steps", "conditions": {"load_kg": n / 10, "arm_m": 0.5}} for n in range(3)]
    choice = f"const choice = new m.TrialChoice(m.used); choice.show({json.dumps(trials)});"
    assert call("studies/trialchoice", f"m.groupsOf({json.dumps(trials)})") == [
        ["load_kg", [0, 0.1, 0.2]],
        ["trial", ["t0", "t1", "t2"]],
    ]
    assert call("studies/trialchoice", f"{{ {choice} return choice.unlessAll(); }}") == []
    left_out = "choice.element.querySelector('[value=\\'load_kg=0.1\\']').checked = false;"
    assert call("studies/trialchoice", f"{{ {choice} {left_out} return choice.unlessAll(); }}") == ["load_kg=0,0.2"]


def test_events_become_marks(call):
    events = [
        {"time_s": 1.0, "name": "search", "detail": "stand before a ramp"},
        {"time_s": 1.1, "name": "search", "detail": "ramp"},
        {"time_s": 1.5, "name": "search", "detail": "stand before a ramp"},
        {"time_s": 1.6, "name": "search", "detail": "ramp"},
        {"time_s": 1.9, "name": "search", "detail": "settle after the search"},
        {"time_s": 2.1, "name": "search", "detail": "done"},
        {"time_s": 3.0, "name": "end", "detail": "tripped; velocity is 9 rad/s"},
    ]
    found = call("plots/marks", f"m.marksOf({events}).map((mark) => [mark.x, mark.kind])")
    assert found == [[1.5, "breakaway"], [1.9, "breakaway"], [1.9, "settle"], [2.1, "estimate"], [3.0, "trip"]]
    assert call("plots/marks", "m.marksOf([{time_s: 1, name: 'end', detail: 'completed'}])") == []


def test_every_equation_of_the_catalogue_is_set(page, service):
    equations = [one["equation"] for one in service.client.get("/effects").json()["items"]]
    shown = (
        f"(all) => {imported('learn/equation')}.then((m) => all.filter((one) => m.equation(one).tagName === 'CODE'))"
    )
    assert page.evaluate(shown, equations) == []


def test_every_module_is_imported_from_where_it_is(page):
    names = [str(path.relative_to(WEB / "modules").with_suffix("")) for path in (WEB / "modules").rglob("*.js")]
    assert max(Counter(Path(name).parent for name in names).values()) <= 20
    for name in names:
        assert page.evaluate(f"{imported(name)}.then(() => true)"), name


@pytest.mark.parametrize(
    ("name", "schema", "example"),
    [
        ("load_kg", "{type: 'number', minimum: 0, maximum: 0.1}", "0, 50, 100"),
        ("load_kg", "{type: 'number', minimum: 0, maximum: 0.05}", "0, 50"),
        ("angle_rad", "{type: 'number', default: Math.PI / 2}", "45, 90, 135"),
        ("repeats", "{type: 'integer', default: 3}", "3, 4, 5"),
        ("balanced", "{type: 'boolean'}", "false, true"),
    ],
)
def test_a_campaign_gives_an_example_in_the_unit_of_the_field(call, name, schema, example):
    assert call("queue/grid", f"m.exampleOf('{name}', {schema})") == example


def test_where_nothing_was_recorded_a_line_is_interrupted(call):
    gaps = "[{from_s: 2, to_s: 7}, {from_s: 8, to_s: 9}]"
    answer = f"{{channels: {{time_s: [0, 1, 2, 7, 8], duty: [1, 2, 3, 4, 5]}}, gaps: {gaps}}}"
    assert call("trials/stretches", f"m.interrupted({answer})") == {
        "time_s": [0, 1, 2, 4.5, 7, 8],
        "duty": [1, 2, 3, None, 4, 5],
    }


def test_what_is_read_has_a_minus_and_what_is_typed_a_hyphen(call):
    assert call("ui/format", "[m.number(-0.5), m.number(-1e-7), m.number('triangle-2'), m.percent(-0.05)]") == [
        "−0.5",
        "−1e−7",
        "triangle-2",
        "−5.00 %",
    ]
    assert call("ui/format", "[m.plain(-0.5), m.plain(null)]") == ["-0.5", "–"]


def test_the_page_has_every_channel_by_the_name_and_unit_of_the_table(call):
    units = call("ui/format", f"{json.dumps(list(CHANNELS))}.map(m.unitOf)")
    assert units == ["" if one.unit == "1" else one.unit for one in CHANNELS.values()]
    assert call("ui/format", f"{json.dumps(list(CHANNELS))}.map(m.nameOf)") == [one.label for one in CHANNELS.values()]


def test_a_channel_has_one_name_on_the_whole_page(call):
    assert call("ui/format", "m.withUnit('current_estimate_a')") == "current from duty [A]"
    assert call("ui/format", "m.withUnit('current_load_a')") == "load current [A]"
    assert call("ui/format", "[m.withUnit('acceleration_rad_s2'), m.withUnit('enabled')]") == [
        "acceleration [°/s²]",
        "power",
    ]
    listed = {"loads_kg": [0, 0.1], "waveforms": ["sweep"], "repeats": 2}
    assert call("ui/format", f"m.conditions({listed})") == "loads 0 g, 100 g, waveforms sweep, repeats 2"


@pytest.mark.parametrize(
    ("value", "low", "high", "text"),
    [
        (0.019969, 0.019937, 0.020001, "0.01997 (0.01994 to 0.02000)"),
        (-9.13e-5, -3.11e-4, 1.28e-4, "−0.00009 (−0.00031 to 0.00013)"),
        (152.3, 140.0, 171.0, "152 (140 to 171)"),
        (2.0, "null", "null", "2"),
        (1.234567e-9, 1.2e-9, 1.3e-9, "1.23e−9 (1.2e−9 to 1.3e−9)"),
    ],
)
def test_a_parameter_is_written_to_the_place_that_its_interval_leaves(call, value, low, high, text):
    assert call("studies/parameters", f"m.written({{value: {value}, low: {low}, high: {high}}})") == text
