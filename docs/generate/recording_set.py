"""The tables of the recording set's format: channels, and the keys of a mapping file."""

from bench.recording_set.mapping import Mapping
from compensator.lab.recordings.recording import CHANNELS
from docs.generate.markdown import code, table
from docs.generate.schema import keys


def channels() -> str:
    """The columns that the CSV of a trial may have, as docs/reference/recording-set.md has them; a test compares."""
    return table(
        ("column", "unit", "meaning"), [(code(one.name), code(one.unit), one.meaning) for one in CHANNELS.values()]
    )


def mapping() -> str:
    """The keys of `mapping.toml`, and those of what its tables hold."""
    whole = Mapping.model_json_schema(by_alias=True)
    column = whole["$defs"]["Column"]
    renamed, trial = whole["$defs"]["Renamed"], whole["$defs"]["MappedTrial"]
    condition = whole["$defs"]["ConditionColumn"]
    parts = (("Column", column), ("ConditionColumn", condition), ("Renamed", renamed), ("MappedTrial", trial))
    return keys(whole) + "".join(f"\nA `{name}`:\n\n{keys(one)}" for name, one in parts)
