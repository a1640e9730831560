"""What forbids an export: one finding a defect, and what --force makes of it."""

import pytest

from urdftool.compare.check import is_faithful
from urdftool.formats.common.force_fallbacks import REPORTED_AS
from urdftool.formats.sdf.options import Options
from urdftool.formats.sdf.verify.compare import verify
from urdftool.formats.sdf.write import write
from urdftool.refusal import Refused

from .robots import (
    BOX,
    TWO,
    export,
    gazebo,
    inertial,
    joint,
    link,
    named,
    names,
    robot,
    rules,
    tree,
)

LIMIT = '<limit lower="0" upper="1" effort="1" velocity="1"/>'
IMPOSSIBLE = inertial(1, (0.1, 0.1, 0.5))

FORCED = {
    "zero-axis": (link("a"), joint("j", "a", "b", inside=f'<axis xyz="0 0 0"/>{LIMIT}'), link("b")),
    "missing-limit": (link("a"), joint("j", "a", "b", inside=""), link("b")),
    "lower-above-upper": (
        link("a"), joint("j", "a", "b", inside='<limit lower="1" upper="0"/>'), link("b"),
    ),
    "inertia-triangle-inequality": (link("a", IMPOSSIBLE),),
    "negative-mass": (link("a", inertial(-1)),),
    "incomplete-inertial": (link("a", '<inertial><mass value="1"/></inertial>'),),
    "not-a-number": (link("a", inertial(mass="heavy")),),
    "mesh-not-found": (
        link("a", f'{inertial()}<visual><geometry><mesh filename="package://no/x.stl"/></geometry>'
             "</visual>"),
    ),
    "empty-geometry": (link("a", f"{inertial()}<collision/>"),),
    "unsupported-shape": (
        link("a", f"{inertial()}<collision><geometry><cone/></geometry></collision>"),
    ),
    "bad-extension-number": (link("a"), gazebo("a", "<mu1>${mu}</mu1>")),
    "unknown-sensor-type": (link("a"), gazebo("a", '<sensor name="s" type="nose"/>')),
    "plugin-without-filename": (link("a"), '<gazebo><plugin name="p"/></gazebo>'),
    "unknown-joint-type": (link("a"), joint("j", "a", "b", "hinge"), link("b")),
    "mimic-cycle": (
        link("a"), joint("j", "a", "b", inside=f'{LIMIT}<mimic joint="j"/>'), link("b"),
    ),
    "mimic-unknown-joint": (
        link("a"), joint("j", "a", "b", inside=f'{LIMIT}<mimic joint="x"/>'), link("b"),
    ),
    "mimic-dof-mismatch": (
        link("a"), joint("j", "a", "b", inside=f'{LIMIT}<mimic joint="k"/>'), link("b"),
        joint("k", "b", "c", "fixed"), link("c"),
    ),
}  # fmt: skip

LEFT = {
    "multiple-roots": ((link("a"), link("b")), ["a", "b"], []),
    "unknown-parent-link": ((link("a"), joint("j", "x", "a")), ["a"], []),
    "unknown-child-link": ((link("a"), joint("j", "a", "x")), ["a"], []),
    "missing-parent-or-child": ((link("a"), '<joint name="j" type="fixed"/>'), ["a"], []),
    "duplicate-link-name": ((link("a"), link("a", inertial(7))), ["a"], []),
    "duplicate-joint-name": (
        (link("a"), link("b"), link("c"), joint("j", "a", "b"), joint("j", "a", "c")),
        ["a", "b", "c"], ["j", "j_2"],
    ),
    "missing-name": ((*TWO, link(""), link("c"), joint("", "b", "c")), ["a", "b", "c"],
                     ["j", "c_joint"]),
}  # fmt: skip
"""What --force makes of errors in links and joints: the links and joints that are left."""

FATAL = {
    "no-links": (),
    "immense-number": (link("a", inertial(1e200)),),
    "no-root": (link("a"), link("b"), joint("j", "a", "b"), joint("k", "b", "a")),
    "detached-cycle": (*TWO, link("c"), link("d"), joint("k", "c", "d"), joint("l", "d", "c")),
    "multiple-parents": (*TWO, link("c"), joint("k", "a", "c"), joint("l", "b", "c")),
}


def refused(*parts, **choices):
    with pytest.raises(Refused) as caught:
        write(robot(*parts), Options(**choices))
    return caught.value


@pytest.mark.parametrize("rule", [*FORCED, *LEFT, *FATAL])
def test_a_defect_is_one_finding_at_its_place(rule):
    parts = {**FORCED, **{name: case[0] for name, case in LEFT.items()}, **FATAL}[rule]
    error = refused(*parts)
    found = [finding for finding in error.findings if finding.code == rule]
    assert len(found) == 1 + (rule in ("missing-parent-or-child", "missing-name"))
    assert str(found[0]).startswith("r.urdf:")
    assert error.line is not None


@pytest.mark.parametrize("rule", FORCED)
@pytest.mark.parametrize("choices", [{}, {"fixed_joints": "lump"}, {"target": "gazebo-classic"}])
def test_force_goes_past_it_and_says_so(rule, choices):
    written = export(*FORCED[rule], force=True, **choices)
    assert REPORTED_AS.get(rule, f"lossy-{rule}") in rules(written)
    assert tree(written).find("link") is not None


@pytest.mark.parametrize("rule", LEFT)
@pytest.mark.parametrize("choices", [{}, {"fixed_joints": "lump"}, {"target": "gazebo-classic"}])
def test_force_leaves_what_can_stand(rule, choices, tmp_path):
    parts, links, joints = LEFT[rule]
    source = robot(*parts)
    options = Options(force=True, file="m.sdf", **choices)
    written = write(source, options)
    assert f"lossy-{rule}" in rules(written)
    assert all("accepted by --force" in loss.hint for loss in written.losses)
    assert names(tree(written), "link") == links
    assert names(tree(written), "joint") == joints
    place = tmp_path / "m.sdf"
    place.write_bytes(written.files["m.sdf"])
    checks = verify(source, written, options, place)
    assert is_faithful(checks), [check.differing for check in checks]


SENSOR = '<sensor name="s" type="{}"/>'


@pytest.mark.parametrize(
    ("kind", "child", "sensor", "lost"),
    [
        ("fixed", "x", ("j", "force_torque"), ["s"]),
        ("0 0 0", "b", ("b", "camera"), []),
        ("fixed", "b", ("j", "force_torque"), []),
    ],
)
def test_sensors_of_joints_that_force_changes(kind, child, sensor, lost, tmp_path):
    reference, type_ = sensor
    parts = (link("a"), joint("j", "a", child, kind), link("b"))
    source = robot(*parts, gazebo(reference, SENSOR.format(type_)))
    options = Options(force=True, file="m.sdf")
    written = write(source, options)
    dropped = [loss for loss in written.losses if "is dropped: its joint" in loss.message]
    assert [loss.name for loss in dropped] == lost
    place = tmp_path / "m.sdf"
    place.write_bytes(written.files["m.sdf"])
    checks = verify(source, written, options, place)
    assert is_faithful(checks), [check.differing for check in checks]


def test_a_joint_of_unknown_type_moves_the_masses_of_both_bodies(tmp_path):
    """Its child becomes a part of the body of its parent, which several links make."""
    parts = (link("foot", ""), joint("i", "foot", "a", "fixed"), link("a"), link("b"), link("c"))
    ends = joint("k", "a", "c", "fixed", origin="0 1 0"), link("d"), joint("l", "b", "d")
    source = robot(*parts, joint("j", "a", "b", "nan", origin="1 0 0"), *ends)
    options = Options(force=True, file="m.sdf", target="gazebo-classic")
    written = write(source, options)
    place = tmp_path / "m.sdf"
    place.write_bytes(written.files["m.sdf"])
    checks = {check.name: check for check in verify(source, written, options, place)}
    assert is_faithful(checks.values()), [c.differing for c in checks.values()]
    assert checks["mass"].verdict == "announced"


def test_a_world_that_no_link_declares_is_the_world():
    parts = (link("a"), joint("j", "world", "a", "fixed"))
    assert [f.code for f in refused(*parts).findings] == ["unknown-parent-link"]
    written = export(*parts, force=True)
    assert tree(written).findtext("joint/parent") == "world"
    assert tree(written).find("joint").get("type") == "fixed"


def test_trees_stand_at_the_origin_one_beside_the_other():
    parts = (*TWO, link("c"), joint("k", "c", "d", "fixed", origin="1 2 3"), link("d"))
    model = tree(export(*parts, force=True))
    assert names(model, "link") == ["a", "b", "c", "d"]
    assert named(model, "link", "c").find("pose") is None
    assert model.get("canonical_link") is None


@pytest.mark.parametrize("rule", FATAL)
def test_force_does_not_invent_a_robot(rule):
    assert rule in [finding.code for finding in refused(*FATAL[rule], force=True).findings]


def test_all_defects_are_said_at_once():
    parts = (
        link("a", IMPOSSIBLE),
        gazebo("a", "<mu1>x</mu1><kp>y</kp><maxContacts>1.5</maxContacts>"),
    )
    found = [finding.code for finding in refused(*parts).findings]
    assert found == ["bad-extension-number"] * 3 + ["inertia-triangle-inequality"]


@pytest.mark.parametrize("text", ["", "nan", "1e400", "0x10", "1,5", "1_000", "${mu}"])
def test_numbers_of_extensions(text):
    error = refused(link("a"), gazebo("a", f"<mu1>{text}</mu1>"))
    shown = f"'{text}'" if text else "empty"
    assert f"link 'a': mu1 is {shown}, not a finite number" in error.message


def test_numbers_of_sensors():
    said = '<sensor name="s" type="imu"><update_rate>fast</update_rate></sensor>'
    assert "fast" in refused(link("a"), gazebo("a", said)).message


def test_an_impossible_inertia_that_a_fixed_neighbour_mends_is_no_defect():
    parts = (
        link("a", inertial(5, (1, 1, 1))),
        joint("j", "a", "b", "fixed"),
        link("b", IMPOSSIBLE),
    )
    assert rules(export(*parts)) == ["lossy-link"]


def test_forced_inertia_is_possible_and_as_near_as_can_be():
    written = export(link("a", IMPOSSIBLE), force=True)
    moments = [float(next(tree(written).iter(n)).text) for n in ("ixx", "iyy", "izz")]
    assert moments[2] <= moments[0] + moments[1]
    assert moments == pytest.approx([0.25, 0.25, 0.5], rel=0.3)


def test_a_shape_that_cannot_be_written_is_left_out_alone():
    inside = f"{inertial()}<collision/><collision>{BOX}</collision>"
    written = export(link("a", inside), force=True)
    assert len(list(tree(written).iter("collision"))) == 1


def test_a_pose_that_is_none_is_left_out_when_forced():
    said = gazebo("a", '<sensor name="s" type="imu"><pose>1 2 x</pose></sensor>')
    assert "six finite numbers" in refused(link("a"), said).message
    assert tree(export(link("a"), said, force=True)).find("link/sensor/pose") is None


@pytest.mark.parametrize(
    "said",
    [
        "<gravity>down</gravity>",
        "<visual><material><diffuse>down</diffuse></material></visual>",
        '<light name="l" type="point"><specular>x</specular></light>',
        "<collision><surface><friction><ode><mu>x</mu></ode></friction></surface></collision>",
        '<sensor name="s" type="imu"><always_on>sometimes</always_on></sensor>',
        '<sensor name="s" type="imu"><imu><noise><rate><mean>x</mean></rate></noise></imu>'
        "</sensor>",
    ],
)
def test_values_that_a_reader_refuses(said):
    parts = (link("a", f"{inertial()}<collision>{BOX}</collision>"), gazebo("a", said))
    assert [f.code for f in refused(*parts).findings] == ["invalid-sdf-value"]
    text = export(*parts, force=True).files["model.sdf"].decode()
    assert all(f">{word}<" not in text for word in ("down", "x", "sometimes"))


def test_a_color_outside_of_0_to_1_is_a_loss():
    """Libsdformat rejects a file with such a color."""
    visual = (
        '<visual><geometry><box size="1 1 1"/></geometry>'
        '<material name="m"><color rgba="153 0 0 255"/></material></visual>'
    )
    written = export(link("a", inertial() + visual))
    assert "153" not in written.text
    assert "lossy-material" in rules(written)
