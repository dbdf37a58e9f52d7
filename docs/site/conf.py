# SPDX-License-Identifier: Apache-2.0
"""Sphinx's configuration. scripts/site builds the site; it says here where what it made lies."""

import os
import pathlib
import re
import warnings

BUILD = pathlib.Path(os.environ["CADT_SITE_BUILD"])
ROOT = pathlib.Path(os.environ["CADT_SITE_ROOT"])

project = "cadt"
author = "the authors of cadt"
copyright = author
release = re.search(r'CADT_VERSION "([^"]+)"', (ROOT / "include/cadt/version.hpp").read_text()).group(1)
version = release

root_doc = "site/index"
extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.intersphinx",
    "sphinx.ext.mathjax",
    "numpydoc",
    "breathe",
    "sphinx_copybutton",
    "sphinx_design",
    "sphinx_gallery.gen_gallery",
]
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}
exclude_patterns = ["site/tools", "site/gallery"]
nitpicky = True
nitpick_ignore_regex = [  # of other libraries, and what the interface names without showing it
    ("py:class", r"cadt\._cadt\..*"),
    ("c:identifier", r"u?int\d+_t|size_t"),
    ("cpp:identifier", r"std(::.*)?|u?int\d+_t|size_t|.*Data|.*State|cadt|detail(::.*)?"),
]
# Two constructors of PointsView differ in their `requires` alone, which Doxygen does not hand on.
suppress_warnings = ["duplicate_declaration.cpp"]

# Markdown as GitHub shows it: the same names for headings, the same links.
myst_enable_extensions = ["colon_fence", "deflist", "attrs_inline"]
myst_heading_anchors = 4

# C++ and C, from Doxygen's XML
breathe_projects = {"cadt": str(BUILD / "doxygen/xml")}
breathe_default_project = "cadt"
breathe_domain_by_extension = {"hpp": "cpp", "h": "c"}
breathe_show_include = False
cpp_id_attributes = ["CADT_API"]
c_id_attributes = ["CADT_API"]

# Python
default_role = "code"  # `name` in docstrings
autodoc_member_order = "bysource"
autodoc_typehints = "none"
numpydoc_show_class_members = False
intersphinx_mapping: dict[str, tuple[str, str | None]] = {}

# The gallery
warnings.filterwarnings("ignore", message="FigureCanvasAgg is non-interactive")
sphinx_gallery_conf = {
    "examples_dirs": str(BUILD / "source/docs/site/gallery"),
    "gallery_dirs": str(BUILD / "source/docs/site/examples"),
    "filename_pattern": r"\.py$",
    "image_scrapers": ("matplotlib",),
    "matplotlib_animations": False,
    "abort_on_example_error": True,
    "min_reported_time": 1,
    "show_memory": False,
    "show_signature": False,
    "download_all_examples": False,
    "remove_config_comments": True,
    "within_subsection_order": "FileNameSortKey",
    "plot_gallery": os.environ.get("CADT_SITE_GALLERY", "1") == "1",
}

html_theme = "pydata_sphinx_theme"
html_title = "cadt"
html_static_path = [str(ROOT / "docs/site/_static")]
html_css_files = ["cadt.css"]
html_extra_path = [str(ROOT / "docs/site/redirect")]
html_show_sourcelink = False
html_sidebars = {f"site/{page}": [] for page in ("index", "install", "choosing_a_back_end", "guarantees")}
html_theme_options = {
    "navbar_align": "left",
    "header_links_before_dropdown": 7,
    "show_toc_level": 2,
    "navigation_with_keys": False,
    "footer_start": ["copyright"],
    "footer_end": [],
    "secondary_sidebar_items": ["page-toc"],
}
