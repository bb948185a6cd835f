"""Sphinx builds the site of these pages: ``make docs``."""

import sys
from pathlib import Path

import carom

HERE = Path(__file__).parent
# Gallery scripts describe the cases of examples/, and draw them with gallery/pictures.py.
sys.path[:0] = [str(HERE), str(HERE.parent / "examples"), str(HERE / "gallery")]

project = "carom"
author = "the authors of carom"
version = release = carom.__version__

extensions = [
    "mathml",  # this and the next: beside this file
    "subscripts",
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.napoleon",
    "sphinx_gallery.gen_gallery",
    "sphinxcontrib.bibtex",
]
html_theme = "furo"
html_math_renderer = "mathml"
html_static_path = ["static"]
html_css_files = ["site.css"]
html_show_copyright = False
html_title = f"carom {release}"
html_theme_options = {
    # Of WCAG's contrast for text, on the ground of the page and of what is pointed at.
    "light_css_variables": {"color-brand-primary": "#0b5fa5", "color-brand-content": "#0b5fa5"},
    "dark_css_variables": {"color-brand-primary": "#7db8f0", "color-brand-content": "#7db8f0"},
}
exclude_patterns = [
    "decisions",
    "gallery",
    "gallery-pages/**/*.ipynb",
    "images",
    # Of an earlier build, as are pages of scripts with other names.
    "sg_execution_times.rst",
    "gallery-pages/sg_execution_times.rst",
    *(
        f"gallery-pages/{page.name}"
        for page in (HERE / "gallery-pages").glob("plot_*.rst")
        if not (HERE / "gallery" / f"{page.stem}.py").exists()
    ),
]

myst_enable_extensions = ["colon_fence", "dollarmath"]
myst_heading_anchors = 4
bibtex_bibfiles = ["references.bib"]

autodoc_member_order = "bysource"
autodoc_typehints = "none"  # the sections of the docstrings say units and shapes
autodoc_class_signature = "mixed"
napoleon_google_docstring = False
autosummary_generate = True
autosummary_ignore_module_all = False

sphinx_gallery_conf = {
    "examples_dirs": "gallery",
    "gallery_dirs": "gallery-pages",
    "filename_pattern": r"/plot_",
    "ignore_pattern": r"pictures\.py",
    "thumbnail_size": (480, 360),
    "within_subsection_order": "FileNameSortKey",
    "abort_on_example_error": True,
    "remove_config_comments": True,
    "download_all_examples": False,
    "show_memory": False,
    "write_computation_times": False,  # its page loads scripts of others
    "min_reported_time": 1,
    # `make check` looks at pages and links; `make docs` runs the cases.
    "plot_gallery": "False" if tags.has("unexecuted") else "True",  # noqa: F821 (Sphinx has it)
}
