from pathlib import Path

from bench.evaluation.blind.pictures import sections_of, write_page
from bench.evaluation.blind.result import LabAnswer, Result, Standing
from bench.evaluation.figures.coverage import Share


def _complete(key: str, p_value: float) -> Result:
    answer = LabAnswer("nothing", (), (), False, p_value, 0.0, 0.02)
    return Result(key, "complete", (), (), (), answer, (), None, 0.02)


def _single(key: str, d_prime: float, first: str) -> Result:
    answer = LabAnswer("missing", (first,), ((first,),), False, 0.001, d_prime, 0.02)
    known = Standing(1.0, d_prime, "", 0.1)
    return Result(key, "single", ("spring",), ("spring",), (1.0,), answer, (known,), None, 0.02)


RESULTS = [
    *(_complete(f"c{number}", 0.03 if number < 2 else 0.7) for number in range(8)),
    _single("s1", 8.0, "spring"),
    _single("s2", 8.0, "spring"),
    _single("s3", 2.5, "cogging"),
]


def test_stated_and_observed_are_drawn_with_their_intervals() -> None:
    stated, names = sections_of(RESULTS, "friction-bench blind")[2].figures
    points = stated.drawn[1]
    shares = dict(zip(points.x, points.y, strict=True))
    assert shares[0.01] == 0.0
    assert shares[0.05] == 0.25
    assert points.high[0] == Share(0, 8).interval()[1]
    assert dict(zip(names.drawn[0].x, names.drawn[0].y, strict=True)) == {2.0: 0.0, 7.0: 1.0}


def test_the_page_says_what_it_was_had_by_and_shows_nothing_that_was_not_measured(tmp_path: Path) -> None:
    page = tmp_path / "blind.html"
    write_page(page, RESULTS, "friction-bench blind --plants 1 --seed 3")
    text = page.read_text()
    assert "friction-bench blind --plants 1 --seed 3" in text
    assert "false alarms, complete models" in text
    assert ">nan<" not in text
