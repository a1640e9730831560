"""Each field of the model is written by each format, or its loss is named; nothing is silent.

A value that is not the default is planted in every row of the tables of settings and in the fields
of joints, links and visuals. Each format writes the robot and reads it back: a value is equal, or a
loss names it. And the comparison names a robot with one other value.
"""

from dataclasses import replace
from functools import partial

import pytest

import urdftool as api
from urdftool.compare.compare import compare_robots
from urdftool.model.appearance import APPEARANCE
from urdftool.model.settings import (
    ALL_OF_JOINTS,
    ALL_OF_LINKS,
    ALL_SURFACE,
    LOST_SETTINGS,
    OF_JOINTS,
    OF_LINKS,
    OF_ROBOT,
    RESISTANCE,
    SURFACE,
    Value,
)
from urdftool.model.world_settings import OF_MUJOCO, OF_SDF

TENSOR = '<inertia ixx=".1" iyy=".1" izz=".1" ixy="0" ixz="0" iyz="0"/>'
URDF = f"""<robot name="r">
<link name="a"><inertial><mass value="2"/>{TENSOR}</inertial>
<visual><geometry><box size="1 1 1"/></geometry></visual>
<collision><geometry><box size="1 1 1"/></geometry></collision></link>
<link name="b"><inertial><mass value="1"/>{TENSOR}</inertial>
<collision><geometry><sphere radius=".2"/></geometry></collision></link>
<joint name="j" type="revolute"><parent link="a"/><child link="b"/><origin xyz="0 0 2"/>
<axis xyz="1 0 0"/><limit lower="-1" upper="1" effort="5" velocity="2"/></joint>{{}}</robot>"""
MASS = (
    "<inertial><mass>{}</mass><inertia><ixx>.1</ixx><iyy>.1</iyy><izz>.1</izz></inertia></inertial>"
)
SDF = f"""<sdf version="1.11"><model name="r"><link name="a">{MASS.format(2)}
<visual name="v"><geometry><box><size>1 1 1</size></box></geometry>
<material><ambient>1 0 0 1</ambient><diffuse>1 0 0 1</diffuse></material></visual>
<collision name="c"><geometry><box><size>1 1 1</size></box></geometry></collision></link>
<link name="b"><pose>0 0 2 0 0 0</pose>{MASS.format(1)}
<collision name="c"><geometry><sphere><radius>.2</radius></sphere></geometry></collision></link>
<joint name="j" type="revolute"><parent>a</parent><child>b</child><axis><xyz>1 0 0</xyz><limit>
<lower>-1</lower><upper>1</upper><effort>5</effort><velocity>2</velocity></limit></axis></joint>
</model></sdf>"""
MJCF = """<mujoco model="r"><compiler angle="radian"/><worldbody>
<body name="a"><freejoint/><inertial pos="0 0 0" mass="2" diaginertia=".1 .1 .1"/>
<geom name="v" type="box" size=".5 .5 .5" contype="0" conaffinity="0" group="2" rgba="1 0 0 1"/>
<geom name="c" type="box" size=".5 .5 .5"/>
<body name="b" pos="0 0 2"><inertial pos="0 0 0" mass="1" diaginertia=".1 .1 .1"/>
<joint name="j" axis="1 0 0" range="-1 1" actuatorfrcrange="-5 5"/>
<geom type="sphere" size=".2"/></body></body></worldbody></mujoco>"""

TABLES = {
    "surface": (ALL_SURFACE, lambda robot: robot.link["b"].collisions[0].surface),
    "link": (ALL_OF_LINKS, lambda robot: robot.link["b"].settings),
    "joint": (ALL_OF_JOINTS, lambda robot: robot.joint["j"].settings),
    "robot": (OF_ROBOT, lambda robot: robot.settings),
    "visual": (APPEARANCE, lambda robot: robot.link["a"].visuals[0].appearance),
}
WORDS = {
    "integrator": "RK4", "cone": "elliptic", "jacobian": "sparse", "solver": "CG",
    "disabled": "contact", "enabled": "energy", "disabled_actuators": "1",
}  # fmt: skip
STRUCTURE = ("static", "preserved", "not_lumped")
"""Settings that are in the base of a robot, or in its joints."""

COLOR = ("diffuse", "transparency")
"""Values of a visual that are in the color of its material."""

EXPRESSED = {
    ("mjcf", "second_friction"): "MJCF has one friction for both directions",
    ("mjcf", "gravity_compensation"): "one attribute with gravity, which is planted, too",
    ("usd", "self_collide"): "written as that of the articulation, which the reader does not read",
}
"""Fields that a format expresses otherwise, and why no loss is named."""


def change(row):
    """Return another value than the default."""
    if row.name in WORDS:
        return WORDS[row.name]
    if isinstance(row.default, bool):
        return not row.default
    if row.kind == "color":
        return (0.25, 0.5, 0.75, 1.0)
    if isinstance(row.default, tuple):
        return tuple(0.5 * number + 0.3 for number in row.default)
    if row.kind == "count":
        return 4.0 if row.default == 3 else 3.0
    return 0.5 * row.default + 0.3


def has(form, row):
    return bool(row.mjcf if form == "mjcf" else row.path)


def list_fields(form):
    """Yield table and row of each setting that a format has."""
    for table, (rows, _) in TABLES.items():
        for row in rows:
            if has(form, row) and row.name not in (*STRUCTURE, *COLOR):
                yield table, row


def plant(robot, chosen):
    """Set other values of settings."""
    for table, row in chosen:
        TABLES[table][1](robot)[row.name] = Value(robot.provenance, change(row))


def read(tmp_path, form, text):
    path = tmp_path / f"r.{'xml' if form == 'mjcf' else form}"
    path.write_text(text)
    return api.load(path)


def make_blocks():
    """Return blocks of a URDF with another value of every setting."""
    texts = []
    for reference, rows, above in (
        ("b", SURFACE, "collision/"), ("b", OF_LINKS, ""), ("j", OF_JOINTS, ""), ("", OF_ROBOT, "")
    ):  # fmt: skip
        for row in rows:
            if row.name in STRUCTURE:
                continue
            content = change(row)
            value = " ".join(map(str, content)) if isinstance(content, tuple) else str(content)
            value = value.lower()
            path = row.tags[0] if row.tags else above + row.path
            if row.opposite:
                path, value = row.opposite, "true"
            inner = value
            for tag in reversed(path.split("/")):
                inner = f"<{tag}>{inner}</{tag}>"
            texts.append(f'<gazebo reference="{reference}">{inner}</gazebo>')
    return "".join(texts).replace(' reference=""', "")


SOURCES = {"urdf": URDF.format(make_blocks()), "sdf": SDF, "mjcf": MJCF}
EXPORTS = {
    "urdf": api.export_urdf,
    "sdf": api.export_sdf,
    "mjcf": partial(api.export_mjcf, actuators="none"),
    "usd": api.export_usd,
}


def is_same(one, other):
    if isinstance(one, tuple) and isinstance(other, tuple):
        return one == pytest.approx(other)
    return one == other if isinstance(one, bool | str) else one == pytest.approx(other)


def is_named(row, losses):
    """Tell whether the data of a loss names a setting."""
    return any(row.name in loss.data.get(LOST_SETTINGS, ()) for loss in losses)


@pytest.mark.usefixtures("stages_are_read_here")
@pytest.mark.library("mujoco")
@pytest.mark.library("pxr")
@pytest.mark.parametrize("target", EXPORTS)
@pytest.mark.parametrize("form", SOURCES)
def test_each_setting_is_written_or_its_loss_is_named(tmp_path, form, target):
    robot = read(tmp_path, form, SOURCES[form])
    fields = [
        (table, row) for table, row in list_fields(form) if form != "urdf" or table != "visual"
    ]
    if form != "urdf":
        plant(robot, fields)
    wanted = {(t, row.name): TABLES[t][1](robot)[row.name].content for t, row in fields}
    written = EXPORTS[target](robot, tmp_path / "out")
    made = api.load(tmp_path / "out" / written.main)
    silent = []
    for table, row in fields:
        value = TABLES[table][1](made).get(row.name)
        content = row.default if value is None else value.content
        if is_same(wanted[table, row.name], content) or (target, row.name) in EXPRESSED:
            continue
        if not is_named(row, written.losses):
            silent.append((table, row.name, wanted[table, row.name], content))
    assert silent == []


ELEMENTS = """<battery name="b"><voltage>12</voltage></battery><projector name="p"/><other>1</other>
<collision><surface><friction><bullet><friction>.3</friction></bullet></friction></surface></collision>
<visual><cast_shadows>false</cast_shadows><visibility_flags>1</visibility_flags></visual>"""


@pytest.mark.library("mujoco")
@pytest.mark.library("pxr")
@pytest.mark.parametrize("target", ["mjcf", "usd"])
def test_each_element_of_a_block_that_is_not_written_is_named_once(tmp_path, target):
    text = URDF.format(f'<gazebo reference="b">{ELEMENTS}</gazebo>')
    text = text.replace('<link name="b">', '<link name="b"><collision><geometry><box size="1 1 1"/>'
                        "</geometry></collision>")  # fmt: skip
    losses = EXPORTS[target](read(tmp_path, "urdf", text)).losses
    named = [loss.message for loss in losses if loss.code == "lossy-gazebo"]
    words = ("<battery>", "<projector>", "<other>", "surface/friction/bullet/friction")
    assert [sum(word in message for message in named) for word in words] == [1, 1, 1, 1]
    assert {loss.name for loss in losses if loss.code == "lossy-gazebo"} == {"b"}


FIELDS = {
    "lower": -0.5, "upper": 0.5, "effort": 7.0, "velocity": 3.0, "damping": 0.7, "friction": 0.6,
    "armature": 0.4, "mass": 3.0, "ixx": 0.12, "axis": (0.0, 1.0, 0.0), "type": "prismatic",
}  # fmt: skip
"""Another value of each field of a joint and of an inertial."""


def replace_field(robot, name):
    """Return the robot with another value of a field of its joint, or of its second link."""
    value, joint, link = FIELDS[name], robot.joint["j"], robot.link["b"]
    if name in [row.name for row in RESISTANCE]:
        joint = joint.replace_resistance({name: value})
    elif name == "axis":
        joint = replace(joint, axis=replace(joint.axis, xyz=value))
    elif name == "type":
        joint = replace(joint, type=value)
    elif name == "mass":
        link = replace(link, inertial=replace(link.inertial, mass=value))
    elif name == "ixx":
        inertia = replace(link.inertial.inertia, ixx=value)
        link = replace(link, inertial=replace(link.inertial, inertia=inertia))
    else:
        joint = replace(joint, limit=replace(joint.limit, **{name: value}))
    return replace(robot, joints=[joint], links=[robot.link["a"], link])


@pytest.mark.usefixtures("stages_are_read_here")
@pytest.mark.library("mujoco")
@pytest.mark.library("pxr")
@pytest.mark.parametrize("target", EXPORTS)
def test_every_number_of_a_joint_and_an_inertial_is_written_or_its_loss_is_named(tmp_path, target):
    plain = read(tmp_path, "sdf", SDF)
    robot = plain
    for name in FIELDS:
        if name != "type":
            robot = replace_field(robot, name)
    written = EXPORTS[target](robot, tmp_path / "out")
    made = api.load(tmp_path / "out" / written.main)
    rows = {difference.what for difference in compare_robots(robot, made).differences}
    named = [loss.message for loss in written.losses]
    assert [
        what for what in rows if not any(what.rpartition(" ")[2] in text for text in named)
    ] == []


@pytest.mark.library("mujoco")
@pytest.mark.parametrize("form", ["sdf", "mjcf"])
def test_the_comparison_names_every_setting(tmp_path, form):
    plain, other = (read(tmp_path, form, SOURCES[form]) for _ in range(2))
    for robot in (plain, other):  # the rest of a spring counts with a spring
        robot.joint["j"].settings["spring_stiffness"] = Value(robot.provenance, 3.0)
    for table, row in list_fields(form):
        if (form, row.name) == ("mjcf", "second_friction"):
            continue
        values = TABLES[table][1](other)
        before = dict(values)
        plant(other, [(table, row)])
        found = [d.what for d in compare_robots(plain, other).differences]
        assert any(row.name.replace("_", " ") in what for what in found), row.name
        values.clear()
        values.update(before)
        assert compare_robots(plain, other).differences == []


@pytest.mark.library("mujoco")
@pytest.mark.parametrize("form", ["urdf", "sdf", "mjcf"])
@pytest.mark.parametrize("name", FIELDS)
def test_the_comparison_names_every_number_of_a_joint_and_an_inertial(tmp_path, form, name):
    plain = read(tmp_path, form, {**SOURCES, "urdf": URDF.format("")}[form])
    found = compare_robots(plain, replace_field(plain, name)).differences
    assert {"b", "j"} & {owner for d in found for owner in (*d.names, *d.owners)}


@pytest.mark.library("mujoco")
@pytest.mark.parametrize(("form", "rows"), [("sdf", OF_SDF), ("mjcf", OF_MUJOCO)])
def test_the_comparison_names_every_setting_of_the_world(tmp_path, form, rows):
    text = MJCF if form == "mjcf" else SDF.replace('"1.11">', '"1.11"><world name="w">')
    text = text.replace("</model></sdf>", "</model></world></sdf>")
    plain, other = (read(tmp_path, form, text) for _ in range(2))
    for row in rows:
        before = dict(other.world)
        other.world[row.name] = Value(other.provenance, change(row))
        found = [d.what for d in compare_robots(plain, other).differences]
        assert row.name.replace("_", " ") in found, row.name
        other.world.clear()
        other.world.update(before)
