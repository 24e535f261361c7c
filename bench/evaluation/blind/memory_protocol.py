"""What is recorded of a joint that may remember: ordinary experiments that show rests, starts, reversals and twist."""

from math import pi

from bench.config.configuration import BenchConfiguration
from bench.evaluation.challenge.session import Protocol
from bench.json_types import Value

WAVEFORMS = ("slow-sine", "small-sine", "sweep", "triangles")
BREAKAWAY_SHARE = 0.1  # of the search's ceiling, roughly: ramps reach it in 2, 0.8 and 0.3 s, which are rest, too
RATES_PER_S = (0.5, 1.25, 3.0)
LEAST_RATE_A_S = 0.005
DWELLS_S = (0.0, 1.0, 5.0)
ORDERS = (1, -1, -1, 1)  # of passes: no line and no parabola in time goes with rest or rate (Thue, Morse)
EXCURSION_RAD = 0.15
AMPLITUDES_RAD = (0.5, 0.1, 0.02)
CHIRP_HZ = (0.5, 8.0)
CHIRP_S = 20.0
ACCELERATION_SHARE = 0.8  # of what the bench allows, at the chirp's highest frequency


def memory_protocol(
    configuration: BenchConfiguration, heaviest_kg: float, top_rad_s: float, duration_s: float
) -> Protocol:
    """Excitation, reversals, breakaway ramps there and back through rests and rates, twice, and a chirp with a load.

    Static friction scatters from start to start, so some seventy starts are needed to detect a rise of a fifth.
    """
    motions: dict[str, Value] = {"loads_kg": [0.0, heaviest_kg], "repeats": 1, "waveforms": list(WAVEFORMS)}
    motions |= {"speed_rad_s": round(top_rad_s, 2), "duration_s": duration_s}
    breakaway_a = BREAKAWAY_SHARE * configuration.search.ceiling_a
    rates = [max(round(share * breakaway_a, 4), LEAST_RATE_A_S) for share in RATES_PER_S]
    passes: list[dict[str, Value]] = [
        {"rates_a_s": rates[::order], "dwells_s": list(DWELLS_S[::order])} for order in ORDERS
    ]
    low_hz, high_hz = CHIRP_HZ
    amplitude_rad = ACCELERATION_SHARE * configuration.motion.acceleration_rad_s2 / (2.0 * pi * high_hz) ** 2
    chirp = {"load_kg": heaviest_kg, "amplitude_rad": round(amplitude_rad, 5), "low_hz": low_hz, "high_hz": high_hz}
    return [
        ("excitation", motions),
        ("reversals", {"amplitudes_rad": list(AMPLITUDES_RAD)}),
        *(("breakaway-ramps", {"excursion_rad": EXCURSION_RAD, **ramps}) for ramps in passes),
        ("chirp", {**chirp, "duration_s": CHIRP_S}),
    ]
