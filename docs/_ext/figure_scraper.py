"""Pictures of the gallery: those of pyplot, and those that results draw, which pyplot knows not."""

from __future__ import annotations

from typing import Any

from matplotlib.figure import Figure
from sphinx_gallery.scrapers import figure_rst, matplotlib_scraper

_PICTURE = "picture"
"""Name that examples give to figures made by `Result.plot` and the functions of `plots`."""


def scrape(block: Any, block_vars: dict[str, Any], gallery_conf: dict[str, Any]) -> str:
    """Save what a block has drawn, and say in reStructuredText where it is."""
    text = matplotlib_scraper(block, block_vars, gallery_conf)
    picture = block_vars["example_globals"].pop(_PICTURE, None)
    if isinstance(picture, Figure):
        path = next(block_vars["image_path_iterator"])
        picture.savefig(path)
        text += figure_rst([path], gallery_conf["src_dir"])
    return text
