"""The flow names every count once, where it belongs."""

from analysis.figures import figure_flow
from analysis.flow import Flow, Group, Step
from tests.analysis.figures.studies import LABELS


def per_arm(treatment, reference):
    return {"polmdp": treatment, "optimal": reference}


FLOW = Flow(
    (
        Step(Group("gave consent", 1040, None), (Group("screened out", 3, None),)),
        Step(
            Group("dealt a place", 1037, per_arm(519, 518)),
            (Group("never began a trial", 1, per_arm(0, 1)),),
        ),
        Step(
            Group("analysed", 1036, per_arm(519, 517)),
            of_these=(Group("completed the study", 1030, per_arm(515, 515)),),
        ),
    )
)


def boxes(drawn):
    (axes,) = drawn.figure.axes
    return [text.get_text().replace("\xa0", " ") for text in axes.texts if text.get_text()]


def test_steps_and_those_who_left_stand_in_order():
    assert boxes(figure_flow(FLOW, LABELS)) == [
        "Gave consent: 1,040",
        "Screened out: 3",
        "Dealt a place: 1,037\nPoLMDP: 519\noptimal: 518",
        "Never began a trial: 1\n(0 + 1)",
        "Analysed: 1,036\nPoLMDP: 519\noptimal: 517\nof these completed the\n"
        "study: 1,030 (515 + 515)",
    ]


def test_a_step_that_nobody_left_has_no_box_beside_it():
    flow = Flow((Step(Group("answered a trial", 4, None)), Step(Group("analysed", 4, None))))
    assert boxes(figure_flow(flow, LABELS)) == ["Answered a trial: 4", "Analysed: 4"]


def test_the_data_list_every_count_with_its_step():
    data = figure_flow(FLOW, LABELS).data
    assert data.rows()[0] == (1, "reached", "gave consent", 1040, None, None)
    assert data.filter(kind="left").select("step", "participants").rows() == [(1, 3), (2, 1)]
    assert data.filter(step=3, kind="of these").rows() == [
        (3, "of these", "completed the study", 1030, 515, 515)
    ]


def test_the_words_follow_the_steps():
    assert figure_flow(FLOW, LABELS).alt == (
        "Flow of participants, in brackets PoLMDP + optimal: gave consent: 1,040, of whom left: "
        "screened out: 3; dealt a place: 1,037 (519 + 518), of whom left: never began a trial: 1 "
        "(0 + 1); analysed: 1,036 (519 + 517)."
    )
