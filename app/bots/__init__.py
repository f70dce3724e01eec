"""Simulated participants: they walk the whole study through its real routes.

crowd -> visit -> rounds -> observer: many of them, one's way, ten rounds, a judgement.
"""
