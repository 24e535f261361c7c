"""Samples are written channel by channel, and read as their description says."""

import numpy as np

from bench.service.http import downloads
from bench.service.http.downloads import column, samples_json
from bench.service.routes.trials import Gap, Samples


def test_the_text_is_that_of_the_description(monkeypatch):
    monkeypatch.setattr(downloads, "AT_ONCE", 7)
    generator = np.random.default_rng(3)
    channels = {"time_s": np.arange(50.0) / 3.0, 'a "name"': generator.normal(size=50)}
    channels['a "name"'][[3, 7, 9]] = np.nan, np.inf, 1e-300
    listed = {name: column(values) for name, values in channels.items()}
    wanted = Samples(trial_id=7, rows_recorded=900, rows_returned=50, gaps=[Gap(from_s=1.0, to_s=2.5)], channels=listed)
    assert samples_json(7, 900, channels, [(1.0, 2.5)]).decode() == wanted.model_dump_json()


def test_nothing_recorded_is_an_answer_too():
    found = Samples.model_validate_json(samples_json(7, 0, {"time_s": np.empty(0)}))
    assert found == Samples(trial_id=7, rows_recorded=0, rows_returned=0, channels={"time_s": []})
