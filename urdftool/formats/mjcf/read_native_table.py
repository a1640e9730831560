"""Elements and attributes of MJCF: those that the robot holds, and those that an export copies."""

from __future__ import annotations

from ...model.settings import ALL_OF_JOINTS, ALL_SURFACE, RESISTANCE

_PLACED = ("pos", "quat", "euler", "axisangle", "xyaxes", "zaxis", "fromto")

KINDS = {
    "tendon": ("tendon", "tendons"),
    "actuator": ("actuator", "actuators"),
    "equality": ("eq", "equalities"),
    "sensor": ("sensor", "sensors"),
    "contact": ("pair", "pairs"),
}
"""Prefix of the fields of MuJoCo's model and list of ``MjSpec`` of the sections that are copied."""

MERGED = ("size", "statistic", "visual", "option")
"""Sections whose attributes are added to those of an export."""

COPIED = (*KINDS, "custom", "keyframe", *MERGED)
"""Sections whose elements are copied."""

ACTUATORS = frozenset((
    "general", "motor", "position", "velocity", "intvelocity", "damper", "cylinder", "muscle",
    "adhesion", "dcmotor", "orientation", "pid", "plugin",
))  # fmt: skip
"""Elements of ``<actuator>`` and of default classes."""

CLASSES = ACTUATORS | {"tendon", "equality", "pair"}
"""Elements of default classes of copied elements."""

REFERENCES = {
    "joint": ("joint", "joint1", "joint2", "jointinparent"),
    "body": ("body", "body1", "body2", "subtree1", "subtree2"),
    "site": ("site", "site1", "site2", "refsite", "slidersite", "cranksite", "sidesite"),
    "geom": ("geom", "geom1", "geom2"),
    "camera": ("camera",),
    "tendon": ("tendon", "tendon1", "tendon2"),
    "actuator": ("actuator",),
    "material": ("material",),
    "mesh": ("mesh",),
    "plugin": ("instance", "plugin"),
    "flex": ("flex",),
    "sensor": (),
    "key": (),
}
"""Attributes that name an element of a kind."""

OBJECTS = {"objname": "objtype", "refname": "reftype"}
"""Attributes that name an element, and those that name its kind."""

_SENSOR = ("name", "objtype", "objname", "site", "joint", "body", "geom", "camera", "actuator",
           "tendon", "jointinparent")  # fmt: skip
_ACTUATOR = (
    *("name", "class", "joint", "jointinparent", "gear", "ctrlrange", "ctrllimited", "forcerange"),
    *("forcelimited", "kp", "kv", "dampratio", "inheritrange", "gainprm", "biasprm", "gaintype"),
    "biastype",
)

READ_IN = {
    "actuator": frozenset(_ACTUATOR),
    "sensor": frozenset(_SENSOR),
    "equality": frozenset((
        "name", "class", "body1", "body2", "site1", "site2", "anchor", "relpose", "active",
        "joint1", "joint2", "polycoef",
    )),
    "keyframe": frozenset(("name", "qpos")),
    "contact": frozenset(("name", "body1", "body2")),
}  # fmt: skip
"""Attributes that the robot holds of the elements of a section; other sections it lacks."""

HELD_VALUES = {
    "actuator": {
        "actuator_gear": 0, "actuator_ctrlrange": 0, "actuator_ctrllimited": 0,
        "actuator_forcerange": 0, "actuator_forcelimited": 0, "actuator_gaintype": 0,
        "actuator_biastype": 0, "actuator_trntype": 0, "actuator_gainprm": 1,
        "actuator_biasprm": 3,
    },
    "sensor": {"sensor_type": 0, "sensor_objtype": 0, "sensor_reftype": 0},
    "equality": {"eq_type": 0, "eq_objtype": 0, "eq_active0": 0, "eq_data": 10},
}  # fmt: skip
"""Values of the elements of a section that the robot holds: how many of each, 0 for all."""

READ = {
    "body": (*_PLACED, "name", "childclass", "mocap", "gravcomp"),
    "joint": (
        *("name", "class", "type", "pos", "axis", "range", "limited", "springdamper", "ref"),
        *("actuatorfrcrange", "actuatorfrclimited", "align"),
        *(row.mjcf_attribute for row in (*RESISTANCE, *ALL_OF_JOINTS) if row.mjcf),
    ),
    "geom": (
        *_PLACED,
        *("name", "class", "type", "size", "mass", "density", "mesh", "material", "rgba"),
        *("group", "shellinertia", "fitscale", "hfield"),
        *(row.mjcf_attribute for row in ALL_SURFACE if row.mjcf),
    ),
    "site": (*_PLACED, "name", "class"),
    "camera": (*_PLACED, "name", "class", "fovy", "resolution", "mode", "target"),
    "light": (
        *("name", "class", "pos", "dir", "type", "directional", "diffuse", "specular", "cutoff"),
        *("castshadow", "mode", "target"),
    ),
    "material": ("name", "class", "rgba", "texture"),
}
"""Attributes that the robot holds, or that take effect in others that it holds."""

PARTS = {
    "body": (("mocap", "sleep", "user"), ()),
    "joint": (("actuatorfrcrange", "actuatorfrclimited"), ("group", "user")),
    "freejoint": ((), ("group", "user")),
    "geom": (("fluidshape", "fluidcoef", "adhesion"), ("user",)),
    "site": ((), ("group", "size", "type", "rgba", "user")),
    "camera": ((), ("mode", "target", "ipd", "projection", "user")),
    "light": ((), ("mode", "target", "attenuation", "exponent", "ambient", "active", "intensity",
                   "range", "bulbradius")),
    "material": ((), ("specular", "shininess", "emission", "reflectance", "metallic", "roughness")),
}  # fmt: skip
"""Attributes of parts that an export copies: those that affect motion, and those that do not."""
