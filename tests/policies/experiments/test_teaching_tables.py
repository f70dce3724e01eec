import csv
import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest
from scipy import stats

from policies import TeachingDesign, make_teaching_tables
from policies.experiments.images import draw_images
from policies.experiments.teaching import COLUMNS, EXAMPLES
from policies.experiments.teaching_figure import draw_teaching
from policies.experiments.teaching_report import PAPER, publish_teaching, summarise
from tests.policies.experiments.numbers import numbers_of, printable, printed_in

TEACHERS = ("polmdp", "optimal")
GOALS = "AB"
BAYES = TeachingDesign("samples", units=7)


def write(path, correct):
    """Rows whose guesses are right where `correct[maze, unit, goal, teacher, trajectory, k]`."""
    with path.open("w", newline="", encoding="utf-8") as file:
        rows = csv.writer(file)
        rows.writerow(COLUMNS)
        for m, u, n, s, j in np.ndindex(correct.shape[:-1]):
            goal, other = GOALS[n], GOALS[1 - n]
            guesses = "".join(goal if right else other for right in correct[m, u, n, s, j])
            rows.writerow([m, u, goal, TEACHERS[s], j, guesses])
    return path


@pytest.fixture
def lessons(tmp_path):
    """The file, and what is right in it: 3 mazes, 7 units, 2 goals, 2 teachers, 2 trajectories."""
    draw = np.random.default_rng(0)
    base = draw.uniform(0.2, 0.8, (3, 7, 1, 1, 1, 1))
    correct = draw.random((3, 7, 2, 2, 2, EXAMPLES)) < base + np.array([[[0.1]], [[0.0]]])
    return write(tmp_path / "samples-bayes.csv", correct), correct


def column(table, name, **where):
    for key, value in where.items():
        table = table.filter(table[key] == value)
    return table[name].to_numpy()


def test_ratios_are_the_shares_of_right_guesses(lessons):
    file, correct = lessons
    tables = make_teaching_tables(file)
    for s, teacher in enumerate(TEACHERS):
        wanted = correct[:, :, :, s].mean(axis=(0, 1, 2, 3))
        assert column(tables.ratios, "ratio", teacher=teacher) == pytest.approx(wanted)
        assert column(tables.ratios, "k", teacher=teacher).tolist() == list(range(1, 21))
    assert tables.chance == 0.5


def test_in_one_maze_they_are_students_interval_and_paired_test_of_the_units(tmp_path, lessons):
    correct = lessons[1][:1]
    tables = make_teaching_tables(write(tmp_path / "one.csv", correct))
    units = correct[0].mean(axis=(1, 3))
    for k in range(EXAMPLES):
        of_polmdp = stats.ttest_1samp(units[:, 0, k], 0).confidence_interval()
        row = tables.ratios.filter(tables.ratios["teacher"] == "polmdp").row(k, named=True)
        assert (row["low"], row["high"]) == pytest.approx(tuple(of_polmdp))
        paired = stats.ttest_rel(units[:, 0, k], units[:, 1, k])
        row = tables.differences.row(k, named=True)
        assert (row["t"], row["p"]) == pytest.approx((paired.statistic, paired.pvalue))
        interval = paired.confidence_interval()
        assert (row["low"], row["high"]) == pytest.approx((interval.low, interval.high))


def test_mazes_are_fixed_only_units_within_them_vary(lessons):
    file, correct = lessons
    units = correct.mean(axis=(2, 4))[:, :, 0, 4]
    se = np.sqrt((units.var(axis=1, ddof=1) / 7).sum()) / 3
    ratios = make_teaching_tables(file).ratios
    half = column(ratios, "high", teacher="polmdp", k=5) - column(
        ratios, "ratio", teacher="polmdp", k=5
    )
    assert half == pytest.approx(stats.t.ppf(0.975, 18) * se)


def test_more_lessons_of_the_same_units_make_no_interval_narrower(tmp_path, lessons):
    """A unit's lessons resemble each other: a hundred copies tell no more than one."""
    once = make_teaching_tables(lessons[0]).ratios["low"].to_numpy()
    copied = write(tmp_path / "more.csv", np.repeat(lessons[1], 5, axis=4))
    assert make_teaching_tables(copied).ratios["low"].to_numpy() == pytest.approx(once)


def test_teachers_who_never_differ_are_no_evidence(tmp_path, lessons):
    correct = lessons[1].copy()
    correct[:, :, :, 1] = correct[:, :, :, 0]
    tests = make_teaching_tables(write(tmp_path / "same.csv", correct)).differences
    assert (tests["difference"] == 0).all()
    assert (tests["p"] == 1).all()


def test_p_is_corrected_over_k(lessons):
    tests = make_teaching_tables(lessons[0]).differences
    p, adjusted = column(tests, "p"), column(tests, "p_holm")
    assert adjusted[p.argmin()] == pytest.approx(min(1, 20 * p.min()))
    assert (adjusted >= p).all()


def test_the_figure_shows_the_ratios_their_bands_and_chance(lessons):
    tables = make_teaching_tables(lessons[0])
    (axes,) = draw_teaching(BAYES, tables).axes
    polmdp, optimal, chance = axes.lines
    assert np.allclose(polmdp.get_ydata(), column(tables.ratios, "ratio", teacher="polmdp"))
    assert np.allclose(optimal.get_ydata(), column(tables.ratios, "ratio", teacher="optimal"))
    assert np.allclose(chance.get_ydata(), 0.5)
    for band, teacher in zip(axes.collections, TEACHERS, strict=True):
        edges = np.asarray(band.get_paths()[0].vertices)[:, 1]
        assert set(column(tables.ratios, "low", teacher=teacher)) <= set(edges)
        assert set(column(tables.ratios, "high", teacher=teacher)) <= set(edges)


def test_images_are_the_same_bytes_each_time(lessons):
    tables = make_teaching_tables(lessons[0])
    images = draw_images(lambda: draw_teaching(BAYES, tables))
    assert ElementTree.fromstring(images[".svg"]).tag.endswith("svg")
    assert images[".png"].startswith(b"\x89PNG")
    assert draw_images(lambda: draw_teaching(BAYES, tables)) == images


def test_publishing_writes_all_beside_the_rows(lessons):
    file, _ = lessons
    before = file.read_bytes()
    text = publish_teaching(file, BAYES)
    names = {path.name.removeprefix("samples-bayes") for path in file.parent.iterdir()}
    assert names == {".csv", "-ratios.csv", "-differences.csv", ".svg", ".png"}
    assert file.read_bytes() == before
    assert text == summarise(BAYES, make_teaching_tables(file))


def test_the_summary_sets_the_papers_ratios_beside_ours(lessons):
    tables = make_teaching_tables(lessons[0])
    row = summarise(BAYES, tables).splitlines()[3]
    ratio = column(tables.ratios, "ratio", teacher="optimal", k=5)[0]
    assert row.startswith("| 5 | ")
    assert f"{ratio:.3f} [" in row
    assert "(0.776)" in row
    assert "(0.691)" in row


def test_the_summary_prints_no_number_but_these(lessons):
    tables = make_teaching_tables(lessons[0])
    published = [ratio for ratios in PAPER.values() for ratio in ratios]
    shown = numbers_of(tables.ratios, tables.differences)
    text = summarise(BAYES, tables)
    assert printed_in(text, ["95 %"]) <= printable([*shown, *published])
