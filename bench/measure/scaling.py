"""How runs on many ranks scale, predicted from what few ranks exchange."""
import math
from typing import NamedTuple

CHUNK = 256                 # bodies

# The assumed cluster: two sockets of 32 cores a node, and a network of 200 Gbit/s.
CORES = 64
LATENCY = 2e-6              # s, of a message, and of each doubling of ranks in a reduction
NETWORK = 25e9              # bytes/s, of a node
COPY = 5e9                  # bytes/s, of a rank in the memory of its node
IMBALANCE = 0.03


class Count(NamedTuple):
    """Of a run on some ranks."""
    sharing: dict  # of run.json
    memory: float  # of the largest rank [bytes]


class Alone(NamedTuple):
    """One process."""
    seconds: float   # of a particle-step
    contacts: float  # their share of it
    steps: float     # to a search


class Fits:
    """Counts of any ranks: those of a surface go with the third root of the bodies of a rank."""

    def __init__(self, grains, found, alone):
        deep = {ranks: one for ranks, one in found.items() if ranks >= 8} or found  # with neighbours on all sides
        mean = lambda value: sum(value(ranks, one.sharing) for ranks, one in deep.items()) / len(deep)  # noqa: E731
        root = lambda ranks: (grains / ranks) ** (1 / 3)  # noqa: E731
        own = lambda ranks, one: one['neighbours'] * grains / ranks  # noqa: E731
        self.neighbours = mean(lambda ranks, one: one['neighbours'] * root(ranks))
        self.pairs = mean(lambda ranks, one: one['shared_pairs'] * root(ranks))
        self.dependent = mean(lambda ranks, one: (1 - one['independent_pairs']) * root(ranks))
        self.bytes = mean(lambda ranks, one: one['step']['bytes'] / own(ranks, one))
        self.search_bytes = mean(lambda ranks, one: one['search']['bytes'] / own(ranks, one))
        self.of_chunk = mean(lambda ranks, one: one['search']['gathered_bytes'] / ((1 - 1 / ranks) * grains / CHUNK))
        self.gathers = mean(lambda ranks, one: one['search']['gathers'])
        self.messages = deep[max(deep)].sharing['step']['messages']
        self.alone = alone

    def parts(self, bodies, ranks):
        """Seconds of a step of weak scaling, with so many bodies on each rank."""
        levels = math.log2(ranks)
        neighbours = self.neighbours * bodies ** (2 / 3)
        leaving = CORES ** (2 / 3) * neighbours if ranks > CORES else 0  # of a node
        gathered = self.of_chunk * bodies * ranks / CHUNK
        computing = self.alone.seconds * bodies
        messages, network = self.messages * LATENCY, leaving * self.bytes / NETWORK
        meanwhile = computing * self.alone.contacts * max(0, 1 - self.dependent / bodies ** (1 / 3))
        waiting = max(0, messages + network - meanwhile) / (messages + network)
        search = neighbours * self.search_bytes / COPY + leaving * self.search_bytes / NETWORK + gathered / COPY + self.gathers * LATENCY * levels
        return {'computing': computing,
                'shared pairs': computing * self.alone.contacts * self.pairs / bodies ** (1 / 3),
                'imbalance': computing * (1 + self.alone.contacts * self.pairs / bodies ** (1 / 3)) * IMBALANCE,
                'copies in a node': neighbours * self.bytes / COPY,
                'waiting for messages': waiting * messages,
                'waiting for the network': waiting * network,
                'reductions': 2 * LATENCY * levels,
                'searches': search / self.alone.steps}

    def efficiency(self, bodies, ranks):
        if ranks == 1:
            return 1.0
        parts = self.parts(bodies, ranks)
        return parts['computing'] / sum(parts.values())
