"""The catalogue of effects, from the effects themselves."""

import math

from latex2mathml.converter import convert

from compensator.lab.effects.catalogue import catalogue
from compensator.lab.effects.effect import Effect, Parameter
from docs.generate.markdown import anchor, code, table

BEGIN = """\
# Catalogue of effects

Each is one physical mechanism that a model can contain. `friction-bench effects` prints the same list, with the effects
of installed packages. "effort" and "position" stand for the units of the study: N m and rad for the torque of a rotary
joint, A and rad for its motor current, N and m for a linear joint.

"""
ROWS = {
    "sliding": "rows in which the joint slides",
    "moving": "rows in motion, near reversals too",
    "breakaway": "starts from rest",
}


def page() -> str:
    """The page: a table of all effects, then each of them."""
    effects = list(catalogue().values())
    overview = table(
        ("effect", "what it is", "driven by"),
        [(f"[{code(one.name)}](#effect-{one.name})", one.title, code(one.driver)) for one in effects],
    )
    return BEGIN + overview + "\n" + "\n".join(map(section, effects))


def section(effect: Effect) -> str:
    """One effect."""
    facts = [
        ("Name", code(effect.name)),
        ("Residuals are plotted against", code(effect.driver)),
        ("Shown by", effect.excited_by),
        ("Judged on", ROWS[effect.rows]),
        ("Shape, scanned", ", ".join(effect.shape_names)),
        ("Channels needed", ", ".join(map(code, effect.channels))),
        ("Must differ between trials", code(effect.varies_with or "")),
        ("Facts of the rig needed", ", ".join(map(code, effect.facts))),
        ("Often confused with", ", ".join(f"[{code(one)}](#effect-{one})" for one in effect.confused_with)),
        ("Part of the measuring chain", "yes: reported apart from effects of the joint" if effect.pipeline else ""),
        ("Source", effect.source),
    ]
    listed = "\n".join(f"- {name}: {value}" for name, value in facts if value)
    equation = f"<p>{convert(effect.equation, display='block')}</p>"
    parameters = table(("coefficient", "unit", "allowed"), map(_parameter, effect.parameters))
    return (
        f"{anchor(f'effect-{effect.name}')}\n## {effect.title}\n\n{effect.physics}\n\n{equation}\n\n{listed}\n\n"
        f"{parameters}"
    )


def _parameter(parameter: Parameter) -> tuple[str, str, str]:
    low, high = parameter.low, parameter.high
    parts = [f"at least {low:g}" if math.isfinite(low) else "", f"at most {high:g}" if math.isfinite(high) else ""]
    return parameter.name, code(parameter.unit_in("effort", "position")), ", ".join(filter(None, parts)) or "any"
