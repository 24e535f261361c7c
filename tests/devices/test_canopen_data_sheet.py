"""Data sheets by CiA 306 as makers write them: encodings, types, short forms; and what is refused, with the place."""

from struct import pack

import pytest

from sim_backend.devices.canopen.objects.data_sheet import read_data_sheet
from sim_backend.devices.canopen.objects.family import Rating, mode_bits
from sim_backend.devices.canopen.objects.from_sheet import family_of
from sim_backend.devices.canopen.serve import data_sheet
from sim_backend.devices.joint_tables import behind_a_drive
from sim_backend.errors import ParameterError

HEAD = """[DeviceInfo]
ProductName=Drive 10 \u00b5m
[MandatoryObjects]
SupportedObjects=1
1=0x1000
[1000]
ParameterName=Device type
DataType=0x0007
AccessType=ro
DefaultValue=0x00020192
"""
OTHERS = """[ManufacturerObjects]
SupportedObjects=2
1=0x2000
1=0x2001
[2000]
ParameterName=Gain
DataType=0x0008
DefaultValue=-0.25
LowLimit=-1.0
HighLimit=100
[2001]
ParameterName=Slip of the pen
DataType=0x0007
DefaultValue=ten
[2002]
ParameterName=COB-ID
DataType=0x0007
DefaultValue=0x180+$NodeID
ParameterValue=$NODEID+0x40000200
[2003]
ParameterName=Gains
ObjectType=0x8
DataType=0x0006
CompactSubObj=2
DefaultValue=7
[2003Value]
NrOfEntries=1
2=0xfF
[2004]
ParameterName=Negative
DataType=0x0003
DefaultValue=0xFFFE
[2005]
ParameterName=Real by its bits
DataType=0x0008
DefaultValue=0x437A0000
[2006]
ParameterName=Long real by its bits
DataType=0x0011
DefaultValue=0x406F400000000000
[2007]
ParameterName=Real of too many bits
DataType=0x0008
DefaultValue=0x406F400000000000
"""
IDENTITY = """[DeviceInfo]
VendorNumber=0x000000FB
ProductNumber=0x63220000
RevisionNumber=rev. 3
[1018]
SubNumber=4
[1018sub0]
DataType=0x0005
DefaultValue=3
[1018sub1]
DataType=0x0007
[1018sub2]
DataType=0x0007
DefaultValue=7
[1018sub3]
DataType=0x0007
[6098]
DataType=0x0002
[6502]
DataType=0x0007
"""
OF_EPOS4 = "".join(f"[{index}]\nSubNumber=1\n[{index}sub2]\nDataType=0x0007\n" for index in ("3001", "30D1"))


@pytest.fixture
def write(tmp_path):
    def written(text, encoding="latin-1"):
        path = tmp_path / "drive.eds"
        path.write_bytes(text.encode(encoding))
        return path

    return written


@pytest.mark.parametrize("encoding", ["latin-1", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be"])
def test_a_file_is_read_in_the_encoding_that_it_names(write, encoding) -> None:
    sheet = read_data_sheet(write(HEAD, encoding))
    assert sheet.name == "Drive 10 \u00b5m"
    assert sheet.default(0x1000) == 0x20192


def test_values_are_those_of_their_type(write) -> None:
    sheet = read_data_sheet(write(HEAD + OTHERS))
    assert sheet.default(0x2000) == int.from_bytes(pack("<f", -0.25), "little")
    gain = next(one.entries[0] for one in sheet.objects if one.index == 0x2000)
    assert (gain.low, gain.high) == (None, None)  # of a number of another kind than what is compared
    cob_id = next(one.entries[0] for one in sheet.objects if one.index == 0x2002)
    assert (cob_id.default, cob_id.with_node_id) == (0x40000200, True)
    assert [sheet.default(0x2003, place) for place in range(3)] == [2, 7, 0xFF]
    assert sheet.default(0x2004) == -2
    assert sheet.default(0x2005) == int.from_bytes(pack("<f", 250.0), "little")
    assert sheet.default(0x2006) == int.from_bytes(pack("<d", 250.0), "little")
    assert sheet.default(0x2007) is None


@pytest.mark.parametrize(
    "text",
    [
        HEAD.replace("\n", "\r"),
        HEAD + "\x1a",
        HEAD + "\0\0",
        "// made by hand\n" + HEAD.replace("=0x0007", "=0x0007 // U32"),
        "Drive, all versions\n\n" + HEAD,
        HEAD.replace("DataType", "  DataType").replace("[1000]", "\t[1000]"),
        HEAD.replace("0x00020192", "20192h"),
    ],
)
def test_what_only_looks_different_is_read_alike(write, text) -> None:
    sheet = read_data_sheet(write(text, "latin-1"))
    plain = read_data_sheet(write(HEAD))
    assert (sheet.objects, sheet.told) == (plain.objects, plain.told)


@pytest.mark.parametrize("name", ["[1A00Sub01]", "[1a00sub 1]", "[1A00sub0x1]"])
def test_a_subindex_is_found_however_it_is_written(write, name) -> None:
    text = f"[1A00]\nSubNumber=2\n{name}\nDataType=0x0007\nDefaultValue=0x60640020\n"
    assert read_data_sheet(write(text)).default(0x1A00, 1) == 0x60640020


def test_what_the_identity_leaves_out_is_told_by_the_device_info(write) -> None:
    sheet = read_data_sheet(write(IDENTITY))
    assert [sheet.default(0x1018, place) for place in range(4)] == [3, 0xFB, 7, None]


@pytest.mark.parametrize(("more", "unit_n_m"), [("", 1e-3), (OF_EPOS4, 1e-6)])
def test_a_drive_of_maxon_is_an_epos4_by_its_objects(write, more, unit_n_m) -> None:
    assert family_of(read_data_sheet(write(IDENTITY + more))).torque_unit_n_m == unit_n_m


def test_a_drive_that_lists_homing_has_it_where_its_modes_are_not_told(write) -> None:
    family = family_of(read_data_sheet(write(IDENTITY)))
    modes = next(one.entries[0] for one in family.objects(Rating.of(behind_a_drive())) if one.index == 0x6502)
    assert 6 in family.modes
    assert modes.default == mode_bits(family.modes)


def test_a_value_that_is_no_number_is_not_told(write) -> None:
    sheet = read_data_sheet(write(HEAD + OTHERS))
    assert sheet.default(0x2001) is None
    assert any(one.index == 0x2001 for one in sheet.objects)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('<?xml version="1.0"?>\n<ISO15745ProfileContainer/>', "is XML .* an EDS or DCF file is wanted"),
        ("A drive\n", "File contains no section headers"),
        (HEAD.replace("[1000]", "[1000]\nObjectType=VAR"), r"\[1000\] ObjectType is 'VAR'; a number is wanted"),
        ("[DeviceInfo]\n", "describes no objects"),
        (HEAD.replace("DataType=", "Type="), r"\[1000\] DataType is ''; a number is wanted"),
        ("Name=A\n" + HEAD, "File contains no section headers. file: 'drive.eds', line: 1 'Name=A"),
        (HEAD + "  and so on\n", r"Source contains parsing errors: 'drive.eds' \[line 11\]: 'and so on"),
        (HEAD.replace("=ro", "=r\0o"), "line 9 has byte 0x00; text is wanted"),
        ("[1018sub1]\nDataType=7\n[1018SUB01]\nDataType=5\n", r"\[1018sub1\] and \[1018SUB01\] are one object"),
    ],
)
def test_what_is_no_data_sheet_is_refused_with_the_place(write, text, words) -> None:
    with pytest.raises(ParameterError, match=f"drive.eds: {words}"):
        read_data_sheet(write(text))


def test_the_sheet_of_a_simulated_drive_has_its_mappings_in_hexadecimal(write) -> None:
    text = data_sheet("epos4")
    assert "DefaultValue=0x60400010\n" in text  # some readers put 0 for any other form
    assert "VendorNumber=251\n" in text
    assert "BaudRate_10=0\nBaudRate_20=0\n" in text
    assert read_data_sheet(write(text)).default(0x1600, 1) == 0x60400010
