"""Which kinds of drive are installed: entry points of the group `friction_bench.drives`, ours and other packages'."""

from functools import cache
from importlib.metadata import EntryPoint, entry_points
from typing import TYPE_CHECKING, Any, NamedTuple

from bench.config.drives.kind import DriveKind, DriveSettings
from bench.config.validation import chosen_by_kind
from bench.errors import ConfigurationError

ENTRY_POINT_GROUP = "friction_bench.drives"
DEFAULT_KIND = "sim"
_OUR_PACKAGE = "friction-bench"


class Installed(NamedTuple):
    """What the entry points led to.

    Attributes:
        kinds: by name; ours first.
        broken: why an entry point cannot be used, by its name.
    """

    kinds: dict[str, DriveKind[Any]]
    broken: dict[str, str]


@cache
def installed() -> Installed:
    """Load every entry point. One that fails takes no other with it.

    Raises:
        ConfigurationError: not even our own are known, as in a checkout that was installed before they were there.
    """
    found = Installed({}, {})
    points = sorted(entry_points(group=ENTRY_POINT_GROUP), key=_order)
    for point in points:
        try:
            kind = point.load()
            found.kinds.setdefault(kind.name, kind)
        except Exception as error:  # whatever another package's module raises
            package = point.dist.name if point.dist is not None else point.value
            found.broken[point.name] = f"'{point.name}' of package {package} cannot be loaded: {error!r}"
    if DEFAULT_KIND not in found.kinds:
        raise ConfigurationError(
            f"no drive kind '{DEFAULT_KIND}' among the entry points '{ENTRY_POINT_GROUP}': the installed package is "
            "older than its source; install it again (make, or pip install --editable .)"
        )
    return found


def drive_kinds() -> dict[str, DriveKind[Any]]:
    """Every kind that can be used, by name; ours first."""
    return installed().kinds


def drive_kind(name: str) -> DriveKind[Any]:
    """A kind by name.

    Raises:
        ConfigurationError: it is not installed; the message says which are.
    """
    kinds = drive_kinds()
    if name not in kinds:
        raise ConfigurationError(f"there is no drive kind '{name}'; {_wanted()}")
    return kinds[name]


def _order(point: EntryPoint) -> tuple[bool, bool, str]:
    """The default kind first, then ours: no other package takes a name of ours."""
    is_ours = point.dist is not None and point.dist.name == _OUR_PACKAGE
    return not is_ours, point.name != DEFAULT_KIND, point.name


def _wanted() -> str:
    """What `kind` may be, and what is installed and cannot be used."""
    found = installed()
    return "; ".join([f"kind should be one of {', '.join(found.kinds)}", *found.broken.values()])


if TYPE_CHECKING:
    AnyDriveSettings = DriveSettings
else:
    AnyDriveSettings = chosen_by_kind((one.settings for one in drive_kinds().values()), _wanted(), DEFAULT_KIND)


def default_drive_settings() -> DriveSettings:
    """The simulated drive."""
    settings: DriveSettings = drive_kind(DEFAULT_KIND).settings(kind=DEFAULT_KIND)
    return settings
