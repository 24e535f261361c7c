"""Files as other labs write them, generated: locales, encodings, headers, stamps, units, formats. One motion in all.

`FILES` holds each file's bytes, and what must come of it: the motion, read right, or a sentence that names the mend.
"""

import io
import json
from collections.abc import Callable
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta

import h5py
import numpy as np
import pandas as pd
from scipy.io import savemat

from bench.recording_set.guess import Known, read_said

RATE_HZ = 100.0
ROWS = 400
TIME_S = np.arange(ROWS) / RATE_HZ
POSITION_RAD = 1.1 * np.sin(2.0 * np.pi * 0.5 * TIME_S) + 0.2 * np.sin(2.0 * np.pi * 1.3 * TIME_S)
VELOCITY_RAD_S = np.gradient(POSITION_RAD, TIME_S)
CURRENT_A = 0.4 * np.sign(VELOCITY_RAD_S) + 0.05 * VELOCITY_RAD_S + 0.8 * np.sin(POSITION_RAD)
TURNING_RAD = 3.0 * TIME_S  # a shaft that goes on one way
DEGREES = np.degrees(POSITION_RAD)
COUNTS = np.round(POSITION_RAD / (2.0 * np.pi) * 16384.0)
START = datetime(2026, 5, 4, 23, 59, 58, tzinfo=UTC)
TRUTH = {"time_s": TIME_S, "position_rad": POSITION_RAD, "current_a": CURRENT_A}
COLUMNS = {"time_s": TIME_S, "position_rad": POSITION_RAD, "current_a": CURRENT_A}


@dataclass(frozen=True)
class Foreign:
    """A file of another lab.

    Attributes:
        name: of the file; data: its bytes.
        asks: what the refusal must say; "" where the file must be read.
        known: what the user tells.
        truth: the channels that must come out, to `digits` decimals.
    """

    name: str
    data: bytes
    asks: str = ""
    known: Known = field(default_factory=lambda: Known({}))
    truth: dict[str, np.ndarray] = field(default_factory=lambda: TRUTH)
    digits: int = 4


def rows(
    columns: dict[str, np.ndarray | list[str]],
    delimiter: str = ",",
    decimal: str = ".",
    header: str | None = "",
    form: str = "%.9g",
    end: str = "\n",
) -> str:
    """A table as text; `header` "" writes the names, None none."""
    cells = [
        [one if isinstance(one, str) else (form % one).replace(".", decimal) for one in values]
        for values in columns.values()
    ]
    head = [delimiter.join(columns) if header == "" else header] if header is not None else []
    return end.join([*head, *(delimiter.join(row) for row in zip(*cells, strict=True))]) + end


def renamed(*names: str, **scales: float) -> dict[str, np.ndarray | list[str]]:
    """Time, position and current under other names; scales by `time`, `position`, `current`."""
    factors = [scales.get(key, 1.0) for key in ("time", "position", "current")]
    return {name: values * factor for name, values, factor in zip(names, COLUMNS.values(), factors, strict=True)}


def stamps(form: Callable[[datetime], str]) -> list[str]:
    """The time of every row as text."""
    return [form(START + timedelta(seconds=float(second))) for second in TIME_S]


def _text(columns: dict[str, np.ndarray | list[str]], **kwargs: str) -> bytes:
    return rows(columns, **kwargs).encode()


DEG = 180.0 / np.pi
GERMAN = renamed("Zeit [ms]", "Winkel [°]", "Strom [mA]", time=1e3, position=DEG, current=1e3)
PLAIN = _text(COLUMNS)


def _text_files() -> dict[str, Foreign]:
    german = rows(GERMAN, delimiter=";", decimal=",", end="\r\n")
    blanks = rows(renamed("t", "theta", "i"), delimiter="  ")
    lines = PLAIN.decode().splitlines(keepends=True)
    return {
        "plain": Foreign("a.csv", PLAIN),
        "german excel, windows-1252": Foreign("a.csv", german.encode("cp1252")),
        "german excel, utf-8 mark": Foreign("a.csv", german.encode("utf-8-sig")),
        "german excel, utf-16": Foreign("a.csv", german.encode("utf-16")),
        "utf-16 without a mark": Foreign("a.csv", german.encode("utf-16-le")),
        "tabs": Foreign("a.txt", _text(COLUMNS, delimiter="\t")),
        "tabs, decimal comma": Foreign("a.tsv", _text(COLUMNS, delimiter="\t", decimal=",")),
        "blanks": Foreign("a.dat", blanks.encode()),
        "bars": Foreign("a.csv", _text(COLUMNS, delimiter="|")),
        "carriage returns": Foreign("a.csv", PLAIN.replace(b"\n", b"\r\n")),
        "old mac": Foreign("a.csv", PLAIN.replace(b"\n", b"\r")),
        "quoted decimal commas": Foreign(
            "a.csv", ("time_s,position_rad,current_a\n" + "".join(
                ",".join('"' + f"{one:.9g}".replace(".", ",") + '"' for one in row) + "\n"
                for row in zip(*COLUMNS.values(), strict=True))).encode()),
        "sign at each end": Foreign("a.csv", PLAIN.replace(b"\n", b",\n")),
        "preface": Foreign("a.csv", b"Scope 12\nDate: 2026-05-04\nOperator: K\n\n" + PLAIN),
        "remarks": Foreign("a.csv", b"# motor 3\n# gear 7\n" + PLAIN),
        "header as a remark": Foreign("a.csv", b"% " + PLAIN),
        "matlab remarks": Foreign("a.txt", b"%% log\n%time_s position_rad current_a\n" + _text(
            COLUMNS, delimiter=" ", header=None)),
        "remarks below": Foreign("a.csv", "".join([*lines[:50], "# paused\n", *lines[50:], "# end\n"]).encode()),
        "header again": Foreign("a.csv", "".join([*lines[:200], lines[0], *lines[200:]]).encode()),
        "blank lines": Foreign("a.csv", PLAIN.replace(b"\n", b"\n\n")),
        "line of units": Foreign("a.csv", _text(
            renamed("Time", "Angle", "Current", time=1e3, position=DEG), header="Time,Angle,Current\nms,deg,A")),
        "line of units in brackets": Foreign("a.csv", _text(
            renamed("t", "q", "i", position=DEG), delimiter=";", header="t;q;i\n[s];[deg];[A]")),
        "a kind above each name, spare columns": Foreign("a.csv", _text(
            {**renamed("Time", "Angle [deg]", "Current", time=1e3, position=DEG), "spare": 0.0 * TIME_S,
             "spare again": 0.0 * TIME_S},
            header="Time,Analog 1,Analog 2,Digital 1,Digital 2\nms,Angle [deg],Current,not used,not used")),
        "an instrument's own lines, as wide as the table": Foreign("a.csv", (
            b"Started,2026-05-04 17:04:51,Trigger,none\nInterval,0.01,Interval,0.01\n"
            + _text({"event": [""] * ROWS, "t [s]": TIME_S, "angle [rad]": POSITION_RAD, "current [A]": CURRENT_A}))),
        "a current without its sign": Foreign("a.csv", _text({
            "time_s": TIME_S, "position_rad": POSITION_RAD, "current": np.abs(CURRENT_A), "duty": 0.1 * CURRENT_A}),
            asks="'current' is never below 0, while 'duty' is of both signs: say --take 'current=current.A. by duty'"),
        "a current without its sign, said": Foreign("a.csv", _text({
            "time_s": TIME_S, "position_rad": POSITION_RAD, "current": np.abs(CURRENT_A), "duty": 0.1 * CURRENT_A}),
            known=Known(read_said(["current=current[A] by duty"]))),
        "a current that is of one sign": Foreign("a.csv", _text({
            "time_s": TIME_S, "position_rad": POSITION_RAD, "current": 3.0 + CURRENT_A, "duty": 0.1 * CURRENT_A}),
            known=Known(read_said(["current=current[A]"])), truth={"current_a": 3.0 + CURRENT_A}),
        "remarks in a column, none made": Foreign("a.csv", rows(
            {**GERMAN, "Bemerkung": [""] * ROWS}, delimiter=";", decimal=",").encode()),
        "remarks in a column, one in the first row": Foreign("a.csv", rows(
            {**GERMAN, "Bemerkung": ["Start", *[""] * (ROWS - 2), "Ende"]}, delimiter=";", decimal=",").encode()),
        "missing values": Foreign("a.csv", PLAIN.replace(b"\n0.05,", b"\n0.05,", 1) + b"4,NA,NA\n4.01,,NaN\n",
                                  truth={"time_s": np.append(TIME_S, [4.0, 4.01])}),
        "scientific": Foreign("a.csv", _text(COLUMNS, form="%.8E")),
        "thousands": Foreign("a.csv", PLAIN + b'"1,004.5",0,0\n',
                             asks="found '1,004.5'; wanted .* between its thousands"),
        "short last line": Foreign("a.csv", PLAIN + b"4.0,0.1", asks="found 2 cells; wanted 3"),
        "text in a number": Foreign("a.csv", PLAIN.replace(b"\n0.5,", b"\n0.5,OVERRUN", 1),
                                    asks="line 52, column 'position_rad': found 'OVERRUN"),
        "pandas, with its index": Foreign("a.csv", pd.DataFrame(COLUMNS).to_csv().encode()),
        "pandas, with the time as its index": Foreign(
            "a.csv", pd.DataFrame(COLUMNS).set_index("time_s").rename_axis(None).to_csv().encode()),
        "pandas, without a time": Foreign(
            "a.csv", pd.DataFrame(COLUMNS).drop(columns="time_s").to_csv().encode(), asks="no column is a time"),
        "no header": Foreign("a.csv", _text(COLUMNS, header=None), asks="no column is a position"),
        "no header, an uneven clock": Foreign("a.csv", _text(
            {"duty": CURRENT_A, "t": TIME_S + 0.02 * (np.arange(ROWS) % 9 == 8).cumsum(), "q": POSITION_RAD},
            header=None), asks=r"or which it is, --take 'column 2=time\[s\]', which never falls"),
        "no header, set points that rise": Foreign("a.csv", _text(
            {"duty": np.floor(TIME_S), "q": POSITION_RAD}, header=None), asks="or which it is, --take 'NAME=time"),
        "no header, many columns": Foreign("a.csv", _text({f"{n}": CURRENT_A for n in range(25)}, header=None),
                                           asks="'column 20' and 5 more\\)"),
        "every line in quotes": Foreign("a.csv", "".join(f'"{line}"\n' for line in PLAIN.decode().split()).encode(),
                                        asks="line 1: the whole line stands in double quotes"),
        "no header, said": Foreign("a.csv", _text(COLUMNS, header=None), known=Known(read_said(
            ["column 1=time[s]", "column 2=position[rad]", "column 3=current[A]"]))),
        "empty": Foreign("a.csv", b"", asks="wanted a header"),
        "picture": Foreign("a.csv", b"\x89PNG\r\n\x1a\n\x00\x00\x00\rIHDR", asks="is no text"),
        "spreadsheet": Foreign("a.xlsx", b"PK\x03\x04", asks="save the table as CSV"),
        "unknown ending": Foreign("a.tdms", b"TDSm", asks="export its channels"),
    }  # fmt: skip


def motor_side(ratio: float) -> bytes:
    """An angle of the joint beside the speed of a motor in front of its gear."""
    rpm = VELOCITY_RAD_S * ratio * 60.0 / (2.0 * np.pi)
    return _text({"t [s]": TIME_S, "Winkel [deg]": DEGREES, "Drehzahl [U/min]": rpm, "I [A]": CURRENT_A})


def _units() -> dict[str, Foreign]:
    speed = {"velocity_rad_s": VELOCITY_RAD_S}
    both = {**TRUTH, **speed}
    quick = 200.0 * TIME_S
    return {
        "milliseconds by their steps": Foreign("a.csv", _text(renamed("time", "pos_rad", "i_a", time=1e3))),
        "microseconds": Foreign("a.csv", _text(renamed("micros", "pos_rad", "i_a", time=1e6))),
        "nanoseconds since 1970": Foreign("a.csv", _text({
            "stamp": [str(1_777_939_198_000_000_000 + round(s * 1e9)) for s in TIME_S],
            "position_rad": POSITION_RAD, "current_a": CURRENT_A})),
        "seconds and nanoseconds": Foreign("a.csv", _text({
            "secs": np.floor(TIME_S + 0.5), "nsecs": np.round((TIME_S + 0.5) % 1.0 * 1e9),
            "position_rad": POSITION_RAD, "current_a": CURRENT_A}, form="%.12g"),
            truth={**TRUTH, "time_s": TIME_S + 0.5}),
        "degrees": Foreign("a.csv", _text(renamed("t[s]", "angle (deg)", "current (A)", position=DEG))),
        "degrees and rpm": Foreign("a.csv", _text({
            "Time, s": TIME_S, "Position, deg": DEGREES, "Speed, rpm": VELOCITY_RAD_S * 60.0 / (2.0 * np.pi),
            "Iq, A": CURRENT_A}, delimiter=";"), truth=both),
        "units told by the speed": Foreign("a.csv", _text({
            "t": TIME_S, "pos": DEGREES, "vel_rad_s": VELOCITY_RAD_S, "i": CURRENT_A}), truth=both),
        "speed told by the position": Foreign("a.csv", _text({
            "t": TIME_S, "pos_rad": POSITION_RAD, "speed": VELOCITY_RAD_S * 60.0 / (2.0 * np.pi), "i": CURRENT_A}),
            truth=both),
        "units that deny each other": Foreign("a.csv", _text({
            "t": TIME_S, "pos_rad": DEGREES, "vel_rad_s": VELOCITY_RAD_S, "i": CURRENT_A}),
            asks="times as fast as 'vel_rad_s'"),
        "speed of the motor": Foreign("a.csv", motor_side(50.0), truth=both),
        "speed of the motor, half a ratio": Foreign("a.csv", motor_side(4.5), truth=both),
        "speed of the motor behind a gear that could be a unit": Foreign(
            "a.csv", motor_side(60.0), asks="--take 'Winkel .deg.=position.deg.'"),
        "speed of the motor behind a gear that could be a unit, said": Foreign(
            "a.csv", motor_side(60.0), known=Known(read_said(["Winkel [deg]=position[deg]"])), truth=both),
        "speed of the motor behind the gear of a rig": Foreign(
            "a.csv", motor_side(60.3), known=Known({}, gear_ratio=60.3), truth=both),
        "speed of nothing known": Foreign("a.csv", motor_side(2.3), asks="changes 0.435 times as fast"),
        "speed of nothing known, which no import takes": Foreign(
            "a.csv", motor_side(2.3), known=Known(read_said(["Winkel [deg]=position[deg]"])),
            asks=r"no import takes: say --take 'Drehzahl .U/min.=ignore'"),
        "counts of another turn": Foreign("a.csv", _text({
            "t": TIME_S, "enc": COUNTS, "vel [rad/s]": VELOCITY_RAD_S, "i": CURRENT_A}),
            known=Known({}, counts_per_turn=1000.0),
            asks=r"'enc' in counts changes 16.4 times as fast as 'vel .*--counts-per-turn 163.. or --take 'vel "),
        "counts of many turns": Foreign("a.csv", _text({
            "t": TIME_S, "enc": COUNTS, "vel [rad/s]": VELOCITY_RAD_S, "i": CURRENT_A}),
            known=Known(read_said(["enc=position[counts]"]), counts_per_turn=133 * 16384.0),
            asks=r"no import takes: say --counts-per-turn 163.. or --take 'vel .rad/s.=ignore'"),
        "speed told by counts": Foreign("a.csv", _text({
            "t": TIME_S, "enc": COUNTS, "speed": VELOCITY_RAD_S * 180.0 / np.pi, "i": CURRENT_A}),
            known=Known({}, counts_per_turn=16384.0), truth=both, digits=3),
        "counts, not told": Foreign("a.csv", _text({"t": TIME_S, "enc": COUNTS, "i": CURRENT_A}),
                                    asks="--counts-per-turn"),
        "counts": Foreign("a.csv", _text({"t": TIME_S, "enc": COUNTS, "i": CURRENT_A}),
                          known=Known({}, counts_per_turn=16384.0), digits=3),
        "degrees without a unit": Foreign("a.csv", _text({"t": TIME_S, "pos": DEGREES, "i": CURRENT_A}),
                                          asks=r"goes back and forth .* --take 'pos=position\[deg\]'"),
        "degrees called radians": Foreign("a.csv", _text({
            "time_s": TIME_S, "position_rad": DEGREES, "current_a": CURRENT_A}), asks="goes back and forth"),
        "degrees, said": Foreign("a.csv", _text({"t": TIME_S, "pos": DEGREES, "i": CURRENT_A}),
                                 known=Known(read_said(["pos=position[deg]"]))),
        "duty of 50": Foreign("a.csv", _text({
            "t": TIME_S, "pos_rad": POSITION_RAD, "duty": 50.0 * CURRENT_A, "supply_v": 24.0 + 0.0 * TIME_S}),
            asks=r"possible is -1.05 .. 1.05 1.*--take 'duty=duty\[%\]'"),
        "duty in per cent": Foreign("a.csv", _text({
            "t": TIME_S, "pos_rad": POSITION_RAD, "duty [%]": 50.0 * CURRENT_A, "supply_v": 24.0 + 0.0 * TIME_S}),
            truth={"position_rad": POSITION_RAD, "duty": 0.5 * CURRENT_A}),
        "supply of 24000": Foreign("a.csv", _text({
            "t": TIME_S, "pos_rad": POSITION_RAD, "duty": 0.5 * CURRENT_A, "supply": 24e3 + 0.0 * TIME_S}),
            asks=r"possible is .*--take 'supply=supply\[mV\]'"),
        "duty without a supply": Foreign("a.csv", _text({
            "t": TIME_S, "pos_rad": POSITION_RAD, "pwm": 0.5 * CURRENT_A}), asks="--supply-v"),
        "supply told": Foreign("a.csv", _text({"t": TIME_S, "pos_rad": POSITION_RAD, "pwm": 0.5 * CURRENT_A}),
            known=Known({}, supply_v=12.0), truth={"supply_v": 12.0 + 0.0 * TIME_S, "duty": 0.5 * CURRENT_A}),
        "kelvin": Foreign("a.csv", _text({**renamed("t", "q_rad", "i"), "temp [K]": 300.0 + TIME_S}),
                          truth={**TRUTH, "temperature_c": 26.85 + TIME_S}),
        "wraps at 360": Foreign("a.csv", _text({
            "t": TIME_S, "angle [deg]": np.degrees(10.0 * TURNING_RAD) % 360.0, "i": CURRENT_A + 1.0}),
            truth={"position_rad": 10.0 * TURNING_RAD}),
        "wraps at pi": Foreign("a.csv", _text({
            "t": TIME_S, "angle [rad]": (10.0 * TURNING_RAD + np.pi) % (2.0 * np.pi) - np.pi, "i": CURRENT_A + 1.0}),
            truth={"position_rad": 10.0 * TURNING_RAD}),
        "wraps at 4096 counts": Foreign("a.csv", _text({
            "t": TIME_S, "enc": np.floor(quick / (2.0 * np.pi) * 0.1 * 4096.0) % 4096.0, "i": CURRENT_A + 1.0}),
            known=Known({}, counts_per_turn=4096.0), truth={"position_rad": 0.1 * quick}, digits=2),
        "torque in mNm": Foreign("a.csv", _text({
            "t": TIME_S, "q_rad": POSITION_RAD, "Drehmoment [mNm]": 1e3 * CURRENT_A}),
            truth={"torque_n_m": CURRENT_A}),
        "linear in mm": Foreign("a.csv", _text({
            "t": TIME_S, "Weg [mm]": 100.0 * POSITION_RAD, "Kraft [N]": CURRENT_A}),
            truth={"position_m": 0.1 * POSITION_RAD, "force_n": CURRENT_A}),
        "voltage alone": Foreign("a.csv", _text({"t": TIME_S, "q_rad": POSITION_RAD, "u [V]": CURRENT_A}),
                                 truth={"voltage_v": CURRENT_A}),
        "speed without a position": Foreign("a.csv", _text({
            "t": TIME_S, "Drehzahl [U/min]": VELOCITY_RAD_S * 60.0 / (2.0 * np.pi), "Strom [A]": CURRENT_A}),
            truth={"position_rad": POSITION_RAD - POSITION_RAD[0]}, digits=2),
        "no effort": Foreign("a.csv", _text({"t": TIME_S, "q_rad": POSITION_RAD}), asks="no column is an effort"),
        "two currents": Foreign("a.csv", _text({**renamed("t", "q_rad", "current_1"), "current_2": 2.0 * CURRENT_A}),
                                asks="could each be the current"),
        "set point beside the actual": Foreign("a.csv", _text({
            "t": TIME_S, "Sollwinkel [°]": DEGREES + 1.0, "Istwinkel [°]": DEGREES, "Strom [A]": CURRENT_A,
            "Schleppfehler [°]": 1.0 + 0.0 * TIME_S}), truth={**TRUTH, "target_rad": POSITION_RAD + 1.0 / DEG}),
        "french": Foreign("a.csv", _text(
            renamed("Temps (s)", "Angle (degrés)", "Courant (A)", position=DEG), delimiter=";", decimal=","),
            known=Known(read_said(["Angle (degrés)=position[deg]"]))),
        "camel case": Foreign("a.csv", _text(renamed("elapsedTime", "jointPositionRad", "motorCurrentA"))),
        "names of ROS": Foreign("a.csv", _text({
            "time": TIME_S, "field.position0": POSITION_RAD, "field.velocity0": VELOCITY_RAD_S,
            "field.effort0": CURRENT_A}), truth={"position_rad": POSITION_RAD, "torque_n_m": CURRENT_A}),
    }  # fmt: skip


def _names() -> dict[str, Foreign]:
    """What a name says may be meant otherwise: "current" is now, "measured" is by whom, a unit is of a sensor."""
    motion = {"time": TIME_S, "pos": POSITION_RAD}
    torque = {**TRUTH, "torque_n_m": CURRENT_A}
    torque.pop("current_a")
    both = {**torque, "load_torque_n_m": 0.8 * CURRENT_A}
    measured = {**motion, "measured_torque": CURRENT_A, "commanded_torque": 1.1 * CURRENT_A}
    return {
        "current is present": Foreign("a.csv", _text({
            "time": TIME_S, "current_position": POSITION_RAD, "currentVelocity": VELOCITY_RAD_S, "Current": CURRENT_A}),
            truth={**TRUTH, "velocity_rad_s": VELOCITY_RAD_S}),
        "current is present, by the unit": Foreign("a.csv", _text({
            "time": TIME_S, "Current (deg)": DEGREES, "Current (A)": CURRENT_A})),
        "current of an axis": Foreign("a.csv", _text({**motion, "current_q": CURRENT_A})),
        "current of the supply": Foreign("a.csv", _text({
            **motion, "bus current [A]": 0.3 * CURRENT_A, "current [A]": CURRENT_A})),
        "a torque and its current, by the unit": Foreign("a.csv", _text({
            **motion, "torque current [A]": CURRENT_A})),
        "measured torque alone": Foreign("a.csv", _text({**motion, "torque_measured": CURRENT_A}), truth=torque),
        "measured torque of the motor": Foreign("a.csv", _text({
            **motion, "motor torque measured [Nm]": CURRENT_A, "brake torque [Nm]": 0.8 * CURRENT_A}), truth=both),
        "measured torque beside the motor's": Foreign("a.csv", _text({
            **motion, "measured_torque": 0.8 * CURRENT_A, "motor_torque": CURRENT_A}), truth=both),
        "measured torque beside a command": Foreign("a.csv", _text(measured), asks=(
            r"may be the torque of the motor, or of a sensor at the load: say --take 'measured_torque=torque\[N m\]'")),
        "measured torque beside a current": Foreign("a.csv", _text({
            **motion, "measured_torque": CURRENT_A, "current": CURRENT_A}), asks="or of a sensor at the load"),
        "measured torque beside a command, said": Foreign("a.csv", _text(measured), truth=torque, known=Known(
            read_said(["measured_torque=torque[N m]"]))),
        "a force in volts": Foreign("a.csv", _text({"t": TIME_S, "pos_m": POSITION_RAD, "Force [V]": CURRENT_A}),
            asks=r"says V in its name, which is no unit of force: say --take 'Force \[V\]=force\[N\]' where"),
        "a torque in per cent": Foreign("a.csv", _text({**motion, "torque [%]": CURRENT_A}),
            asks=r"says % in its name, which is no unit of torque"),
        "a torque in per cent, said": Foreign("a.csv", _text({**motion, "torque [%]": CURRENT_A}), truth=torque,
            known=Known(read_said(["torque [%]=torque[N m]"]))),
    }  # fmt: skip


def _stamps() -> dict[str, Foreign]:
    rest = {"position_rad": POSITION_RAD, "current_a": CURRENT_A}
    lines = PLAIN.decode().splitlines(keepends=True)
    swapped = [*lines[:100], lines[101], lines[100], *lines[102:]]
    coarse = {"t [s]": np.floor(TIME_S * 20.0) / 20.0, "q [rad]": POSITION_RAD, "i [A]": CURRENT_A}
    iso = stamps(lambda moment: moment.isoformat(timespec="milliseconds"))
    twice = [*lines, *lines[1:]]
    return {
        "ISO stamps": Foreign("a.csv", _text({"timestamp": iso, **rest})),
        "ISO stamps with Z": Foreign("a.csv", _text({
            "timestamp": stamps(lambda m: m.strftime("%Y-%m-%dT%H:%M:%S.%fZ")), **rest})),
        "german stamps": Foreign("a.csv", _text({
            "Datum": stamps(lambda m: m.strftime("%d.%m.%Y %H:%M:%S,%f")), **rest}, delimiter=";", decimal=",")),
        "american stamps": Foreign("a.csv", _text({
            "Timestamp": stamps(lambda m: m.strftime("%m/%d/%Y %I:%M:%S.%f %p")), **rest})),
        "date and time apart": Foreign("a.csv", _text({
            "Date": stamps(lambda m: m.strftime("%Y-%m-%d")), "Time": stamps(lambda m: m.strftime("%H:%M:%S.%f")),
            **rest})),
        "time of day past midnight": Foreign("a.csv", _text({
            "Time": stamps(lambda m: m.strftime("%H:%M:%S.%f")), **rest})),
        "rate in the preface": Foreign("a.csv", b"Sample rate: 100 Hz\n" + _text(rest)),
        "no time": Foreign("a.csv", _text(rest), asks="--rate-hz"),
        "rate told": Foreign("a.csv", _text(rest), known=Known({}, rate_hz=100.0)),
        "line twice": Foreign("a.csv", "".join([*lines[:100], *lines[99:]]).encode()),
        "lines swapped": Foreign("a.csv", "".join(swapped).encode()),
        "coarse clock": Foreign("a.csv", _text(coarse)),
        "two runs in one file": Foreign("a.csv", "".join(twice).encode(), asks="a second run begins; split the file"),
    }  # fmt: skip


def _bytes(write: Callable[[io.BytesIO], object]) -> bytes:
    buffer = io.BytesIO()
    write(buffer)
    return buffer.getvalue()


def _hdf5(file: io.BytesIO) -> None:
    with h5py.File(file, "w") as made:
        for name, values in GERMAN.items():
            made[f"log/{name}"] = values


def _simulink(file: io.BytesIO, columns: dict[str, np.ndarray]) -> None:
    """A logged signal as MATLAB 7.3 keeps it: a reference to an object, and its bytes among MATLAB's own groups."""
    with h5py.File(file, "w") as made:
        made["out"] = np.arange(6, dtype="u4").reshape(1, 6)
        made["out"].attrs["MATLAB_object_decode"] = 3
        for number in range(5):
            made[f"#sigstream#/{number}/#data#"] = np.zeros(5000, "u1")
        for name, values in columns.items():
            made[name] = values


def _formats() -> dict[str, Foreign]:
    frame = pd.DataFrame(GERMAN)
    struct = {"log": {"time": TIME_S, "angle_deg": DEGREES, "current_a": CURRENT_A, "note": "first"}}
    records = [dict(zip(COLUMNS, map(float, row), strict=True)) for row in zip(*COLUMNS.values(), strict=True)]
    nested = [
        {"t": r["time_s"], "joint": {"position_rad": r["position_rad"], "current_a": r["current_a"]}} for r in records
    ]
    simulink = {"out": {"time": TIME_S, "signals": {"values": np.column_stack([POSITION_RAD, CURRENT_A])}}}
    signals = [
        {"Name": name, "Data": values, "Unit": "", "XIndex": 1.0}
        for name, values in (("Root/angle_rad", POSITION_RAD), ("Root/current_a", CURRENT_A))
    ]
    capture = {"X": {"Name": "", "Data": TIME_S, "Unit": "", "Raster": ""}, "Y": signals, "Description": {"Author": ""}}
    unnamed = {"t": TIME_S, "Y": [{"q_rad": POSITION_RAD}, {"i_a": CURRENT_A}]}
    return {
        "mat, variables": Foreign("a.mat", _bytes(lambda f: savemat(f, {**COLUMNS, "gear": 7.0}))),
        "mat, structure": Foreign("a.mat", _bytes(lambda f: savemat(f, struct))),
        "mat, signals": Foreign("a.mat", _bytes(lambda f: savemat(f, simulink)), known=Known(read_said(
            ["signals.values 1=position[rad]", "signals.values 2=current[A]"]))),
        "mat, a list of signals": Foreign("a.mat", _bytes(lambda f: savemat(f, {"run1": capture})), known=Known(
            read_said(["X.Data=time[s]", "Y.Root/angle_rad.Data=position[rad]", "Y.Root/current_a.Data=current[A]"]))),
        "mat, a list of signals without names": Foreign("a.mat", _bytes(lambda f: savemat(f, unnamed))),
        "mat 7.3, Simulink": Foreign("a.mat", _bytes(lambda f: _simulink(f, {})), asks="holds MATLAB objects .*plain"),
        "mat 7.3, Simulink beside arrays": Foreign("a.mat", _bytes(lambda f: _simulink(f, COLUMNS))),
        "npz": Foreign("a.npz", _bytes(lambda f: np.savez(f, **COLUMNS))),
        "npy, columns": Foreign("a.npy", _bytes(lambda f: np.save(f, np.column_stack(list(COLUMNS.values())))),
                                asks="no column is a position"),
        "npy, records": Foreign("a.npy", _bytes(lambda f: np.save(f, np.rec.fromarrays(
            list(COLUMNS.values()), names=list(COLUMNS))))),
        "npy, objects": Foreign("a.npy", _bytes(lambda f: np.save(f, np.array([{}, {}]))), asks="save plain arrays"),
        "hdf5": Foreign("a.h5", _bytes(_hdf5)),
        "parquet": Foreign("a.parquet", _bytes(frame.to_parquet)),
        "parquet with stamps": Foreign("a.parquet", _bytes(pd.DataFrame({
            "time": pd.to_datetime(1_777_939_198.0 + TIME_S, unit="s"), "position_rad": POSITION_RAD,
            "current_a": CURRENT_A}).to_parquet)),
        "json lines": Foreign("a.jsonl", "\n".join(map(json.dumps, records)).encode()),
        "json, nested": Foreign("a.json", json.dumps(nested).encode()),
        "json, broken": Foreign("a.jsonl", json.dumps(records[0]).encode() + b"\n{", asks="is no JSON"),
        "mat, damaged": Foreign("a.mat", b"MATLAB 5.0 MAT-file" + b"\x07" * 200, asks="is no MATLAB file"),
        "hdf5, damaged": Foreign("a.h5", b"\x89HDF\r\n\x1a\n" + b"\x07" * 99, asks="is no HDF5 file"),
        "parquet, damaged": Foreign("a.parquet", b"PAR1" + b"\x07" * 99, asks="is no Parquet file"),
    }  # fmt: skip


FILES: dict[str, Foreign] = {**_text_files(), **_units(), **_names(), **_stamps(), **_formats()}
