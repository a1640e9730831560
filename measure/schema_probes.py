"""Attributes of MuJoCo's schema, each set in a model: ``python -m measure.schema_probes``.

For each attribute of each element, values are tried until MuJoCo compiles another model. The model
with the attribute is then compared with the one without it, and with the URDF of the one without
it. A line is printed for an attribute of which neither comparison says anything.
"""

from __future__ import annotations

import re
import sys
import tempfile
from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import mujoco
import numpy as np
from lxml import etree

import urdftool
from urdftool.compare.difference import Comparison
from urdftool.model.elements import Robot

BASE = """<mujoco model="r"><compiler/><option><flag/></option><size/><statistic/>
<default><default class="k"/></default>
<asset><mesh name="m" vertex="0 0 0 1 0 0 0 1 0 0 0 1"/><hfield name="h" nrow="2" ncol="2"
size="1 1 1 1" elevation="0 1 1 0"/>
<texture name="x" type="2d" builtin="flat" width="4" height="4"/><material name="w"/></asset>
<worldbody><geom name="floor" type="plane" size="1 1 .1"/><light name="lw"/><camera name="cw"/>
<body name="a" pos="0 0 1"><freejoint name="f"/><geom name="ga" type="box" size=".1 .2 .3"
mass="1"/><site name="sa" pos="0 0 .1"/>
<body name="b" pos=".3 0 0"><joint name="jb" axis="0 1 0"/><geom name="gb" type="cylinder"
size=".1 .2" density="800"/><site name="sb" pos="0 0 .1"/><camera name="ca"/><light name="la"/>
<body name="c" pos=".3 0 0"><inertial pos=".01 0 0" mass="1" diaginertia=".1 .2 .25"/>
<joint name="jc" axis="1 0 0" range="-1 1" limited="true"/><geom name="gc" size=".1"/>
<site name="sc" pos="0 0 .1"/></body></body>
<body name="d" pos="0 .3 0"><joint name="jd" type="slide"/><geom name="gd" type="mesh" mesh="m"
material="w"/><geom name="gx" size=".1" contype="0" conaffinity="0"/></body>
<body name="e" pos="0 .6 0"><joint name="je" type="ball"/><geom name="ge" size=".1"/></body></body>
</worldbody>
<contact><pair name="p" geom1="gb" geom2="gd"/><exclude name="q" body1="b" body2="d"/></contact>
<tendon><fixed name="t"><joint joint="jb" coef="1"/><joint joint="jc" coef="2"/></fixed>
<spatial name="s"><site site="sa"/><geom geom="gb"/><site site="sc"/><pulley divisor="2"/>
<site site="sa"/><site site="sb"/></spatial></tendon>
<equality><connect name="ec" body1="c" body2="d" anchor=".1 0 0"/>
<weld name="ew" body1="c" body2="d"/><joint name="ej" joint1="jb" joint2="jc"/>
<tendon name="et" tendon1="t" tendon2="s"/></equality>
<actuator><general name="ag" joint="jb"/><motor name="am" joint="jb"/>
<position name="ap" joint="jc"/><velocity name="av" joint="jc"/>
<intvelocity name="ai" joint="jc" actrange="-1 1"/>
<damper name="ad" joint="jc" ctrlrange="0 1"/><cylinder name="ay" joint="jd"/>
<muscle name="au" joint="jd" lengthrange="0 1"/><adhesion name="ah" body="b" ctrlrange="0 1"/>
</actuator>
<sensor><gyro name="ng" site="sb"/><jointpos name="nj" joint="jb"/><actuatorfrc name="na"
actuator="am"/><framepos name="nf" objtype="body" objname="b"/><rangefinder name="nr" site="sb"/>
<subtreecom name="ns" body="a"/><distance name="nd" geom1="gb" geom2="ge"/><clock name="nc"/>
<user name="nu" dim="2"/><touch name="no" site="sb"/></sensor>
<custom><numeric name="un" data="1 2"/><text name="ut" data="words"/><tuple name="uu"><element
objtype="body" objname="b"/></tuple></custom>
<keyframe><key name="home"/></keyframe></mujoco>"""

PLAIN = """<mujoco model="r"><compiler/><option><flag/></option><worldbody>
<body name="a" pos="0 0 1"><geom name="ga" type="box" size=".1 .2 .3" mass="1"/>
<body name="b" pos=".3 0 0"><inertial pos=".01 0 0" mass="1" diaginertia=".1 .2 .25"/>
<joint name="jb" axis="0 1 0" range="-50 50" damping="1" frictionloss="1"/>
<geom name="gb" type="cylinder" size=".1 .2"/>
<body name="c" pos="0 .3 0"><joint name="jc" type="slide" range="0 1" damping="1"/>
<geom name="gc" size=".1" density="800"/></body></body></body></worldbody>
<actuator><position name="ap" joint="jc" kp="20" ctrlrange="0 1" forcerange="-5 5"/></actuator>
</mujoco>"""
"""A robot that its URDF holds, but for the actuator."""

WORDS = (
    *("20 30 40", "0.37", "3", "2", "1", "0", "0.37 0.41", "0.1 0.2 0.3", "1 2 3 4"),
    *("true", "false", "disable", "enable", "1 0 0 1 1 0", "0.5 0.6 0.001 0.4 2", "-2 2", "0 1"),
    *("1 0 0 0 1 0", "0 0 0 1 1 1", "0 0 0 1 1 1 1", "1 2 3 .1 .1 .1", "7 8 9", "b", "c", "jb"),
    *("jc", "jd", "sa", "sb", "sc", "ga", "gb", "gc", "t", "s", "w", "m", "x", "k", "h", "am"),
    *("ca", "site", "body", "geom", "xbody", "hinge", "slide", "ball", "sphere", "box", "filter"),
    *("ellipsoid", "cylinder", "degree", "radian", "XYZ", "implicit", "RK4", "elliptic", "sparse"),
    *("PGS", "never", "init", "filterexact", "integrator", "affine", "muscle", "user", "track"),
    *("perspective", "orthographic", "spot", "directional", "exact", "shell", "legacy", "convex"),
    *("linear", "cubic", "zoh", "gradient", "checker", "cube", "sRGB", "edge", "cross", "random"),
    *("vel", "acc", "all", "auto", "positive", "0.5 0 0 0 0.5 0", "8", "100", "5M", "linux"),
    *("0 0 0 .1 .1 .1 .1 .1 .1", "dist", "normal", "first", "mindist", "a b", "4 5 6 7", "10 10"),
    *("0 0 0.5", "0.3 -0.2 1", "1 1 1", "0 0 0 0 0 0 0 0 0 0", "0 0 1 1 0 0 0 .1 .2 .3 1 0 0 0"),
    *(" ".join(["0.1"] * n) for n in (9, 10, 11, 12, 13, 14)),
)  # fmt: skip
"""Values that are tried."""

_UNSAID = re.compile(
    r"name|class|content_type|.*dir|file.*|strippath|save.*|usethread|embed|user|group"
    r"|castshadow"
)
"""Attributes that say nothing of a model by themselves."""

_LINE = re.compile(r"^( *)(\S+) \((.)\) +(.*)$")


def read_schema() -> dict[str, list[str]]:
    """Return the attributes of each element of MJCF, by its path below ``<mujoco>``."""
    found: dict[str, list[str]] = {}
    stack: list[str] = []
    path = ""
    for line in mujoco.mj_printSchema(False, False).splitlines():
        start = _LINE.match(line)
        if start and len(start[1]) < _COLUMN:
            stack = [*stack[: len(start[1]) // 3], start[2]]
            path = "/".join(stack[1:]).replace("(world)body", "body")
            found[path] = start[4].split()
        elif path:
            found[path] += line.split()
    return found


_COLUMN = 20
"""Column in which MuJoCo prints the first attribute."""


_ALL = slice(None)


class Probe(NamedTuple):
    """A model with an attribute.

    Attributes:
        element: Path of the element below ``<mujoco>``.
        attribute: Name of the attribute.
        value: Its value; empty if none was found that makes another model.
        text: The model with it.
        fields: Fields of MuJoCo's model that are another.
    """

    element: str
    attribute: str
    value: str = ""
    text: str = ""
    fields: tuple[str, ...] = ()


def list_probes(base: str, chosen: slice = _ALL) -> Iterator[Probe]:
    """Yield a probe for each attribute of each element that the base has.

    Args:
        base: The model.
        chosen: Which attributes of all.
    """
    plain = _collect(mujoco.MjModel.from_xml_string(base))
    root = etree.fromstring(base)
    known = [
        (path, attribute)
        for path, attributes in read_schema().items()
        if path and not path.startswith(("default", "visual")) and root.xpath(_find(path))
        for attribute in attributes
        if not _UNSAID.fullmatch(attribute)
    ]
    for path, attribute in known[chosen]:
        yield _try_words(base, path, attribute, plain)


def _find(path: str) -> str:
    """Return the XPath of the elements at a path of the schema."""
    body, _, rest = path.partition("/")
    if body != "body":
        return f"./{path}"
    return f".//worldbody//body/{rest}" if rest else ".//worldbody//body"


def _try_words(base: str, path: str, attribute: str, plain: dict[str, Any]) -> Probe:
    """Return the first value of an attribute that makes another model."""
    where = _find(path)
    for number in range(len(etree.fromstring(base).xpath(where))):
        for word in WORDS:
            root = etree.fromstring(base)
            root.xpath(where)[number].set(attribute, word)
            text = etree.tostring(root, encoding="unicode")
            try:
                found = _collect(mujoco.MjModel.from_xml_string(text))
            except (ValueError, mujoco.FatalError):
                continue
            fields = [n for n in plain if n not in _DERIVED and not _is_same(plain[n], found[n])]
            if fields:
                return Probe(path, attribute, word, text, tuple(fields))
    return Probe(path, attribute)


_DERIVED = frozenset(("signature", "names", "names_map", "paths"))


def _collect(model: mujoco.MjModel) -> dict[str, Any]:
    """Return the arrays and options of a model."""
    found: dict[str, Any] = {}
    for owner, prefix in ((model, ""), (model.opt, "opt_"), (model.stat, "stat_")):
        for name in dir(owner):
            value = getattr(owner, name)
            if not name.startswith("_") and isinstance(value, int | float | np.ndarray):
                found[prefix + name] = value
    return found


def _is_same(x: Any, y: Any) -> bool:
    one, two = np.asarray(x), np.asarray(y)
    return one.shape == two.shape and bool(np.allclose(one, two, rtol=1e-6, atol=1e-12))


def load(text: str, folder: Path, name: str) -> Robot:
    """Load a description from a text."""
    path = folder / name
    path.write_text(text)
    return urdftool.load(path)


def compare(one: Robot, two: Robot) -> Comparison:
    """Return the comparison of two robots."""
    (comparison,) = urdftool.verify(one, two).pairs.values()
    return comparison


_ROWS = {
    "opt_": ("world",),
    "actuator_": ("actuators", "limits", "other elements"),
    "tendon_": ("other elements",),
    "wrap_": ("other elements",),
    "eq_": ("other elements", "loops", "tree"),
    "sensor_": ("sensors", "other elements"),
    "pair_": ("contact pairs",),
    "exclude_": ("contact pairs",),
    "light_": ("other elements",),
    "site_": ("frames", "other elements"),
    "cam_": ("sensors", "other elements"),
    "key_": ("configurations",),
    "numeric_": ("other elements",),
    "text_": ("other elements",),
    "tuple_": ("other elements",),
    "hfield_": ("collisions", "visuals"),
    "geom_": ("collisions", "visuals", "surface", "colors", "other elements"),
    "mesh_": ("collisions", "visuals"),
    "mat_": ("colors", "textures", "looks"),
    "tex_": ("colors", "textures", "looks"),
    "jnt_": ("joint physics", "limits", "tree", "axes", "other elements"),
    "dof_": ("joint physics",),
    "qpos_spring": ("joint physics",),
    "body_": ("mass", "inertia", "center of mass", "frames", "link flags", "base"),
}
"""Rows that a field of MuJoCo's model concerns, by its beginning."""


def list_concerned(fields: Iterable[str]) -> set[str]:
    """Return the rows that the fields of a model concern."""
    return {row for field in fields for start, rows in _ROWS.items() if field.startswith(start)
            for row in rows}  # fmt: skip


def is_named(comparison: Comparison, rows: set[str]) -> bool:
    """Tell whether no row of those is equal without a word: one differs or is not compared."""
    if not comparison.partial.isdisjoint(rows):
        return True
    return any(row in rows for row in comparison.list_skipped()) or any(
        difference.row in rows for difference in comparison.differences
    )


def list_silent(base: str, folder: Path, chosen: slice = _ALL) -> Iterator[tuple[str, Probe]]:
    """Yield each probe, with the comparison that does not name it: ``MJCF``, ``URDF`` or none."""
    plain = load(base, folder, "base.xml")
    urdf = load(urdftool.export_urdf(plain, force=True).text, folder, "base.urdf")
    for probe in list_probes(base, chosen):
        if not probe.value:
            yield "?", probe
            continue
        changed = load(probe.text, folder, "probe.xml")
        rows = list_concerned(probe.fields)
        named = is_named(compare(urdf, changed), rows) or not rows
        same = not compare(plain, changed).is_equal
        yield " ".join(w for w, known in (("MJCF", same), ("URDF", named)) if not known), probe


def main() -> int:
    """Print the attributes of which a comparison says nothing; return 1 if there are some."""
    counts: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as name:
        for base in (PLAIN, BASE):
            for silent, probe in list_silent(base, Path(name)):
                counts[silent or "named"] += 1
                if silent:
                    shown = f"{probe.element}@{probe.attribute}={probe.value!r}"
                    print(silent, shown, *probe.fields[:5], flush=True)
    print(dict(counts))
    return int(bool(counts.keys() - {"named", "?"}))


if __name__ == "__main__":
    sys.exit(main())
