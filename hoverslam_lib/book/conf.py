"""Settings of Sphinx for the book; `hoverslam_lib.book` calls it."""

from importlib.util import find_spec
from pathlib import Path

HERE = Path(__file__).parent
(_mathjax,) = find_spec("sphinx-mathjax-offline").submodule_search_locations

project = html_title = "Landing a booster"
author = ""
language = "en"
extensions = ["myst_nb"]
myst_enable_extensions = ["amsmath", "dollarmath"]
myst_heading_anchors = 4
nb_execution_mode = "off"  # the stored outputs are shown
nb_merge_streams = True
nb_code_prompt_show = "Show the {type}"
nb_code_prompt_hide = "Hide the {type}"

# one file that draws its own letters: with font files MathJax is thirty megabytes
mathjax_path = "tex-svg.js"
mathjax3_config = {"options": {"enableMenu": False}}

html_theme = "sphinx_book_theme"
html_theme_options = {
    "home_page_in_toc": True,
    "show_toc_level": 2,
    "use_download_button": False,
    "navbar_persistent": [],  # the sidebar has the field for searching
}
html_context = {"default_mode": "auto"}
html_static_path = [str(HERE / "static"), str(Path(_mathjax, "static", "mathjax", mathjax_path))]
html_css_files = ["book.css"]
html_js_files = ["recorded.js"]
html_copy_source = html_show_sourcelink = html_show_copyright = html_show_sphinx = False
html_show_search_summary = False  # it asks for the text of pages, which a page opened from a folder may not
