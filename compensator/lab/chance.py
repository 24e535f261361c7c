"""How a chance is stated: never smaller than what signs flipped at random can know."""

SIGNIFICANT = 0.01  # p-value up to which a finding is taken for no luck

SIGN_FLIPS = 999
LEAST_STATED = 1.0 / (1.0 + SIGN_FLIPS)
"""No flip of 999 did as well: the chance is this at most. Tails of F and chi-squared go on."""


def stated(p_value: float) -> float:
    """A chance as it is told to people and programs: `LEAST_STATED` stands for that and less."""
    return max(p_value, LEAST_STATED)


def chance_in_words(p_value: float) -> str:
    """`p = 0.02`, or `p <= 0.001`."""
    return f"p {chance_cell(p_value) if p_value <= LEAST_STATED else f'= {p_value:.3g}'}"


def chance_cell(p_value: float | None) -> str:
    """The same for a table: `0.02`, `<= 0.001`, or `-` where none is known."""
    if p_value is None or p_value != p_value:  # NaN is not itself
        return "-"
    return f"<= {LEAST_STATED:g}" if p_value <= LEAST_STATED else f"{p_value:.3g}"
