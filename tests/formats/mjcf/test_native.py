"""An export of an MJCF copies what only MuJoCo has, and reports what it does not copy."""

import pytest

pytest.importorskip("mujoco")

from lxml import etree

from measure.same_format import mjcf
from measure.same_format.run import export_text, list_differing_fields
from urdftool.compare.compare import compare_robots
from urdftool.formats.mjcf.options import Options
from urdftool.formats.mjcf.read import read
from urdftool.formats.mjcf.verify import verify
from urdftool.formats.mjcf.write import write

KEPT = (
    "spatial tendon with limit, spring and damping",
    "unnamed motor of a tendon",
    "motor of a site",
    "integrating servo",
    "group of an actuator",
    "weld with torque scale",
    "quadratic coupling",
    "contact pair",
    "clock",
    "gyro",
    "frame sensor of a geom",
    "tuple",
    "velocities of a keyframe",
    "actuator groups",
    "statistic",
    "group of a joint",
    "size of a site",
    "sleep policy",
)


def add(*names):
    """Return a model with additions."""
    root = etree.fromstring(mjcf.BASE)
    for planted in mjcf.CHANGES:
        if planted.what in names:
            planted.edit(root)
    return etree.tostring(root, encoding="unicode")


def test_additions_are_kept(tmp_path):
    plain, made = export_text(mjcf.BASE, tmp_path), export_text(add(*KEPT), tmp_path)
    assert list_differing_fields(plain, made) == []
    assert [check.name for check in made.checks if check.verdict == "differs"] == []
    assert made.losses == plain.losses


CLASSES = """<mujoco><default><position kp="7"/><default class="strong"><position kp="9"/>
<tendon stiffness="3"/></default></default>
<worldbody><body name="a"><joint name="j"/><geom size=".1"/>
<body name="b"><joint name="k" axis="1 0 0"/><geom size=".1"/></body></body></worldbody>
<tendon><fixed name="t" class="strong"><joint joint="j" coef="1"/></fixed></tendon>
<actuator><position joint="j"/><position joint="k" class="strong"/></actuator></mujoco>"""


@pytest.mark.parametrize(
    ("old", "new", "text"),
    [
        ("", "", ""),
        ('kp="7"', 'kp="8"', "joint actuator 'j': gain is 8, not 7"),
        ('stiffness="3"', 'stiffness="4"', "<fixed> 't': tendon stiffness is"),
        ('coef="1"', 'coef="2"', "<fixed> 't': joint/@coef is 2, not 1"),
        ('<fixed name="t"', '<fixed name="u"', "<fixed> 't' is missing"),
    ],
)
def test_classes_and_what_the_proof_finds(tmp_path, old, new, text):
    (tmp_path / "a.xml").write_text(CLASSES)
    source = read(tmp_path / "a.xml").robot
    made = write(source, Options())
    assert old in made.text
    (tmp_path / "b.xml").write_text(made.text.replace(old, new, 1) if old else made.text)
    checks = verify(source, made, tmp_path / "b.xml", made)
    differing = [text for check in checks for text in check.differing]
    assert bool(differing) == bool(text)
    assert text in " ".join(differing)


@pytest.mark.parametrize(
    ("old", "new", "title"),
    [
        ('coef="1"', 'coef="2"', "<fixed> 't': joint/@coef"),
        ('name="t"', 'name="u"', "<fixed> 't': existence"),
        ('stiffness="3"', 'stiffness="4"', "<fixed> 't': tendon stiffness"),
    ],
)
def test_two_files_are_compared_with_their_copied_elements(tmp_path, old, new, title):
    (tmp_path / "a.xml").write_text(CLASSES)
    (tmp_path / "b.xml").write_text(CLASSES.replace(old, new))
    robots = [read(tmp_path / name).robot for name in ("a.xml", "b.xml")]
    assert title in [d.title for d in compare_robots(*robots).differences]
    assert compare_robots(robots[0], robots[0]).is_equal


def test_what_a_copied_element_names_must_be_there(tmp_path):
    (tmp_path / "a.xml").write_text(add("held joint", "joint sensor", "energy sensor"))
    written = write(read(tmp_path / "a.xml").robot, Options())
    lost = [loss for loss in written.losses if loss.code == "lossy-mujoco-element"]
    assert [loss.message.partition(":")[0] for loss in lost] == [
        "<motor> 'm'",
        "<joint>",
        "<jointpos> 'jp'",
        "<key> 'home'",
    ]
    assert lost[0].location.line
    assert "e_potential" in written.text


def test_other_formats_report_each(tmp_path):
    (tmp_path / "a.xml").write_text(add(*KEPT))
    losses = {loss.code: loss for loss in read(tmp_path / "a.xml").losses}
    assert {"unread-tendon", "unread-setting", "unread-display", "unread-custom"} <= losses.keys()
    assert "noise of <gyro> g" in losses["unread-setting"].data["names"]
    assert "sleep of <body> a" in losses["unread-setting"].data["names"]
