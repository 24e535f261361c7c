"""What a kind of drive brings in: settings, driver, simulated device, and how the conformance tests set it up."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Generic, TypeVar

from bench.config.drives.simulated_device import Simulate
from bench.config.rig import Rig, Section
from drivers.contract import Drive


class DriveSettings(Section):
    """A `[drive]` section. Those of a drive on a wire derive from `RealDriveSettings`.

    A kind whose settings do not is simulated in this process: its time is virtual, and it has `hang_load`.
    """

    kind: str


@dataclass(frozen=True)
class ConformanceBench:
    """One way to run the conformance tests (`tests/drivers/conformance`) on a kind.

    Attributes:
        name: in the names of the tests.
        device: options of `friction-bench simulate-device KIND`.
        settings: keys of `[drive]`, beside those that the simulated device prints; short time limits do not fit a
            busy test machine.
        has_link: whether the device takes `--link`, so that its port comes back under the same name.
    """

    name: str
    device: tuple[str, ...] = ()
    settings: Mapping[str, Any] = field(default_factory=dict)
    has_link: bool = True


SettingsT = TypeVar("SettingsT", bound=DriveSettings)


@dataclass(frozen=True)
class DriveKind(Generic[SettingsT]):
    """A kind of drive. Its functions import what they need themselves: a bench needs no library of another kind.

    Attributes:
        title: of the family, for people.
        settings: the `[drive]` section; its `kind` is a `Literal` with the name of the kind.
        make: makes the drive, not yet open, of the section and the rig. Raises `ConfigurationError`.
        simulate: imports the function behind `friction-bench simulate-device KIND`; None where there is no device.
        conformance: how the conformance tests run on it.
        share: lets drives of one bench that are on one line use it together, before they are opened; raises
            `ConfigurationError`. None: each has a line of its own.
    """

    title: str
    settings: type[SettingsT]
    make: Callable[[SettingsT, Rig], Drive]
    simulate: Callable[[], Simulate] | None = None
    conformance: tuple[ConformanceBench, ...] = ()
    share: Callable[[Sequence[Any]], None] | None = None

    @property
    def name(self) -> str:
        """What `kind` in `[drive]` says."""
        name: str = self.settings.model_fields["kind"].annotation.__args__[0]  # type: ignore[union-attr]
        return name
