"""The values that sdformat's unit tests of its converter expect, for robots as small as theirs.

Where theirs is a known fault ours is said to differ in the page of the format: a massless link that
moves is kept with all below it, ``disableFixedJointLumping`` keeps a fixed joint fixed, shapes keep
their names, and a number that is none is refused with its place.
"""

import pytest

from urdftool.refusal import Refused

from .robots import export, gazebo, joint, link, named, names, robot, rules, tree

LUMP, KEEP = {"fixed_joints": "lump"}, {"fixed_joints": "keep"}
CLASSIC = {"target": "gazebo-classic"}
HEAVY = (
    '<inertial><mass value="0.1"/><origin rpy="1.570796326794895 0 0" xyz="0.123456789123456 0 0.0"'
    '/><inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial>'
)
SPHERE = '<geometry><sphere radius="1.0"/></geometry>'
SHAPES = f"<visual>{SPHERE}</visual><collision>{SPHERE}</collision>"


def chain(kinds, light=0, kept=()):
    """Links in a row; one of them, counted from 1, has shapes and no mass."""
    parts = [link(f"link{n}", SHAPES if n == light else HEAVY) for n in range(1, len(kinds) + 2)]
    for n, kind in enumerate(kinds, 1):
        parts.append(
            joint(f"joint{n}_{n + 1}", f"link{n}", f"link{n + 1}", kind, "", origin="1 2 3")
        )
    tag = "<disableFixedJointLumping>true</disableFixedJointLumping>"
    return [*parts, *(gazebo(name, tag) for name in kept)]


TURN, FIX = "continuous", "fixed"
ALL = ["link1", "link2", "link3"]
BOTH = ["joint1_2", "joint2_3"]
FIRST_FRAMES = {"joint1_2": "link1", "link2": "joint1_2"}
LAST_FRAMES = {"joint2_3": "link2", "link3": "joint2_3"}

ROWS = [
    # joints, massless link, kept by a tag, choices, links, joints, frames, what is said
    ((TURN,), 0, (), KEEP, ALL[:2], BOTH[:1], {}, []),
    ((FIX,), 0, (), LUMP, ALL[:1], [], FIRST_FRAMES, []),
    ((FIX,), 0, (), KEEP, ALL[:2], BOTH[:1], {}, []),
    ((FIX, TURN), 2, (), LUMP, ["link1", "link3"], BOTH[1:], FIRST_FRAMES, []),
    ((FIX, TURN), 2, (), KEEP, ["link1", "link3"], BOTH[1:], FIRST_FRAMES, ["lossy-link"]),
    ((TURN, FIX), 2, (), LUMP, ALL[:2], BOTH[:1], LAST_FRAMES, []),
    ((TURN, FIX), 2, (), KEEP, ["link1", "link3"], BOTH[:1],
     {"link2": "link3", "joint2_3": "link3"}, ["lossy-link"]),
    ((TURN, FIX), 3, (), LUMP, ALL[:2], BOTH[:1], LAST_FRAMES, []),
    ((TURN, FIX), 3, (), KEEP, ALL[:2], BOTH[:1], LAST_FRAMES, ["lossy-link"]),
]  # fmt: skip
LOST_THERE = [
    # what sdformat drops with all below it, or fails at
    ((TURN,), 1, ()),
    ((TURN,), 2, ()),
    ((TURN, TURN), 2, ()),
    ((FIX, TURN), 2, BOTH[:1]),
    ((TURN, FIX), 2, BOTH[1:]),
    ((FIX, FIX), 2, BOTH),
    ((TURN, FIX), 3, BOTH[1:]),
]


@pytest.mark.parametrize(
    ("kinds", "light", "kept", "choices", "links", "joints", "frames", "said"), ROWS
)
def test_links_without_mass(kinds, light, kept, choices, links, joints, frames, said):
    written = export(*chain(kinds, light, kept), **choices)
    model = tree(written)
    assert names(model, "link") == links
    assert names(model, "joint") == joints
    assert {e.get("name"): e.get("attached_to") for e in model.findall("frame")} == frames
    assert rules(written) == said
    if light:
        assert [e.get("name") for e in model.iter("visual")] == [f"link{light}_visual"]
        assert [e.get("name") for e in model.iter("collision")] == [f"link{light}_collision"]


@pytest.mark.parametrize(("kinds", "light", "kept"), LOST_THERE)
@pytest.mark.parametrize("choices", [LUMP, KEEP])
def test_a_link_that_has_no_mass_and_no_neighbour_takes_nothing_with_it(
    kinds, light, kept, choices
):
    written = export(*chain(kinds, light, kept), **choices)
    model = tree(written)
    assert names(model, "link") == ALL[: len(kinds) + 1]
    assert names(model, "joint") == BOTH[: len(kinds)]
    assert named(model, "link", f"link{light}").findtext("inertial/mass") == "1e-12"
    assert rules(written) == ["lossy-mass"]


def test_the_mass_of_a_link_is_that_of_what_is_lumped_into_it():
    made = named(tree(export(*chain((TURN, FIX), 2), **LUMP)), "link", "link2")
    assert float(made.findtext("inertial/mass")) == 0.1


@pytest.mark.parametrize("light", [2, 3])
def test_a_small_mass_is_a_mass(light):
    part = HEAVY.replace('"0.1"', '"1e-6"')
    parts = [p.replace(SHAPES, part) for p in chain((FIX, TURN), light)]
    assert names(tree(export(*parts)), "link") == ALL


@pytest.mark.parametrize(
    ("mass", "said"), [("0", "lossy-mass"), (None, "lossy-mass"), ("-0.1", "negative-mass")]
)
def test_masses_that_are_none_are_said(mass, said):
    inside = "" if mass is None else HEAVY.replace('"0.1"', f'"{mass}"')
    if said == "negative-mass":
        with pytest.raises(Refused) as caught:
            export(link("link1", inside))
        assert [finding.code for finding in caught.value.findings] == [said]
    else:
        assert rules(export(link("link1", inside))) == [said]


FACTORS = [
    ("dampingFactor", "25.2", "velocity_decay/linear"),
    ("dampingFactor", "25.2", "velocity_decay/angular"),
    ("maxVel", "1.7", "collision/surface/contact/ode/max_vel"),
    ("minDepth", "0.001", "collision/surface/contact/ode/min_depth"),
    ("mu1", "8.9", "collision/surface/friction/ode/mu"),
    ("mu2", "12.5", "collision/surface/friction/ode/mu2"),
    ("kp", "1000.2", "collision/surface/contact/ode/kp"),
    ("kd", "100.1", "collision/surface/contact/ode/kd"),
    ("maxContacts", "99", "collision/max_contacts"),
    ("laserRetro", "72.8", "collision/laser_retro"),
]


@pytest.mark.parametrize(("tag", "value", "path"), FACTORS)
@pytest.mark.parametrize("choices", [{}, CLASSIC])
def test_factors_of_links(tag, value, path, choices):
    shape = (
        '<collision><geometry><cylinder length="0.0206" radius="0.0352"/></geometry></collision>'
    )
    said = gazebo("wheel_left_link", f"<{tag}>{value}</{tag}>")
    model = tree(export(link("wheel_left_link", HEAVY + shape), said, **choices))
    assert model.findtext(f"link/{path}") == value


def test_a_damping_factor_that_is_no_number_is_refused():
    said = gazebo("link", "<dampingFactor>foo</dampingFactor>")
    with pytest.raises(Refused, match="'foo', not a finite number"):
        export(link("link"), said)


JOINT_ELEMENTS = [
    ("stopCfm", "0.8", "physics/ode/limit/cfm"),
    ("stopErp", "0.8", "physics/ode/limit/erp"),
    ("fudgeFactor", "11.1", "physics/ode/fudge_factor"),
]
NECK = (
    '<axis xyz="0 -1 0"/><limit effort="100" velocity="0.349" lower="-0.314" upper="0.017"/>',
    {"xyz": "0 -1 0", "limit/effort": "100", "limit/velocity": "0.349", "limit/lower": "-0.314",
     "limit/upper": "0.017"},
)  # fmt: skip


@pytest.mark.parametrize(("tag", "value", "path"), JOINT_ELEMENTS)
@pytest.mark.parametrize("choices", [{}, CLASSIC])
def test_elements_of_joints(tag, value, path, choices):
    parts = (link("chest_link"), joint("head_j0", "chest_link", "neck_tilt", inside=NECK[0]))
    said = gazebo("head_j0", f"<{tag}>{value}</{tag}>")
    made = tree(export(*parts, link("neck_tilt"), said, **choices)).find("joint")
    assert made.findtext(path) == value
    assert {path: made.findtext(f"axis/{path}") for path in NECK[1]} == NECK[1]


OPTIONS = [
    ({}, LUMP, None),
    ({"disableFixedJointLumping": "true"}, LUMP, "fixed"),  # there a revolute joint of 0 and 0
    ({"preserveFixedJoint": "true"}, LUMP, "fixed"),
    ({"disableFixedJointLumping": "true", "preserveFixedJoint": "true"}, LUMP, "fixed"),
    ({"disableFixedJointLumping": "false"}, LUMP, None),
    ({"preserveFixedJoint": "false"}, LUMP, None),
    ({}, KEEP, "fixed"),
    ({"disableFixedJointLumping": "false"}, KEEP, "fixed"),
    ({"preserveFixedJoint": "false"}, KEEP, "fixed"),
    ({"preserveFixedJoint": "YES"}, LUMP, "fixed"),
    ({"preserveFixedJoint": "1"}, LUMP, "fixed"),
]


@pytest.mark.parametrize(("tags", "choices", "kind"), OPTIONS)
def test_what_is_said_of_a_fixed_joint(tags, choices, kind):
    said = [gazebo("joint1_2", f"<{tag}>{text}</{tag}>") for tag, text in tags.items()]
    for _ in range(2):  # nothing of one conversion is known in the next
        made = tree(export(*chain((FIX,)), *said, **choices)).find("joint")
        assert (made.get("type") if made is not None else None) == kind


def test_poses_are_relative_to_joints_and_parents():
    parts = (
        link("world", ""),
        joint("jointw_1", "world", "link1", "fixed"),
        link("link1"),
        joint("joint1_2", "link1", "link2", "continuous", "").replace(
            '<origin xyz="0 0 0"/>', '<origin xyz="0.0 0.0 0.0" rpy="0.0 0.0 1.570796326794897"/>'
        ),
        link("link2"),
        joint("joint2_3", "link2", "link3", "continuous", "", origin="1.0 0.0 0.0"),
        link("link3"),
    )
    model = tree(export(*parts))
    poses = {e.get("name"): (e.find("pose").get("relative_to"), e.findtext("pose"))
             for e in model if e.tag in ("link", "joint")}  # fmt: skip
    assert poses == {
        "jointw_1": ("__model__", "0 0 0 0 0 0"),
        "link1": ("jointw_1", "0 0 0 0 0 0"),
        "joint1_2": ("link1", "0 0 0 0 0 1.570796326794897"),
        "link2": ("joint1_2", "0 0 0 0 0 0"),
        "joint2_3": ("link2", "1 0 0 0 0 0"),
        "link3": ("joint2_3", "0 0 0 0 0 0"),
    }
    types = {e.get("name"): e.get("type") for e in model.findall("joint")}
    assert types == {"jointw_1": "fixed", "joint1_2": "revolute", "joint2_3": "revolute"}
    ends = [(e.findtext("parent"), e.findtext("child")) for e in model.findall("joint")]
    assert ends == [("world", "link1"), ("link1", "link2"), ("link2", "link3")]
    assert [e.text for e in model.iterfind("joint/axis/xyz")] == ["1 0 0"] * 2


def test_numbers_keep_their_digits():
    pose = tree(export(link("link1", HEAVY))).findtext("link/inertial/pose")
    assert pose == "0.123456789123456 0 0 1.570796326794895 0 0"


@pytest.mark.parametrize("choices", [{}, CLASSIC])
def test_blanks_around_values_are_nothing(choices):
    said = "<material>\n Gazebo/Orange\n </material><mu1>\n 100\n </mu1><mu2>\n\n 1000\n\n</mu2>"
    model = tree(export(link("link", HEAVY + SHAPES), gazebo("link", said), **choices))
    ode = model.find("link/collision/surface/friction/ode")
    assert [ode.findtext("mu"), ode.findtext("mu2")] == ["100", "1000"]
    material = model.find("link/visual/material")
    if choices:
        assert material.findtext("script/name") == "Gazebo/Orange"
        uri = material.findtext("script/uri")
        assert uri == "file://media/materials/scripts/gazebo.material"
    else:
        assert material.findtext("ambient") == "1 0.5088 0.0468 1"


@pytest.mark.parametrize("choices", [{}, CLASSIC])
def test_a_visual_without_a_material_has_none(choices):
    model = tree(export(link("link", HEAVY + SHAPES), gazebo("link", "<mu1>0.2</mu1>"), **choices))
    assert model.find("link/visual/material") is None


@pytest.mark.parametrize(
    ("origin", "pose"),
    [
        ("<origin/>", None),
        ('<origin xyz="0 0 0"/>', None),
        ('<origin xyz="1 2 3" rpy="0 0 0.5"/>', "1 2 3 0 0 0.5"),
    ],
)
def test_the_origin_of_a_robot_is_the_pose_of_its_model(origin, pose):
    assert tree(export(origin, link("link"))).findtext("pose") == pose


def test_an_origin_of_a_robot_that_is_none_is_said():
    parts = ('<origin xyz="0 foo 0" rpy="0 0 0"/>', link("link"))
    with pytest.raises(Refused) as caught:
        export(*parts)
    assert [finding.code for finding in caught.value.findings] == ["not-a-number"]
    assert tree(export(*parts, force=True)).find("pose") is None


def test_a_robot_without_anything_is_one_link():
    model = tree(export('<link name="link1"/>'))
    assert names(model, "link") == ["link1"]
    assert robot('<link name="link1"/>').name == model.get("name")
