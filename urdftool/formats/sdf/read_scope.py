"""Models of SDF with their includes, as scopes of names, and the frame graph of each.

Every pose is resolved within its model: ``//pose/@relative_to``, ``//frame/@attached_to`` and
``placement_frame`` of the specification (1.7 and later), and the rules of older versions.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from ...errors import ModelError
from ...model.pose import IDENTITY, Pose
from ...source.document import Element
from .read_values import Version, read_pose, read_text

SELF_COLLIDE = "contacts between the links of a nested model (self_collide) are not read"
"""Text of the loss for a link or model."""

MODEL = "__model__"
"""Name of the frame of a model."""

WORLD = "world"


@dataclass
class Item:
    """Link, joint or frame of a model.

    Attributes:
        element: Its element.
        home: Frame to which its pose is relative by default, in place of the model frame.
    """

    element: Element
    home: str = MODEL

    @property
    def name(self) -> str:
        """Return the name."""
        return self.element.get("name") or ""


@dataclass
class Scope:
    """Model with the names in it.

    Attributes:
        element: The ``<model>``.
        name: Name, which an ``<include>`` may replace.
        version: Version of its file.
        posed: Element whose ``<pose>`` is that of the model: the model or its ``<include>``.
        placement: Frame that the pose places; empty for the model frame.
        is_static: Whether it is fixed to the world.
        links: Links by name.
        joints: Joints by name.
        frames: Frames by name.
        models: Nested models by name.
        canonical: Name of the link to which the model frame is attached; empty if none is named.
        parent: Model around it.
        home: Frame of the parent to which its pose is relative by default.
        merged: Pose of the frame of a merged model, which has no contents of its own; its
            ``canonical`` is a link of the parent.
    """

    element: Element
    name: str
    version: Version
    posed: Element
    placement: str = ""
    is_static: bool = False
    links: dict[str, Item] = field(default_factory=dict)
    joints: dict[str, Item] = field(default_factory=dict)
    frames: dict[str, Item] = field(default_factory=dict)
    models: dict[str, Scope] = field(default_factory=dict)
    canonical: str = ""
    parent: Scope | None = None
    home: str = MODEL
    merged: Pose | None = None
    _poses: dict[str, Pose | None] = field(default_factory=dict)

    def list_scopes(self, prefix: str = "") -> Iterator[tuple[str, Scope]]:
        """Yield this scope and those nested in it, each with the prefix of its names."""
        if self.merged is None:
            yield prefix, self
        for name, model in self.models.items():
            yield from model.list_scopes(f"{prefix}{name}::")

    def compute_pose(self, name: str, user: Element) -> Pose:
        """Return the pose of a frame of any kind in the frame of this model.

        Args:
            name: Name, which may be scoped: ``arm::tip``.
            user: Element that refers to it.

        Raises:
            ModelError: There is no such frame, or frames refer to each other in a cycle.
        """
        if name in ("", MODEL):
            return IDENTITY
        known = self._poses.get(name, False)
        if known is None:
            raise ModelError(f"the pose of frame '{name}' refers to itself", at=user.place)
        if known is not False:
            return known  # type: ignore[return-value]
        self._poses[name] = None
        try:
            found = self._resolve(name, user)
        except RecursionError:
            raise ModelError("frames refer to more than 900 others", at=user.place) from None
        self._poses[name] = found
        return found

    def _resolve(self, name: str, user: Element) -> Pose:
        if name in self.links:
            return self._compute_item_pose(self.links[name], self.links[name].home)
        if name in self.frames:
            item = self.frames[name]
            return self._compute_item_pose(item, item.element.get("attached_to") or item.home)
        if name in self.joints:
            item = self.joints[name]
            return self._compute_item_pose(item, read_text(item.element, "child"))
        if name in self.models:
            return self._compute_nested_pose(self.models[name])
        first, separator, rest = name.partition("::")
        if separator and first in self.models:
            return self._compute_nested_pose(self.models[first]) @ self.models[first].compute_pose(
                rest, user
            )
        if name == WORLD and self.parent is None:
            return read_own_pose(self).invert()
        raise ModelError(f"frame '{name}' does not exist", at=user.place)

    def _compute_item_pose(self, item: Item, default: str) -> Pose:
        """Return the pose of an item whose pose is relative to a frame by default."""
        pose, named = read_pose(item.element)
        named = item.home if named == MODEL else named
        return self.compute_pose(named or default, item.element) @ pose

    def _compute_nested_pose(self, model: Scope) -> Pose:
        _, named = read_pose(model.posed)
        return self.compute_pose(named or model.home, model.posed) @ read_own_pose(model)

    def link_of(self, name: str, user: Element) -> tuple[str, ...] | None:
        """Return the path of the link to which a frame is attached; None for the world.

        Raises:
            ModelError: There is no such frame.
        """
        return self._link_of(name, user, 0)

    def _link_of(self, name: str, user: Element, depth: int) -> tuple[str, ...] | None:
        if depth > 100:
            raise ModelError(f"frame '{name}' is attached to itself", at=user.place)
        if name in self.links:
            return (name,)
        if name in self.frames:
            to = self.frames[name].element.get("attached_to") or self.frames[name].home
            return self._link_of(to, user, depth + 1)
        if name in self.joints:
            return self._link_of(read_text(self.joints[name].element, "child"), user, depth + 1)
        first, separator, rest = name.partition("::")
        if first in self.models and self.models[first].merged is None:
            path = self.models[first]._link_of(rest if separator else MODEL, user, depth + 1)
            return None if path is None else (first, *path)
        if name == WORLD and self.parent is None:
            return None
        if first in self.models and self.models[first].merged is not None:
            return self._link_of(self.models[first].canonical, user, depth + 1)
        if name == MODEL:
            to = self.canonical or next(iter((*self.links, *self.models)), "")
            if to:
                return self._link_of(to, user, depth + 1)
        raise ModelError(f"'{name}' is neither a link nor a frame of the model", at=user.place)


def read_own_pose(model: Scope) -> Pose:
    """Return the ``<pose>`` of a model for its model frame."""
    if model.merged is not None:
        return model.merged
    pose, _ = read_pose(model.posed)
    if not model.placement:
        return pose
    return pose @ model.compute_pose(model.placement, model.posed).invert()
