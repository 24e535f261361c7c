"""Effects that build on the load that the gear carries, each on that of the model with it.

A model that lacks free play, or a spring, weighs the arm wrongly: its columns take some of what is missing. A formula
that goes by such a load is the worse for it, and by how much depends on the formula. So where two of them are held
against each other, each stands on the load that would be predicted were it the right one (one step of Gauss-Newton).
"""

from dataclasses import replace

from compensator.lab.effects.catalogue import effect_named
from compensator.lab.model.fit import fit_model
from compensator.lab.screening.candidates import Candidates
from compensator.lab.screening.evidence import Block, score_of


def on_own_load(gathered: Candidates) -> Candidates:
    """The candidates, where the evidence pays for two effects or more that build on the load; else as they are."""
    speaking = [name for name in _building_on_load(gathered) if _best(gathered, name)[0] > 0.0]
    if len(speaking) < 2:
        return gathered
    renewed = {name: _renewed(gathered, name) for name in speaking}
    return replace(gathered, named=[renewed.get(block.name, {}).get(block.key, block) for block in gathered.named])


def _building_on_load(gathered: Candidates) -> list[str]:
    return [name for name in dict.fromkeys(b.name for b in gathered.named) if effect_named(name).builds_on == "load"]


def _best(gathered: Candidates, name: str) -> tuple[float, Block]:
    """The best score of an effect's shapes, and the block that has it."""
    scored = [(score_of(gathered.bases, b, gathered.noise), b) for b in gathered.named if b.name == name]
    return max(scored, key=lambda one: one[0])


def _renewed(gathered: Candidates, name: str) -> dict[object, Block]:
    """Every shape's block, on the load of the model with the best one in it."""
    fit, best, effect = gathered.fit, _best(gathered, name)[1], effect_named(name)
    shape = best.key if isinstance(best.key, tuple) else ()
    grown = fit_model(fit.dataset, [*fit.names, name], fit.training, {**fit.shapes, name: shape})
    shapes = effect.shapes(grown.dataset.trials[0].motion)
    made = grown.dataset.columns_of_effects([(effect, shapes)])[0]
    blocks = {block.key: block for block in gathered.named if block.name == name}
    return {
        key: replace(blocks[key], columns=gathered.tested(columns))
        for key, columns in zip(shapes, made, strict=True)
        if key in blocks
    }
