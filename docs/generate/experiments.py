"""The kinds of experiment, from their own descriptions."""

from bench.experiments.kind import ExperimentKind
from bench.experiments.registry import KINDS
from docs.generate.markdown import code, table
from docs.generate.schema import keys

BEGIN = """\
# Kinds of experiment

`friction-bench run KIND --parameter value` starts one, and so do *Start* on the page and `POST /api/v1/experiments`.
Each is refused before any motion where it would leave a limit of the bench.

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
    return f"({_slug(kind)})=\n## {kind.title}\n\n`{kind.name}`: {kind.summary}\n\n{moved}{parameters}"
