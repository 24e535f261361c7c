"""Recording sets that the tests write."""

from pathlib import Path

RIG = 'name = "bench 3"\n'
GOOD = "time_s,position_rad,duty\n0.0,0.1,0.5\n0.5,0.2,0.25\n1.0,0.3,-1\n"


def write_set(folder: Path, files: dict[str, str | bytes]) -> Path:
    """A folder with these files, and a rig.toml unless one is given."""
    folder.mkdir(exist_ok=True)
    for name, content in ({"rig.toml": RIG} | files).items():
        data = content.encode() if isinstance(content, str) else content
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(data)
    return folder
