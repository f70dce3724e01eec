"""Arrival: the invitation link, coming back by it, and consent.

Each function takes the connection of an open transaction; `database.write` commits it before
the reply. Opening the link changes nothing: scanners and previews open people's links, too.
"""

import re
import secrets
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import timedelta

from sqlalchemy import Connection

from app import VERSION, books, repository
from app.errors import CLOSED_TO_ARRIVALS, InvalidInput, StudyClosed
from app.event_log import CAME_BACK
from app.recruiter_ids import (
    PARAMETERS,
    is_unfilled,
    lacking_id,
    misnamed,
    not_filled_in,
    read_id,
    require_shape,
)
from app.repository import Record
from app.sessions import begin_session, hashed
from app.steps import ENDINGS, Step
from app.study import PARTICIPANT, PILOTS, Study

DECLINED = "arrived, no consent"
"""Name of the anonymous count of those who said no."""

_ARRIVAL = re.compile(r"[A-Za-z0-9_-]{16,64}")


@dataclass(frozen=True)
class Link:
    """What an invitation link says: the recruiter's ids, and whether this is a pilot.

    `misnamed` is a parameter that looks like the id under a name that is not ours, `unfilled` one
    of the others that holds a placeholder.
    """

    recruiter_id: str | None = None
    recruiter_study: str | None = None
    recruiter_session: str | None = None
    stream: str = PARTICIPANT
    misnamed: str | None = None
    unfilled: str | None = None

    @classmethod
    def read(cls, values: Mapping[str, str]) -> "Link":
        """Read a link's query or the consent form's hidden fields; BadLink if not filled in."""
        person, *others = PARAMETERS
        unfilled = next((name for name in others if is_unfilled(name, values)), None)
        study, session = (
            None if is_unfilled(name, values) else read_id(name, values) for name in others
        )
        return cls(
            read_id(person, values), study, session, stream_of(values), misnamed(values), unfilled
        )

    @property
    def ids(self) -> dict[str, str]:
        """The recruiter's ids by parameter."""
        ids = (self.recruiter_id, self.recruiter_study, self.recruiter_session)
        return {name: value for name, value in zip(PARAMETERS, ids, strict=True) if value}

    def fields(self) -> dict[str, str]:
        """The same as hidden fields of the consent form, or the query of a link."""
        return self.ids if self.stream == PARTICIPANT else {**self.ids, self.stream: "1"}

    def require_of_newcomer(self, id_required: bool) -> None:
        """BadLink unless somebody who is not known yet can come by this link."""
        if self.unfilled:
            raise not_filled_in(self.unfilled)
        for name, value in self.ids.items():
            require_shape(name, value)
        if id_required and self.recruiter_id is None and self.stream == PARTICIPANT:
            raise lacking_id(self.misnamed)


def stream_of(values: Mapping[str, str]) -> str:
    """The stream that a link or a form is for; only the value 1 makes a pilot."""
    return next((stream for stream in PILOTS if values.get(stream) == "1"), PARTICIPANT)


@dataclass(frozen=True)
class Known:
    """Somebody who opened a link again.

    `elsewhere`: in a browser that has no session of theirs; `same_invitation`: by the link with
    which they began, and not by one for another submission of theirs.
    """

    participant: Record
    elsewhere: bool
    same_invitation: bool


def find(connection: Connection, link: Link, token: str | None) -> Known | None:
    """Who opens a link: by the recruiter's id or, without one, by the browser's session.

    A session that has ended, or that moved away, claims nobody who comes without an id: on a
    shared computer that is somebody else.
    """
    here = repository.participant_in_session(connection, hashed(token))
    if here is not None and not (here.current and here.stream == link.stream):
        here = None
    if link.recruiter_id is None:
        stays = here is not None and here.step not in ENDINGS
        return Known(here, False, True) if here is not None and stays else None
    known = repository.participant_recruited(connection, link.stream, link.recruiter_id)
    if known is None:
        return None
    same = _same_invitation(repository.recruit_of(connection, known.id), link)
    is_here = here is not None and here.id == known.id
    # A browser that came by another invitation proves itself by the very one.
    unproven = here is not None and not here.proven and _proves(same, link)
    return Known(known, elsewhere=not is_here or unproven, same_invitation=same)


def go_on_here(
    connection: Connection, study: Study, link: Link, token: str | None, user_agent: str
) -> tuple[Known, str | None] | None:
    """Let somebody who is known by their link go on in this browser.

    Returns who it is and their new session's token, none where this browser had one already;
    None for whoever is not known (any more).
    """
    known = find(connection, link, token)
    if known is None:
        return None
    if not known.elsewhere:
        return known, None
    proven = _proves(known.same_invitation, link)
    return known, _move(connection, study, known.participant, user_agent, proven)


def _move(
    connection: Connection, study: Study, participant: Record, user_agent: str, proven: bool
) -> str:
    """Move a participant's session to this browser; returns its token.

    An animation that was moving in the other browser counts as seen for as long as it can have
    been: it goes on from there, and cannot be watched again from its start.
    """
    token = begin_session(connection, study, participant, CAME_BACK, user_agent, proven)
    trial = repository.last_trial(connection, participant.id)
    if trial is not None and trial.stopped_at is None:
        since_ms = (repository.now() - trial.played_at) / timedelta(milliseconds=1)
        repository.change_trial(
            connection,
            participant.id,
            trial.trial_index,
            position_ms=max(trial.position_ms, min(since_ms, trial.length_ms)),
        )
    return token


def _proves(same_invitation: bool, link: Link) -> bool:
    """Whether an invitation shows that a browser is the participant's: not by the id alone."""
    return same_invitation and link.recruiter_session is not None


def _same_invitation(recruit: Record | None, link: Link) -> bool:
    began_with = recruit and (recruit.recruiter_study, recruit.recruiter_session)
    return began_with == (link.recruiter_study, link.recruiter_session)


def has_own_code(connection: Connection, participant: Record) -> bool:
    """Whether a browser may show the code of an ending: that of another submission is not its."""
    if participant.proven:
        return True
    recruit = repository.recruit_of(connection, participant.id)
    return recruit is None or recruit.recruiter_session is None


def consent(
    connection: Connection,
    study: Study,
    arrival: str,
    link: Link,
    token: str | None,
    user_agent: str,
) -> str | None:
    """Make the participant, once for each recruiter's id, browser and showing of the form.

    Returns the token of their session; None when there is a participant already, whom the link
    leads on.
    """
    known = find(connection, link, token)
    sent_before = repository.participant_arrived(connection, arrival)
    if known is not None and not (known.elsewhere and sent_before):
        return None
    if sent_before is not None:
        # Pressed twice: the browser gave up the reply that brought its session.
        return _move(connection, study, sent_before, user_agent, proven=True)
    if not study.settings.study_open:
        raise StudyClosed(CLOSED_TO_ARRIVALS)
    link.require_of_newcomer(study.settings.require_id)
    if books.take_back_no(connection, arrival):
        books.tally(connection, DECLINED, -1)
    participant = repository.add_participant(
        connection,
        pseudonym=new_pseudonym(),
        arrival=arrival,
        stream=link.stream,
        step=Step.ABOUT_YOU,
        study_hash=study.hash,
        app_version=VERSION,
        consent_hash=study.consent_hash,
        consented_at=repository.now(),
        user_agent=user_agent,
        pilot_before=_was_pilot(connection, link),
    )
    if link.recruiter_id:
        repository.add_recruit(
            connection,
            participant_id=participant.id,
            stream=link.stream,
            recruiter_id=link.recruiter_id,
            recruiter_study=link.recruiter_study,
            recruiter_session=link.recruiter_session,
        )
    return begin_session(connection, study, participant, "consented", user_agent, proven=True)


def decline(connection: Connection, arrival: str, link: Link, token: str | None) -> bool:
    """Count somebody who gave no consent, once for each showing of the form, unless a pilot.

    Nothing else is kept of them. False, and nothing is counted, for who has consented already.
    """
    consented = repository.participant_arrived(connection, arrival)
    if consented is not None or find(connection, link, token) is not None:
        return False
    if link.stream == PARTICIPANT and books.note_no(connection, arrival):
        books.tally(connection, DECLINED)
    return True


def read_arrival(form: Mapping[str, str]) -> str:
    """The nonce of one showing of the consent form; InvalidInput for what no form of ours has."""
    arrival = form.get("arrival", "")
    if not _ARRIVAL.fullmatch(arrival):
        raise InvalidInput("arrival: expected the hidden field of the consent page.")
    return arrival


def new_pseudonym() -> str:
    """A random name; no spreadsheet takes it for a number, whatever digits it holds."""
    return f"p{secrets.token_hex(6)}"


def _was_pilot(connection: Connection, link: Link) -> bool:
    """Whether a participant's recruiter's id has been a pilot before."""
    if link.stream != PARTICIPANT or link.recruiter_id is None:
        return False
    return any(
        repository.participant_recruited(connection, stream, link.recruiter_id) for stream in PILOTS
    )
