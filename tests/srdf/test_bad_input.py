"""Robots with defects: each has a verdict or a message, and none a traceback."""

import pytest

pytest.importorskip("fcl")

from tests.srdf.test_adjacent import BOX
from tests.srdf.test_prove import sphere_arm

LIMIT = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'


def joint(name, parent, child, kind="revolute", x=0.3, limit=LIMIT):
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="{x} 0 0"/><axis xyz="0 0 1"/>{limit}</joint>'
    )


def robot(names, *joints, shape=BOX):
    links = "".join(f'<link name="{name}">{shape}</link>' for name in names)
    return f'<robot name="r">{links}{"".join(joints)}</robot>'


CYCLE = robot("abc", joint("ab", "a", "b"), joint("bc", "b", "c"), joint("ca", "c", "a"))
DIAMOND = robot(
    "abcd",
    *(joint("ab", "a", "b"), joint("ac", "a", "c"), joint("bd", "b", "d"), joint("cd", "c", "d")),
)
INSIDE = robot("abc", joint("ab", "a", "b", x=0.4), joint("bc", "b", "c", x=-0.4))
NO_LIMITS = sphere_arm(0.01).replace('<limit lower="-3.141592653589793" ', "<x ")
HUGE = sphere_arm(0.01, -1e300, 1e300)
NAN = sphere_arm(0.01).replace('radius="0.1"', 'radius="nan"', 1)
PLANE = sphere_arm(0.01).replace('<sphere radius="0.1"/>', "<plane/>", 1)


@pytest.mark.parametrize(
    ("text", "code", "out", "err"),
    [
        (sphere_arm(0.01).replace("collision>", "visual>"), 2, "", "use --visual"),
        (sphere_arm(0.01).replace('<sphere radius="0.1"/>', '<mesh filename="no.stl"/>', 1), 0,
         "open       post  tip, because the shape of 'post' is unknown", "no.stl"),
        (NO_LIMITS, 0, "never      post  tip", ""),
        (sphere_arm(-0.01, 2.0, 1.0), 0, "can-touch  post  tip", ""),
        (sphere_arm(0.01, 2.0, 1.0), 0, "never      post  tip", ""),
        (CYCLE, 0, "adjacent   a  c", ""),
        (DIAMOND, 0, "open       a  d, because link 'd' is the child of several joints", ""),
        (INSIDE, 0, "can-touch  a  c", ""),
        (HUGE, 0, "never      post  tip", ""),
        (NAN, 0, "because the shape of 'post' is unknown", "'post' is not compared"),
        (PLANE, 0, "because the shape of 'post' is unknown", "'post' is not compared"),
        ("<robot name='r'/>", 2, "", "no link has collision geometry"),
        ("<robot name='r'><link name='a'>", 2, "", "r.urdf:1"),
        (robot("a"), 0, "", "0 pairs: none"),
    ],
    ids=["no geometry", "missing mesh", "no limits", "crossed limits touch", "crossed limits",
         "cycle", "several parents", "inside", "huge limits", "nan size", "plane", "empty",
         "truncated", "one link"],
)  # fmt: skip
def test_a_defect_has_a_verdict_or_a_message(urdftool, write, text, code, out, err):
    write("r.urdf", text)
    result = urdftool("srdf", "r.urdf", "--format", "table", "-j", "1")
    assert result.code == code, result.err
    assert out in result.out
    assert err in result.err
    assert "Traceback" not in result.err


def test_a_link_inside_a_mesh_does_not_touch_its_surface(urdftool, write):
    """Contacts are those of surfaces, as of MoveIt; the page says so."""
    corners = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    faces = ["1 2 4 3", "5 7 8 6", "1 5 6 2", "3 4 8 7", "1 3 7 5", "2 6 8 4"]
    lines = [f"v {x} {y} {z}" for x, y, z in corners] + [f"f {face}" for face in faces]
    write("cube.obj", "\n".join(lines) + "\n")
    text = INSIDE.replace(
        BOX, '<collision><geometry><mesh filename="cube.obj"/></geometry></collision>', 1
    )
    write("r.urdf", text)
    result = urdftool("srdf", "r.urdf", "--format", "table", "-j", "1")
    assert "never      a  c" in result.out


@pytest.mark.parametrize(
    ("srdf", "error"),
    [
        ('<robot name="x"><disable_collisions link1="p" link2="q" reason="Never"/></robot>',
         "r.srdf:1:1: the SRDF is of another robot"),
        ("<sdf/>", "r.srdf:1:1: the root element is <sdf>"),
        ("<robot", "r.srdf:1"),
        (None, "r.srdf"),
    ],
    ids=["another robot", "not an SRDF", "truncated", "missing"],
)  # fmt: skip
@pytest.mark.parametrize("option", ["--check", "--update"])
def test_an_srdf_that_cannot_be_used_is_refused(urdftool, write, tmp_path, option, srdf, error):
    write("r.urdf", sphere_arm(0.01))
    if srdf is not None:
        write("r.srdf", srdf)
    result = urdftool("srdf", "r.urdf", option, "r.srdf", "-j", "1")
    assert result.code == 2
    assert error in result.err
    assert srdf is None or (tmp_path / "r.srdf").read_text("utf-8") == srdf


@pytest.mark.slow
def test_a_long_chain_ends_with_its_time(urdftool, write):
    names = [f"l{number}" for number in range(120)]
    joints = [joint(f"j{n}", names[n], names[n + 1], x=0.3) for n in range(119)]
    write("r.urdf", robot(names, *joints))
    result = urdftool("srdf", "r.urdf", "--format", "table", "-j", "1", "--time", "0")
    assert result.code == 0
    assert result.out.count("\n") == 120 * 119 // 2
    assert "because the time was up" in result.out
