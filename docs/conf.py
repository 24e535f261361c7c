"""How Sphinx builds the documents: `make docs`."""

import sys
from pathlib import Path

DOCS = Path(__file__).parent
sys.path.insert(0, str(DOCS.parent))

from sphinx.addnodes import toctree as toctree_node  # noqa: E402

from bench import __version__  # noqa: E402
from docs.generate import docstrings, pages  # noqa: E402

project = "friction-bench"
version = release = __version__
copyright = "the friction-bench developers, Apache-2.0"  # noqa: A001  Sphinx's name for it
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
exclude_patterns = ["generate/**"]
pygments_style = "friendly"

html_theme = "furo"
html_title = f"friction-bench {__version__}"
html_static_path = ["static"]
html_css_files = ["site.css"]
html_show_sphinx = False

myst_heading_anchors = 3
myst_enable_extensions = ["colon_fence", "attrs_inline"]

smartquotes = False
default_role = "literal"  # a name between single backquotes in a docstring
napoleon_use_ivar = True
suppress_warnings = ["ref.python"]  # two classes may have an attribute of one name
autodoc_typehints = "signature"
autodoc_member_order = "bysource"
python_use_unqualified_type_names = True


def titles_alone(toc):
    """The title of a page and the pages below it, without its sections."""
    toc = toc.deepcopy()
    for entry in toc.children:
        if len(entry) > 1:
            entry[1][:] = list(entry.findall(toctree_node))
    return toc


def navigate_by_titles(app, _page, _template, context, _doctree):
    """Make the tree of all pages, which stands beside each of them, from their titles.

    The theme asks for no more, but for each page Sphinx would copy every section and every member of all of them first:
    a third of the time of a build.
    """
    env, whole = app.env, context.get("toctree")
    if whole is None:
        return
    if not hasattr(env, "titles_of_tocs"):
        env.titles_of_tocs = {name: titles_alone(toc) for name, toc in env.tocs.items()}

    def tree(titles_only=False, **how):
        tocs = env.tocs
        env.tocs = env.titles_of_tocs if titles_only else tocs
        try:
            return whole(titles_only=titles_only, **how)
        finally:
            env.tocs = tocs

    context["toctree"] = tree


def setup(app):
    """Read docstrings as what they are, before napoleon does; have what the theme asks for ready before it asks."""
    app.connect("autodoc-process-docstring", docstrings.process, priority=100)
    app.connect("html-page-context", navigate_by_titles, priority=100)


pages.write(DOCS / "reference" / "generated")
