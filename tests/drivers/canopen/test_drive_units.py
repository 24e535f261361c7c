"""Units by the drive's own objects, beside the rig's: computed, compared, refused where they contradict."""

from math import isnan, nan, pi

import pytest

from drivers.can_bus.settings import BusSettings
from drivers.canopen.cia301.object_access import ObjectRefusedError
from drivers.canopen.cia301.object_table import ObjectTable
from drivers.canopen.cia402.drive_units import read_units
from drivers.canopen.settings import CanopenSettings
from drivers.errors import DriveConfigurationError

TENTH_DEGREE, INCREMENTS, RPM, METRES_PER_S = 0xFF410000, 0x00B50000, 0x00B44700, 0x00010300


class Objects:
    """Reads from a table; anything else is absent."""

    def __init__(self, values):
        self._values = values

    def read(self, item):
        try:
            return self._values[item.index, item.subindex]
        except KeyError:
            raise ObjectRefusedError("x", "absent", 0x06020000) from None


def units(counts_per_turn, objects, **settings):
    flat = {}
    for index, value in objects.items():
        pairs = enumerate(value, 1) if isinstance(value, tuple) else [(0, value)]
        flat |= {(index, place): number for place, number in pairs}
    told = CanopenSettings(bus=BusSettings("virtual", "x"), node_id=5, **settings)
    return read_units(ObjectTable(Objects(flat), "x"), told, counts_per_turn)


@pytest.mark.parametrize(
    ("counts_per_turn", "objects"),
    [
        (4096, {}),  # nothing told, nothing to contradict
        (4096, {0x608F: (4096, 1)}),
        (2000, {0x608F: (20_000, 10)}),
        (3600, {0x608F: (2000, 1), 0x6092: (3600, 1)}),
        (3600, {0x608F: (2000, 1), 0x60A8: TENTH_DEGREE}),
        (3600, {0x608F: (2000, 1), 0x6091: (1, 1), 0x6092: (3600, 1), 0x60A8: TENTH_DEGREE}),
        (180, {0x608F: (2000, 1), 0x6091: (20, 1), 0x6092: (3600, 1)}),  # of the shaft behind the gear
        (180, {0x6091: (20, 1), 0x60A8: TENTH_DEGREE}),
        (4096, {0x608F: (4096, 1), 0x6092: (1, 1), 0x60A8: INCREMENTS}),  # feed as delivered
        (4096, {0x608F: (4096, 1), 0x6091: (20, 1), 0x60A8: INCREMENTS}),
        (4096, {0x6091: (5308416, 5308416)}),
    ],
)
def test_a_rig_that_agrees_is_taken(counts_per_turn, objects):
    assert units(counts_per_turn, objects).rows[0].configuration == counts_per_turn


@pytest.mark.parametrize(
    ("counts_per_turn", "objects", "told"),
    [
        (4096, {0x608F: (2000, 1)}, "2000 by encoder resolution 0x608F"),
        (2000, {0x608F: (2000, 1), 0x6092: (3600, 1)}, "3600 by feed constant 0x6092"),
        (2000, {0x608F: (2000, 1), 0x60A8: TENTH_DEGREE}, "3600 by position unit 0x60A8"),
        (3600, {0x6091: (20, 1), 0x6092: (3600, 1)}, "180 by feed constant 0x6092"),
    ],
)
def test_a_rig_that_contradicts_the_drive_is_refused_with_both_values(counts_per_turn, objects, told):
    with pytest.raises(DriveConfigurationError, match=f"{told}.*the rig says {counts_per_turn}"):
        units(counts_per_turn, objects)
    assert units(counts_per_turn, objects, units_from_configuration=True).rows[0].configuration == counts_per_turn


@pytest.mark.parametrize(
    ("objects", "rad_s"),
    [
        ({0x60A9: RPM}, 2 * pi / 60),
        ({0x60A9: RPM, 0x6091: (20, 1)}, 20 * 2 * pi / 60),  # of the shaft; the motor is faster
        ({0x60A9: 0x00B50300}, 2 * pi / 4096),
        ({0x6096: (1, 1)}, 2 * pi / 4096),  # position units a second
        ({0x6096: (60, 4096)}, 2 * pi / 60),  # rpm, as a factor
        ({0x60A9: RPM, 0x6096: (1, 1)}, 2 * pi / 60),  # factor as delivered
    ],
)
def test_velocity_by_unit_or_by_factor(objects, rad_s):
    assert units(4096, objects).velocity_rad_s == pytest.approx(rad_s)


@pytest.mark.parametrize("objects", [{}, {0x60A9: METRES_PER_S}])
def test_a_velocity_whose_unit_nobody_tells_is_not_measured(objects):
    assert isnan(units(4096, objects).velocity_rad_s)


def test_a_drive_that_contradicts_itself_is_decided_by_the_settings():
    objects = {0x60A9: RPM, 0x6096: (1, 10)}
    with pytest.raises(DriveConfigurationError, match=r"the drive contradicts itself\. Set velocity_unit"):
        units(4096, objects)
    assert units(4096, objects, velocity_unit="rpm").velocity_rad_s == pytest.approx(2 * pi / 60)


def test_a_velocity_unit_that_contradicts_the_drive_is_refused():
    with pytest.raises(DriveConfigurationError, match=r"which is rpm.*the settings say 0.1 rpm"):
        units(4096, {0x60A9: RPM}, velocity_unit="0.1 rpm")


@pytest.mark.parametrize(
    ("objects", "told_rad_s2"),
    [
        ({}, nan),
        ({0x60A9: RPM}, nan),  # of velocity
        ({0x60AA: 0x00B55700}, 2.0 * pi / 4096),  # increments
        ({0x60AA: 0xFAB45700, 0x6091: (20, 1)}, 20.0 * 2e-6 * pi),  # millionths of a turn of the shaft
        ({0x60AA: 0x00C00300}, 2.0 * pi / 60.0),  # rpm a second
        ({0x60AA: 0x00014700}, nan),
        ({0x6097: (1, 1)}, nan),  # as delivered
        ({0x6097: (10, 1)}, 0.1 * 2.0 * pi / 4096),
    ],
)
def test_the_unit_of_accelerations_is_what_the_drive_tells(objects, told_rad_s2):
    assert units(4096, objects).acceleration_rad_s2 == pytest.approx(told_rad_s2, nan_ok=True)
