"""The files of a figure, and the look that all figures share."""

import matplotlib
import numpy as np
import polars as pl
from matplotlib.colors import to_rgb

from analysis.figures import COLOURS, Drawn, write_figure
from analysis.figures.style import panel


def a_figure():
    with panel(2.0, "a note") as (figure, axes):
        axes.plot([0, 1], [0.5, 0.25])
        axes.set_ylabel("share")
    return Drawn(figure, pl.DataFrame({"x": [0, 1], "y": [0.5, 0.25]}), "A line from 0.5 to 0.25.")


def test_a_figure_is_written_as_vector_as_picture_and_as_numbers(tmp_path):
    write_figure(a_figure(), tmp_path, "line")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["line.csv", "line.png", "line.svg"]
    assert (tmp_path / "line.csv").read_text() == "x,y\n0,0.5\n1,0.25\n"


def test_the_same_data_give_the_same_bytes(tmp_path):
    for folder in ("once", "again"):
        (tmp_path / folder).mkdir()
        write_figure(a_figure(), tmp_path / folder, "line")
    for path in (tmp_path / "once").iterdir():
        assert path.read_bytes() == (tmp_path / "again" / path.name).read_bytes()


def test_files_carry_no_date_and_drawing_leaves_no_style_behind(tmp_path):
    before = dict(matplotlib.rcParams)
    write_figure(a_figure(), tmp_path, "line")
    assert dict(matplotlib.rcParams) == before
    svg = (tmp_path / "line.svg").read_text()
    assert "<dc:date>" not in svg
    assert b"Software" not in (tmp_path / "line.png").read_bytes()


def test_the_vector_file_needs_no_font(tmp_path):
    write_figure(a_figure(), tmp_path, "line")
    assert "<text" not in (tmp_path / "line.svg").read_text()


def test_dollars_in_a_label_are_no_mathematics():
    with panel(2.0, "from $5 to $10") as (figure, axes):
        axes.set_ylabel("from $5 to $10")
    assert not axes.yaxis.label.get_parse_math()
    assert not any(text.get_parse_math() for text in figure.texts)


def test_the_two_colours_differ_in_lightness_as_well():
    lightness = [np.dot(to_rgb(each), (0.2126, 0.7152, 0.0722)) for each in COLOURS]
    assert abs(lightness[0] - lightness[1]) > 0.2
