"""Checks the built pages: `python -m docs.generate.site out/docs`.

Every link inside the site leads to a page and to a place on it, and nothing is loaded from elsewhere.
"""

import sys
from dataclasses import dataclass, field
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

LOADED = {"script": "src", "img": "src", "iframe": "src", "source": "src", "link": "href"}


@dataclass
class Page(HTMLParser):
    """What one page links to, loads, and can be linked at."""

    links: list[str] = field(default_factory=list)
    loaded: list[str] = field(default_factory=list)
    places: set[str] = field(default_factory=set)

    def __post_init__(self) -> None:
        super().__init__()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Keep what matters of one element."""
        found = {name: value for name, value in attrs if value}
        self.places |= {found[name] for name in ("id", "name") if name in found}
        if tag == "a" and "href" in found:
            self.links.append(found["href"])
        if tag in LOADED and LOADED[tag] in found:
            self.loaded.append(found[LOADED[tag]])


def read(folder: Path) -> dict[Path, Page]:
    """Every page of a site, by its file."""
    pages = {}
    for file in sorted(folder.rglob("*.html")):
        pages[file.resolve()] = Page()
        pages[file.resolve()].feed(file.read_text(encoding="utf-8"))
    return pages


def problems(folder: Path) -> list[str]:
    """Links that lead nowhere, and what would be loaded from another host; one sentence each."""
    pages = read(folder)
    found = [] if pages else [f"{folder}: no page is there; build the documents first"]
    for file, page in pages.items():
        name = file.relative_to(folder.resolve())
        found += [f"{name}: loads {url} from elsewhere" for url in page.loaded if _host(url)]
        for url in [*page.links, *(one for one in page.loaded if not _host(one))]:
            if problem := _problem(file, url, pages):
                found.append(f"{name}: {url}: {problem}")
    return found


def _host(url: str) -> bool:
    parts = urlsplit(url)
    return bool(parts.netloc) or parts.scheme in ("http", "https")


def _problem(file: Path, url: str, pages: dict[Path, Page]) -> str:
    """What is wrong with a link; "" where nothing is, or where it leads out of the site."""
    parts = urlsplit(url)
    if parts.scheme or parts.netloc:
        return ""
    target = (file.parent / unquote(parts.path)).resolve() if parts.path else file
    if not target.is_file():
        return "there is no such file"
    if parts.fragment and target in pages and unquote(parts.fragment) not in pages[target].places:
        return "there is no such place on that page"
    return ""


def main() -> None:
    """Print what is wrong; exit code 1 where anything is."""
    found = problems(Path(sys.argv[1]))
    sys.exit("\n".join(found) if found else 0)


if __name__ == "__main__":
    main()
