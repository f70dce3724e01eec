"""The measures of a trial, each defined once: pages, export and analysis call these.

Plain Python and no imports, because the web server calls them on every answer.
"""

FULL_SCORE = 10.0
"""Points of a correct guess in the first third of the motion."""


def correct(guess: str, goal: str) -> bool:
    """Tell whether the guessed area is the one the robot was going to."""
    return guess == goal


def prediction_time_s(stop_time_s: float, length_s: float, correct: bool) -> float:
    """Time of prediction, s: the stop time if the guess was correct, else the full length.

    Both times count motion only, 0 <= stop_time_s <= length_s. Source: the paper, section 4.4.
    """
    return stop_time_s if correct else length_s


def score(correct: bool, stop_time_s: float, length_s: float) -> float:
    """Points of a trial, 0 to 10: 0 if wrong, else min(10, 10 (T - t) / (2T/3)).

    t is `stop_time_s`, T is `length_s` > 0, both in s of motion with 0 <= t <= T: a correct
    guess within the first third earns everything, from there on it falls linearly to 0.
    """
    if not correct:
        return 0.0
    return min(FULL_SCORE, FULL_SCORE * (length_s - stop_time_s) / (2 * length_s / 3))


def too_fast(stop_time_s: float, first_decision_s: float) -> bool:
    """Tell whether Stop came before the first decision of the robot was there to be seen whole.

    `first_decision_s` is the motion, s, until the robot has completed its first step by choice.
    """
    return stop_time_s < first_decision_s
