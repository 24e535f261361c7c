"""Register maps from TOML files, those that come with the package and those of the user."""

import tomllib
from collections.abc import Mapping
from importlib import resources
from pathlib import Path
from typing import Any

from drivers.contract import Mode
from drivers.modbus.register import Number, Register, Space, Text
from drivers.modbus.register_map import (
    DEMANDS,
    MEASURED,
    WRITE_ONE,
    WRITE_SEVERAL,
    Identity,
    RegisterMap,
    Watchdog,
    Words,
)

MAPS = resources.files("drivers.modbus") / "maps"
_MODE_WORDS = tuple(mode.value for mode in DEMANDS)
Table = dict[str, Any]
"""A table of TOML."""
_SECTIONS = {
    "identity", "control", "mode", "status", "fault", "demand", "measured", "watchdog", "register", "text", "name",
    "source", "low_word_first", "low_byte_first", "read_write", "longest_gap", "limits", "write_function",
}  # fmt: skip


class MapError(ValueError):
    """Raised when a map cannot be used; names the file, the place, what was found and what is wanted."""


def known_maps() -> list[str]:
    """Names of the maps that come with the package."""
    return sorted(item.name.removesuffix(".toml") for item in MAPS.iterdir() if item.name.endswith(".toml"))


def load_map(name: str) -> RegisterMap:
    """A map by name, or by path where the name ends in ".toml".

    Raises:
        MapError: there is none, or it cannot be used.
    """
    if name.endswith(".toml"):
        try:
            return parse_map(Path(name).read_text(encoding="utf-8"), name)
        except OSError as error:
            raise MapError(f"{name}: cannot be read: {error.strerror}") from error
    file = MAPS / f"{name}.toml"
    if name not in known_maps():
        raise MapError(f"there is no register map '{name}'; known are {', '.join(known_maps())}, or give a .toml file")
    return parse_map(file.read_text(encoding="utf-8"), f"map {name}")


def parse_map(text: str, source: str) -> RegisterMap:
    """A map from TOML; `source` is named in errors.

    Raises:
        MapError: what is wrong, and where.
    """
    try:
        values = tomllib.loads(text)
    except (ValueError, RecursionError) as error:  # a number of thousands of digits is a plain ValueError
        raise MapError(f"{source}: is no TOML: {error}") from error
    try:
        return _Reader(values).read()
    except KeyError as error:
        raise MapError(f"{source}: {error.args[0]} is missing") from error
    except (ValueError, TypeError, AttributeError) as error:
        raise MapError(f"{source}: {error}") from error


class _Reader:
    """One file; its errors name the section, the file is named outside."""

    def __init__(self, values: Table) -> None:
        unknown = values.keys() - _SECTIONS
        if unknown:
            raise ValueError(f"{', '.join(sorted(unknown))}: unknown; known are {', '.join(sorted(_SECTIONS))}")
        self._values = values
        self._registers = self._read_registers()

    def read(self) -> RegisterMap:
        values = self._values
        fault = self._section("fault")
        return RegisterMap(
            name=values["name"],
            source=values["source"],
            identity=self._identity(),
            demand=self._demand(),
            measured=self._measured(),
            watchdog=self._watchdog(),
            control=self._words("control", ("off", "quick_stop", "clear_fault", *_MODE_WORDS)),
            mode=self._words("mode", _MODE_WORDS),
            status=self._words("status", ("enabled", "quick_stop", "fault", "torque_off")),
            fault=self._register(fault["register"], "fault") if fault else None,
            fault_names={int(number, 0): name for number, name in fault.get("names", {}).items()},
            fault_is_bits=bool(fault.get("bits", False)),
            read_write=bool(values.get("read_write", False)),
            longest_gap=int(values.get("longest_gap", 0)),
            current_limit=self._current_limit(),
            write_function=self._write_function(),
        )

    def _section(self, name: str) -> Table:
        found: Table = self._values.get(name, {})
        return found

    def _read_registers(self) -> dict[str, Register]:
        found: dict[str, Register] = {}
        for row in self._values["register"]:
            register = self._one_register(dict(row))
            if register.name in found:
                raise ValueError(f"register '{register.name}' is there twice")
            found[register.name] = register
        return found

    def _one_register(self, row: Table) -> Register:
        name = row.pop("name", "")
        place = f"register '{name}'"
        if not name:
            raise ValueError(f"a register at address {row.get('address')} has no name")
        try:
            made = Register(
                name=name,
                space=Space(row.pop("space")),
                address=int(row.pop("address")),
                number=Number[row.pop("type").upper()],
                unit=row.pop("unit", ""),
                scale=float(row.pop("scale", 1.0)),
                offset=float(row.pop("offset", 0.0)),
                low_word_first=self._flag(row, "low_word_first"),
                low_byte_first=self._flag(row, "low_byte_first"),
            )
        except KeyError as error:
            raise ValueError(f"{place}: {error.args[0]} is missing or not known") from error
        row.pop("meaning", None)
        if row:
            raise ValueError(f"{place}: {', '.join(row)}: unknown key")
        if made.scale == 0.0 or not 0 <= made.address <= made.end - 1 <= 0xFFFF:
            raise ValueError(f"{place}: scale {made.scale:g}, address {made.address}; not 0, and 0 .. 65535 are wanted")
        if made.space.is_bits is not (made.number is Number.BIT):
            raise ValueError(f"{place}: a coil or discrete input has type bit, and nothing else has")
        return made

    def _flag(self, row: dict[str, Any], name: str) -> bool:
        """Of the register, or else of the whole map."""
        return bool(row.pop(name, self._values.get(name, False)))

    def _register(self, name: str, place: str) -> Register:
        if name not in self._registers:
            raise ValueError(f"{place} names register '{name}', which is not in the map")
        return self._registers[name]

    def _writable(self, name: str, place: str) -> Register:
        register = self._register(name, place)
        if not register.space.is_writable:
            raise ValueError(f"{place} names register '{name}', which can only be read")
        return register

    def _words(self, section: str, known: tuple[str, ...]) -> Words | None:
        values = dict(self._section(section))
        if not values:
            return None
        register = self._register(values.pop("register"), section)
        mask, bits = int(values.pop("mask", 0xFFFF)), bool(values.pop("bits", False))
        unknown = values.keys() - set(known)
        if unknown:
            raise ValueError(f"{section}: {', '.join(sorted(unknown))}: unknown; known are {', '.join(known)}")
        return Words(register, {name: int(word) for name, word in values.items()}, mask, bits)

    def _demand(self) -> dict[Mode, Register]:
        found = self._parts("demand", DEMANDS_BY_NAME)
        return {DEMANDS_BY_NAME[name]: self._writable(register.name, "demand") for name, register in found.items()}

    def _measured(self) -> dict[str, Register]:
        found = self._parts("measured", dict.fromkeys(MEASURED))
        if "position_counts" not in found:
            raise ValueError("measured: position_counts is missing; no joint is moved without its position")
        return found

    def _parts(self, section: str, known: Mapping[str, Any]) -> dict[str, Register]:
        found = {}
        for part, name in self._values[section].items():
            if part not in known:
                raise ValueError(f"{section}: {part}: unknown; known are {', '.join(known)}")
            found[part] = self._register(name, f"{section}.{part}")
        return found

    def _watchdog(self) -> Watchdog:
        values = self._values["watchdog"]
        fault = int(values["fault"]) if "fault" in values else None
        needs = tuple(
            (self._writable(name, "watchdog.needs"), float(value)) for name, value in values.get("needs", {}).items()
        )
        if "register" in values:
            return Watchdog(self._writable(values["register"], "watchdog"), fault=fault, needs=needs)
        return Watchdog(None, float(values["fixed_s"]), fault, needs)

    def _current_limit(self) -> Register | None:
        values = self._section("limits")
        if unknown := values.keys() - {"current_a"}:
            raise ValueError(f"limits: {', '.join(sorted(unknown))}: unknown; known is current_a")
        return self._writable(values["current_a"], "limits.current_a") if values else None

    def _write_function(self) -> int | None:
        function = self._values.get("write_function")
        if function not in (None, WRITE_ONE, WRITE_SEVERAL):
            raise ValueError(f"write_function is {function}; {WRITE_ONE} or {WRITE_SEVERAL} is wanted, or none")
        return function

    def _identity(self) -> Identity:
        values = self._values["identity"]
        family = None
        if "family" in values:
            family = Words(self._register(values["family"]["register"], "identity"), {"is": values["family"]["is"]})
        optional = {part: self._register(values[part], "identity") for part in ("firmware", "serial") if part in values}
        text = self._text(values["product_text"]) if "product_text" in values else None
        return Identity(values["vendor"], values["product"], family=family, product_text=text, **optional)

    def _text(self, name: str) -> Text:
        for row in self._values.get("text", []):
            if row["name"] == name:
                return Text(name, Space(row["space"]), int(row["address"]), int(row["words"]))
        raise ValueError(f"identity names text '{name}', which is not in the map")


DEMANDS_BY_NAME = {name: mode for mode, name in DEMANDS.items()}
