"""Which kinds of drive there are. `kind` in bench.toml chooses one; `bench.drive_factory` makes it."""

from bench.drives.simulated import SimulatedDriveSettings

DriveSettings = SimulatedDriveSettings
