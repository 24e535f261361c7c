"""What the paper shows, as numbers (Saini, Sarkar, Datta Ray 2013). Read off its figures where it gives no table."""

TABLE_1_G = {
    0: -0.36, 10: 8.90, 20: 19.09, 30: 27.27, 40: 41.63, 50: 51.27, 60: 59.27, 70: 69.27, 80: 81.63, 90: 90.54,
    100: 100.54,
}  # fmt: skip
"""Actual load [g] -> reflected load [g]. At 90 degrees, as Fig. 8 says; the caption says 0."""

FIG_2 = {"speed_at_500_ma_rpm": 2000.0}
FIG_3 = {"duty_at_1200_rpm_lightest": 0.4}
"""About 400 counts, taken as counts of 1000."""
FIG_4 = {"lowest_ma": 100.0, "highest_ma": 850.0, "spread_ma": 750.0}
FIG_7 = {"largest_uncompensated_ma": 300.0, "largest_compensated_ma": 0.0}
FIG_9 = {"lowest_ma": -100.0, "highest_ma": 900.0}
