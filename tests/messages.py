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
RIGHT_ANSWER = {"attempt": "1", "answer": "know"}

Body = dict[str, Any]


def key() -> str:
    return str(uuid.uuid4())


def control(answer: str, attempt: int = 1) -> dict[str, str]:
    return {"attempt": str(attempt), "answer": answer}


def event(kind: str, client_time_ms: float = 1.5, **details: Any) -> Body:
    return {"type": kind, "client_time_ms": client_time_ms, "details": details}


def played(ticket: str) -> Body:
    device = {
        "viewport_width": 1280,
        "viewport_height": 800,
        "pixel_ratio": 1.0,
        "refresh_rate_hz": 60.0,
        "pointer_type": "mouse",
        "reduced_motion": False,
    }
    events = [event("shown"), event("played")]
    return {"key": key(), "ticket": ticket, "device": device, "events": events}


def stopped(stop_time_ms: float) -> Body:
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
    }


def answered(guess: str, stop_time_ms: float, confidence: int = 5) -> Body:
    return {
        "key": key(),
        "stop_time_ms": stop_time_ms,
        "guess": guess,
        "confidence": confidence,
        "guess_latency_ms": 1200.5,
        "confidence_latency_ms": 800,
        "pointer_moved": True,
        "events": [event("answered")],
    }
