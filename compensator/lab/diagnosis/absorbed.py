"""What a model's own offset may be: friction that differs by direction hides in it, and is missing in no residual."""

from collections.abc import Collection, Sequence

from compensator.lab.diagnosis.note import Note, Value
from compensator.lab.effects.catalogue import effect_named
from compensator.lab.effects.effect import Effect
from compensator.lab.model.fitted import Fit
from compensator.lab.model.intervals import estimates

OFFSET = "offset"
LEAST_SHARE = 0.05  # of dry friction: a current sensor's zero, or a mount that is not level, makes less


def absorbed(fit: Fit, left_out: Collection[str]) -> list[Note]:
    """A note for each effect that the offset hides, where the offset is surely not zero, and not small.

    Args:
        fit: of the model.
        left_out: effects that cannot be judged.
    """
    offset = next((one for one in estimates(fit) if one.effect == OFFSET), None)
    friction = fit.dry_friction if any(one.effect.name == "coulomb" and one.kept[0] for one in fit.terms) else 0.0
    if offset is None or friction <= 0.0 or not (offset.low > 0.0 or offset.high < 0.0):
        return []
    share = abs(offset.value) / friction
    if share < LEAST_SHARE:
        return []
    hidden = [one for one in map(effect_named, left_out) if OFFSET in one.hidden_by]
    # what pulls towards a rest position pulls at the zero of the position, too, unless it rests there
    springs = [one for one in fit.effects if one.by_position and OFFSET in one.confused_with]
    return [_note(one, springs, offset.value, offset.unit, share) for one in hidden]


def _note(effect: Effect, springs: Sequence[Effect], value: float, unit: str, share: float) -> Note:
    values: dict[str, Value] = {"effect": effect.name, "offset": value, "unit": unit, "share": share}
    constant = ""
    if springs:
        values["constant_part_of"] = springs[0].name
        constant = (
            f"the constant part of the model's {springs[0].in_sentence}, whose rest is then not at position zero, or "
        )
    text = (
        f"The model's offset, {value:.3g} {unit}, is {share:.0%} of dry friction: it may as well be {constant}"
        f"{effect.in_sentence}, which these trials cannot tell from it; {effect.excited_by} would."
    )
    return Note("absorbed", text, values)
