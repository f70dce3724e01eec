"""The report: its parts, what they say, and how they look on paper, screen and terminal."""
