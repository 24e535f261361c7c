"""A report as one HTML file that needs no network: words, tables, and figures drawn by Plotly's own JavaScript."""

import json
from collections.abc import Sequence
from dataclasses import replace
from html import escape
from pathlib import Path

from plotly.offline import get_plotlyjs

from bench.report.section import Section, Table
from bench.report.wording import spoken

FEW_COLUMNS = 2  # fit on a phone as they are
_CONTENTS_FROM = 3  # sections; fewer are seen at once
_STYLE = """
:root { color-scheme: light dark; --text: #222; --soft: #555; --line: #ccc; --page: #fff; }
@media (prefers-color-scheme: dark) { :root { --text: #e6ebf0; --soft: #a3afbc; --line: #36414d; --page: #11161c; } }
body { font: 16px/1.5 system-ui, sans-serif; max-width: 60rem; margin: 2rem auto; padding: 0 1rem;
  color: var(--text); background: var(--page); }
a { color: inherit; }
.table { overflow-x: auto; }
table { border-collapse: collapse; margin: 1rem 0; font-variant-numeric: tabular-nums; }
caption { text-align: left; font-weight: 600; padding-bottom: .3rem; }
th, td { padding: .15rem .8rem; border-bottom: 1px solid var(--line); text-align: left; }
.number { text-align: right; white-space: nowrap; }
figure { margin: 1.5rem 0; }
figcaption { font-weight: 600; }
.figure { width: 100%; height: 24rem; }
.contents { columns: 2; color: var(--soft); }
@media screen and (max-width: 40rem) {
  .contents { columns: 1; }
  .figure { height: 20rem; }
  /* a row of a table becomes a card: nothing stands outside the screen */
  .wide, .wide tbody, .wide caption { display: block; }
  .wide .head { display: none; }
  .wide tr { display: block; border: 1px solid var(--line); border-radius: 6px; }
  .wide tr { padding: .3rem .6rem; margin-bottom: .5rem; }
  .wide td { display: flex; gap: .2rem .8rem; border: 0; padding: .1rem 0; text-align: left; }
  .wide td::before { content: attr(data-title); color: var(--soft); flex: 0 0 8rem; }
  td { overflow-wrap: anywhere; padding: .15rem .4rem; }
  td:empty { display: none; }
}
@media print {
  :root { --text: #000; --soft: #333; --line: #999; --page: #fff; }
  body { max-width: none; margin: 0; font-size: 10pt; }
  .table { overflow: visible; }
  h2 { break-after: avoid; }
  tr, figure { break-inside: avoid; }
}
"""
_DRAW = """
const dark = matchMedia("(prefers-color-scheme: dark)");
function draw(printing = false) {
  const [colour, grid] = dark.matches && !printing ? ["#e6ebf0", "#36414d"] : ["#222222", "#dddddd"];
  for (const place of document.querySelectorAll(".figure")) {
    const figure = JSON.parse(document.getElementById(place.dataset.from).textContent);
    const look = { ...figure.layout, paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)" };
    look.font = { ...figure.layout.font, color: colour };
    for (const axis of ["xaxis", "yaxis"]) {
      look[axis] = { ...figure.layout[axis], gridcolor: grid, zerolinecolor: colour, automargin: true };
    }
    for (const trace of figure.data) if (trace.type === "bar" && trace.error_y) trace.error_y.color = colour;
    Plotly.react(place, figure.data, look, { responsive: true, displaylogo: false });
  }
}
draw();
dark.addEventListener("change", () => draw());
addEventListener("beforeprint", () => draw(true));
addEventListener("afterprint", () => draw());
"""


def html_page(title: str, sections: Sequence[Section]) -> str:
    """A report as one HTML page."""
    parts = [part for number, section in enumerate(sections) for part in _section(section, number)]
    contents = _contents(sections) if len(sections) >= _CONTENTS_FROM else ""
    return (
        f'<!doctype html>\n<html lang="en"><head><meta charset="utf-8"><title>{escape(title)}</title>\n'
        f'<meta name="viewport" content="width=device-width, initial-scale=1"><style>{_STYLE}</style></head>\n'
        f"<body><h1>{escape(title)}</h1>\n{contents}{''.join(parts)}\n"
        f"<script>{get_plotlyjs()}</script><script>{_DRAW}</script></body></html>\n"
    )


def write_html(path: Path, title: str, sections: Sequence[Section]) -> None:
    """Write a report. The file is complete or not there: it is written beside and then renamed."""
    page = html_page(title, sections)
    path.parent.mkdir(parents=True, exist_ok=True)
    unfinished = path.with_name(f"{path.name}.part")
    unfinished.write_text(page, encoding="utf-8")
    unfinished.replace(path)


def cell_text(value: object) -> str:
    """A cell: short numbers, '-' for nothing."""
    if value is None:
        return "-"
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def _contents(sections: Sequence[Section]) -> str:
    links = [f'<li><a href="#part-{at}">{escape(one.title)}</a></li>' for at, one in enumerate(sections)]
    return f'<nav aria-label="Contents"><ol class="contents">{"".join(links)}</ol></nav>\n'


def _section(section: Section, number: int) -> list[str]:
    parts = [f'<h2 id="part-{number}">{escape(section.title)}</h2>\n']
    parts += [f"<p>{escape(spoken(sentence))}</p>\n" for sentence in section.sentences]
    parts += [_table(table) for table in section.tables]
    for index, figure in enumerate(section.figures):
        name = f"figure-{number}-{index}"
        data = json.dumps(figure.to_plotly(), allow_nan=False).replace("</", "<\\/")
        parts.append(f'<script type="application/json" id="{name}">{data}</script>')
        title = escape(spoken(figure.title))
        parts.append(f"<figure><figcaption>{title}</figcaption>")
        parts.append(f'<div class="figure" data-from="{name}" role="img" aria-label="{title}"></div></figure>\n')
    return parts


def _table(table: Table) -> str:
    """On a narrow screen each row becomes a card, and each cell says its column. A column of nothing is left out."""
    table = _filled(table)
    sides = [' class="number"' if column.endswith("#") else "" for column in table.columns]
    names = [escape(spoken(column.removesuffix("#"))) for column in table.columns]
    head = "".join(f"<th{side}>{name}</th>" for name, side in zip(names, sides, strict=True))
    titles = [f' data-title="{name}"' for name in names]
    rows = "".join(f"<tr>{''.join(_cells(row, sides, titles))}</tr>" for row in table.rows)
    wide = ' class="wide"' if len(names) > FEW_COLUMNS else ""
    caption = f"<caption>{escape(spoken(table.title))}</caption>"
    head = f'<tr class="head">{head}</tr>' if any(names) else ""
    return f'<div class="table" tabindex="0"><table{wide}>{caption}{head}{rows}</table></div>\n'


def _filled(table: Table) -> Table:
    kept = [
        at for at in range(len(table.columns)) if not table.rows or any(row[at] not in (None, "") for row in table.rows)
    ]
    rows = [[row[at] for at in kept] for row in table.rows]
    return replace(table, columns=[table.columns[at] for at in kept], rows=rows)


def _cells(row: Sequence[object], sides: Sequence[str], titles: Sequence[str]) -> list[str]:
    cells = zip(row, sides, titles, strict=True)
    return [f"<td{side}{title}>{escape(spoken(cell_text(value)))}</td>" for value, side, title in cells]
