"""How Sphinx builds the documents: `make docs`."""

import sys
from pathlib import Path

DOCS = Path(__file__).parent
sys.path.insert(0, str(DOCS.parent))

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


def setup(app):
    """Read docstrings as what they are, before napoleon does."""
    app.connect("autodoc-process-docstring", docstrings.process, priority=100)


pages.write(DOCS / "reference" / "generated")
