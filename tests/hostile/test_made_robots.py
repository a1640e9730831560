"""Robots that are made by a grammar, right in some places and wrong in others."""

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

NUMBER = st.sampled_from(
    ["0", "1", "-1", "0.5", "1e-9", "1e9", "1e308", "nan", "inf", "1,5", "x", ""]
)
THREE = st.one_of(
    st.lists(NUMBER, min_size=3, max_size=3).map(" ".join),
    st.lists(NUMBER, max_size=4).map(" ".join),
)
NAME = st.sampled_from(
    ["a", "b", "c", "base", "", "a b", "é", "<", "$(x)", "${1}", "../x", "\u202e"]
)
KINDS = st.sampled_from(
    ["revolute", "prismatic", "fixed", "continuous", "floating", "planar", "ball", ""]
)


def attributes(**values):
    return st.fixed_dictionaries({}, optional=values).map(
        lambda found: "".join(f' {key}="{value}"' for key, value in found.items())
    )


def escaped(strategy):
    return strategy.map(lambda text: text.replace("<", "&lt;"))


def element(tag, given=None, inner=None):
    given = st.just("") if given is None else given
    inner = st.just("") if inner is None else inner
    return st.tuples(given, inner).map(lambda both: f"<{tag}{both[0]}>{both[1]}</{tag}>")


def some(*strategies):
    return st.lists(st.one_of(*strategies), max_size=4).map("".join)


name = escaped(NAME)
origin = element("origin", attributes(xyz=THREE, rpy=THREE))
shape = st.one_of(
    element("box", attributes(size=THREE)),
    element("cylinder", attributes(radius=NUMBER, length=NUMBER)),
    element("sphere", attributes(radius=NUMBER)),
    element("mesh", attributes(filename=name, scale=THREE)),
)
moments = attributes(ixx=NUMBER, ixy=NUMBER, ixz=NUMBER, iyy=NUMBER, iyz=NUMBER, izz=NUMBER)
inertial = element(
    "inertial",
    None,
    some(origin, element("mass", attributes(value=NUMBER)), element("inertia", moments)),
)
geometry = element("geometry", None, some(shape))
parts = some(inertial, *(element(t, None, some(origin, geometry)) for t in ("visual", "collision")))
limit = element("limit", attributes(lower=NUMBER, upper=NUMBER, effort=NUMBER, velocity=NUMBER))
inside = some(
    *(
        origin,
        limit,
        element("parent", attributes(link=name)),
        element("child", attributes(link=name)),
    ),
    *(element("axis", attributes(xyz=THREE)), element("mimic", attributes(joint=name))),
)
ROBOTS = element(
    "robot",
    attributes(name=name),
    some(
        element("link", attributes(name=name), parts),
        element("joint", attributes(name=name, type=KINDS), inside),
        element("gazebo", attributes(reference=name)),
        element("material", attributes(name=name), element("color", attributes(rgba=THREE))),
    ),
)
COMMANDS = (
    *(["expand", "IN"], ["lint", "IN"], ["info", "IN"], ["graph", "IN", "-o", "-"]),
    *(["inertia", "robot", "IN"], ["diff", "IN", "IN"], ["lint", "IN", "--unsafe-fixes", "--diff"]),
    *(["export", kind, "IN", "-o", "-", "--force"] for kind in ("sdf", "mjcf")),
)


@pytest.mark.parametrize("command", COMMANDS, ids=" ".join)
@settings(
    max_examples=12, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(text=ROBOTS, extension=st.sampled_from([".urdf", ".urdf.xacro"]))
def test_no_robot_breaks_a_command(command, urdftool, tmp_path, text, extension):
    path = tmp_path / f"r{extension}"
    path.write_text(text, "utf-8")
    done = urdftool(*(path if word == "IN" else word for word in command))
    assert done.code in (0, 1, 2), f"{text}\n{done.err}"
    assert "Traceback" not in done.out + done.err
    assert done.code != 2 or done.err.strip()
