"""One list of parts, three renderings: as a page, as Markdown, for the terminal."""

import re
from html.parser import HTMLParser

import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.reporting.document import Finding, Grid, Heading, Items, Paragraph, Part, Picture
from analysis.reporting.html import html
from analysis.reporting.inline_svg import inline_svg
from analysis.reporting.markdown import markdown
from analysis.reporting.plain import plain_text

SVG = (
    '<?xml version="1.0" encoding="utf-8"?>\n<!DOCTYPE svg PUBLIC "x" "http://example.org/x.dtd">\n'
    '<svg xmlns:xlink="http://www.w3.org/1999/xlink" width="10pt" height="20pt" '
    'viewBox="0 0 10 20" xmlns="http://www.w3.org/2000/svg" version="1.1">\n'
    '<metadata><a href="http://example.org/"/></metadata>\n'
    '<defs><path id="a"/></defs><g clip-path="url(#a)"><use xlink:href="#a" width="3"/></g></svg>\n'
)
EVERY_PART: list[Part] = [
    Heading("Title", 1),
    Heading("First"),
    Paragraph("Text."),
    Finding("Yes.", "It is so, p < .001."),
    Items(("one", "two")),
    Grid("Counts", ("", "n"), (("a", "1"),)),
    Picture("f", "What it shows", "a figure"),
]
VOID = {"meta", "path", "use"}


class Page(HTMLParser):
    """What is open, in which order, and with which attributes."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.text = ""
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        if tag not in VOID:
            assert self.open.pop() == tag

    def handle_data(self, data):
        self.text += data

    def all(self, name):
        return [attributes for tag, attributes in self.tags if tag == name]


def page(parts):
    return Page(html(parts, {"f": SVG}))


def test_each_part_has_its_markdown():
    assert markdown(EVERY_PART) == (
        "# Title\n\n## First\n\nText.\n\n**Yes.** It is so, p < .001.\n\n- one\n- two\n\n"
        "*Counts*\n\n|  | n |\n| --- | ---: |\n| a | 1 |\n\n"
        "![a figure](figures/f.svg)\n\n*What it shows*\n"
    )


def test_markdown_lets_no_text_become_an_element():
    text = markdown([Paragraph("a <b>"), Grid("n", ("", "x|y"), (("<i>", "p < .05"),))])
    assert "a &lt;b>" in text
    assert r"|  | x\|y |" in text
    assert "| &lt;i> | p < .05 |" in text


def test_on_the_terminal_tables_are_aligned_and_pictures_left_out():
    parts: list[Part] = [
        Grid("Sizes", ("", "n"), (("arm", "1000"), ("a", "1"))),
        Picture("f", "What it shows", "a figure"),
    ]
    assert plain_text(parts) == "Sizes\n        n\narm  1000\na       1\n"


def test_on_the_terminal_an_answer_stands_over_its_numbers():
    assert plain_text([Finding("Yes.", "p < .001")]) == "Yes.\n  p < .001\n"


def test_wrapping_never_parts_a_symbol_from_its_number():
    text = plain_text([Items((("word " * 15) + "U = 177976, p < .001",))])
    assert "U = 177976" in text
    assert "p < .001" in text
    assert len(text.splitlines()) > 1


def test_a_page_has_language_title_one_main_and_one_first_heading():
    found = page(EVERY_PART)
    assert found.open == []
    assert found.all("html") == [{"lang": "en"}]
    assert [len(found.all(tag)) for tag in ("title", "main", "h1")] == [1, 1, 1]
    assert "Title" in found.text


def test_a_page_needs_nothing_else_and_runs_nothing():
    text = html(EVERY_PART, {"f": SVG})
    assert not re.search(r"https?:|<script|<link|<img|@import|url\((?!#)| on\w+=", text)


def test_a_page_lists_its_sections_and_every_link_leads_somewhere():
    parts = [*EVERY_PART, Heading("Time of prediction, s")]
    found = page(parts)
    ids = {attributes["id"] for _, attributes in found.tags if "id" in attributes}
    links = [attributes["href"] for attributes in found.all("a")]
    assert links == ["#first", "#time-of-prediction-s"]
    assert {link[1:] for link in links if link} <= ids


def test_a_table_on_a_page_names_its_rows_and_columns_and_scrolls_by_keyboard():
    found = page(EVERY_PART)
    assert [each["scope"] for each in found.all("th")] == ["col", "row"]
    assert len(found.all("caption")) == 1
    (wide,) = (each for each in found.all("div") if each.get("class") == "wide")
    assert (wide["tabindex"], wide["role"], wide["aria-label"]) == ("0", "region", "Counts")


def test_a_figure_on_a_page_is_drawn_there_with_a_text_for_who_does_not_see_it():
    found = page(EVERY_PART)
    (drawing,) = found.all("svg")
    assert (drawing["role"], drawing["aria-label"]) == ("img", "a figure")
    assert "What it shows" in found.text


def test_two_drawings_on_a_page_share_no_id():
    ids = [re.findall(r'\bid="([^"]+)"', inline_svg(SVG, name, "")) for name in ("one", "two")]
    assert ids == [["one-a"], ["two-a"]]


def test_references_inside_a_drawing_still_hold():
    drawing = inline_svg(SVG, "one", "")
    assert "url(#one-a)" in drawing
    assert 'href="#one-a"' in drawing


def test_a_drawing_takes_the_width_it_is_given_and_keeps_what_is_inside():
    opening, rest = inline_svg(SVG, "one", 'a "b" <c>').split(">", 1)
    assert opening == ('<svg viewBox="0 0 10 20" role="img" aria-label="a &quot;b&quot; &lt;c&gt;"')
    assert 'width="3"' in rest


def test_what_is_no_drawing_is_refused():
    with pytest.raises(ValueError, match="f: expected an SVG"):
        inline_svg("nothing", "f", "")


@given(st.text())
def test_no_text_of_the_data_becomes_an_element(text):
    parts: list[Part] = [
        Heading("Title", 1),
        Paragraph(text),
        Finding(text, text),
        Items((text,)),
        Grid(f"c{text}", ("", text), ((text, text),)),
    ]
    known = {"html", "head", "meta", "title", "style", "body", "main", "nav", "ul", "li", "h1"}
    known |= {"p", "strong", "span", "div", "table", "caption", "thead", "tbody", "tr", "th", "td"}
    assert {tag for tag, _ in page(parts).tags} <= known


def test_numbers_stay_with_their_symbols_on_a_page():
    text = html([Heading("T", 1), Paragraph("It is chi2(1) = 48.864, p < .001.")], {})
    assert '<span class="whole">chi2(1) = 48.864</span>, ' in text
    assert '<span class="whole">p &lt; .001.</span>' in text
