"""Reports as PDF: the page of `report_html`, set by WeasyPrint."""

from __future__ import annotations

import logging
from importlib import import_module
from types import ModuleType

from epicyclic.errors import InputError, Problem


def check_pdf() -> None:
    """Raise `InputError` if WeasyPrint, which is optional, cannot be used."""
    _weasyprint()


def _weasyprint() -> ModuleType:
    try:
        return import_module("weasyprint")
    except (ImportError, OSError) as error:  # it needs Pango, a library of the system
        problem = Problem(
            "-o",
            ".pdf",
            f"needs WeasyPrint, which cannot be used: {error}.",
            'Install it (pip install "epicyclic[pdf]"), or print the .html page from a browser.',
        )
        raise InputError([problem], "the command") from None


def report_pdf(
    page: str,  # As `report_html` returns it.
) -> bytes:
    """A page as PDF, of its still figures.

    Raises
    ------
    InputError
        If WeasyPrint cannot be used.
    """
    weasyprint = _weasyprint()

    # it reports every property of style sheets for screens
    logging.getLogger("weasyprint").setLevel(logging.CRITICAL)
    fetcher = weasyprint.urls.URLFetcher(allowed_protocols=["data"])  # nothing from elsewhere
    document = weasyprint.HTML(string=page, url_fetcher=fetcher)
    pdf: bytes = document.write_pdf()
    return pdf
