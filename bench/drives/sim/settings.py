"""Settings of the simulated drive."""

from typing import TYPE_CHECKING, Any, Literal

from pydantic import Field

from bench.config.drives.kind import DriveSettings
from bench.config.quantities import quantity
from bench.config.rig import Section
from bench.config.validation import chosen_by_kind, kind_of


class FaultSettings(Section):
    """Something that goes wrong at a time, for a while or for good."""

    at_s: float = quantity(..., "s", "When it begins, since the drive was made", ge=0)
    for_s: float | None = quantity(None, "s", "How long it lasts; for good where left out", gt=0)
    clock: Literal["drive", "wall"] = quantity(
        "drive", "", "Whose seconds: the drive's own, which a fast simulation runs through at once, or the wall clock's"
    )

    def values(self) -> dict[str, float | str]:
        """The quantities of this kind of fault, by name."""
        return self.model_dump(exclude={"kind", *FaultSettings.model_fields})


class EncoderStuck(FaultSettings):
    """The encoder shows the position of the start, whatever the motor does."""

    kind: Literal["encoder-stuck"]


class EncoderJump(FaultSettings):
    """The encoder has lost counts: every position is off by so much."""

    kind: Literal["encoder-jump"]
    jump_rad: float = quantity(..., "rad", "What every position is off by")


class SamplesLost(FaultSettings):
    """Neither command nor sample gets through."""

    kind: Literal["samples-lost"]


class SamplesLate(FaultSettings):
    """What the drive measures arrives late, and says so."""

    kind: Literal["samples-late"]
    age_s: float = quantity(..., "s", "How late", gt=0, le=1)


class OverTemperature(FaultSettings):
    """The drive is too hot and switches itself off."""

    kind: Literal["over-temperature"]
    temperature_c: float = quantity(95.0, "degC", "How hot it says it is", gt=0)


class OverCurrent(FaultSettings):
    """The stage has seen a current spike and switches itself off."""

    kind: Literal["over-current"]
    current_a: float = quantity(20.0, "A", "The spike", gt=0)


class SupplyLost(FaultSettings):
    """The supply of the power stage is gone; the drive's logic lives on."""

    kind: Literal["supply-lost"]


class DriveFailed(FaultSettings):
    """Any other fault of the drive's own."""

    kind: Literal["drive-failed"]
    text: str = quantity("internal fault", "", "What the drive says", min_length=1)


class TorqueDisabled(FaultSettings):
    """Somebody has opened the safe-torque-off circuit."""

    kind: Literal["torque-disabled"]


class ClutchSlips(FaultSettings):
    """The coupling between transmission and arm holds no more than this."""

    kind: Literal["clutch-slips"]
    limit_n_m: float = quantity(..., "N m", "Torque at which it slips", gt=0)


class LoadFalls(FaultSettings):
    """The load falls off the arm. It does not come back by itself."""

    kind: Literal["load-falls"]


KINDS: tuple[type[FaultSettings], ...] = (
    EncoderStuck, EncoderJump, SamplesLost, SamplesLate, OverTemperature, OverCurrent, SupplyLost, DriveFailed,
    TorqueDisabled, ClutchSlips, LoadFalls,
)  # fmt: skip
if TYPE_CHECKING:
    AnyFault = FaultSettings
else:
    AnyFault = chosen_by_kind(KINDS, f"kind should be one of {', '.join(map(kind_of, KINDS))}")


class SimulatedDriveSettings(DriveSettings):
    """A drive and a joint in software."""

    kind: Literal["sim"] = "sim"
    preset: str = quantity("paper", "", "Plant that is simulated")
    seed: int = quantity(1, "", "Seed of the plant's scatter and noise; the same seed gives the same samples", ge=0)
    faults: tuple[AnyFault, ...] = Field(default=(), description="What goes wrong with drive and joint, and when")
    plant: dict[str, Any] = Field(default_factory=dict, description="Plant parameters that differ from the preset")
