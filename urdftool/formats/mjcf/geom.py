"""Visual and collision geometry as geoms of the classes ``visual`` and ``collision``."""

from __future__ import annotations

from collections.abc import Iterator

from lxml import etree

from ...model.elements import Collision, Link, Mesh, Visual
from ...model.numbers import format_numbers_text
from ...model.shapes import get_shape_name
from ..common.naming import UniqueNames
from ..common.shape_box import get_shape_size
from ..written import Written
from .frame import set_origin
from .gazebo import get_surface_attributes, report_surface_losses
from .material import Materials
from .meshes import Assets, MeshPiece

SIZELESS = "not exported: it has no size"


def list_visual_geoms(
    link: Link, assets: Assets, materials: Materials, names: UniqueNames, written: Written
) -> Iterator[etree._Element]:
    """Yield the geoms of a link's visuals, one for each material of a mesh."""
    for visual in link.visuals:
        for index, (geom, piece) in enumerate(_list_geoms(link, visual, assets, written)):
            _set_name(geom, link, visual, names, index)
            geom.set("class", "visual")
            materials.set_material(geom, visual, link, piece)
            yield geom


def list_collision_geoms(
    link: Link, assets: Assets, names: UniqueNames, written: Written
) -> Iterator[etree._Element]:
    """Yield the geoms of a link's collisions."""
    report_surface_losses(link, written)
    for collision in link.collisions:
        for index, (geom, _) in enumerate(_list_geoms(link, collision, assets, written)):
            _set_name(geom, link, collision, names, index)
            geom.set("class", "collision")
            for name, value in get_surface_attributes(collision).items():
                geom.set(name, value)
            yield geom


def _list_geoms(
    link: Link, shape: Visual | Collision, assets: Assets, written: Written
) -> Iterator[tuple[etree._Element, MeshPiece | None]]:
    what = "visual" if isinstance(shape, Visual) else "collision"
    if isinstance(shape.geometry, Mesh):
        for piece in assets.pieces.get(id(shape.geometry), ()):
            geom = etree.Element("geom", type="mesh", mesh=piece.name)
            set_origin(geom, shape.origin)
            yield geom, piece
        if id(shape.geometry) not in assets.pieces:
            _report_shape_loss(
                link,
                shape,
                f"a {what} of link '{link.name}' is not exported: its mesh is missing",
                written,
            )
        return
    simple = get_shape_size(shape.geometry)
    if simple is None:
        tag = f"<{get_shape_name(shape.geometry)}>" if shape.geometry is not None else "nothing"
        _report_shape_loss(
            link,
            shape,
            f"a {what} of link '{link.name}' is not exported: its geometry is {tag}",
            written,
        )
        return
    if not min(simple[1]) > 0:
        if simple[0] == "capsule" and simple[1][0] > 0 and simple[1][1] == 0:
            simple = "sphere", simple[1][:1]
        else:
            _report_shape_loss(
                link, shape, f"a {what} of link '{link.name}' is {SIZELESS}", written
            )
            return
    geom = etree.Element("geom", type=simple[0], size=format_numbers_text(simple[1]))
    set_origin(geom, shape.origin)
    yield geom, None


def _report_shape_loss(
    link: Link, shape: Visual | Collision, message: str, written: Written
) -> None:
    kind = "visual" if isinstance(shape, Visual) else "collision"
    written.report_loss(kind, message, shape.place, kind="link", name=link.name)


def _set_name(
    geom: etree._Element, link: Link, shape: Visual | Collision, names: UniqueNames, index: int
) -> None:
    """Keep the name of a shape, made unique among all geoms."""
    if not shape.name:
        return
    kind = "visual" if isinstance(shape, Visual) else "collision"
    own = shape.name if index == 0 else f"{shape.name}_{index}"
    name = names.take(own, f"{link.name}_{own}", f"{link.name}_{own}_{kind}")
    geom.set("name", name)
