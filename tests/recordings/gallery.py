"""Pictures of what `explain` makes of recordings: `python -m tests.recordings.gallery FOLDER out/gallery [NAME...]`.

A picture is the head of the report: the error from model to model, and what was measured beside what the first and the
last model predict.
EMPS is a published benchmark and XL330 is under Apache-2.0: their pictures are in the documents. Those of the others
are for whoever has the recordings.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

from tests.browser.browser import browser
from tests.browser.pictures import DRAWN_MS, refuse_large

# paths in the folder of recordings, and options, as docs/explanation/recordings.md has them
SETS = {
    "emps": (["emps"], []),
    "xl330": (["xl330"], []),
    "sts3215": (["sts3215"], []),
    "odrive": (["odrive/slow*_nocomp_*.csv"], ["--counts-per-turn", "8192"]),
    "hsm150": (["hsm150"], []),
}
WIDTH, HEIGHT = 1000, 900


def main() -> None:
    """Explain each set and take its picture.

    Raises:
        SystemExit: a picture has become too large for the repository.
    """
    data, folder, *names = sys.argv[1:]
    Path(folder).mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as scratch, browser() as chromium:
        for name in names or SETS:
            report = explained(Path(data).absolute(), name, Path(scratch))
            page = chromium.new_page(viewport={"width": WIDTH, "height": HEIGHT})
            page.goto(report.as_uri())
            page.wait_for_timeout(DRAWN_MS)
            first, last = (page.locator("figure").nth(number).bounding_box() for number in range(2))
            clip = {**first, "height": last["y"] + last["height"] - first["y"]}
            page.screenshot(path=Path(folder) / f"explain-{name}.png", full_page=True, clip=clip)
    refuse_large(Path(folder))


def explained(data: Path, name: str, scratch: Path) -> Path:
    """The report of a set."""
    patterns, options = SETS[name]
    paths = [str(path) for pattern in patterns for path in sorted(data.glob(pattern))]
    report = scratch / f"{name}.html"
    command = [Path(sys.executable).with_name("friction-bench"), "explain", *paths, *options, "--html", report]
    subprocess.run(command, cwd=scratch, check=True)
    return report


if __name__ == "__main__":
    main()
