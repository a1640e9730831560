"""Elements and attributes of MJCF that are added to a model, and what MuJoCo compiles of them."""

from __future__ import annotations

import re
from collections import Counter

import mujoco
import numpy as np

from ..planted.change import Planted, add, both, put

_DIGITS = 6
"""Digits of values that count as equal; chosen, above the single precision of some fields."""

BASE = """<mujoco model="plain"><worldbody>
<geom name="floor" type="plane" size="1 1 .1"/>
<body name="a" pos="0 0 1"><freejoint name="free"/><geom name="ga" size=".1" mass="1"/>
<site name="sa" pos="0 0 .1"/>
<body name="b" pos=".3 0 0"><joint name="jb" range="-1 1"/><geom name="gb" size=".1" mass="1"/>
<site name="sb" pos="0 0 .1"/>
<body name="c" pos=".3 0 0"><joint name="jc" axis="0 1 0"/><geom name="gc" size=".1" mass="1"/>
<site name="sc" pos="0 0 .1"/></body></body>
<body name="d" pos="0 .3 0"><joint name="jd" axis="1 0 0"/><geom name="gd" size=".1" mass="1"/>
</body></body>
</worldbody>
<contact/><equality/><tendon/>
<actuator><motor name="m" joint="jb"/></actuator>
<sensor/><custom/><keyframe><key name='home'/></keyframe></mujoco>"""

TENDON = "<fixed name='t'><joint joint='jb' coef='1'/><joint joint='jc' coef='-2'/></fixed>"
SPATIAL = """<spatial name='s' range='0 1' stiffness='10' damping='2'><site site='sa'/>
<geom geom='gb'/><site site='sc'/></spatial>"""

_B, _GEOM, _JOINT = "//body[@name='b']", "//geom[@name='gb']", "//joint[@name='jb']"


def _in(parent: str, row: str, xml: str) -> Planted:
    return Planted(row, row, add(f"/mujoco/{parent}", xml))


def _on_tendon(row: str, parent: str, xml: str) -> Planted:
    return Planted(row, row, both(add("/mujoco/tendon", TENDON), add(f"/mujoco/{parent}", xml)))


def _set(row: str, path: str, name: str, value: str) -> Planted:
    return Planted(row, row, put(path, name, value))


CHANGES = (
    _in("tendon", "fixed tendon", TENDON),
    _in("tendon", "armature of a tendon", TENDON.replace("name", "armature='0.5' name")),
    _in("tendon", "spatial tendon with limit, spring and damping", SPATIAL),
    _on_tendon("motor of a tendon", "actuator", "<motor name='mt' tendon='t' gear='3'/>"),
    _on_tendon("unnamed motor of a tendon", "actuator", "<motor tendon='t' gear='3'/>"),
    _on_tendon("servo of a tendon", "actuator", "<position tendon='t' kp='3'/>"),
    _in("actuator", "motor of a site", "<motor name='ms' site='sb' gear='0 0 1 0 0 0'/>"),
    _in("actuator", "muscle", "<muscle name='mu' joint='jb' lengthrange='-1 1'/>"),
    _in("actuator", "actuator with a filter",
        "<general name='mf' joint='jc' dyntype='filter' dynprm='0.1'/>"),
    _in("actuator", "integrating servo", "<intvelocity joint='jc' kp='4' actrange='-1 1'/>"),
    _in("actuator", "cylinder", "<cylinder joint='jc' timeconst='1' area='3'/>"),
    _in("actuator", "adhesion", "<adhesion body='b' gain='10' ctrlrange='0 1'/>"),
    _in("actuator", "unnamed motor", "<motor joint='jc' gear='7'/>"),
    _in("actuator", "group of an actuator", "<motor name='mg' joint='jc' group='3'/>"),
    _on_tendon("tendon equality", "equality", "<tendon tendon1='t' polycoef='0.1 1 0 0 0'/>"),
    _in("equality", "connect", "<connect name='k' body1='c' body2='d' anchor='.1 0 0'/>"),
    _in("equality", "weld with torque scale",
        "<weld name='w' body1='c' body2='d' torquescale='3'/>"),
    _in("equality", "solver settings of a weld",
        "<weld name='w' body1='c' body2='d' solref='0.5 1'/>"),
    _in("equality", "linear coupling", "<joint joint1='jb' joint2='jc' polycoef='0 2 0 0 0'/>"),
    _in("equality", "quadratic coupling", "<joint joint1='jb' joint2='jc' polycoef='0 2 3 0 0'/>"),
    _in("equality", "inactive coupling",
        "<joint joint1='jb' joint2='jc' polycoef='0 2 0 0 0' active='false'/>"),
    _in("equality", "held joint", "<joint joint1='jb' polycoef='0.3 0 0 0 0'/>"),
    _in("contact", "contact pair", "<pair geom1='gb' geom2='gd' friction='0.3'/>"),
    _in("contact", "exclusion", "<exclude body1='b' body2='d'/>"),
    _in("sensor", "clock", "<clock name='time'/>"),
    _in("sensor", "gyro", "<gyro name='g' site='sb' noise='0.1'/>"),
    _in("sensor", "touch", "<touch name='to' site='sb'/>"),
    _in("sensor", "joint sensor", "<jointpos name='jp' joint='jb'/>"),
    _in("sensor", "cutoff of a sensor", "<jointvel name='jv' joint='jb' cutoff='4'/>"),
    _in("sensor", "actuator sensor", "<actuatorfrc name='af' actuator='m'/>"),
    _on_tendon("tendon sensor", "sensor", "<tendonpos name='tp' tendon='t'/>"),
    _in("sensor", "frame sensor of a body", "<framepos objtype='body' objname='b'/>"),
    _in("sensor", "frame sensor with reference",
        "<framepos objtype='site' objname='sb' reftype='site' refname='sc'/>"),
    _in("sensor", "frame sensor of a geom", "<framequat objtype='geom' objname='gb'/>"),
    _in("sensor", "subtree sensor", "<subtreecom name='com' body='a'/>"),
    _in("sensor", "distance of geoms", "<distance name='dist' geom1='gb' geom2='gd'/>"),
    _in("sensor", "limit sensor", "<jointlimitpos name='jl' joint='jb'/>"),
    _in("sensor", "ball sensor of a free joint", "<framelinvel objtype='xbody' objname='a'/>"),
    _in("sensor", "user sensor", "<user name='own' dim='2' needstage='pos'/>"),
    _in("sensor", "energy sensor", "<e_potential name='e'/>"),
    _in("custom", "number", "<numeric name='n' data='1 2 3'/>"),
    _in("custom", "text", "<text name='x' data='words'/>"),
    _in("custom", "tuple",
        "<tuple name='tu'><element objtype='body' objname='b' prm='2'/></tuple>"),
    _in("keyframe", "keyframe", "<key name='k' qpos='0 0 1 1 0 0 0 .1 .2 .3' time='3'/>"),
    _in("keyframe", "velocities of a keyframe", "<key name='k' qvel='1 0 0 0 0 0 0 .2 .3'/>"),
    _set("gravity compensation", "//body[@name='a']", "gravcomp", "0.3"),
    Planted("gravity", "gravity", add("/mujoco", "<option gravity='0 0 -1'/>")),
    Planted("flag", "flag", add("/mujoco", "<option><flag contact='disable'/></option>")),
    Planted("actuator groups", "actuator groups",
            add("/mujoco", "<option actuatorgroupdisable='2'/>")),
    Planted("contact override", "contact override",
            add("/mujoco", "<option o_margin='0.1'><flag override='enable'/></option>")),
    Planted("solver iterations", "solver iterations",
            add("/mujoco", "<option ls_iterations='7' sdf_iterations='7' ccd_iterations='7'/>")),
    Planted("memory", "memory", add("/mujoco", "<size memory='3M'/>")),
    Planted("statistic", "statistic", add("/mujoco", "<statistic extent='7' center='1 2 3'/>")),
    Planted("haze of the picture", "visual", add("/mujoco", "<visual><map haze='.7'/></visual>")),
    _set("contact mask", _GEOM, "contype", "2"),
    _set("adhesion gap", _GEOM, "gap", "0.01"),
    _set("fluid shape", _GEOM, "fluidshape", "ellipsoid"),
    _set("group of a geom", _GEOM, "group", "4"),
    _set("user data of a geom", _GEOM, "user", "4 5"),
    _set("limit stiffness", _JOINT, "solreflimit", "0.5 1"),
    _set("friction stiffness", _JOINT, "solreffriction", "0.5 1"),
    _set("group of a joint", _JOINT, "group", "3"),
    _set("user data of a joint", _JOINT, "user", "4 5"),
    _set("reference of a joint", _JOINT, "ref", "0.2"),
    _set("spring of a joint", _JOINT, "springref", "0.2"),
    _set("spring frequency", _JOINT, "springdamper", "0.2 1"),
    _set("armature", _JOINT, "armature", "0.2"),
    _set("force limit of a joint", _JOINT, "actuatorfrcrange", "-2 3"),
    Planted("motor beside one of a site", "force range", both(
            put("//motor[@name='m']", "ctrlrange", "-1 1"),
            add("/mujoco/actuator", "<motor name='ms' site='sb' gear='0 0 1 0 0 0'/>"))),
    _set("size of a site", "//site[@name='sb']", "size", "0.05"),
    _set("color of a site", "//site[@name='sb']", "rgba", "1 0 0 1"),
    _set("sleep policy", "//body[@name='a']", "sleep", "never"),
    Planted("mocap body", "mocap", add("//worldbody",
            "<body name='hand' mocap='true'><geom size='.1' mass='1'/></body>")),
    Planted("camera", "camera", add(_B, "<camera name='cam' mode='track'/>")),
    Planted("camera optics", "camera optics",
            add(_B, "<camera name='cam' ipd='0.2' projection='orthographic'/>")),
    Planted("light", "light", add(_B, "<light name='li' dir='1 0 0' attenuation='1 2 0'/>")),
    Planted("deformable body", "flex", add("//worldbody",
            "<flexcomp name='cloth' type='grid' count='3 3 1' spacing='.1 .1 .1' radius='.01'/>")),
    Planted("height field", "height field", both(
        add("/mujoco", "<asset><hfield name='h' nrow='2' ncol='2' size='1 1 1 1' "
            "elevation='0 1 1 0'/></asset>"),
        add("//worldbody", "<geom type='hfield' hfield='h'/>"))),
)  # fmt: skip
"""What is added; the rows are its kinds."""


_DERIVED = re.compile(
    r"(adr|num|id|_map|sameframe|names|paths|text_data|signature|nbuffer|geom[12])$"
)
"""Fields of a compiled model that are places in others."""


def list_values(model: mujoco.MjModel) -> dict[str, Counter[tuple[float, ...]]]:
    """Return the values of each field of a compiled model, without their order."""
    found = {}
    for part in (model, model.opt, model.stat, model.vis.map):
        for name in dir(part):
            value = None if name.startswith("_") or _DERIVED.search(name) else getattr(part, name)
            if isinstance(value, np.ndarray | float | int) and not isinstance(value, bool):
                rows = np.asarray(value, float)
                count = len(rows) if part is model and rows.ndim else 1
                rows = rows.reshape(count, -1) if count else rows.reshape(0, 1)
                found[name] = Counter(map(tuple, np.round(rows, _DIGITS) + 0.0))
                if name.endswith("_user"):  # zeros of parts without data, if others have some
                    found[name] = Counter({k: n for k, n in found[name].items() if any(k)})
    return found


def list_changes(old: mujoco.MjModel, new: mujoco.MjModel) -> dict[str, object]:
    """Return the values that one compiled model lacks and has in addition, by field."""
    before, after = list_values(old), list_values(new)
    changes = {n: (before[n] - after[n], after[n] - before[n]) for n in before}
    return {name: more or less for name, (less, more) in changes.items() if less or more}
