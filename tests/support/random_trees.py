"""Random trees of links as URDF files, with names of any kind."""

from __future__ import annotations

from dataclasses import dataclass
from xml.sax.saxutils import quoteattr

from hypothesis import strategies as st

NAMES = st.text(st.characters(exclude_categories=("Cs", "Cc")), min_size=1, max_size=12).filter(
    str.strip
) | st.sampled_from(
    ["a/b", "<b>x</b>", "=1+1", "\u202egnp", "x" * 10_000, "../etc", "{x}", "é", '"', "a b", "%n"]
)


@dataclass(frozen=True)
class RandomLink:
    """A link, the joint before it, and a box.

    Attributes:
        name: its own.
        parent: number of the link before it.
        place, turn: of its joint, [m] and [rad].
        axis: of that.
        slides: whether it slides.
        box: edges, [m].
        mass: [kg]; 0: none is stated.
    """

    name: str
    parent: int
    place: tuple[float, ...]
    turn: tuple[float, ...]
    axis: tuple[float, ...]
    slides: bool
    box: tuple[float, ...]
    mass: float


@dataclass(frozen=True)
class Tree:
    """Links, of which the first stands still."""

    links: tuple[RandomLink, ...]

    def way(self, i: int) -> list[int]:
        """The links from the first one, without it, to another one."""
        found = list[int]()
        while i:
            found.insert(0, i)
            i = self.links[i].parent
        return found


def _numbers(low: float, high: float) -> st.SearchStrategy[tuple[float, ...]]:
    one = st.integers(0, 100).map(lambda k: round(low + (high - low) * k / 100, 4))
    return st.tuples(one, one, one)


@st.composite
def random_trees(draw: st.DrawFn, most: int = 7) -> Tree:
    """Trees of up to `most` moving links, whose last one is at the end of a chain."""
    count = draw(st.integers(2, most))
    names = draw(st.lists(NAMES, min_size=count + 1, max_size=count + 1, unique_by=str.strip))
    bare = draw(st.booleans())
    links = list[RandomLink]()
    for i, name in enumerate(names):
        parent = max(0, i - 1) if draw(st.integers(0, 3)) else draw(st.integers(0, max(0, i - 1)))
        axis = draw(_numbers(-1, 1).filter(lambda a: sum(x * x for x in a) > 0.1))
        stated = 0.0 if bare else draw(st.integers(1, 50)) / 10
        links.append(
            RandomLink(
                name=name,
                parent=parent,
                place=draw(_numbers(-0.4, 0.4)),
                turn=draw(_numbers(-3, 3)),
                axis=axis,
                slides=draw(st.integers(0, 4)) == 0,
                box=draw(_numbers(0.02, 0.3)),
                mass=stated,
            )
        )
    return Tree(tuple(links))


def tree_urdf(tree: Tree, plain: bool = False) -> str:
    """The file; `plain` names are link0, link1, …, and so are the joints' always."""
    parts = list[str]()
    for i, link in enumerate(tree.links):
        name = quoteattr(_name(tree, i, plain))
        shape = f'<geometry><box size="{_text(link.box)}"/></geometry>'
        solid = f"<visual>{shape}</visual><collision>{shape}</collision>"
        parts.append(f"<link name={name}>{_inertial(link)}{solid}</link>")
        if i:
            before = quoteattr(_name(tree, link.parent, plain))
            parts.append(
                f'<joint name="joint{i}" type="{"prismatic" if link.slides else "revolute"}">'
                f"<parent link={before}/><child link={name}/>"
                f'<origin xyz="{_text(link.place)}" rpy="{_text(link.turn)}"/>'
                f'<axis xyz="{_text(link.axis)}"/>'
                '<limit lower="-3" upper="3" effort="9" velocity="9"/></joint>'
            )
    return f'<robot name="random">{"".join(parts)}</robot>'


def _name(tree: Tree, i: int, plain: bool) -> str:
    return f"link{i}" if plain else tree.links[i].name


def _inertial(link: RandomLink) -> str:
    if not link.mass:
        return ""
    x, y, z = (link.mass / 12 * edge**2 for edge in link.box)
    moments = f'ixx="{y + z!r}" iyy="{x + z!r}" izz="{x + y!r}" ixy="0" ixz="0" iyz="0"'
    return f'<inertial><mass value="{link.mass}"/><inertia {moments}/></inertial>'


def _text(values: tuple[float, ...]) -> str:
    return " ".join(map(str, values))
