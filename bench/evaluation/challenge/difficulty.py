"""How hard a challenge is: how much is hidden, how large it is, and how good the recordings are."""

from dataclasses import dataclass

from bench.errors import ParameterError


@dataclass(frozen=True, slots=True)
class Difficulty:
    """One degree of difficulty.

    Attributes:
        counts: chances of zero, one and two mechanisms.
        sizes: the part of each mechanism's range that its size comes from, as shares of it (log).
        noise: of the current measurement, standard deviation as a share of the peak current.
        loads: hung one after the other, as shares of the heaviest.
        duration_s: of one motion.
        repeats: of each motion under each load.
        steps: repeated steps to 90 degrees with the zero-speed search, for what shows at rest alone.
    """

    counts: tuple[float, float, float]
    sizes: tuple[float, float]
    noise: float
    loads: tuple[float, ...]
    duration_s: float
    repeats: int
    steps: int


DIFFICULTIES: dict[str, Difficulty] = {
    "easy": Difficulty((0.15, 0.85, 0.0), (0.7, 1.0), 0.001, (0.0, 0.5, 1.0), 8.0, 2, 6),
    "medium": Difficulty((0.15, 0.6, 0.25), (0.4, 0.9), 0.005, (0.0, 0.5, 1.0), 8.0, 1, 4),
    "hard": Difficulty((0.2, 0.4, 0.4), (0.1, 0.7), 0.02, (0.0, 1.0), 6.0, 1, 0),
}


def find_difficulty(name: str) -> Difficulty:
    """The difficulty of that name.

    Raises:
        ParameterError: naming those there are.
    """
    if name not in DIFFICULTIES:
        raise ParameterError(f"difficulty is '{name}'; allowed is {', '.join(DIFFICULTIES)}")
    return DIFFICULTIES[name]
