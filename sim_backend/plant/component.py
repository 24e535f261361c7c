"""What every component of the plant shares: quantities with units, checked when made."""

from dataclasses import MISSING, dataclass, field, fields
from typing import Any

from sim_backend.errors import ParameterError

# no quantity of a joint in SI is beyond; far within what a float holds, so that no product of a few overflows
SMALLEST, LARGEST = 1e-15, 1e12


def quantity(
    unit: str,
    *,
    above: float | None = None,
    at_least: float | None = None,
    at_most: float | None = None,
    **default: Any,
) -> Any:
    """Return a dataclass field that carries its unit and its allowed range.

    Args:
        unit: SI unit, "1" for a plain number.
        above: the value must be greater than this.
        at_least: the value must not be less than this.
        at_most: the value must not be greater than this.
        default: `default=...`, where the component may do without the quantity.
    """
    return field(
        metadata={"unit": unit, "above": above, "at_least": at_least, "at_most": at_most},
        default=default.get("default", MISSING),
    )


@dataclass(frozen=True, kw_only=True)
class Component:
    """One part of the plant. Refuses values that are not finite, or outside their range."""

    def __post_init__(self) -> None:
        for item in fields(self):
            if "unit" in item.metadata:
                self._check(item.name, item.metadata)

    def _check(self, name: str, range_: Any) -> None:
        value = getattr(self, name)
        if isinstance(value, bool) or not isinstance(value, int | float):
            self.refuse(name, "a finite number is wanted")
        if not abs(value) <= LARGEST:
            self.refuse(name, f"a finite number is wanted, at most {LARGEST:g} in size")
        if range_["above"] is not None and not value > range_["above"]:
            self.refuse(name, f"must be greater than {range_['above']:g}")
        if range_["above"] == 0 and value < SMALLEST:
            self.refuse(name, f"too small to be told from 0; at least {SMALLEST:g} is wanted")
        if range_["at_least"] is not None and not value >= range_["at_least"]:
            self.refuse(name, f"must be at least {range_['at_least']:g}")
        if range_["at_most"] is not None and not value <= range_["at_most"]:
            self.refuse(name, f"must be at most {range_['at_most']:g}")

    def refuse(self, name: str, law: str) -> None:
        """Raise for a parameter of this component.

        Raises:
            ParameterError: always, with component, parameter, value, unit and the law that is broken.
        """
        unit = next(item.metadata["unit"] for item in fields(self) if item.name == name)
        raise ParameterError(f"{type(self).__name__}.{name} = {getattr(self, name)!r} [{unit}]: {law}")
