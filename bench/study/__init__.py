"""Studies: compare a model with the measurement, diagnose what is missing, add it, watch the error fall.

Every function takes the store first and returns JSON-able dicts; errors are `bench.errors.BenchError`.
"""

from bench.study.changes import add_effect, drop_effect
from bench.study.closed_loop import keep_motion_errors, simulate
from bench.study.compare import compare
from bench.study.create import create_study, describe, list_studies
from bench.study.diagnose import diagnose
from bench.study.effects import effect_example, effects_catalogue
from bench.study.error_map import error_map, moments
from bench.study.extend import extend_study
from bench.study.ladder import ladder
from bench.study.on_bench import bench_configurations, keep_bench_error
from bench.study.refit import refit
from bench.study.report.report import report_html
from bench.study.search import search
from bench.study.suggestion.next_round import next_round
from bench.study.suggestion.suggest import suggest
from bench.study.use import use

__all__ = [
    "add_effect",
    "bench_configurations",
    "compare",
    "create_study",
    "describe",
    "diagnose",
    "drop_effect",
    "effect_example",
    "effects_catalogue",
    "error_map",
    "extend_study",
    "keep_bench_error",
    "keep_motion_errors",
    "ladder",
    "list_studies",
    "moments",
    "next_round",
    "refit",
    "report_html",
    "search",
    "simulate",
    "suggest",
    "use",
]
