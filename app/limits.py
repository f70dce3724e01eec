"""How many may begin from one network: a token bucket for each, in memory, names of none."""

import math
import secrets
import time
from collections import OrderedDict
from collections.abc import Callable
from hashlib import blake2b
from ipaddress import IPv6Address, ip_address

MOST_NETWORKS = 10_000
"""Kept at once, a few hundred bytes each; the one not seen for longest is forgotten."""
IPV6_HOST_BITS = 64
"""A household or a phone has a whole network of addresses, of which this part is its own."""


class Moderation:
    """Lets `per_minute` through from each network, as many at once, then one at a time."""

    def __init__(self, per_minute: int, clock: Callable[[], float] = time.monotonic) -> None:
        self._most = float(per_minute)
        self._per_second = per_minute / 60
        self._clock = clock
        self._secret = secrets.token_bytes(16)
        self._buckets: OrderedDict[bytes, tuple[float, float]] = OrderedDict()

    def wait_s(self, address: str | None) -> int:
        """0 if somebody may begin from there, which is counted; else how many seconds to wait.

        Nobody waits whose address is unknown, or this machine's own: programs that rehearse, and
        everybody behind a proxy that does not say for whom it asks.
        """
        network = _network(address)
        if network is None:
            return 0
        key = blake2b(network, key=self._secret, digest_size=16).digest()
        now = self._clock()
        left, since = self._buckets.pop(key, (self._most, now))
        left = min(self._most, left + (now - since) * self._per_second)
        allowed = left >= 1
        self._buckets[key] = (left - 1 if allowed else left, now)
        if len(self._buckets) > MOST_NETWORKS:
            self._buckets.popitem(last=False)
        return 0 if allowed else math.ceil((1 - left) / self._per_second)


def _network(address: str | None) -> bytes | None:
    try:
        known = ip_address(address or "")
    except ValueError:
        return None
    if isinstance(known, IPv6Address):
        known = known.ipv4_mapped or known
    if known.is_loopback:
        return None
    if isinstance(known, IPv6Address):
        return (int(known) >> IPV6_HOST_BITS).to_bytes(8, "big")
    return known.packed
