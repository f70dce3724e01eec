"""What is said of who left, and of what stands for the trials never answered."""

from analysis.reporting.markdown import markdown
from analysis.reporting.people_tables import sensitivity_parts


def test_intention_to_treat_says_whom_it_counts_and_what_fills_their_lists(paper):
    text = markdown(sensitivity_parts(paper.evidence, paper.data.plan))
    length_s = paper.data.trials["length_s"].mean()
    assert (
        "Intention to treat: all who began count with the plan's 10 trials; those not answered "
        "count as the worst case (a wrong guess, time of prediction: the mean full length, "
        f"{length_s:.2f} s, confidence 1). To begin is to answer a trial."
    ) in text
