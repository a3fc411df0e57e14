"""Robots of this package that are files in assets/robots."""

from __future__ import annotations

from onpath.assets import asset_path
from onpath.models.systems.chain_robot import chain_entry, output_axes
from onpath.models.systems.file_chain import Options
from onpath.models.systems.rigid_chain import ChainSource
from onpath.models.systems.robots import RobotEntry
from onpath.models.systems.urdf_file import read_urdf
from onpath.models.systems.xml_elements import root_of


def own_robot(name: str, label: str, text: str, home: tuple[float, ...]) -> RobotEntry:
    """The entry of the file of this name, whose tip is the link "tip"; see `ChainSource`."""
    file = asset_path(f"robots/{name}.urdf")
    chain = read_urdf(file, root_of(file.read_bytes()), Options(tip="tip")).chain
    return chain_entry(
        ChainSource(
            name=name,
            label=label,
            text=text,
            chain=chain,
            home=home,
            axes=output_axes(chain),
        )
    )
