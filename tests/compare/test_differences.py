import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.graph.robots import robot
from urdftool.compare.compare import compare_robots
from urdftool.compare.difference import THERE
from urdftool.compare.differences import compare
from urdftool.compare.settings import measure_content
from urdftool.compare.tolerance import close, compute_angle, is_same
from urdftool.model.elements import Origin
from urdftool.model.load import load
from urdftool.model.pose import rotation_from_rpy
from urdftool.model.settings import Value
from urdftool.report.compare import describe_what

LINK = '<link name="a">{}</link><link name="b"/>'
JOINT = '<joint name="j" type="{}"><parent link="a"/><child link="b"/>{}</joint>'
BODY = '<inertial>{}<mass value="{}"/><inertia {}/></inertial>'
TENSOR = 'ixx="1" ixy="0" ixz="0" iyy="2" iyz="0" izz="{}"'
BOX = '<visual><origin xyz="{} 0 0"/><geometry><box size="1 1 {}"/></geometry></visual>'


def of(link="", joint="", kind="revolute", more=""):
    inside = LINK.format(link) + JOINT.format(kind, joint) + more
    return robot(f'<robot name="r">{inside}</robot>')


def said(a, b, **options):
    return [(d.kind, d.new_name, describe_what(d)) for d in compare(a, b, **options)]


SAME = {
    "order": (
        robot('<robot name="r"><link name="a"/><link name="b"/></robot>'),
        robot('<robot name="r"><link name="b"/><link name="a"/></robot>'),
    ),
    "rpy another way": (
        of(joint='<origin rpy="0.1 0.2 0.3"/>'),
        of(joint=f'<origin rpy="{0.1 + math.pi} {math.pi - 0.2} {0.3 + math.pi}"/>'),
    ),
    "an origin that says nothing": (of(), of(joint='<origin xyz="0 0 0"/>')),
    "the axis there is without one": (of(), of(joint='<axis xyz="1 0 0"/>')),
    "the axis of a fixed joint": (of(kind="fixed"), of(joint='<axis xyz="0 1 0"/>', kind="fixed")),
    "limits that readers take for zero": (
        of(joint='<limit effort="1" velocity="1"/>'),
        of(joint='<limit effort="1" velocity="1" lower="0" upper="0.0"/>'),
    ),
    "a turned inertial frame": (
        of(BODY.format("", 1, TENSOR.format(3))),
        of(
            BODY.format(
                f'<origin rpy="0 0 {math.pi / 2}"/>',
                1,
                'ixx="2" ixy="0" ixz="0" iyy="1" iyz="0" izz="3"',
            )
        ),
    ),
    "shapes in another order": (
        of(BOX.format(0, 1) + BOX.format(1, 2)),
        of(BOX.format(1, 2) + BOX.format(0, 1)),
    ),
    "a colour by its name": (
        of(
            '<visual><geometry><sphere radius="1"/></geometry><material name="red"/></visual>',
            more='<material name="red"><color rgba="1 0 0 1"/></material>',
        ),
        of(
            '<visual><geometry><sphere radius="1"/></geometry>'
            '<material name="rouge"><color rgba="1 0 0 1"/></material></visual>'
        ),
    ),
    "numbers of a plugin": (
        of(more='<gazebo><plugin name="p" filename="f"><rate>10</rate></plugin></gazebo>'),
        of(more='<gazebo><plugin filename="f" name="p"><rate> 10.0 </rate></plugin></gazebo>'),
    ),
}


@pytest.mark.parametrize("case", SAME)
def test_how_it_is_written_does_not_count(case):
    assert said(*SAME[case]) == []


BODIED = of(BODY.format('<origin xyz="0 0 1"/>', 1, TENSOR.format(3)))
CHANGED = {
    "mass": (BODIED, of(BODY.format('<origin xyz="0 0 1"/>', 2, TENSOR.format(3)))),
    "center of mass": (BODIED, of(BODY.format('<origin xyz="0 0 2"/>', 1, TENSOR.format(3)))),
    "inertia": (BODIED, of(BODY.format('<origin xyz="0 0 1"/>', 1, TENSOR.format(2.5)))),
    "inertial": (BODIED, of()),
    "visual geometry": (of(BOX.format(0, 1)), of(BOX.format(0, 2))),
    "visual origin": (of(BOX.format(0, 1)), of(BOX.format(1, 1))),
    "visual added": (of(), of(BOX.format(1, 1))),
    "visual removed": (of(BOX.format(1, 1)), of()),
    "type": (of(), of(kind="fixed")),
    "origin": (of(), of(joint='<origin rpy="0 0 0.1"/>')),
    "axis": (of(), of(joint='<axis xyz="-1 0 0"/>')),
    "limit effort": (of(joint='<limit effort="1"/>'), of(joint='<limit effort="2"/>')),
    "dynamics damping": (of(), of(joint='<dynamics damping="2"/>')),
    "mimic joint": (of(), of(joint='<mimic joint="k"/>')),
    "safety controller k position": (
        of(joint='<safety_controller k_position="1" k_velocity="1"/>'),
        of(joint='<safety_controller k_position="2" k_velocity="1"/>'),
    ),
}


@pytest.mark.parametrize("what", CHANGED)
def test_what_changed_is_named(what):
    changes = list(compare(*CHANGED[what]))
    assert what in [change.what for change in changes]
    assert {change.name for change in changes} <= {"a", "j"}
    if what != "mimic joint":
        assert len(changes) == 1


def test_what_hangs_on_is_named_by_its_path():
    block = '<gazebo reference="a"><sensor name="s" type="imu"><rate>{}</rate></sensor></gazebo>'
    changes = said(of(more=block.format(1)), of(more=block.format(2)))
    assert changes == [("gazebo", "a", "sensor[s]/rate")]


def test_parts_that_are_new_or_gone():
    old = robot('<robot name="r"><link name="a"/><link name="b"/></robot>')
    new = robot('<robot name="r"><link name="a"/><link name="c"><visual/></link></robot>')
    assert said(old, new) == [("link", "b", "removed"), ("link", "c", "added")]


def test_a_moved_link_has_another_parent():
    text = (
        '<robot name="r"><link name="a"/><link name="b"/><link name="c"/>'
        '<joint name="ab" type="fixed"><parent link="a"/><child link="b"/></joint>'
        '<joint name="bc" type="fixed"><parent link="{}"/><child link="c"/></joint></robot>'
    )
    (change,) = compare(robot(text.format("b")), robot(text.format("a")))
    assert (change.name, change.what, *change.values) == ("bc", "parent", "b", "a")


def test_new_names_are_no_other_change():
    text = (
        '<robot name="r"><link name="base"/><link name="{0}arm"/>'
        '<joint name="{0}j" type="revolute"><parent link="base"/><child link="{0}arm"/></joint>'
        '<link name="{0}tip"/>'
        '<joint name="{0}k" type="fixed"><parent link="{0}arm"/><child link="{0}tip"/>'
        '<mimic joint="{0}j"/></joint>'
        '<gazebo reference="{0}tip"><mu1>1</mu1></gazebo>'
        '<transmission name="t"><joint name="{0}j"/></transmission></robot>'
    )
    assert said(robot(text.format("")), robot(text.format("left_"))) == [
        ("link", "left_arm", "renamed"),
        ("link", "left_tip", "renamed"),
        ("joint", "left_j", "renamed"),
        ("joint", "left_k", "renamed"),
    ]


def test_broken_robots_are_compared_too():
    loop = (
        '<robot><link name="a"/><link/><joint/><joint name="j"><parent link="a"/>'
        '<child link="a"/></joint></robot>'
    )
    assert said(robot(loop), robot(loop)) == []
    assert said(robot(loop), robot("<robot/>")) != []
    assert said(robot("<robot/>"), robot(loop)) != []


@given(st.floats(-3, 3), st.floats(-1.5, 1.5), st.floats(-3, 3), st.floats(0, 3))
def test_an_angle_is_by_how_much_it_is_turned(roll, pitch, yaw, by):
    from urdftool.model.pose import multiply_matrices

    rotation = rotation_from_rpy((roll, pitch, yaw))
    turned = multiply_matrices(rotation, rotation_from_rpy((by, 0, 0)))
    assert compute_angle(rotation, turned) == pytest.approx(by, abs=1e-9)


@pytest.mark.parametrize(
    ("a", "b", "same"),
    [(1, 1 + 1e-12, True), (1, 1.001, False), (0, 1e-16, True), (None, 0, False), (1e-9, 2e-9, 0)],
)
def test_close(a, b, same):
    assert close(a, b, 1e-9) is bool(same)


@pytest.mark.slow
@pytest.mark.corpus
def test_a_robot_is_equal_to_itself():
    from tests.conftest import CORPUS
    from urdftool.errors import UrdftoolError

    for path in sorted(CORPUS.rglob("*.urdf")):
        try:
            model, again = load(path), load(path)
        except UrdftoolError:
            continue
        assert said(model, again) == [], path


def test_elements_told_apart_by_a_name_show_both_names():
    block = (
        '<ros2_control name="c" type="system"><hardware><port name="/dev/{}"><baud>1</baud></port>'
        "{}</hardware></ros2_control>"
    )
    a = of(more=block.format("47090", ""))
    b = of(more=block.format("47093", '<led name="x"/>'))
    found = {(change.what, *change.values) for change in compare(a, b)}
    assert found == {
        ("hardware/port", "/dev/47090", "/dev/47093"),
        ("hardware/led[x] added", None, THERE),
    }


def test_several_new_names_are_not_paired():
    block = '<gazebo><plugin name="p" filename="f">{}</plugin></gazebo>'
    a = of(more=block.format('<j name="1"/>'))
    b = of(more=block.format('<j name="2"/><j name="3"/>'))
    found = {change.what for change in compare(a, b)}
    assert found == {
        "plugin[p]/j[1] removed",
        "plugin[p]/j[2] added",
        "plugin[p]/j[3] added",
    }


@pytest.mark.parametrize(
    ("a", "b", "same"),
    [
        (1.0, 1.0 + 1e-12, True),
        (True, 1.0, True),
        ("a", "b", False),
        (None, 0.0, False),
        ((1.0, 2.0), (1.0, 2.0 + 1e-12), True),
        ((1.0, 2.0), (1.0, 2.0, 3.0), False),
        (("x", "y"), ("x", "z"), False),
        ({"p": (1.0,)}, {"p": (1.0 + 1e-12,)}, True),
        ({"p": 1.0}, {"q": 1.0}, False),
        (Value(None, 2.0), Value(None, 3.0), False),
        (Origin(None, (1.0, 0.0, 0.0)), Origin(None, (1.0, 0.0, 1e-3)), False),
        (None, Origin(None), True),
    ],
)
def test_values_of_any_kind(a, b, same):
    assert is_same(a, b, 1e-9) is same


def test_lists_of_different_length_differ():
    assert measure_content((1.0, 2.0), (1.0, 2.0, 3.0)) == math.inf
    assert measure_content((1.0, 2.0), (1.0, 2.5)) == 0.5


def test_a_value_that_is_gone_is_at_its_place_in_the_first_file():
    a, b = of(joint='<limit effort="2"/>'), of(joint="<limit/>")
    (difference,) = compare(a, b)
    assert difference.values == (2.0, None)
    assert [place.path for place in difference.places] == ["r.urdf", "r.urdf"]
    assert difference.place == difference.places[1]
    (gone,) = (d for d in compare(of(), robot('<robot name="r"><link name="a"/></robot>'))
               if d.kind == "link")  # fmt: skip
    assert (gone.what, gone.values[1], gone.places[1].path) == ("existence", None, "")
    assert gone.place == gone.places[0]


AXIS = """<robot name="r"><link name="a"/><link name="b"/><joint name="j" type="continuous">
<parent link="a"/><child link="b"/><axis xyz="{}"/></joint></robot>"""


@pytest.mark.parametrize(
    ("one", "two", "whats", "is_equal"),
    [
        ("0 0 0", "0 0 1", ["axis"], False),
        ("0 0 1", "0 0 1e-20", ["axis"], False),
        ("0 0 0", "0 0 1e-20", [], True),
        ("0 0 1", "0 0 7", ["axis length"], True),  # verify compares directions
        ("0.577 0.577 0.577", "1 1 1", ["axis length"], True),
        ("0.577 0.577 0.577", "0.57735 0.57735 0.57735", [], True),
    ],
)
def test_axes_without_direction_and_of_another_length(tmp_path, one, two, whats, is_equal):
    robots = []
    for name, axis in (("one", one), ("two", two)):
        (tmp_path / f"{name}.urdf").write_text(AXIS.format(axis))
        robots.append(load(tmp_path / f"{name}.urdf"))
    assert [change.what for change in compare(*robots)] == whats
    rows = {difference.row for difference in compare_robots(*robots).differences}
    assert ("axes" not in rows) is is_equal
