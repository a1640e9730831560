"""The mirror image of a robot: frames, axes, tensors, shapes, and meshes in new files."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from itertools import count
from pathlib import PurePosixPath

from ..errors import MeshError, ModelError, UrdftoolError
from ..geometry.load import load_named
from ..model.elements import Collision, Joint, Link, Mesh, Origin, Vector, Visual
from ..model.kinematics import MOVABLE
from ..model.numbers import parse_numbers
from ..model.pose import Pose, make_pose
from ..source.document import Element
from .around import rename_in_files
from .closed_loops import check_loops
from .draft import Draft
from .numbers import negate_text
from .prefix import declare_names
from .references import Names, list_names_in_text, rename

PLANES = {"yz": 0, "xz": 1, "xy": 2}
"""Coordinate that the reflection at each plane negates."""


def mirror_robot(
    draft: Draft,
    plane: str,
    exchange: tuple[str, str] = ("", ""),
    *,
    meshes: str = "files",
    mesh_dir: str = "meshes",
) -> None:
    """Make the mirror image at a plane through the frame of the root.

    A link frame R becomes S R S, with the reflection S. Positions and limits of joints keep their
    values: the axis of a rotation becomes -S a, that of a slide S a.

    Args:
        draft: The robot.
        plane: ``xy``, ``xz`` or ``yz``.
        exchange: Parts of names to exchange, such as ``l_`` and ``r_``; empty for none.
        meshes: ``files`` writes meshes with reversed faces, ``scale`` a negative scale.
        mesh_dir: Folder of new meshes, relative to the output.

    Raises:
        ModelError: The plane is unknown, names clash, or a joint has several positions.
        MeshError: A mesh cannot be mirrored.
    """
    if plane not in PLANES:
        raise ModelError(f"plane '{plane}' is not one of {', '.join(PLANES)}")
    index = PLANES[plane]
    check_loops(draft, draft.robot.link, "whose mirror image is not known")
    for joint in draft.robot.joints:
        mirror_joint(draft, joint, index)
    written: dict[str, str] = {}
    for link in draft.robot.links:
        mirror_link(draft, link, index)
        mirror_meshes(draft, link, index, (meshes, mesh_dir), written)
    _mirror_blocks(draft, index)
    draft.declare("mirror", plane)
    if any(exchange):
        _exchange_names(draft, *exchange)


def compute_reflected(pose: Pose, index: int) -> Pose:
    """Return S R S of a pose."""
    signs = [-1.0 if row == index else 1.0 for row in range(3)]
    rows = [tuple(signs[i] * signs[j] * pose.rotation[i][j] for j in range(3)) for i in range(3)]
    x, y, z = (sign * value for sign, value in zip(signs, pose.translation, strict=True))
    return Pose((_as_vector(rows[0]), _as_vector(rows[1]), _as_vector(rows[2])), (x, y, z))


def _as_vector(values: Sequence[float]) -> Vector:
    x, y, z = values
    return x, y, z


def _set_reflected(draft: Draft, owner: Element, origin: Origin | None, index: int) -> None:
    """Write S R S of an origin: signs of its numbers, which keep their digits."""
    if origin is None or origin.xml is None:
        return
    if origin.quaternion is not None:
        draft.set_pose(owner, origin, compute_reflected(make_pose(origin), index))
        return
    for name, kept in (("xyz", False), ("rpy", True)):
        if origin.xml.get(name) is not None:
            text = _get_three(origin.xml, name, "")
            draft.set(origin.xml, name, _negate_words(text, index, others=kept))


def _get_three(element: Element, name: str, default: str) -> str:
    """Return the text of an attribute with three numbers.

    Raises:
        ModelError: It has others.
    """
    text = element.get(name) or default
    if parse_numbers(text, 3) is None:
        raise ModelError(
            f"{name} '{text}' is not three numbers, which readers interpret differently; fix it "
            "first",
            at=element.locate_attribute(name),
        )
    return text


def _negate_words(text: str, index: int, *, others: bool) -> str:
    """Negate one of three numbers, or the two others.

    With the reflection S = diag(1, -1, 1), S Rx(a) S is Rx(-a), S Ry(a) S is Ry(a), and
    S Rz(a) S is Rz(-a); the rotation about the normal of the plane keeps its angle.
    """
    numbers = count()

    def negate(match: re.Match[str]) -> str:
        return negate_text(match[0]) if (next(numbers) == index) != others else match[0]

    return re.sub(r"\S+", negate, text)


def mirror_joint(draft: Draft, joint: Joint, index: int) -> None:
    """Write the mirror image of origin and axis of a joint.

    Raises:
        ModelError: The joint has several positions.
    """
    if joint.type not in (*MOVABLE, "fixed"):
        raise ModelError(
            f"{joint.type} joint '{joint.name}' has several positions, which have other signs in "
            "the mirror image",
            at=joint.place,
        )
    _set_reflected(draft, joint.element, joint.origin, index)
    if joint.is_fixed:
        return
    slides = joint.type == "prismatic"
    axis = None if joint.axis is None else joint.axis.xml
    text = "1 0 0" if axis is None else _get_three(axis, "xyz", "1 0 0")
    new = _negate_words(text, index, others=not slides)
    if axis is not None:
        draft.set(axis, "xyz", new)
    elif new != text:
        draft.append(joint.element, [f'<axis xyz="{new}"/>'])


def _list_shapes(link: Link) -> list[Visual | Collision]:
    return [*link.visuals, *link.collisions]


_PRODUCTS = {"ixy": (0, 1), "ixz": (0, 2), "iyz": (1, 2)}


def mirror_link(draft: Draft, link: Link, index: int) -> None:
    """Write the mirror image of the mass properties of a link, and of the poses of its shapes."""
    inertial = link.inertial
    if inertial is not None:
        _set_reflected(draft, inertial.element, inertial.origin, index)
        tensor = None if inertial.inertia is None else inertial.inertia.xml
        for name, pair in _PRODUCTS.items():
            text = None if tensor is None else tensor.get(name)
            if tensor is not None and text is not None and index in pair:
                draft.set(tensor, name, negate_text(text))
    for shape in _list_shapes(link):
        _set_reflected(draft, shape.element, shape.origin, index)


def mirror_meshes(
    draft: Draft, link: Link, index: int, how: tuple[str, str], written: dict[str, str]
) -> None:
    """Mirror the meshes of a link.

    ``index`` is the coordinate that the reflection negates; new meshes are added to ``written``.
    """
    for shape in _list_shapes(link):
        if isinstance(shape.geometry, Mesh):
            _mirror_mesh(draft, shape.geometry, index, *how, written)


def _mirror_mesh(
    draft: Draft, mesh: Mesh, index: int, how: str, folder: str, written: dict[str, str]
) -> None:
    """Write a mirrored mesh and its name, or a negative scale."""
    element = mesh.element
    if how == "scale":
        words = _get_three(element, "scale", "1 1 1").split()
        words[index] = negate_text(words[index])
        if words == ["1", "1", "1"]:
            draft.remove_attribute(element, "scale")
        else:
            draft.set(element, "scale", " ".join(words))
        return
    uri = mesh.filename
    if uri not in written:
        written[uri] = _write_mesh(draft, uri, index, folder, element, set(written.values()))
    draft.set(element, "filename", written[uri])


def _write_mesh(
    draft: Draft, uri: str, index: int, folder: str, element: Element, taken: set[str]
) -> str:
    from ..bundle.mesh_formats import MaterialNames, encode_mtl, encode_obj, encode_stl

    factors = [-1.0 if axis == index else 1.0 for axis in range(3)]
    try:
        mesh = load_named(draft.description, uri, factors)
    except UrdftoolError as error:
        raise MeshError(
            f"mesh '{uri}' cannot be mirrored: {error.message}; --mesh scale writes a negative "
            "scale instead",
            at=element.place,
        ) from error
    path = PurePosixPath(uri.replace("\\", "/"))
    suffix = ".stl" if mesh.format == "stl" else ".obj"
    stem = f"{folder}/{path.stem}".lstrip("/")
    name, number = f"{stem}{suffix}", 2
    while name in taken or name in draft.meshes:
        name, number = f"{stem}_{number}{suffix}", number + 1
    if suffix == ".stl":
        draft.meshes[name] = encode_stl(mesh)
        return name
    library = f"{PurePosixPath(name).stem}.mtl"
    is_colored = any(part.rgba for part in mesh.parts)
    names = MaterialNames(library if is_colored else "", {})
    draft.meshes[name] = encode_obj(mesh, names)
    if is_colored:
        draft.meshes[str(PurePosixPath(name).with_suffix(".mtl"))] = encode_mtl(mesh, names)
    if any(part.texture or part.image for part in mesh.parts):
        draft.report(
            "texture", f"images of mesh '{uri}' are not in the mirrored file", element.place
        )
    if mesh.format not in ("stl", "obj"):
        what = mesh.format.upper()
        draft.report("mesh", f"mesh '{uri}' was written as OBJ in place of {what}", element.place)
    return name


def _mirror_blocks(draft: Draft, index: int) -> None:
    """Mirror the poses of sensors in blocks of simulators, and list others, which are not."""
    for block in draft.root.list_children("gazebo"):
        for element in block.walk():
            if _is_pose_of_sensor(element):
                first, then = element.text.split()[:3], element.text.split()[3:]
                place = _negate_words(" ".join(first), index, others=False)
                turn = _negate_words(" ".join(then), index, others=True)
                draft.set_text(element, f"{place} {turn}")
            elif element.tag in ("pose", "xyz", "rpy", "xyzOffset", "rpyOffset", "axis"):
                message = f"<{element.tag}> of <gazebo> is not mirrored"
                draft.report("gazebo", message, element.place)


def _is_pose_of_sensor(element: Element) -> bool:
    """Tell whether it is the pose of a sensor in its link or joint, as six numbers."""
    above = element.parent
    return (
        element.tag == "pose"
        and above is not None
        and above.tag == "sensor"
        and not element.attributes
        and parse_numbers(element.text, 6) is not None
    )


def _exchange_names(draft: Draft, one: str, other: str) -> None:
    """Exchange two parts of the names of links and joints."""
    names = Names(
        {name: _exchange(name, one, other) for name in draft.robot.link},
        {name: _exchange(name, one, other) for name in draft.robot.joint},
    )
    for kind, known in (("link", names.links), ("joint", names.joints)):
        counts = Counter(known.values())
        doubled = [name for name, count in counts.items() if count > 1]
        if doubled:
            raise ModelError(
                f"two {kind}s would have the name '{min(doubled)}'", path=draft.file.path
            )
    if all(old == new for known in names[:2] for old, new in known.items()):
        raise ModelError(f"no name has '{one}' or '{other}'", path=draft.file.path)
    rename(draft, names)
    rename_in_files(draft, names.every, {"link": names.links, "joint": names.joints})
    declare_names(draft, names)
    changed = [old for known in names[:2] for old, new in known.items() if old != new]
    list_names_in_text(draft, changed, "it is not changed")


def _exchange(name: str, one: str, other: str) -> str:
    """Exchange two parts of a name; see :func:`exchange_part`."""
    new = exchange_part(name, one, other)
    return exchange_part(name, other, one) if new == name else new


def exchange_part(name: str, old: str, new: str) -> str:
    """Return a name with a part at its start, else at its end, or else at the start of a word.

    A word begins after a letter that is not alphanumeric, or with a capital or another letter that
    is not: ``l_`` is a part of ``arm_l_1``, and not of ``tool_base``.
    """
    if not old:
        return name
    if name.startswith(old):
        return new + name[len(old) :]
    if name.endswith(old) and (len(old) > 1 or not name[: -len(old)][-1:].isalnum()):
        return name[: -len(old)] + new
    at = name.find(old)
    while at > 0:
        if not old[0].islower() or not name[at - 1].isalnum():
            return name[:at] + new + name[at + len(old) :]
        at = name.find(old, at + 1)
    return name
