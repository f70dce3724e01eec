"""What a participant's browser sends, for tests and benchmarks that play one."""

import uuid
from typing import Any

ABOUT_ME = {
    "age": "31",
    "gender": "woman",
    "nationality": "Portuguese",
    "education": "master's degree",
    "occupation": "employed",
    "robot_familiarity": "i have seen some",
}
RIGHT_ANSWER = {"answer": "know"}
WRONG_ANSWER = {"answer": "end"}

Body = dict[str, Any]


def key() -> str:
    return str(uuid.uuid4())


def event(kind: str, client_time_ms: float = 1.5, **details: Any) -> Body:
    return {"type": kind, "client_time_ms": client_time_ms, "details": details}


def played(**changes: Any) -> Body:
    device = {
        "viewport_width": 1280,
        "viewport_height": 800,
        "pixel_ratio": 1.0,
        "refresh_rate_hz": 60.0,
        "pointer_type": "mouse",
        "reduced_motion": False,
    }
    return {"key": key(), "device": device, "events": [event("shown"), event("played")], **changes}


def stopped(stop_time_ms: float, **changes: Any) -> Body:
    return {
        "key": key(),
        "stop_time_ms": stop_time_ms,
        "reached_end": False,
        "pauses": 0,
        "paused_ms": 0,
        "focus_losses": 0,
        "frames_dropped": 0,
        "reduced_motion": False,
        "events": [event("stopped")],
        **changes,
    }


def answered(guess: str = "A", confidence: int = 5, **changes: Any) -> Body:
    return {
        "key": key(),
        "guess": guess,
        "confidence": confidence,
        "guess_latency_ms": 1200.5,
        "confidence_latency_ms": 800,
        "events": [event("answered")],
        **changes,
    }
