"""Shapes between those scanned, of effects that build on the load that the gear carries.

What swings or flies differs much from one shape of a scan to the next: between them both the evidence may be twice as
strong and the share of the load one that can be. So the best shape is looked for between those scanned, too.
"""

from dataclasses import replace

import numpy as np

from compensator.lab.effects.catalogue import effect_named
from compensator.lab.effects.effect import Shape
from compensator.lab.model.shape_search import REFINEMENTS, between, power_within
from compensator.lab.screening.base import Block
from compensator.lab.screening.candidates import Candidates
from compensator.lab.screening.evidence import score_of


def with_shapes_between(gathered: Candidates) -> Candidates:
    """The candidates, and the best shape between those scanned of every effect of the load whose evidence pays."""
    names = dict.fromkeys(block.name for block in gathered.named if effect_named(block.name).builds_on == "load")
    own = {name: [block for block in gathered.named if block.name == name] for name in names}
    speaking = [blocks for blocks in own.values() if any(_pays(gathered, block) for block in blocks)]
    return replace(gathered, named=[*gathered.named, *(_between(gathered, blocks) for blocks in speaking)])


def _pays(gathered: Candidates, block: Block) -> bool:
    return score_of(gathered.bases, block, gathered.noise) > 0.0


def _between(gathered: Candidates, own: list[Block]) -> Block:
    """The block of the best shape between an effect's own; it pays for every shape tried.

    The best is what explains most in a shape, and with a share of the load, that can be.
    """
    effect, dataset = effect_named(own[0].name), gathered.fit.dataset
    [bounds] = effect.ranges_in(dataset.effort_definition.quantity)
    scanned = own[0].scanned + REFINEMENTS

    def block_of(shape: Shape) -> Block:
        columns = dataset.unchecked_columns(effect, [shape])[0]
        return replace(own[0], columns=gathered.tested(columns), scanned=scanned, shape=shape)

    def power(block: Block) -> float:
        if not effect.searched(block.shape):
            return -np.inf
        base = gathered.bases[block.base]
        column = block.columns[:, 0]
        return power_within(base.beyond(column), base.residual, bounds)

    start = max(own, key=power).shape
    return block_of(between([block.shape for block in own], start, lambda shape: -power(block_of(shape))))
