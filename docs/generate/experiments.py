"""The kinds of experiment, from their own descriptions."""

from bench.config.quantities import unit_of
from bench.experiments.kind import RESULTS_OF_ALL, ExperimentKind
from bench.experiments.registry import KINDS
from docs.generate.markdown import code, table
from docs.generate.schema import keys

BEGIN = """\
# Kinds of experiment

`friction-bench run KIND --parameter value` starts one, and so do *Start* on the page and `POST /api/v1/experiments`.
Each is refused before any motion where it would leave a limit of the bench.

`friction-bench trial N` prints the results of a trial, and `GET /api/v1/trials/N` answers them. Their names stand
below. The results of an experiment are made of those of its trials: `min_`, `max_`, `mean_` and `spread_` before a
name, or `rows` with one line for each.

"""


def page() -> str:
    """The page: a table of all kinds, then the parameters of each."""
    overview = table(
        ("kind", "what it does"), [(f"[{code(one.name)}](#{_slug(one)})", one.summary) for one in KINDS.values()]
    )
    return BEGIN + overview + "\n" + "\n".join(map(_section, KINDS.values()))


def _slug(kind: ExperimentKind) -> str:
    return f"kind-{kind.name}"


def _section(kind: ExperimentKind) -> str:
    moved = "It moves a master and a slave.\n\n" if kind.pair else ""
    parameters = keys(kind.parameters.model_json_schema())
    head = f"({_slug(kind)})=\n## {kind.title}\n\n`{kind.name}`: {kind.summary}\n\n"
    return f"{head}{moved}{parameters}\nResults of a trial:\n\n{_results(kind)}"


def _results(kind: ExperimentKind) -> str:
    told = {**kind.results, **RESULTS_OF_ALL}
    return table(("result", "unit", "what it is"), [(code(one), code(unit_of(one)), told[one]) for one in told])
