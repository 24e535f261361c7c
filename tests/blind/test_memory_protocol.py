import numpy as np

from bench.evaluation.blind.items import draw_item, items_of, protocol_of
from bench.evaluation.blind.recorded import bench_for
from bench.evaluation.challenge.session import Protocol


def _protocol() -> Protocol:
    item = items_of(3, 1, ("memory",))[0]
    drawn = draw_item(item, 0)
    return protocol_of(item, drawn.joint.heaviest_kg, drawn.joint.top_rad_s, bench_for(item, drawn))


def test_neither_a_line_nor_a_parabola_in_time_goes_with_rest_or_rate() -> None:
    ramps = [values for kind, values in _protocol() if kind == "breakaway-ramps"]
    tried = np.array([(dwell, rate) for one in ramps for dwell in one["dwells_s"] for rate in one["rates_a_s"]])
    ranks = np.column_stack([np.unique(values, return_inverse=True)[1] for values in tried.T]) - 1.0
    time = np.arange(len(tried)) - 0.5 * (len(tried) - 1)
    assert len(tried) == 36
    assert np.abs(ranks).sum(axis=0).tolist() == [24.0, 24.0]  # three of each, alike often
    assert np.allclose(ranks.T @ np.column_stack([time, time**2]), 0.0)
