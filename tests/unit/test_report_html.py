"""The report as one HTML file."""

from __future__ import annotations

from html.parser import HTMLParser

import pytest

import epicyclic as ep

VOID = {"meta", "br", "link", "img"}
"""Tags without an end."""


class Page(HTMLParser):
    """Numbers, links and ids of a page, and whether its tags are balanced."""

    def __init__(self, text):
        super().__init__()
        self.numbers, self.links, self.ids, self.open = {}, [], [], []
        self.sections = []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        attributes = dict(attrs)
        if tag not in VOID:
            self.open.append(tag)
        if tag == "data":
            self.numbers[attributes["data-key"]] = float(attributes["value"])
        if tag == "section":
            self.sections.append(attributes["id"])
        self.links += [
            value for key, value in attrs if key in ("src", "href", "xlink:href") and value
        ]
        if "id" in attributes:
            self.ids.append(attributes["id"])

    def handle_startendtag(self, tag, attrs):
        self.handle_starttag(tag, attrs)
        if tag not in VOID:
            self.open.pop()

    def handle_endtag(self, tag):
        assert self.open.pop() == tag


@pytest.fixture(scope="module")
def record(talbot):
    return ep.record(talbot)


@pytest.fixture(scope="module")
def page(record):
    return ep.report_html(record)


def test_every_tag_is_closed_and_every_id_is_unique(page):
    parsed = Page(page)
    assert parsed.open == []
    assert len(set(parsed.ids)) == len(parsed.ids)


def test_nothing_is_loaded_from_elsewhere(page):
    for link in Page(page).links:
        assert link.startswith(("#", "data:")), link[:80]


def test_a_stored_file_gives_the_same_page(record, page, tmp_path):
    ep.save_result(record, tmp_path / "result.nc")
    assert ep.report_html(ep.open_result(tmp_path / "result.nc")) == page
