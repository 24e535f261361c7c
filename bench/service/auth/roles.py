"""Roles and who holds them. Each role may do what the one before may."""

from dataclasses import dataclass
from enum import StrEnum
from functools import total_ordering


@total_ordering
class Role(StrEnum):
    """What a token is good for.

    - viewer: reads, and stops the joint
    - operator: starts and answers experiments, changes studies, calibrations and what is imported
    - admin: takes over the bench, reads the audit log
    """

    VIEWER = "viewer"
    OPERATOR = "operator"
    ADMIN = "admin"

    def __lt__(self, other: str) -> bool:
        order = list(Role)
        return order.index(self) < order.index(Role(other))


@dataclass(frozen=True, slots=True)
class Caller:
    """Whose token came with a request.

    Attributes:
        name: of the token.
        role: of the token.
    """

    name: str
    role: Role
