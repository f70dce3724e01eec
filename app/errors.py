"""Errors of the study.

AppError (carries an HTTP status and a code; one handler renders it as page or JSON)
├── NoSession          401  the browser has no session, or one that has ended
├── Moved              409  the session went on in another browser
├── OtherParticipant   409  the browser's session is not that of the page's participant any more
├── NotProven          403  a browser that has not shown to be the participant's
├── NoSuchTrial        404  the study has no trial of this number
├── WrongStep          409  what was sent belongs to a step the participant is not at
├── StudyClosed        409  the study takes no new participants, and nobody out, any more
├── PlaceReturned      409  the place went to somebody else before its first frame was played
├── InvalidInput       422  what was sent cannot be: which field, expected, came
│   └── BadLink        422  the invitation link lacks what the recruiter was to write into it
├── TooLarge           413  the request is larger than any page of ours sends
├── ForeignOrigin      403  a POST that did not come from our own pages
│   └── HostChanged         ... as far as can be seen, because a proxy changed the header Host
├── TooMany            429  more began from one network than is taken in a minute
├── DatabaseMismatch   500  a database that this version must not open
├── DatabaseUnavailable 503 the database cannot store or read just now
└── DealingFailed      500  no balanced list could be drawn from the pool
"""


class AppError(Exception):
    """Anything the study refuses; the message is one sentence for whoever reads it."""

    status = 500
    code = "error"
    retry_after_s: int | None = None

    @property
    def shown(self) -> str:
        """What participants read of it."""
        return str(self)


class NoSession(AppError):
    """The browser has no session, or one that has ended."""

    status = 401
    code = "no_session"

    def __init__(self) -> None:
        super().__init__(
            "Please open the study through your invitation link, and allow its cookie."
        )


class Moved(AppError):
    """The session went on in another browser."""

    status = 409
    code = "moved"

    def __init__(self) -> None:
        super().__init__("You went on with the study in another browser.")


class OtherParticipant(AppError):
    """The browser's session is not that of the page's participant any more."""

    status = 409
    code = "other_participant"

    def __init__(self) -> None:
        super().__init__("Somebody else has begun the study in this browser since.")


class NotProven(AppError):
    """A browser that has not shown to be the participant's."""

    status = 403
    code = "not_proven"

    def __init__(self) -> None:
        super().__init__(
            "Please withdraw in the browser in which you took part, or open here the very link "
            "with which you began, if it names your session. Otherwise, write to the researchers."
        )


class NoSuchTrial(AppError):
    """The study has no trial of this number."""

    status = 404
    code = "no_such_trial"


class WrongStep(AppError):
    """What was sent belongs to a step the participant is not at."""

    status = 409
    code = "wrong_step"


CLOSED_TO_ARRIVALS = "No new participants can begin. Thank you for your interest."
CLOSED_TO_WITHDRAWAL = "To have your answers deleted, please write to the researchers."


class StudyClosed(AppError):
    """The study takes no new participants, and nobody out, any more."""

    status = 409
    code = "study_closed"


class PlaceReturned(AppError):
    """The place went to somebody else before its first frame was played."""

    status = 409
    code = "place_returned"

    def __init__(self) -> None:
        super().__init__("The first animation was not started in time; a new set is ready.")


class InvalidInput(AppError):
    """What was sent cannot be; the message names the field, what was expected and what came."""

    status = 422
    code = "invalid"


class BadLink(InvalidInput):
    """The invitation link lacks what the recruiter was to write into it."""

    code = "bad_link"


class TooLarge(AppError):
    """The request is larger than any page of ours sends."""

    status = 413
    code = "too_large"


class ForeignOrigin(AppError):
    """A POST that did not come from our own pages."""

    status = 403
    code = "foreign_origin"


class HostChanged(ForeignOrigin):
    """A POST of our own page, as it seems, whose header Host a proxy has changed."""

    def __init__(self) -> None:
        super().__init__(
            "The proxy in front of the study changes the address that browsers ask for: it must "
            "pass the header Host on unchanged, with its port. Please tell the researchers."
        )


class TooMany(AppError):
    """More began from one network than is taken in a minute."""

    status = 429
    code = "too_many"

    def __init__(self, wait_s: int) -> None:
        super().__init__(
            "Many people have just begun from your network. Nothing is wrong with yours: please "
            f"wait {wait_s} seconds, go back to the study, and press the button again."
        )
        self.retry_after_s = wait_s


class DatabaseMismatch(AppError):
    """A database that this version must not open."""


class DatabaseUnavailable(AppError):
    """The database cannot store or read just now: locked, lost, full, damaged, read-only.

    The message, for who runs the study, names file and reason; participants read `shown`.
    """

    status = 503
    code = "unavailable"
    retry_after_s = 5
    shown = (
        "The study cannot store anything just now. Please load this page again in a moment: "
        "nothing stored is lost, and what you had filled in is sent again."
    )


class DealingFailed(AppError):
    """No balanced list could be drawn from the pool."""
