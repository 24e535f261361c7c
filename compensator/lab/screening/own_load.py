"""Effects that build on the load that the gear carries, each on that of the model with it.

A model that lacks free play, or a spring, weighs the arm wrongly: its columns take some of what is missing. A formula
that goes by such a load is the worse for it, and by how much depends on the formula. So where two of them are held
against each other, each stands on the load that would be predicted were it the right one (one step of Gauss-Newton).

What swings or flies differs much from one shape of a scan to the next: between them both the evidence may be twice as
strong and the share of the load one that can be. So the best shape is looked for between those scanned, too.
"""

from dataclasses import replace

from compensator.lab.effects.catalogue import effect_named
from compensator.lab.effects.effect import Shape
from compensator.lab.model.fit import fit_model, fit_sliding
from compensator.lab.model.fitted import Fit
from compensator.lab.model.shape_search import REFINEMENTS, between, power_within
from compensator.lab.rows.dataset import Dataset
from compensator.lab.screening.base import Block
from compensator.lab.screening.candidates import Candidates
from compensator.lab.screening.evidence import score_of


def on_own_load(gathered: Candidates) -> Candidates:
    """The candidates with the best shape between those scanned, of effects that build on the load and that speak.

    Where the evidence pays for two of them or more, each on its own load.
    """
    speaking = [name for name in _building_on_load(gathered) if _best(gathered, name)[0] > 0.0]
    loads = dict.fromkeys(speaking, gathered.fit.dataset)
    if len(speaking) > 1:
        fit = gathered.fit
        sliding = fit_sliding(fit.dataset, fit.names, fit.training, fit.shapes)
        loads = {name: _with_best(gathered, name, sliding) for name in speaking}
        renewed = {name: _renewed(gathered, name, dataset) for name, dataset in loads.items()}
        named = [renewed.get(block.name, {}).get(block.key, block) for block in gathered.named]
        gathered = replace(gathered, named=named)
    between_scanned = [_between_scanned(gathered, name, dataset) for name, dataset in loads.items()]
    return replace(gathered, named=[*gathered.named, *between_scanned])


def _building_on_load(gathered: Candidates) -> list[str]:
    return [name for name in dict.fromkeys(b.name for b in gathered.named) if effect_named(name).builds_on == "load"]


def _best(gathered: Candidates, name: str) -> tuple[float, Block]:
    """The best score of an effect's shapes, and the block that has it."""
    scored = [(score_of(gathered.bases, b, gathered.noise), b) for b in gathered.named if b.name == name]
    return max(scored, key=lambda one: one[0])


def _with_best(gathered: Candidates, name: str, sliding: Fit) -> Dataset:
    """The dataset with the load that a model with the effect's best shape in it predicts."""
    fit, best = gathered.fit, _best(gathered, name)[1]
    return fit_model(fit.dataset, [*fit.names, name], fit.training, {**fit.shapes, name: best.shape}, sliding).dataset


def _renewed(gathered: Candidates, name: str, dataset: Dataset) -> dict[object, Block]:
    """Every shape's block, on the load of a dataset."""
    effect = effect_named(name)
    shapes = effect.shapes(dataset.trials[0].motion)
    made = dataset.columns_of_effects([(effect, shapes)])[0]
    blocks = {block.key: block for block in gathered.named if block.name == name}
    return {
        key: replace(blocks[key], columns=gathered.tested(columns))
        for key, columns in zip(shapes, made, strict=True)
        if key in blocks
    }


def _between_scanned(gathered: Candidates, name: str, dataset: Dataset) -> Block:
    """The block of the best shape between those scanned, on the load of a dataset; it pays for every shape tried.

    The best is what explains most with a share of the load that can be.
    """
    effect = effect_named(name)
    [bounds] = effect.ranges_in(dataset.effort_definition.quantity)
    own = [block for block in gathered.named if block.name == name]
    scanned = own[0].scanned + REFINEMENTS

    def block_of(shape: Shape) -> Block:
        columns = dataset.unchecked_columns(effect, [shape])[0]
        return replace(own[0], columns=gathered.tested(columns), scanned=scanned, key=shape)

    def power(block: Block) -> float:
        base = gathered.bases[block.base]
        column = block.columns[:, 0]
        return power_within(column - base.basis @ (base.basis.T @ column), base.residual, bounds)

    start = max(own, key=power).shape
    return block_of(between([block.shape for block in own], start, lambda shape: -power(block_of(shape))))
