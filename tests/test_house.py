"""The tree keeps to its limits: `python -m tests.house -v` shows where it does not."""

import pytest

from tests.house import Figure, figures

FIGURES = [figure for figure in figures() if figure.limit is not None]


@pytest.mark.parametrize("figure", FIGURES, ids=lambda figure: figure.name)
def test_the_tree_keeps_to_its_limits(figure: Figure) -> None:
    assert figure.limit is not None
    assert figure.found <= figure.limit, "\n".join(figure.examples)
