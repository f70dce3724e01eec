"""Tables behind printed figures: all of them, only them, and the paper's."""

from decimal import ROUND_HALF_UP, Decimal

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy import stats
from typer.testing import CliRunner

from analysis import AnalysisError
from analysis.__main__ import alone
from analysis.reconstruct import Figures, printed, reconstruct

PAPER = ["--chi2", "48.864", "--n", "1500", "--p1", ".85", "--p2", ".70"]


def figures(chi2, n, p1, p2, trials_each=None, yates=False):
    shares = printed("p1", p1), printed("p2", p2)
    return Figures(printed("chi2", chi2), n, *shares, trials_each, yates)


def counts(found):
    return [tuple(each.table.counts.ravel().tolist()) for each in found]


def as_printed(number, digits):
    return str(Decimal(number).quantize(Decimal(1).scaleb(-digits), ROUND_HALF_UP))


def run(*arguments):
    return CliRunner(env={"COLUMNS": "200"}).invoke(alone, ["reconstruct", *arguments])


def test_the_papers_figures_in_whole_participants_come_from_one_table_only(golden):
    """Golden case paper_98x52: R 4.2.2 stats::chisq.test."""
    case = golden("paper_98x52")
    assert case["input"]["table"] == [[832, 148], [362, 158]]
    (found,) = reconstruct(figures("48.864", 1500, ".85", ".70", trials_each=10))
    assert counts([found]) == [(832, 148, 362, 158)]
    assert found.chi2 == pytest.approx(case["expected"]["chi2"], abs=case["tol"])
    assert found.p == pytest.approx(case["expected"]["p"])


def test_with_continuity_correction_the_same_table_is_found_by_its_corrected_figure(golden):
    """Golden case paper_98x52: R 4.2.2 stats::chisq.test(correct = TRUE)."""
    corrected = as_printed(golden("paper_98x52")["expected"]["chi2_yates"], 3)
    found = reconstruct(figures(corrected, 1500, ".85", ".70", trials_each=10, yates=True))
    assert (832, 148, 362, 158) in counts(found)


def test_with_equal_arms_the_papers_figures_come_from_no_table():
    found = reconstruct(figures("48.864", 1500, ".85", ".70"))
    assert found
    assert all(each.table.arms[0].n != 750 for each in found)


def chi_square_of(table, yates):
    """From observed and expected counts, where the tool works with the cross product."""
    a, b, c, d = table
    rows, columns, n = (a + b, c + d), (a + c, b + d), sum(table)
    cells = zip(table, [row * column / n for row in rows for column in columns], strict=True)
    return sum(max(abs(seen - expected) - yates / 2, 0) ** 2 / expected for seen, expected in cells)


def numbers_of(table, yates):
    a, b, c, d = table
    return chi_square_of(table, yates), a / (a + b), c / (c + d)


def tables_of(n):
    for size in range(1, n):
        for a in range(size + 1):
            yield from (
                (a, size - a, c, n - size - c) for c in range(n - size + 1) if 0 < a + c < n
            )


@given(
    table=st.lists(st.integers(0, 6), min_size=4, max_size=4),
    share_digits=st.integers(1, 2),
    chi2_digits=st.integers(0, 2),
    yates=st.booleans(),
)
@settings(max_examples=40)
def test_it_finds_the_tables_within_the_rounding_and_no_others(
    table, share_digits, chi2_digits, yates
):
    a, b, c, d = table
    assume(a + b and c + d and 0 < a + c < sum(table))
    digits = (chi2_digits, share_digits, share_digits)
    figures_of = [as_printed(x, k) for x, k in zip(numbers_of(table, yates), digits, strict=True)]

    def off(other):
        """How far a table's numbers are from the figures, at most 1 where they print so."""
        return max(
            abs(x - float(text)) * 10**k * 2
            for x, text, k in zip(numbers_of(other, yates), figures_of, digits, strict=True)
        )

    chi2, p1, p2 = figures_of
    found = set(counts(reconstruct(figures(chi2, sum(table), p1, p2, yates=yates))))
    assert tuple(table) in found
    assert {each for each in tables_of(sum(table)) if off(each) < 1 - 1e-6} <= found
    assert all(off(each) < 1 + 1e-6 for each in found)


@pytest.mark.parametrize("yates", [False, True])
def test_chi_square_and_p_are_scipys(yates):
    for found in reconstruct(figures("48.864", 1500, ".85", ".70", yates=yates)):
        expected = stats.chi2_contingency(found.table.counts, correction=yates)
        assert (found.chi2, found.p) == pytest.approx((expected.statistic, expected.pvalue))


def test_more_digits_leave_fewer_tables():
    few, many = (figures("48.9", 1500, p1, p2) for p1, p2 in ((".849", ".696"), (".85", ".70")))
    assert set(counts(reconstruct(few))) < set(counts(reconstruct(many)))


def test_many_tables_are_tried_in_pieces_with_the_same_result(monkeypatch):
    whole = reconstruct(figures("48.864", 1500, ".85", ".70"))
    monkeypatch.setattr("analysis.reconstruct._BLOCK", 1000)
    assert reconstruct(figures("48.864", 1500, ".85", ".70")) == whole


def test_all_correct_in_both_arms_has_no_chi_square_to_find():
    assert counts(reconstruct(figures("0", 8, "1.00", "1.00"))) == []


@pytest.mark.parametrize("text", ["", "85%", "nan", "inf", "-.5", "1e9", "1e-12"])
def test_what_is_no_printed_number_is_refused(text):
    with pytest.raises(AnalysisError, match="p1: expected a number from 0 as it is printed"):
        printed("p1", text)


def test_the_command_lists_tables_with_participants_and_p():
    result = run(*PAPER, "--trials-per-participant", "10")
    assert result.exit_code == 0
    assert result.stdout.startswith("1 table of 1500 trials in whole participants of 10 with")
    row = ("832 of 980", "362 of 520", "84.90 % / 69.62 %", "98 + 52", "48.863883", "2.74e-12")
    for cell in row:
        assert cell in result.stdout.splitlines()[-1]


def test_without_trials_per_participant_it_does_not_speak_of_participants():
    result = run(*PAPER)
    assert result.stdout.startswith("3 tables of 1500 trials with chi2(1) = 48.864")
    assert "participants" not in result.stdout


def test_no_table_is_an_answer():
    result = run("--chi2", "1", "--n", "20", "--p1", ".99", "--p2", ".70")
    assert (result.exit_code, result.stderr) == (0, "")
    assert result.stdout.startswith("No tables of 20 trials")


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        (["--p1", "85"], "share correct: expected 0 to 1, as in .85, got 85"),
        (["--chi2", "many"], "chi2: expected a number from 0 as it is printed, got 'many'"),
        (["--n", "1"], "n: expected 2 to 1,000,000 trials, got 1"),
        (["--trials-per-participant", "7"], "expected a divisor of n = 1500, got 7"),
        (["--n", "1000000"], "tables to try, got"),
    ],
)
def test_bad_input_is_one_line_and_exit_code_2(changed, message):
    result = run(*PAPER, *changed)
    assert (result.exit_code, result.stdout) == (2, "")
    assert message in result.stderr
    assert len(result.stderr.splitlines()) == 1
