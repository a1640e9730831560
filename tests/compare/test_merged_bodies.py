"""Comparison of rigid bodies whose links, roots, frames or shapes are organized differently."""

import pytest

from urdftool.compare.compare import compare_robots
from urdftool.formats.registry import format_named

LINK = """<link name="{name}"><inertial><origin xyz="{com}"/><mass value="{mass}"/>
<inertia ixx="{ixx}" ixy="0" ixz="0" iyy="{iyy}" iyz="0" izz="{izz}"/></inertial>{more}</link>
"""
JOINT = """<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>
<origin xyz="{xyz}" rpy="{rpy}"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
"""


def link(name, mass=1.0, com="0 0 0.1", moments=(0.02, 0.02, 0.01), more=""):
    ixx, iyy, izz = moments
    return LINK.format(name=name, mass=mass, com=com, ixx=ixx, iyy=iyy, izz=izz, more=more)


def joint(name, parent, child, *, kind="revolute", xyz="0.1 0 0.3", rpy="0 0 0"):
    return JOINT.format(name=name, parent=parent, child=child, kind=kind, xyz=xyz, rpy=rpy)


def make(*parts):
    return f'<robot name="r">\n{"".join(parts)}</robot>\n'


@pytest.fixture
def compare(write):
    """Compare two texts, in both orders; return the differences of the first order."""

    def compare(one, two, kind="urdf"):
        robots = [
            format_named(name).read(write(f"{number}.xml", text)).robot
            for number, (name, text) in enumerate((("urdf", one), (kind, two)))
        ]
        forth, back = compare_robots(*robots), compare_robots(*reversed(robots))
        titles = [
            {(d.row, d.title) for d in c.differences if d.kind != "robot" and not d.is_convention}
            for c in (forth, back)
        ]
        assert titles[0] == titles[1]
        return titles[0]

    return compare


CHAIN = (
    link("base", 4),
    link("arm"),
    link("hand"),
    joint("shoulder", "base", "arm"),
    joint("wrist", "arm", "hand"),
)


@pytest.mark.parametrize("name", ["shoulder", "wrist"])
def test_a_joint_that_is_fixed_in_one_file_is_one_difference(compare, name):
    fixed = make(*CHAIN).replace(f'name="{name}" type="revolute"', f'name="{name}" type="fixed"')
    assert compare(make(*CHAIN), fixed) == {("tree", f"joint '{name}': type")}


def test_a_frame_that_turns_a_child_is_no_convention(compare):
    """Only the joint below shows that the frame turned about its axis."""
    turned = make(*CHAIN).replace(
        joint("shoulder", "base", "arm"), joint("shoulder", "base", "arm", rpy="0 0 0.02")
    )
    assert compare(make(*CHAIN), turned) == {("frames", "joint 'shoulder': origin")}


def test_a_frame_that_turns_a_welded_link_is_no_convention(compare):
    parts = [*CHAIN[:3], joint("shoulder", "base", "arm")]
    parts.append(joint("wrist", "arm", "hand", kind="fixed"))
    turned = make(*parts).replace('"0.1 0 0.3" rpy="0 0 0"', '"0.1 0 0.3" rpy="0 0 0.02"', 1)
    assert compare(make(*parts), turned) == {("frames", "joint 'shoulder': origin")}


def test_another_link_frame_and_a_small_distance_of_the_axes(compare):
    """The frame of the arm is turned about x, with everything in it; its axis is 0.5 mm off."""
    quarter = 1.5707963267948966
    parts = link("base", 4), link("hand")
    one = make(
        *parts,
        link("arm", com="0 0.1 0.1", moments=(0.02, 0.03, 0.04)),
        joint("shoulder", "base", "arm"),
        joint("wrist", "arm", "hand"),
    )
    shoulder = joint("shoulder", "base", "arm", xyz="0.1 0.0005 0.3", rpy=f"{quarter} 0 0")
    two = make(
        *parts,
        link("arm", com="0 0.1 -0.1", moments=(0.02, 0.04, 0.03)),
        shoulder.replace('axis xyz="0 0 1"', 'axis xyz="0 1 0"'),
        joint("wrist", "arm", "hand", xyz="0.1 0.3 0", rpy=f"{-quarter} 0 0"),
    )
    assert compare(one, two) == {("frames", "joint 'shoulder': origin")}


def test_inertia_moved_to_a_welded_link_is_equal(compare):
    def make_pair(moved):
        moments = [(0.02 - d, 0.02 - d, 0.01) for d in (moved, -moved)]
        return make(
            link("base", 4, moments=moments[0]),
            link("plate", moments=moments[1]),
            joint("weld", "base", "plate", kind="fixed"),
        )

    assert compare(make_pair(0), make_pair(0.005)) == set()
    unequal = make_pair(0.005).replace('ixx="0.025"', 'ixx="0.026"')
    assert ("inertia", "link 'plate': inertia") in compare(make_pair(0), unequal)


def test_a_light_link_of_a_heavy_body_is_compared(compare):
    """1 % of it is less than the tolerance of the body, of which another link was merged."""
    light, sensor = link("light", 0.001, moments=(1e-6, 1e-6, 1e-6)), link("sensor", 0.5)
    welds = [joint(f"weld_{n}", "base", n, kind="fixed", xyz="0 0 0") for n in ("light", "sensor")]
    separate = make(link("base", 40), light, sensor, *welds)
    merged = make(
        link("base", 40.5, moments=(0.04, 0.04, 0.02)),
        light,
        '<link name="sensor"/>',
        *welds,
    )
    separate = separate.replace('mass value="40"', 'mass value="40.0"')
    assert compare(separate, merged) == set()
    changed = merged.replace('value="0.001"', 'value="0.00101"')
    assert ("mass", "link 'light': mass") in compare(separate, changed)


def test_the_tensor_of_a_light_welded_link_is_compared(compare):
    parts = link("base", 40), joint("weld", "base", "light", kind="fixed")
    light = [link("light", 0.001, moments=(x, 1e-6, 1e-6)) for x in (1e-6, 1.02e-6)]
    found = compare(*(make(*parts, text) for text in light))
    assert found == {("inertia", "link 'light': inertia")}


def test_inertia_moved_to_a_heavy_link_is_equal(compare):
    """The heavy link differs by less than its tolerance."""
    parts = joint("weld", "base", "light", kind="fixed"), link("hand"), joint("j", "base", "hand")
    robots = [
        make(
            link("base", 40, moments=(1 - d, 1 - d, 1)),
            link("light", 0.001, moments=(1e-5 + d, 1e-5 + d, 1e-5)),
            *parts,
        )
        for d in (0, 5e-6)
    ]
    assert compare(*robots) == set()


def test_a_change_next_to_a_merged_link_is_named(compare):
    weld = joint("weld", "base", "sensor", kind="fixed", xyz="0 0 0")
    separate = make(link("base", 4), link("sensor", 0.5), weld)
    merged = make(link("base", 4.5, moments=(0.04, 0.04, 0.02)), '<link name="sensor"/>', weld)
    assert compare(separate, merged) == set()
    changed = merged.replace('ixx="0.04"', 'ixx="0.05"')
    assert compare(separate, changed) == {("inertia", "link 'base': inertia")}


def test_a_root_without_mass_may_be_left_out(compare):
    """One difference of another property does not bring back the pose of the root."""
    weld = joint("foot", "base_footprint", "base", kind="fixed", xyz="0 0 0.2")
    whole = make('<link name="base_footprint"/>', *CHAIN, weld)
    assert compare(whole, make(*CHAIN)) == set()
    heavier = make(*CHAIN).replace('mass value="4"', 'mass value="5"')
    assert {title for row, title in compare(whole, heavier) if row != "inertia"} == {
        "link 'base': mass"
    }


def test_a_link_with_another_name_is_found_by_its_joint(write):
    box = '<collision><geometry><box size="0.1 0.2 0.3"/></geometry></collision>'
    one = make(*CHAIN)
    two = make(*CHAIN[:2], link("hand_2", more=box), *CHAIN[3:]).replace('"hand"', '"hand_2"')
    robots = [
        format_named("urdf").read(write(f"{number}.xml", text)).robot
        for number, text in enumerate((one, two))
    ]
    (difference,) = compare_robots(*robots).differences
    assert (difference.row, difference.names) == ("collisions", ("hand", "hand_2"))


CAPSULE = """<sdf version="1.11"><model name="r"><link name="base"><inertial><mass>4</mass>
<pose>0 0 0.1 0 0 0</pose><inertia><ixx>0.02</ixx><iyy>0.02</iyy><izz>0.01</izz></inertia>
</inertial><collision name="c"><pose>0 0.1 0 0.5 0 0</pose><geometry><capsule><radius>0.1</radius>
<length>0.4</length></capsule></geometry></collision></link></model></sdf>
"""


def test_a_capsule_is_a_cylinder_with_two_spheres(compare):
    from math import cos, sin

    ends = [
        f'<collision><origin xyz="0 {0.1 - side * sin(0.5)!r} {side * cos(0.5)!r}"/>'
        '<geometry><sphere radius="0.1"/></geometry></collision>'
        for side in (-0.2, 0.2)
    ]
    tube = '<collision><origin xyz="0 0.1 0" rpy="0.5 0 0"/><geometry><cylinder radius="0.1" '
    shapes = f'{tube}length="0.4"/></geometry></collision>{"".join(ends)}'
    whole = make(link("base", 4, more=shapes))
    assert compare(whole, CAPSULE, "sdf") == set()
    assert {row for row, _ in compare(whole.replace(ends[0], ""), CAPSULE, "sdf")} == {"collisions"}


@pytest.mark.library("mujoco")
def test_a_transparent_visual_is_kept(write):
    text = """<mujoco><worldbody><body name="b"><freejoint/><geom type="box" size="1 1 1"/>
<geom name="glass" type="sphere" size="1" contype="0" conaffinity="0" rgba="1 1 1 0"/>
<geom type="sphere" size="2" rgba="1 1 1 0"/></body></worldbody></mujoco>"""
    robot = format_named("mjcf").read(write("a.xml", text)).robot
    shapes = robot.link["b"]
    assert [visual.name for visual in shapes.visuals if visual.name] == ["glass"]
    assert len(shapes.visuals) == 2
    assert len(shapes.collisions) == 2


def test_a_free_body_that_only_one_world_has(compare):
    """An empty world with one free body is left out, but not if the other file has two."""
    free = (
        '<joint name="{0}_root" type="floating"><parent link="world"/><child link="{0}"/></joint>'
    )
    parts = ['<link name="world"/>', *CHAIN, free.format("base")]
    both = make(*parts, link("ball"), free.format("ball"))
    assert compare(both, make(*parts)) == {("tree", "joint 'ball_root': existence")}
