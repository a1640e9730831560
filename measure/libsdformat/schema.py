"""Write ``urdftool/model/sdf_schema.json`` from the descriptions of SDF that libsdformat installs.

``python -m measure.libsdformat.schema /usr/share/sdformat12`` reads those of SDF 1.4 to 1.9, and
adds the elements of ``NEWER``, which later versions define or Gazebo reads. See
:mod:`urdftool.model.sdf_schema` for the layout of the result.
"""

from __future__ import annotations

import argparse
import json
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from lxml import etree

from urdftool.model import sdf_schema

VERSIONS = ("1.4", "1.5", "1.6", "1.7", "1.8", "1.9")

OF_WORLDS = frozenset(
    f"{name}.sdf"
    for name in (
        *("physics", "world", "state", "link_state", "model_state", "light_state", "scene", "gui"),
        *("actor", "road", "population", "spherical_coordinates", "atmosphere"),
    )
)
"""Descriptions of elements outside of models, some of which have names that models use, too."""

NEWER = {
    "axis": "initial_position mimic",
    "axis2": "initial_position mimic",
    "camera": "camera_info_topic optical_frame_id trigger_topic triggered",
    "collision": "auto_inertia_params density",
    "cone": "length radius",
    "convex_decomposition": "max_convex_hulls voxel_resolution",
    "geometry": "cone",
    "inertial": "auto_inertia_params density fluid_added_mass",
    "joint": "plugin",
    "lidar": "visibility_mask",
    "light": "light_on visualize",
    "link": "plugin",
    "material": "shininess",
    "mesh": "convex_decomposition optimization",
    "mimic": "multiplier offset reference",
    "navsat": "position_sensing velocity_sensing",
    "projector": "visibility_flags",
    "ray": "visibility_mask",
    "sensor": "air_speed dvl frame_id gz_frame_id ignition_frame_id navsat",
}
"""Children of elements in SDF 1.10 to 1.12, or that new Gazebo reads, without their types."""

Item = tuple[str, str, Any]
"""Name of an element, name of its child or ``@`` and name of its attribute, description of that."""


def iterate_items(folder: Path) -> Iterator[tuple[str, Item]]:
    """Yield the name of each file of a version with each item that it describes."""
    roots = {path.name: etree.parse(path).getroot() for path in sorted(folder.glob("*.sdf"))}
    for name, root in roots.items():
        if root.tag == "element":
            for item in _iterate_children(root, roots):
                yield name, item


def _iterate_children(element: Any, roots: dict[str, Any]) -> Iterator[Item]:
    parent = element.get("name")
    for child in element:
        if child.tag == "attribute":
            yield parent, "@" + child.get("name"), child
        elif child.tag == "element" and child.get("name"):
            yield parent, child.get("name"), child
            yield from _iterate_children(child, roots)
        elif child.tag == "include" and child.get("filename") in roots:
            included = roots[child.get("filename")]
            yield parent, included.get("name"), included


def describe_value(item: Any) -> str:
    """Return the type of an element or attribute, with its bounds and whether it needs a value."""
    kind = item.get("type") or ""
    words = [kind.replace(" ", "-")]
    if kind in ("double", "int", "unsigned int") and (item.get("min") or item.get("max")):
        words += [f"{item.get('min') or '-inf'}:{item.get('max') or 'inf'}"]
    if item.get("required") == "1" and kind:
        words.append("required")
    return " ".join(words)


def make_schema(folder: Path) -> dict[str, dict[str, str]]:
    """Return the schema of all versions; libsdformat converts old files to the newest first."""
    values: dict[tuple[str, str], dict[str, list[str]]] = defaultdict(lambda: defaultdict(list))
    for version in VERSIONS:
        for name, (parent, child, item) in iterate_items(folder / version):
            key = (("world/" if name in OF_WORLDS else "") + parent, child)
            values[key][version].append(describe_value(item))
    schema: dict[str, dict[str, str]] = defaultdict(dict)
    for (parent, child), described in values.items():
        version = max(described)
        shared = _find_shared(described[version])
        schema[parent][child] = shared if version == VERSIONS[-1] else f"old {shared}".strip()
    for parent, children in NEWER.items():
        for child in children.split():
            if schema[parent].get(child, "old").startswith("old"):
                schema[parent][child] = ""
    return {parent: dict(sorted(children.items())) for parent, children in sorted(schema.items())}


def _find_shared(described: list[str]) -> str:
    """Return what the places of one version say alike of a value."""
    first, *others = described
    shared = [word for word in first.split(" ") if all(word in d.split(" ") for d in others)]
    return " ".join(shared) if shared and all(d.split(" ")[0] == shared[0] for d in others) else ""


def main() -> None:
    """Write the file."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path, help="folder with the versions, of sdformat 12")
    schema = make_schema(parser.parse_args().folder)
    path = Path(sdf_schema.__file__).with_suffix(".json")
    lines = (f"{json.dumps(name)}: {json.dumps(items)}" for name, items in schema.items())
    path.write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")


if __name__ == "__main__":
    main()
