"""The losses that an export reported, for the verification of the result."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace

from ...finding import Finding
from ...model.elements import Collision, Link, Mesh, Robot, Visual


@dataclass(frozen=True)
class DeclaredLosses:
    """Losses that an export reported; a verification accepts the differences that they explain.

    Attributes:
        losses: Pairs of the code of a loss and the name of its link, joint or file.
    """

    losses: frozenset[tuple[str, str]] = frozenset()

    @classmethod
    def from_findings(cls, findings: Iterable[Finding]) -> DeclaredLosses:
        """Collect the codes and names of findings."""
        return cls(frozenset((finding.code, finding.name) for finding in findings))

    def has_any(self, *codes: str) -> bool:
        """Return whether a loss with one of these codes was reported anywhere."""
        return any(code in codes for code, _ in self.losses)

    def has_for(self, codes: Iterable[str], *names: str) -> bool:
        """Return whether a loss with one of these codes was reported for one of these names."""
        return any((code, name) in self.losses for code in codes for name in names)


def name_links(robot: Robot, losses: Iterable[Finding]) -> Iterator[Finding]:
    """Yield losses, those of mesh files and materials also for each link that has them."""
    losses = list(losses)
    yield from losses
    named = [loss for loss in losses if loss.kind in ("mesh", "material")]
    for link in robot.links if named else ():
        names = set(list_look_names(link))
        yield from (replace(loss, name=link.name) for loss in named if loss.name in names)


def list_look_names(link: Link) -> Iterator[str]:
    """Yield the names of the materials and mesh files of a link, which losses have."""
    for visual in link.visuals:
        if visual.material is not None:
            yield visual.material.name
    shapes: list[Visual | Collision] = [*link.visuals, *link.collisions]
    for shape in shapes:
        if isinstance(shape.geometry, Mesh):
            yield shape.geometry.filename.rpartition("/")[2]
