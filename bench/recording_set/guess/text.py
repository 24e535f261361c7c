"""A mapping as the text of its file."""

import tomli_w

from bench.config.rig import Rig
from bench.recording_set.mapping import Mapping


def mapping_text(mapping: Mapping, notes: tuple[str, ...] = ()) -> str:
    """The text of a mapping.toml: what differs from the defaults, with remarks at its head."""
    values = mapping.model_dump(mode="json", by_alias=True, exclude_defaults=True, exclude_none=True)
    plain = {name: value for name, value in values.items() if not isinstance(value, dict | list)}
    tables = {name: value for name, value in values.items() if name not in plain}
    head = "".join(f"# {note}\n" for note in notes)
    return head + tomli_w.dumps(plain | tables)


def rig_text(rig: Rig) -> str:
    """The text of a rig.toml, as far as the rig is known."""
    return tomli_w.dumps(rig.model_dump(mode="json", exclude_defaults=True, exclude_none=True))
