"""How the source tree measures: `python -m tests.house` prints each figure beside its limit.

What is above its limit is marked, and the command ends with 1. `tests/test_house.py` holds the tree to the same limits.
"""

import ast
import re
import subprocess
import sys
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import grimp

from tests.paths import ROOT

PACKAGES = ("bench", "compensator", "drivers", "sim_backend")
SMALL_LINES = 40
SMALL_FILES = 4  # per cent
FILES_A_FOLDER = 20

# One of a kind a file, as the recipes of CONTRIBUTING.md ask for: small for a reason of its own.
OWN_REASON = re.compile(
    r"compensator/lab/effects/|compensator/rivals/|sim_backend/mechanisms/"  # an effect, a compensation, a mechanism
    r"|bench/cli/|/routes/|bench/study/\w+/"  # a command, a route, an answer about a study
    r"|drivers/\w+/(settings|protocol)\.py$|sim_backend/devices/\w+/serve\.py$|bench/drives/|/modes/"  # a kind of drive
    r"|/migrations/|/errors\.py$"
)


class Figure(NamedTuple):
    """One measure of the tree.

    Attributes:
        name: what is measured.
        found: its value.
        limit: the largest value that is allowed; None where there is none.
        examples: where to look.
    """

    name: str
    found: float
    limit: float | None
    examples: tuple[str, ...] = ()

    @property
    def is_kept(self) -> bool:
        """Whether it is within its limit."""
        return self.limit is None or self.found <= self.limit


@dataclass(frozen=True)
class Tree:
    """The files of the product as git knows them, relative to the root."""

    root: Path
    files: tuple[str, ...]

    @classmethod
    def of(cls, root: Path) -> "Tree":
        """The tracked and the new files that are not ignored."""
        words = ["git", "-C", str(root), "ls-files", "--cached", "--others", "--exclude-standard"]
        listed = subprocess.run(words, capture_output=True, text=True, check=True).stdout.split("\n")
        return cls(root, tuple(sorted({name for name in listed if name and (root / name).is_file()})))

    def python(self) -> list[str]:
        """Python files of the product."""
        return [name for name in self.files if name.endswith(".py") and name.split("/")[0] in PACKAGES]

    def text(self, name: str) -> str:
        """The text of a file."""
        return (self.root / name).read_text(encoding="utf-8")

    def lines(self, name: str) -> int:
        """The number of lines of a file."""
        return self.text(name).count("\n")


def figures(root: Path = ROOT) -> list[Figure]:
    """Every figure of the tree."""
    tree = Tree.of(root)
    return [
        crowded_folders(tree),
        small_files(tree),
        longest_chain(),
        untyped_records(tree),
        calls_by_name(tree),
        english_parsed_in_the_page(tree),
        product_lines(tree),
        readme_lines(tree),
        readme_width(tree),
    ]


def crowded_folders(tree: Tree) -> Figure:
    """Folders of the product with more files than a reader takes in at once."""
    sources = [
        name for name in tree.files if re.match(r"(bench|compensator|drivers|sim_backend|web)/.*\.(py|js)$", name)
    ]
    count = Counter(str(Path(name).parent) for name in sources if not name.endswith("__init__.py"))
    crowded = tuple(f"{folder}: {files}" for folder, files in sorted(count.items()) if files > FILES_A_FOLDER)
    return Figure(f"folders with more than {FILES_A_FOLDER} files", len(crowded), 0, crowded)


def small_files(tree: Tree) -> Figure:
    """Files under 40 lines that are not one of a kind, as per cent of all files."""
    all_files = [name for name in tree.python() if not name.endswith(("__init__.py", "__main__.py"))]
    small = tuple(name for name in all_files if tree.lines(name) < SMALL_LINES and not OWN_REASON.search(name))
    return Figure(
        f"files under {SMALL_LINES} lines [%]", round(100 * len(small) / len(all_files), 2), SMALL_FILES, small
    )


def longest_chain() -> Figure:
    """The number of modules on the longest way along imports."""
    graph = grimp.build_graph(*PACKAGES, cache_dir=None)
    imports = {module: graph.find_modules_directly_imported_by(module) for module in graph.modules}
    chain = _longest(imports)
    return Figure("longest import chain", len(chain), 20, tuple(chain))


def _longest(imports: dict[str, set[str]]) -> list[str]:
    """The longest way; a module that is met again ends it."""
    known: dict[str, list[str]] = {}
    under_way: set[str] = set()

    def way_from(module: str) -> list[str]:
        if module in under_way:
            return []
        if module not in known:
            under_way.add(module)
            known[module] = [module, *max((way_from(one) for one in sorted(imports[module])), key=len, default=[])]
            under_way.discard(module)
        return known[module]

    sys.setrecursionlimit(max(sys.getrecursionlimit(), 4 * len(imports)))
    return max((way_from(module) for module in sorted(imports)), key=len)


def untyped_records(tree: Tree) -> Figure:
    """`dict[str, Any]` in annotations."""
    found = Counter({name: tree.text(name).count("dict[str, Any]") for name in tree.python()})
    most = tuple(f"{name}: {count}" for name, count in found.most_common(20) if count)
    return Figure("dict[str, Any]", found.total(), 60, most)


def calls_by_name(tree: Tree) -> Figure:
    """Functions that are looked up by a name which is not a literal, and called on the spot or handed on."""
    found = []
    for name in tree.python():
        text = tree.text(name)
        for node in ast.walk(ast.parse(text)) if "getattr(" in text else ():
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Call) and _is_getattr(node.func):
                found.append(f"{name}:{node.lineno}")
    return Figure("calls by name through getattr", len(found), 0, tuple(found))


def _is_getattr(call: ast.Call) -> bool:
    return isinstance(call.func, ast.Name) and call.func.id == "getattr"


def english_parsed_in_the_page(tree: Tree) -> Figure:
    """Regular expressions of the page that look for English words at the beginning of a sentence."""
    found = [
        f"{name}:{number}"
        for name in tree.files
        if name.startswith("web/") and name.endswith(".js")
        for number, line in enumerate(tree.text(name).split("\n"), 1)
        if re.search(r"/\^?[A-Z][a-z]+ [a-z]+|startsWith\(\"[A-Z][a-z]+ ", line) and not line.lstrip().startswith("//")
    ]
    return Figure("English parsed in the page", len(found), 0, tuple(found))


def product_lines(tree: Tree) -> Figure:
    """Lines of the product: Python, JavaScript, style and markup of the page."""
    kinds = (".py", ".js", ".css", ".html")
    total = sum(
        tree.lines(name) for name in tree.files if name.endswith(kinds) and name.split("/")[0] in (*PACKAGES, "web")
    )
    return Figure("product lines", total, None)


def readme_lines(tree: Tree) -> Figure:
    """Lines of the README."""
    return Figure("README lines", tree.lines("README.md"), 120)


def readme_width(tree: Tree) -> Figure:
    """Characters of the README's longest line."""
    return Figure("README longest line", max(map(len, tree.text("README.md").split("\n"))), 120)


def main() -> int:
    """Print the table; the places of what is above its limit, and with `-v` all. 1 where anything is."""
    found = figures()
    for figure in found:
        limit = "" if figure.limit is None else f"at most {figure.limit:g}"
        mark = "" if figure.is_kept else "   NOT KEPT"
        sys.stdout.write(f"{figure.name:45} {figure.found:>8.6g}   {limit}{mark}\n")
        if "-v" in sys.argv or not figure.is_kept:
            sys.stdout.writelines(f"    {example}\n" for example in figure.examples)
    return int(not all(figure.is_kept for figure in found))


if __name__ == "__main__":
    sys.exit(main())
