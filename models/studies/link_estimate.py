"""Which base parameters of a robot's links a log tells, and their values.

The base parameters of `link_parameters.py` are those that any motion could tell; a log tells some
of them, and others only in sums with each other, as `parameter_estimate.py` finds.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from onpath.models.studies.linear_model import MotionRecord
from onpath.models.studies.parameter_estimate import BaseParameter, Sums, estimate
from onpath.models.systems.link_parameters import base_set, base_system, stated_values
from onpath.models.systems.rigid_chain import ChainSource


@dataclass(frozen=True, slots=True)
class LinkParameter:
    """A base parameter of a link.

    Attributes:
        link: its number, from 1.
        body: name of the link in the robot's file.
        terms: parameters of links and their multiples, whose sum it is; the leading one is first.
        stated: its value by the robot's file, or of the sum that is told.
        told: what a log tells of it, by the names of leading parameters: itself, or with `others`
            the sum with multiples of these; None: nothing.
    """

    link: int
    body: str
    terms: Sums
    stated: float
    told: BaseParameter | None

    @property
    def name(self) -> str:
        """Name of the leading parameter, such as "Izz1"."""
        return self.terms[0][0]


@dataclass(frozen=True, slots=True)
class LinkEstimate:
    """What a log tells of a robot's links.

    Attributes:
        parameters: all base parameters, from the base to the tip.
        unexplained: share of the torque that they do not explain.
    """

    parameters: tuple[LinkParameter, ...]
    unexplained: float


def link_estimate(source: ChainSource, records: list[MotionRecord]) -> LinkEstimate:
    """Estimate the base parameters of a chain's links, and the dry friction of its motors.

    Raises:
        ValueError: see `estimate`.
    """
    base, system, chain = base_set(source), base_system(source), source.chain
    found = estimate(system, records, np.zeros(len(base.leading)))
    told = {each.name: each for each in found.found}
    values = dict(zip(base.base_names, base.sums @ stated_values(chain), strict=True))
    parameters = list[LinkParameter]()
    for i, name in enumerate(base.base_names):
        link = int(name.lstrip("IabmxyzJ"))
        each = told.get(name)
        sums = () if each is None else each.others
        stated = values[name] + sum(share * values.get(other, 0.0) for other, share in sums)
        body = chain.bodies[link - 1].name
        parameters.append(LinkParameter(link, body, base.terms(i), float(stated), each))
    return LinkEstimate(tuple(parameters), found.unexplained)
