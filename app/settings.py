"""Settings, each read from a variable GOALGUESS_<NAME>."""

import os
import re
from functools import cached_property
from pathlib import Path
from typing import Annotated, Literal
from urllib.parse import urlsplit

from pydantic import Field, ValidationError, field_validator
from pydantic_core import PydanticCustomError
from pydantic_settings import BaseSettings, SettingsConfigDict, SettingsError
from sqlalchemy.engine import make_url
from sqlalchemy.exc import ArgumentError

from app.errors import InvalidInput

PREFIX = "GOALGUESS_"

CODES_EXAMPLE = '{"completed": "C1A2B3"}'

Ending = Literal["completed", "no_consent", "screened_out", "failed", "withdrawn"]


_WITHOUT_CODE: dict[Ending, str] = {
    "completed": "recruited participants get no completion code, and are asked to message you",
    "no_consent": "whoever does not agree is asked to return their submission, without a link",
    "screened_out": "whoever fails the control question is asked to return their submission, "
    "without a link",
    "failed": "whoever the study does not work for is asked to message you",
    "withdrawn": "whoever withdraws is asked to return their submission, without a link",
}
"""What participants meet at an ending that has no code."""


class Settings(BaseSettings):
    """All settings with their defaults; a test holds README's table equal to them."""

    model_config = SettingsConfigDict(env_prefix=PREFIX, frozen=True)

    database_url: str = Field(
        "sqlite:///goalguess.sqlite", description="Where answers are stored: a SQLite file."
    )
    withdrawals: Path | None = Field(
        None,
        description="List of withdrawn participants, by which a restored backup drops them "
        "again (default: beside the database, ending in .withdrawn).",
    )
    study_open: bool = Field(
        True, description="Whether new participants may begin, and finished ones still withdraw."
    )
    require_id: bool = Field(
        False,
        description="Whether participants need a recruiter's id in their link; pilots need none.",
    )
    researchers: str = Field("", description="Who runs the study, as the consent page says it.")
    contact: str = Field("", description="How participants reach the researchers.")
    seed: Annotated[int, Field(ge=0, lt=2**63)] | None = Field(
        None,
        description="Seed of the dealing of conditions and lists, stored when the database is "
        "made (default: drawn at random then).",
    )
    block_size: Annotated[int, Field(ge=2, le=1000, multiple_of=2)] = Field(
        4, description="Places in a block; each block holds both conditions equally often."
    )
    place_minutes: Annotated[float, Field(gt=0, le=525_600)] = Field(
        30, description="A place whose first frame is not played for this long is dealt again."
    )
    step_ms: Annotated[int, Field(ge=20, le=60_000)] = Field(
        1000, description="Duration of one maze step, ms."
    )
    lead_in_ms: Annotated[int, Field(ge=0, le=60_000)] = Field(
        1500, description="Still picture before the motion, ms; not counted as time."
    )
    return_url: str = Field(
        "https://app.prolific.com/submissions/complete?cc={code}",
        description="Where participants go at the end; {code} is the ending's code.",
    )
    codes: dict[Ending, str] = Field(
        {},
        description="Recruiter's code of each ending, as JSON: completed, no_consent, "
        "screened_out, failed, withdrawn. An ending without a code says what to do instead.",
    )

    root_path: str = Field(
        "",
        description="Path under which a proxy shows the study, like /study; whether the proxy "
        "passes it on or takes it off makes no difference.",
    )
    consents_per_minute: Annotated[int, Field(ge=1, le=100_000)] = Field(
        60,
        description="How many may begin in a minute from one network address; more are asked to "
        "wait. This machine's own address has no limit.",
    )
    keep_alive_s: Annotated[int, Field(ge=1, le=3600)] = Field(
        65,
        description="How long an unused connection stays open, s; longer than the proxy keeps its "
        "own.",
    )

    @field_validator("return_url")
    @classmethod
    def _require_web_address(cls, value: str) -> str:
        if not value:
            return value
        try:
            address = urlsplit(value)
        except ValueError:
            address = urlsplit("")
        if (
            address.scheme not in ("http", "https")
            or not address.hostname
            or not value.isprintable()
        ):
            raise PydanticCustomError(
                "web_address", "expected an address that begins with https:// or http:// and a host"
            )
        return value

    @field_validator("root_path")
    @classmethod
    def _require_path(cls, value: str) -> str:
        if not re.fullmatch(r"(/[A-Za-z0-9._~-]+)*", value):
            raise PydanticCustomError(
                "path", "expected a path like /study, without a slash at its end"
            )
        return value

    @cached_property
    def database_file(self) -> Path:
        """The SQLite file; InvalidInput for any other kind of database."""
        try:
            url = make_url(self.database_url)
        except ArgumentError:
            url = None
        named = url is not None and url.drivername in ("sqlite", "sqlite+pysqlite")
        if url is None or not named or url.database in (None, "", ":memory:"):
            raise InvalidInput(
                "GOALGUESS_DATABASE_URL: expected a SQLite file like "
                f"sqlite:///goalguess.sqlite, came {self.database_url!r}"
            )
        return Path(str(url.database))

    @property
    def gaps(self) -> list[str]:
        """What participants will miss as long as it is not set, a line each."""
        needed = {
            "RESEARCHERS": (self.researchers, "the consent page names nobody"),
            "CONTACT": (self.contact, "participants cannot reach you"),
            **{
                f"CODES, {ending}": (self.codes.get(ending), lack)
                for ending, lack in _WITHOUT_CODE.items()
            },
        }
        return [f"{PREFIX}{name} ({lack})" for name, (value, lack) in needed.items() if not value]

    @property
    def doubts(self) -> list[str]:
        """What is set so that recruiters may pay or lead people wrongly, a line each."""
        found = []
        for ending, code in self.codes.items():
            if code and ending != "completed" and code == self.codes.get("completed"):
                found.append(
                    f"{PREFIX}CODES, {ending}: the same code as completed, so the recruiter cannot "
                    "tell these people from those to be paid"
                )
        if any(self.codes.values()) and self.return_url and "{code}" not in self.return_url:
            found.append(f"{PREFIX}RETURN_URL: holds no {{code}}, so the way back brings none")
        return found

    @property
    def withdrawals_file(self) -> Path:
        """The list of withdrawn participants, kept outside the database."""
        file = self.database_file
        return self.withdrawals or file.with_name(file.name + ".withdrawn")


def load_settings() -> Settings:
    """The settings of this process's environment; InvalidInput names the variable at fault."""
    known = {f"{PREFIX}{name.upper()}" for name in Settings.model_fields}
    unknown = sorted(name for name in os.environ if name.startswith(PREFIX) and name not in known)
    if unknown:
        raise InvalidInput(f"{unknown[0]}: expected one of {', '.join(sorted(known))}")
    try:
        return Settings()
    except SettingsError as error:
        raise InvalidInput(f"{PREFIX}CODES: expected JSON like {CODES_EXAMPLE}") from error
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        name, *key = (str(part) for part in first["loc"])
        where = f"{PREFIX}{name.upper()}" + (f", {key[0]!r}" if key else "")
        example = f"; write it like {CODES_EXAMPLE}" if name == "codes" else ""
        raise InvalidInput(
            f"{where}: {first['msg']}, came {str(first['input'])!r}{example}"
        ) from error
