"""The numbers of the flexible five-bar: lengths, inertias and friction, and its beam."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass, replace

import numpy as np

from onpath.assets import asset_path

_NAMES = "M11 M22 J0 J1 l1 l rho omega1 zeta alpha b1 b2 b3"
NAMES: tuple[str, ...] = tuple(_NAMES.split())
PAYLOAD = "payload"  # an additional name, for a robot with a payload


@dataclass(frozen=True, slots=True)
class FlexibleLinks:
    """Linkage and beam.

    Attributes:
        link1, link2, beam: lengths l1, l2 and l, [m].
        M11, M22, J0, J1: inertias, [kg m²].
        rho: mass of the beam per length, [kg/m].
        frequency: of the first mode, clamped, [Hz].
        zeta: damping ratio of every mode.
        b1, b2, b3: viscous friction of the joints, [N m s].
    """

    link1: float
    link2: float
    beam: float
    M11: float
    M22: float
    J0: float
    J1: float
    rho: float
    frequency: float
    zeta: float
    b1: float
    b2: float
    b3: float

    def lumped(self, alpha: float, payload: float = 0.0) -> dict[str, float]:
        """The parameters of the equations of motion by name (SI).

        Args:
            alpha: α, share of the deflection in the controlled output: 1 for the tip, 0 for the
                rigid link.
            payload: mass at the tip, [kg].
        """
        numbers = {name: getattr(self, name) for name in NAMES if hasattr(self, name)}
        omega1 = 2 * np.pi * self.frequency
        lengths = {"l1": self.link1, "l": self.beam}
        return numbers | lengths | {"omega1": omega1, "alpha": alpha, "payload": payload}

    def changed(self, rho: float, frequency: float, zeta: float) -> FlexibleLinks:
        """The same linkage with another beam: `rho` in [kg/m], `frequency` in [Hz]."""
        return replace(self, rho=rho, frequency=frequency, zeta=zeta)


def load_links() -> FlexibleLinks:
    """The illustrative robot of assets/flexible_five_bar.toml."""
    data = tomllib.loads(asset_path("flexible_five_bar.toml").read_text("utf-8"))
    return FlexibleLinks(**data["lengths"], **data["inertia"], **data["beam"], **data["friction"])
