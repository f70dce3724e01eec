"""Reading TOML strictly: every key is asked for by type, and one that nobody asked for is wrong."""

from __future__ import annotations

import hashlib
import json
import re
import tomllib
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any

from .errors import AnalysisError, TomlError

_NAMES: dict[type, str] = {str: "a text", float: "a number", int: "a whole number"}


def read_toml(path: Path) -> dict[str, Any]:
    """Return what the file holds; AnalysisError if it cannot be read, TomlError if no TOML."""
    try:
        text = path.read_text(encoding="utf-8")
        return tomllib.loads(text)
    except OSError as error:
        reason = error.strerror or str(error)
        raise AnalysisError(f"{path}: expected a TOML file, got: {reason}") from error
    except UnicodeDecodeError as error:
        raise TomlError(path.name, "", "TOML in UTF-8", str(error)) from error
    except tomllib.TOMLDecodeError as error:
        got = str(error) + _hint(text)
        raise TomlError(path.name, "", "TOML in UTF-8", got) from error


def _hint(text: str) -> str:
    """Say how TOML writes the first number that begins with its point."""
    found = re.search(r"^[^#=\n]*=\s*([+-]?)(\.\d+)", text, re.MULTILINE)
    return f"; write {found[1]}0{found[2]} for {found[1]}{found[2]}" if found else ""


def content_sha256(content: Mapping[str, Any]) -> str:
    """Return the hash of what a file says, in hexadecimal, however the file is written."""
    canonical = json.dumps(content, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(canonical.encode()).hexdigest()


class Section:
    """A table of a TOML file; `key` is its dotted place in `file`, empty for the whole."""

    def __init__(self, file: str, content: Mapping[str, Any], key: str = "") -> None:
        self.file, self.content, self._key = file, content, key

    def allow(self, known: Collection[str]) -> None:
        """Raise the first key that is not one of `known` as a TomlError."""
        for key in self.content:
            if key not in known:
                raise self.wrong(key, f"one of the keys {', '.join(known) or '(none)'}", key)

    def text(self, key: str) -> str:
        """Return a text that is not empty."""
        value = self._of(key, str)
        if not value:
            raise self.wrong(key, "a text", "an empty one")
        return str(value)

    def whole(self, key: str, least: int = 0) -> int:
        """Return a whole number, at least `least`."""
        value = self._of(key, int)
        if value < least:
            raise self.wrong(key, f"a whole number of at least {least}", value)
        return int(value)

    def number(self, key: str) -> float:
        """Return a finite number, which may be written as a whole one."""
        value = float(self._of(key, float))
        if not abs(value) < float("inf"):
            raise self.wrong(key, "a finite number", value)
        return value

    def choice(self, key: str, choices: Collection[str]) -> str:
        """Return a text that is one of `choices`."""
        value = self.content.get(key)
        if not isinstance(value, str) or value not in choices:
            raise self.wrong(key, " or ".join(choices), value)
        return value

    def section(self, key: str) -> Section:
        """Return a table in this one; a missing one is empty."""
        return self._section(self.content.get(key, {}), key)

    def sections(self, key: str) -> list[Section]:
        """Return a list of tables, each named by its place from 1."""
        value = self.content.get(key, [])
        if not isinstance(value, list):
            raise self.wrong(key, "a list of tables", value)
        return [self._section(each, f"{key}[{place}]") for place, each in enumerate(value, start=1)]

    def wrong(self, key: str, expected: str, got: object) -> TomlError:
        """Return the error that names this key."""
        return TomlError(self.file, self._place(key), expected, _shown(got))

    def _of(self, key: str, kind: type) -> Any:
        value = self.content.get(key)
        kinds = (int, float) if kind is float else (kind,)
        if not isinstance(value, kinds) or isinstance(value, bool):
            raise self.wrong(key, _NAMES[kind], value)
        return value

    def _section(self, value: object, key: str) -> Section:
        if not isinstance(value, dict):
            raise self.wrong(key, "a table", value)
        return Section(self.file, value, self._place(key))

    def _place(self, key: str) -> str:
        return f"{self._key}.{key}" if self._key else key


def _shown(value: object) -> str:
    return "nothing" if value is None else f"{value!r:.60}"
