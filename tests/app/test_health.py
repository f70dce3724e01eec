"""What a watcher sees: whether answers can be stored."""

import shutil
import sqlite3

from app import VERSION, health


def test_a_study_that_can_store_answers_is_well(browser):
    reply = browser.get("/health")
    assert reply.status_code == 200
    assert set(reply.json()) == {"status", "version", "database_writable", "disk_free_mb"}
    assert reply.json() | {"disk_free_mb": 0} == {
        "status": "ok",
        "version": VERSION,
        "database_writable": True,
        "disk_free_mb": 0,
    }


def test_a_database_that_others_hold_is_failing_within_the_watchers_patience(
    browser, settings, monkeypatch
):
    monkeypatch.setattr(health, "PATIENCE_S", 0.2)
    with sqlite3.connect(settings.database_file, isolation_level=None) as other:
        other.execute("BEGIN IMMEDIATE")
        reply = browser.get("/health")
        other.execute("ROLLBACK")
    assert reply.status_code == 503
    assert (reply.json()["status"], reply.json()["database_writable"]) == ("failing", False)
    monkeypatch.undo()
    assert browser.get("/health").status_code == 200


def test_a_disk_that_is_nearly_full_is_failing(browser, monkeypatch):
    usage = shutil.disk_usage("/")._replace(free=50_000_000)
    monkeypatch.setattr(shutil, "disk_usage", lambda _folder: usage)
    reply = browser.get("/health")
    assert (reply.status_code, reply.json()["disk_free_mb"]) == (503, 50)


def test_a_folder_that_is_gone_is_failing(browser, monkeypatch):
    def gone(_folder):
        raise FileNotFoundError

    monkeypatch.setattr(shutil, "disk_usage", gone)
    assert browser.get("/health").status_code == 503
