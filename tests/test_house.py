"""The tree keeps to its limits: `python -m tests.house -v` shows where it does not."""

from tests.house import figures


def test_the_tree_keeps_to_its_limits() -> None:
    over = [figure for figure in figures() if figure.limit is not None and figure.found > figure.limit]
    assert over == [], "\n".join(example for figure in over for example in (figure.name, *figure.examples))
