"""The comparison as JUnit XML, for a CI server, and as sections of an HTML report."""

from collections.abc import Sequence
from pathlib import Path
from xml.etree import ElementTree as Xml

from bench.evaluation.bench_report.comparison import FAMILY_RATE, Line
from bench.report.section import Section, Table

BAD = ("worse", "changed", "failed")
COLUMNS = ("metric", "before#", "now#", "change#", "interval from#", "to#", "p (worse)#", "verdict")
EXPLANATION = (
    f"A metric is called worse where an exact permutation test over the seeds says so; those of which neither way is "
    f"better are called changed. The chance that any of them is, although nothing has changed, is at most "
    f"{FAMILY_RATE:.0%}."
)


def is_bad(lines: Sequence[Line]) -> bool:
    """Whether any metric is worse, or could not be measured."""
    return any(line.verdict in BAD for line in lines)


def cells(line: Line) -> tuple[object, ...]:
    """A row of the table."""
    numbers = (line.before, line.now, line.change, line.low, line.high, line.p_worse)
    return (line.metric.name, *numbers, line.verdict)


def sections(lines: Sequence[Line]) -> list[Section]:
    """For the HTML report."""
    title = "Worse than before" if is_bad(lines) else "As before, or better"
    sentences = [EXPLANATION, *(f"{line.metric.title}: {line.sentence}." for line in lines)]
    return [Section(title, sentences, [Table("Before and now", COLUMNS, [cells(line) for line in lines])])]


def write_junit(path: Path, lines: Sequence[Line], took_s: float) -> None:
    """One test case per metric; what is worse or was not measured is a failure."""
    bad = sum(line.verdict in BAD for line in lines)
    counts = {"tests": str(len(lines)), "failures": str(bad), "errors": "0", "time": f"{took_s:.3f}"}
    root = Xml.Element("testsuites", counts)
    suite = Xml.SubElement(root, "testsuite", {"name": "bench-report", **counts})
    for line in lines:
        case = Xml.SubElement(suite, "testcase", {"classname": "bench-report", "name": line.metric.name})
        if line.verdict in BAD:
            message = f"{line.metric.title}: {line.sentence}"
            Xml.SubElement(case, "failure", {"type": line.verdict, "message": message}).text = message
        else:
            Xml.SubElement(case, "system-out").text = line.sentence
    path.parent.mkdir(parents=True, exist_ok=True)
    Xml.ElementTree(root).write(path, encoding="utf-8", xml_declaration=True)
