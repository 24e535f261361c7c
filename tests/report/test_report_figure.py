"""Figures as Plotly's JSON."""

import json
from math import nan

import pytest

from bench.report.section import Figure, Points


def test_a_bar_whose_end_is_not_known_is_left_out():
    points = Points("residual", [0.0, 1.0], [2.0, 3.0], [1.5, nan], [3.0, nan])
    drawn = Figure("residual", "load [kg]", "residual [A]", [points]).to_plotly()
    bars = json.loads(json.dumps(drawn, allow_nan=False))["data"][0]["error_y"]
    assert bars["array"] == pytest.approx([1.0, None])
    assert bars["arrayminus"] == pytest.approx([0.5, None])
