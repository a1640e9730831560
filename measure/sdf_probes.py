"""Elements of SDF's schema, each set in a model: ``python -m measure.sdf_probes``.

For each element below a model or world that has a value, a value other than its default is set. The
model with it is then compared with the one without it, and with the URDF of the one without it. A
line is printed for an element of which a comparison says nothing.
"""

from __future__ import annotations

import re
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from lxml import etree

import urdftool
from urdftool.compare.difference import Comparison
from urdftool.model.sdf_schema import get_children, get_value_type

from .schema_probes import compare, load

BASE = """<sdf version="1.9"><world name="w"><model name="r">
<link name="a"><inertial><mass>1</mass><inertia><ixx>.1</ixx><iyy>.1</iyy><izz>.1</izz></inertia>
</inertial><collision name="c"><geometry><box><size>1 1 1</size></box></geometry></collision></link>
<link name="b"><pose>0 0 1 0 0 0</pose><inertial><mass>1</mass><inertia><ixx>.1</ixx><iyy>.1</iyy>
<izz>.1</izz></inertia></inertial><collision name="c"><geometry><sphere><radius>.1</radius></sphere>
</geometry></collision><visual name="v"><geometry><sphere><radius>.1</radius></sphere></geometry>
</visual></link>
<joint name="j" type="revolute"><parent>a</parent><child>b</child><axis><xyz>0 1 0</xyz><limit>
<lower>-1</lower><upper>1</upper><effort>5</effort><velocity>2</velocity></limit><dynamics>
<damping>1</damping><friction>1</friction></dynamics></axis></joint></model></world></sdf>"""

PLACES = {"world": ".//world", "model": ".//model", "link": ".//link[@name='b']",
          "joint": ".//joint"}  # fmt: skip
"""XPath of the elements that get the others."""

_APART = frozenset((
    *("model", "link", "joint", "include", "frame", "plugin", "sensor", "light", "actor", "road"),
    *("state", "scene", "gui", "visual", "geometry", "population", "spherical_coordinates"),
    *("audio", "audio_source", "audio_sink", "battery", "particle_emitter", "projector", "axis2"),
    *("gripper", "parent", "child"),
))  # fmt: skip
"""Elements that are parts of their own, pictures, or the names of other parts."""

VALUES = {
    "bool": ("true", "false"), "double": ("0.37", "0.41"), "float": ("0.37", "0.41"),
    "int": ("3", "4"), "unsigned-int": ("3", "4"), "unsigned": ("3", "4"),
    "vector3": ("0.1 0.2 0.3", "1 2 3"), "vector2d": ("0.1 0.2", "1 2"),
    "pose": ("0.1 0.2 0.3 0.1 0.2 0.3", "1 2 3 0 0 0"), "string": ("word", "other"),
    "color": ("1 0 0 1", "0 1 0 1"), "quaternion": ("0 0 0 1", "0 0 1 0"), "time": ("3 4", "5 6"),
}  # fmt: skip
"""Two values by type, of which one at least is not the default."""

_DEEPEST = 7


def list_elements(tag: str, path: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], str]]:
    """Yield the paths of the elements with a value below one, and the types of the values."""
    for child in sorted(get_children(tag, newest=True) or ()):
        if child in _APART or len(path) > _DEEPEST or child in path:
            continue
        kind = get_value_type(tag, child)
        if kind in VALUES:
            yield (*path, child), kind
        else:
            yield from list_elements(child, (*path, child))


def list_probes() -> Iterator[tuple[str, list[str]]]:
    """Yield the path of each probe, and the models with its values."""
    for place, xpath in PLACES.items():
        for path, kind in list_elements(place):
            yield "/".join((place, *path)), [_put(xpath, path, value) for value in VALUES[kind]]


def _put(xpath: str, path: tuple[str, ...], value: str) -> str:
    """Return the base with a value at a path below an element."""
    root = etree.fromstring(BASE)
    element = root.find(xpath)
    assert element is not None
    for name in path:
        found = element.find(name)
        element = etree.SubElement(element, name) if found is None else found
    element.text = value
    return etree.tostring(root, encoding="unicode")


def summarize(comparison: Comparison) -> object:
    """Return what a comparison says, without places."""
    differences = {(d.row, d.names, d.what, str(d.values)) for d in comparison.differences}
    skipped = {
        (row, re.sub(r"\([^()]*:\d+:\d+\)", "", why))
        for row, why in comparison.list_skipped().items()
    }
    return differences, skipped, set(comparison.not_comparable)


def list_silent(folder: Path, chosen: slice = slice(None)) -> Iterator[tuple[str, str]]:
    """Yield each path, after the comparisons that name none of its values: SDF, URDF or none.

    Args:
        folder: A folder for files.
        chosen: Which probes of all.
    """
    plain = load(BASE, folder, "base.sdf")
    urdf = load(urdftool.export_urdf(plain, force=True).text, folder, "base.urdf")
    usual = summarize(compare(urdf, plain))
    for path, texts in list(list_probes())[chosen]:
        silent = {"SDF", "URDF"}
        for text in texts:
            changed = load(text, folder, "probe.sdf")
            if not compare(plain, changed).is_equal:
                silent.discard("SDF")
            if summarize(compare(urdf, changed)) != usual:
                silent.discard("URDF")
        yield " ".join(sorted(silent)), path


def main() -> int:
    """Print the elements of which a comparison says nothing; return 1 if there are some."""
    counts: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as name:
        for silent, path in list_silent(Path(name)):
            counts[silent or "named"] += 1
            if silent:
                print(silent, path)
    print(dict(counts))
    return int(bool(counts.keys() - {"named"}))


if __name__ == "__main__":
    sys.exit(main())
