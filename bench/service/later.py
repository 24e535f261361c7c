"""Functions of the model lab by name: the service hands them to the processes of the lab, and never imports the lab.

Fits take scipy and half a second to import; whoever opens the first page waits for none of it. Each is imported by the
process that calls it first.
"""

from dataclasses import dataclass
from pkgutil import resolve_name
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from bench.study.changes import add_effect as add_effect
    from bench.study.changes import drop_effect as drop_effect
    from bench.study.closed_loop import simulate as simulate
    from bench.study.compare import compare as compare
    from bench.study.create import create_study as create_study
    from bench.study.create import describe as describe
    from bench.study.diagnose import diagnose as diagnose
    from bench.study.effects import effect_example as effect_example
    from bench.study.effects import effects_catalogue as effects_catalogue
    from bench.study.extend import extend_study as extend_study
    from bench.study.ladder import ladder as ladder
    from bench.study.plots.error_map import error_map as error_map
    from bench.study.plots.moments import action as action
    from bench.study.plots.moments import moments as moments
    from bench.study.plots.series import drivers_over_time as drivers_over_time
    from bench.study.report.report import report_html as report_html
    from bench.study.search import search as search
    from bench.study.suggestion.next_round import next_round as next_round
    from bench.study.suggestion.suggest import suggest as suggest
    from bench.study.units import compare_units as compare_units
    from bench.study.use import use as use

MODULES = {
    "add_effect": "changes",
    "drop_effect": "changes",
    "simulate": "closed_loop",
    "compare": "compare",
    "create_study": "create",
    "describe": "create",
    "diagnose": "diagnose",
    "effect_example": "effects",
    "effects_catalogue": "effects",
    "extend_study": "extend",
    "ladder": "ladder",
    "error_map": "plots.error_map",
    "action": "plots.moments",
    "moments": "plots.moments",
    "drivers_over_time": "plots.series",
    "report_html": "report.report",
    "search": "search",
    "next_round": "suggestion.next_round",
    "suggest": "suggestion.suggest",
    "compare_units": "units",
    "use": "use",
}


@dataclass(frozen=True, slots=True)
class Later:
    """A function of `bench.study`; another process finds it by its name, too."""

    name: str

    @property
    def __name__(self) -> str:
        return self.name

    def __call__(self, *args: Any, **kwargs: Any) -> Any:
        """What it returns; the first call imports it."""
        return resolve_name(f"bench.study.{MODULES[self.name]}:{self.name}")(*args, **kwargs)


def __getattr__(name: str) -> Later:
    if name not in MODULES:
        raise AttributeError(name)
    return Later(name)
