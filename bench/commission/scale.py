"""Counts of a joint turn from an angle seen, and what of gear ratio and encoder counts fits them."""

from dataclasses import dataclass
from math import pi, radians

from bench.commission.questions import GEAR_RATIO, CommissionError, Known

LEAST_COUNTS = 200.0  # between the two positions of the arm
EYE_RAD = radians(3.0)  # how well an angle is seen
AGREES_SHARE = 0.08  # of the counts of a joint turn; a level arm is seen to 3 of 90 degrees, and so is "straight down"
QUADRATURE = (4.0, 0.25)  # lines taken for counts, and the other way round
FITS_SHARE = 0.1
LEAST_RATIO = (1.0 - FITS_SHARE) * GEAR_RATIO.least  # seen by eye; an arm that nobody turned, and that swings, has less


@dataclass(frozen=True, slots=True)
class Scale:
    """How counts become joint angles.

    Attributes:
        gear_ratio, counts_per_turn: their product is what was measured, or what is known exactly and agrees with it.
        encoder_sign: 1 where the count rises with the angle.
        zero_counts: count while the arm hangs straight down.
        low, high: ends of what the seen angle allows for the product.
        sentence: what was corrected, and why; "" where nothing was.
    """

    gear_ratio: float
    counts_per_turn: float
    encoder_sign: int
    zero_counts: float
    low: float
    high: float
    sentence: str = ""

    @property
    def count_rad(self) -> float:
        """Joint angle of a count [rad]."""
        return 2.0 * pi / (self.gear_ratio * self.counts_per_turn)

    @property
    def zero_rad(self) -> float:
        """What `drive.zero_rad` has to be [rad]."""
        return self.encoder_sign * self.zero_counts * self.count_rad


def scale_of(down_counts: float, turned_counts: float, angle_rad: float, known: Known, told_by_drive: float) -> Scale:
    """The scale from two positions of the arm.

    Args:
        down_counts: hanging straight down.
        turned_counts: turned by hand to the angle.
        angle_rad: as it was seen, towards positive angles.
        known: what the person says of ratio and counts.
        told_by_drive: counts of a motor turn by the drive's own objects; NaN where it tells none.

    Raises:
        CommissionError: the count did not move, or less than any gear lets it.
    """
    way = turned_counts - down_counts
    if abs(way) < LEAST_COUNTS:
        raise CommissionError(
            f"the count moved by {way:.0f} only while the arm was turned by {angle_rad:.2f} rad; at least "
            f"{LEAST_COUNTS:.0f} are wanted. Is the encoder plugged in and powered, and does the motor turn with the "
            "arm (a clutch, a worm gear, a brake)?"
        )
    per_turn = abs(way) / angle_rad * 2.0 * pi
    ends = sorted(abs(way) / (angle_rad + side * EYE_RAD) * 2.0 * pi for side in (-1.0, 1.0))
    ratio, counts, sentence = _shared_out(per_turn, known, told_by_drive)
    if ratio < LEAST_RATIO:
        raise CommissionError(
            f"gear.ratio is {ratio:.2g} by a count that moved by {way:.0f} while the arm was turned by "
            f"{angle_rad:.2f} rad; allowed is at least {GEAR_RATIO.least:g}. Was the arm turned so far, and is "
            f"sensor.counts_per_turn {counts:g}? Correct what is wrong, then start again"
        )
    return Scale(ratio, counts, 1 if way > 0.0 else -1, down_counts, ends[0], ends[1], sentence)


def _shared_out(per_turn: float, known: Known, told_by_drive: float) -> tuple[float, float, str]:
    """Gear ratio and counts of a motor turn whose product is the counts of a joint turn; what was corrected."""
    ratio, counts, said = known.gear_ratio, known.counts_per_turn, []
    if told_by_drive == told_by_drive:  # not NaN
        if counts is not None and counts != told_by_drive:
            said.append(f"sensor.counts_per_turn is {told_by_drive:g} by the drive itself, not {counts:g}")
        counts = told_by_drive
    if ratio is None and counts is None:
        said.append("gear.ratio is not known: it is left at 1, and motor constants are those at the joint")
        return 1.0, per_turn, "; ".join(said)
    if ratio is None or counts is None:
        whole = per_turn / (ratio or counts or 1.0)
        return (ratio, whole, "") if ratio is not None else (whole, counts or whole, "; ".join(said))
    excess = per_turn / (ratio * counts)
    if abs(excess - 1.0) <= AGREES_SHARE:
        return ratio, counts, "; ".join(said)
    fits = [factor for factor in QUADRATURE if abs(excess / factor - 1.0) <= FITS_SHARE]
    if fits and told_by_drive != told_by_drive:
        said.append(
            f"sensor.counts_per_turn is {counts * fits[0]:g}, not {counts:g}: counts are four per line of the encoder"
        )
        return ratio, counts * fits[0], "; ".join(said)
    said.append(f"gear.ratio is {per_turn / counts:.3g} by the angle that was seen, not {ratio:g}")
    return per_turn / counts, counts, "; ".join(said)
