import pytest

from tests.graph.robots import robot
from urdftool.api.lint import check
from urdftool.graph.detailed import create_detailed_figure
from urdftool.graph.dot import to_dot
from urdftool.graph.fold import fold_fixed
from urdftool.graph.marks import mark_findings
from urdftool.graph.mermaid import label, to_mermaid

ARM = """<robot name="arm">
<link name="base">
 <inertial><mass value="2.5"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
 <visual><geometry><mesh filename="package://arm/meshes/base.dae"/></geometry></visual>
 <visual><geometry><box size="1 1 1"/></geometry></visual>
 <visual><geometry><box size="1 1 1"/></geometry></visual>
</link>
<link name="upper"/>
<link name="tip">
 <inertial><mass value="0.5"/></inertial>
 <collision><geometry><sphere radius="1"/></geometry></collision>
</link>
<joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/>
 <origin xyz="0 0 0.5" rpy="0 1.5707963 0"/><axis xyz="0 0 -1"/>
 <limit lower="-1.5" upper="2" effort="10" velocity="3"/></joint>
<joint name="wrist" type="fixed"><parent link="upper"/><child link="tip"/></joint>
<link name="finger"/>
<joint name="slide" type="prismatic"><parent link="tip"/><child link="finger"/>
 <axis xyz="1 1 0"/><limit upper="0.1" effort="5" velocity="0.2"/>
 <mimic joint="shoulder" multiplier="-2" offset="0.1"/></joint>
<transmission name="t"><type>transmission_interface/SimpleTransmission</type>
 <joint name="shoulder">
  <hardwareInterface>hardware_interface/EffortJointInterface</hardwareInterface></joint>
</transmission>
<gazebo reference="tip"><sensor name="eye" type="camera">
 <plugin name="p" filename="libcamera.so"/></sensor></gazebo>
<gazebo><plugin name="drive" filename="libdrive.so"/></gazebo>
<gazebo reference="nothing"><sensor name="lost" type="imu"/></gazebo>
<ros2_control name="hw" type="system"><hardware><plugin>fake/System</plugin></hardware>
 <joint name="shoulder">
  <command_interface name="position"/><state_interface name="velocity"/></joint>
 <sensor name="force"/>
</ros2_control>
</robot>"""


@pytest.fixture
def figure():
    return create_detailed_figure(robot(ARM))


def lines(figure, key):
    return figure.nodes[key].lines


def test_a_joint_says_what_it_does(figure):
    assert lines(figure, "joint:shoulder") == [
        "revolute about -z",
        "-1.5 … 2 rad",
        "at most 10 N·m, 3 rad/s",
        "transmission t (EffortJointInterface)",
        "command position; state velocity",
    ]
    assert lines(figure, "joint:slide") == [
        "prismatic along 1 1 0",
        "0 … 0.1 m",
        "at most 5 N, 0.2 m/s",
        "mimics -2 × shoulder +0.1",
    ]
    assert lines(figure, "joint:wrist") == ["fixed"]


def test_a_link_says_what_it_is_made_of(figure):
    assert lines(figure, "link:base") == [
        "2.5 kg",
        "visual: base.dae, 2 × box",
        "no collision",
    ]
    assert lines(figure, "link:upper") == ["frame"]
    assert lines(figure, "link:tip") == ["0.5 kg", "no visual", "collision: sphere"]


def test_what_is_attached_hangs_where_it_is(figure):
    held = {(edge.tail, edge.head) for edge in figure.edges if edge.kind == "holds"}
    assert held == {
        ("link:tip", "sensor:eye"),
        ("link:base", "plugin:drive"),
        ("missing:nothing", "sensor:lost"),
        ("joint:shoulder", "controller:hw"),
    }
    assert lines(figure, "sensor:eye") == ["camera sensor", "libcamera.so"]
    assert lines(figure, "controller:hw") == ["ros2_control system", "fake/System", "sensor force"]


def test_a_mimic_is_an_edge_from_what_it_follows(figure):
    assert [(e.tail, e.head) for e in figure.edges if e.kind == "mimic"] == [
        ("joint:shoulder", "joint:slide")
    ]


def test_origins_stand_on_the_edges(figure):
    (edge,) = [e for e in figure.edges if e.head == "joint:shoulder" and e.kind == "joint"]
    assert (edge.xyz, edge.rpy) == ("0 0 0.5", "0 1.571 0")


def test_a_rigid_body_has_the_mass_of_its_links(figure):
    folded = fold_fixed(figure)
    node = folded.nodes["link:upper"]
    assert node.members == ["tip"]
    assert node.lines == ["0.5 kg"]
    assert node.facts["mass"] == 0.5
    assert ("link:upper", "sensor:eye") in {(e.tail, e.head) for e in folded.edges}
    assert "joint:wrist" not in folded.nodes


def test_findings_stand_on_their_nodes(figure):
    mark_findings(figure, check(robot(ARM)))
    found = {node.key: {f.code for f in node.findings} for node in figure.nodes.values()}
    assert "incomplete-inertial" in found["link:tip"]
    assert "missing-collision" in found["link:base"]
    assert any("dangling-reference" in rules for key, rules in found.items() if "nothing" in key)
    text = to_dot(figure)
    (line,) = [line for line in text.splitlines() if line.startswith('"link:tip" [')]
    assert ": incomplete-inertial" in line


def test_instances_of_a_macro_are_all_marked(xacro_file):
    from urdftool.model.load import load

    path = xacro_file(
        "r.urdf.xacro",
        '<xacro:macro name="leg" params="n"><link name="leg_${n}"><inertial>'
        '<mass value="-1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>'
        '</link><joint name="hip_${n}" type="fixed"><parent link="base"/>'
        '<child link="leg_${n}"/></joint></xacro:macro><link name="base"/>'
        '<xacro:leg n="1"/><xacro:leg n="2"/>',
    )
    model = load(path)
    figure = create_detailed_figure(model)
    mark_findings(figure, check(model))
    for key in ("link:leg_1", "link:leg_2"):
        assert "negative-mass" in {finding.code for finding in figure.nodes[key].findings}


def test_mermaid_has_every_node_and_edge(figure):
    text = to_mermaid(figure)
    assert text.startswith("flowchart TB\n")
    assert text.count(":::") == len(figure.nodes)
    assert sum("-->" in line or "-.-" in line for line in text.splitlines()) == len(figure.edges)
    assert '-->|"xyz 0 0 0.5<br>rpy 0 1.571 0"|' in text


@pytest.mark.parametrize(
    ("name", "shown"),
    [
        ("arm_1", "arm_1"),
        ('a"b', "a#34;b"),
        ("<b>", "#60;b#62;"),
        ("#35;", "#35;35#59;"),
        ("`md`", "#96;md#96;"),
        ("a\\n", "a#92;#8288;n"),
    ],
)
def test_mermaid_takes_nothing_in_a_name_for_markup(name, shown):
    assert label(name) == shown
