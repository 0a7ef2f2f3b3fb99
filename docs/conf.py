"""Sphinx configuration of the Epicyclic documentation."""

from __future__ import annotations

import sys
from importlib import metadata
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent / "_ext"))

project = "Epicyclic"
author = "The Epicyclic developers"
copyright = author
release = version = metadata.version("epicyclic")

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx.ext.mathjax",
    "sphinx_gallery.gen_gallery",
    "sphinx-mathjax-offline",  # formulas need no network
    "case_keys",
    "figure_labels",
    "module_table",
    "source_pages",
]
exclude_patterns = ["_build", "_ext", "gallery/*.ipynb", "gallery/*.py"]
html_theme = "furo"
html_static_path = ["_static"]
html_css_files = ["formulas.css"]
html_title = f"Epicyclic {release}"

sphinx_gallery_conf = {
    "examples_dirs": "../examples",
    "gallery_dirs": "gallery",
    "image_scrapers": ("figure_scraper.scrape",),
    "min_reported_time": 1,
    "remove_config_comments": True,
    "show_signature": False,
    "within_subsection_order": "FileNameSortKey",
    "write_computation_times": False,
}

myst_enable_extensions = ["amsmath", "dollarmath"]
myst_heading_anchors = 3

autodoc_member_order = "bysource"
autodoc_typehints = "none"  # types stand in the docstrings, with shapes and units
napoleon_google_docstring = False
napoleon_use_rtype = False
# Types in docstrings are words ("mapping of str to float"); only names of this package are checked.
nitpick_ignore_regex = [("py:.*", r"(?!epicyclic\.).*")]
