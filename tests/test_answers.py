"""What checks make of an answer: what it is, how far it is from another, and how it is shown."""

import math

import numpy as np
import pytest

from hoverslam_lib.checks import answers, feedback, judging, lesson_01, lesson_04, lesson_09, lesson_11, lesson_13

RAISED = ValueError("too long")
DISTANCES = [
    (1.0, 1.0, 0.0),
    (1.2, 1.0, pytest.approx(2)),
    (1.0, 1.2, pytest.approx(0.2 / 0.11)),
    (math.nan, math.nan, 0.0),
    (math.nan, 1.0, math.inf),
    (math.inf, math.inf, 0.0),
    ([1.0], 1.0, 0.0),
    ([1.0, 2.0], [1.0, 2.4], pytest.approx(0.4 / 0.17)),
    ([1.0, 2.0], [1.0], math.inf),
    (np.ones((2, 1)), np.ones(2), math.inf),
    ([], [], 0.0),
    (("soft", 1.2), ("soft", 1.0), pytest.approx(2)),
    (("soft", 1.0), ("crash", 1.0), math.inf),
    (("soft", 1.0), ("soft",), math.inf),
    ("soft", "soft", 0.0),
    ("soft", 1.0, math.inf),
    (RAISED, ValueError("too long"), 0.0),
    (RAISED, ValueError("too short"), math.inf),
    (RAISED, TypeError("too long"), math.inf),
    (RAISED, 1.0, math.inf),
    (1.0, RAISED, math.inf),
]


@pytest.mark.parametrize(("a", "b", "expected"), DISTANCES)
def test_distance_is_in_units_of_the_tolerance(a, b, expected):
    assert answers.distance(a, b, rtol=0.05, atol=0.05) == expected


@pytest.mark.parametrize(
    ("value", "shape", "what", "nudge"),
    [
        ([1.0, 2.0], (3,), "The result should be 3 numbers; it holds 2 numbers.", True),
        (np.ones((3, 1)), (3,), "The result should be 3 numbers; it holds 3 × 1 numbers.", False),
        (2.0, (3,), "The result should be 3 numbers; it holds one number.", False),
        ("2", (3,), "The result should be 3 numbers; it is '2'.", False),
        ([1.0, math.inf], (2,), "The result holds inf, which is not a finite number.", True),
        (math.nan, (), "The result is nan, which is not a finite number.", True),
        (math.sin, (), "The result should be one number; it is <built-in function sin>.", False),
        ((lambda x: x), (), "The result should be one number; it is a function: are the brackets", False),
    ],
)
def test_what_is_no_array_of_that_shape_is_said(value, shape, what, nudge):
    with pytest.raises(feedback.Wrong) as raised:
        answers.array(value, shape)
    assert raised.value.what.startswith(what)
    assert raised.value.nudge is nudge


def test_answer_may_get_an_array_with_nan_or_of_words_and_leave_it():
    for given in (np.array([1.0, math.nan]), np.array(["soft", "crash"]), np.array([1, 2])):
        assert answers.repeatable(lambda x: 3.0, given) == 3.0

    def spoils(x):
        x[0] = x[1]
        return 3.0

    for given in (np.array([1.0, math.nan]), np.array(["soft", "crash"])):
        with pytest.raises(feedback.Wrong, match="changes what it is given"):
            answers.repeatable(spoils, given)


def test_answer_is_shown_in_six_digits_and_four_numbers():
    assert answers.digits(1 / 3) == "0.333333"
    assert answers.digits([1, 2, 3, 4]) == "1, 2, 3, 4"
    assert answers.digits(range(5)) == "0, 1, 2, 3, …"
    assert answers.digits([]) == "[]"
    assert answers.digits("soft") == "'soft'"


def test_refusal_reads_as_what_it_says():
    assert str(feedback.Wrong("You square.", "squared", nudge=True)) == "You square."


# ---- how it is judged ------------------------------------------------------------------------------------------------

NUMBERS = judging.Numbers(
    {"my_height": judging.Value("for the height", rtol=0.05), "my_count": judging.Value("for the count")},
    {"my_height": 100.0, "my_count": 10.0},
    [("halved", {"my_height": 50.0}), ("both", {"my_height": 20.0, "my_count": 2.0})],
)


@pytest.mark.parametrize(
    ("answer", "what", "mistake"),
    [
        ((110.0, ...), "Not right for the height: 110 is close, but not within 5 %. Read or compute it", None),
        ((90.0, 10.0), "Not right for the height: 90 is close", None),
        ((130.0, ...), "Not right for the height: you have 130.", None),
        ((..., 11.0), "Not right for the count: you have 11.", None),
        ((50.0, 10.0), "", "halved"),
        ((20.0, 2.0), "", "both"),
        ((20.0, ...), "Not right for the height: you have 20.", None),
    ],
)
def test_number_that_is_not_right_is_close_or_a_mistake_or_neither(answer, what, mistake):
    with pytest.raises(feedback.Wrong) as raised:
        list(NUMBERS(*answer))
    assert raised.value.what.startswith(what)
    assert raised.value.mistake == mistake


def test_numbers_within_their_tolerance_are_right():
    assert len(list(NUMBERS(104.0, 10.0))) == 2
    assert len(list(NUMBERS(..., 10.0))) == 1


def test_what_cannot_be_called_is_no_answer_where_a_function_is_asked_for():
    judge = judging.Cases(lambda x: 2 * x, [], [(1.0,), (3.0,)], "for {x:g}")
    assert len(list(judge(lambda x: x + x))) == 2
    with pytest.raises(feedback.Wrong, match=r"should be a function of \(x\); it is 3\.0"):
        list(judge(3.0))
    passed, wrong = judge(lambda x: x + 1)
    assert passed is None
    assert str(wrong) == "Not right for 3: it gives 4."


def test_search_that_is_none_or_divides_by_zero_of_itself_is_no_search_that_never_stops():
    with pytest.raises(feedback.Wrong, match=r"should be a function of \(height, early, late\)"):
        list(lesson_09.twelve_flights(60.2))

    def divides(height, early, late):
        return (height(early) - height(late)) / 0

    with pytest.raises(ZeroDivisionError):
        list(lesson_09.twelve_flights(divides))


def test_detector_that_says_nothing_is_told_that_its_return_is_missing():
    with pytest.raises(feedback.Wrong, match="None, neither True nor False: is a `return` missing"):
        lesson_11._alarm(None)


def test_measures_that_do_not_disagree_enough_are_told_by_how_much():
    exact, p, q = ([3.0, 0.01], [3.3, 0.001], [0.03, 0.08])
    with pytest.raises(feedback.Wrong) as raised:
        list(lesson_01.measures_disagree(exact, p, q))
    by_mape = (0.99 + 7) / (0.1 + 0.9)
    by_nmae = (0.3 + 0.009) / (2.97 + 0.07)
    assert raised.value.values == {"mape": pytest.approx(by_mape), "nmae": pytest.approx(by_nmae)}


def test_runs_are_named_as_people_would():
    assert not [what for what in lesson_11._runs() if "inf" in what]
    assert [what for what in lesson_11._runs() if ", never lit, " in what]


def test_midpoint_method_of_the_worlds_looks_at_the_middle():
    assert lesson_13._midpoint(lambda t, h, v: -v, 0.0, 0.0, 1.0, 0.1) == pytest.approx((0.09525, 0.905), rel=1e-15)
    assert lesson_13._midpoint(lambda t, h, v: t + h, 2.0, 1.0, 4.0, 0.2) == pytest.approx((1.87, 4.7), rel=1e-15)


def raising(error):
    def solve(*arguments):
        raise error

    return solve


def test_what_is_done_where_there_is_no_solution_is_told_in_words():
    probe = lesson_04.without_solution(1.0, 2.0)
    assert str(probe(raising(ZeroDivisionError()))) == "an ArithmeticError"
    for handed_back in (ArithmeticError("none"), ArithmeticError):
        assert str(probe(lambda x, y, back=handed_back: back)) == "an error that is handed back"
    for returned in (3.0, None, float):
        assert str(probe(lambda x, y, back=returned: back)) == "no word"
    with pytest.raises(feedback.Wrong, match="asked is an ArithmeticError.*raised ValueError: no root"):
        probe(raising(ValueError("no root")))


@pytest.mark.parametrize(
    ("ends", "mistake"),
    [
        (["crash", "stopped too high", "soft landing", "soft landing"], None),
        (["crash", "stopped too high", "stopped too high", "soft landing"], "stops too high"),
    ],
)
def test_law_that_stops_too_high_does_so_in_most_flights_that_fail(ends, mistake):
    with pytest.raises(feedback.Wrong) as raised:
        list(lesson_13._enough("With errors", ends, 4, 4, None, {0.6, 0.7, 1.0}))
    assert raised.value.mistake == mistake
    assert f"{ends.count('stopped too high')} × stopped too high" in raised.value.values["score"]
