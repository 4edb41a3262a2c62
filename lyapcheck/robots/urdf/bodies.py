"""Whether the bodies of a URDF file can exist."""

from __future__ import annotations

from fractions import Fraction

from lyapcheck.check.numbers.matrices import is_positive_semidefinite
from lyapcheck.robots.chain_bounds import bodily
from lyapcheck.robots.urdf.fields import UrdfNotes
from lyapcheck.robots.urdf.parts import UrdfJoint, UrdfLink
from lyapcheck.robots.urdf.tree import Tree, carrier


def moved_links(tree: Tree, chain: tuple[UrdfJoint, ...]) -> list[UrdfLink]:
    """The links that the chain moves; those of the base do not matter."""
    return [tree.links[name] for name, joint in carrier(tree, chain).items() if joint is not None]


def check_bodies(links: list[UrdfLink], notes: UrdfNotes) -> None:
    """Note every link whose inertia is not positive semidefinite: M would not be positive definite."""
    for link in links:
        if not is_positive_semidefinite(tensor(link)):
            repair = "check the signs and the point about which it is given (the centre of mass)"
            notes.fail(
                link.element, f"link {link.name}: inertia", "", "must be positive semidefinite", repair
            )


def impossible(links: list[UrdfLink]) -> list[str]:
    """The links with a principal moment above the sum of the others: no body has that, but many files do."""
    return [link.name for link in links if not bodily(tensor(link))]


def tensor(link: UrdfLink) -> list[list[Fraction]]:
    """The inertia of a link as the file gives it."""
    xx, yy, zz, xy, xz, yz = link.inertia
    return [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
