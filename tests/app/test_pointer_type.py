"""The pointer type is a choice: whatever else a page sends is stored, and exported, as other."""

import pytest
from sqlalchemy import update

from analysis import PARTICIPANTS, read_table
from app.export import export
from app.tables import participants
from tests import messages


def play_with(browser, pointer_type):
    browser.reach_trials()
    device = messages.played("")["device"] | {"pointer_type": pointer_type}
    return browser.play(1, device=device)


@pytest.mark.parametrize("sent", ["mouse", "touch", "pen", "keyboard", "other", None])
def test_a_known_pointer_type_is_stored_as_it_is(browser, rows, sent):
    assert play_with(browser, sent).status_code == 200
    assert rows(participants)[0].pointer_type == sent


@pytest.mark.parametrize("sent", ["", "stylus", "=HYPERLINK(1)", "x" * 500, 7, True, ["mouse"], {}])
def test_anything_else_is_stored_as_other_and_never_refused(browser, rows, sent):
    assert play_with(browser, sent).status_code == 200
    assert rows(participants)[0].pointer_type == "other"


def test_what_an_older_version_stored_is_exported_as_other(browser, client, study, tmp_path):
    play_with(browser, "mouse")
    database = client.app.state.services.database
    older = update(participants).values(pointer_type="trackball")
    database.submit(lambda connection: connection.execute(older)).result()
    export(database, study, tmp_path, simulated=False)
    assert read_table(PARTICIPANTS, tmp_path / "participants.csv")["pointer_type"].to_list() == [
        "other"
    ]
