import xml.etree.ElementTree as ElementTree
from functools import partial

import polars as pl
import pytest

from policies.experiments.figures import FIGURES, draw_figure, figure_data
from policies.experiments.images import draw_images
from policies.experiments.tables import make_tables


@pytest.mark.parametrize("name", FIGURES)
def test_a_figure_is_drawn_as_svg_and_png_the_same_bytes_each_time(name, tables):
    draw = partial(draw_figure, name, tables)
    images = draw_images(draw)
    assert ElementTree.fromstring(images[".svg"]).tag.endswith("svg")
    assert images[".png"].startswith(b"\x89PNG")
    assert draw_images(draw) == images


@pytest.mark.parametrize("name", FIGURES)
def test_its_data_are_the_means_of_all_three_frameworks(name, tables):
    data = figure_data(name, tables)
    for measure in FIGURES[name]:
        shown = data.filter(pl.col("measure") == measure)
        assert shown.equals(tables.means.filter(pl.col("measure") == measure))
        assert set(shown["framework"]) == {"polmdp", "lmdp", "optimal"}


def test_the_times_have_the_failures_with_them(tables):
    data = figure_data("time", tables)
    lost = data.filter(
        pl.col("measure") == "not_arrived_percent",
        pl.col("framework") == "lmdp",
        pl.col("world") == "3x3",
    )
    assert lost["mean"].to_list() == pytest.approx([100 / 12])
    assert data.filter(pl.col("measure") == "timed_out_percent").height == 6


@pytest.mark.parametrize("name", FIGURES)
def test_a_framework_that_never_arrives_and_worlds_alike_can_be_drawn(name, rows):
    lost = rows.with_columns(
        failed=pl.col("framework") == "lmdp",
        arrived=pl.col("framework") != "lmdp",
        states=pl.lit(4),
        goals=pl.lit(2),
    )
    assert draw_images(partial(draw_figure, name, make_tables(lost, seed=1)))


@pytest.mark.parametrize("name", FIGURES)
def test_one_world_with_one_pair_can_be_drawn(name, rows):
    one = rows.filter(pl.col("world") == "2x2", pl.col("pair") == 0)
    assert draw_images(partial(draw_figure, name, make_tables(one, seed=1)))
