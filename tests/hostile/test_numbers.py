"""One number of a robot at a time, as large or small as there are: no command breaks on it."""

import json

import pytest

ROBOT = """<robot name="r">
<link name="base"><inertial><origin xyz="{0} 0.1 0.2" rpy="{1} 0 0"/><mass value="{2}"/>
<inertia ixx="{3}" ixy="{4}" ixz="0" iyy="{5}" iyz="0" izz="0.1"/></inertial>
<visual><origin xyz="{6} 0 0" rpy="0 {7} 0"/><geometry><box size="{8} 1 1"/></geometry></visual>
<collision><origin xyz="{9} 0 0"/><geometry><sphere radius="{10}"/></geometry></collision></link>
<link name="arm"><inertial><mass value="1"/>
<inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial>
<visual><geometry><cylinder radius="{11}" length="{12}"/></geometry></visual>
<collision><geometry><cylinder radius="{11}" length="{12}"/></geometry></collision></link>
<joint name="j" type="revolute"><parent link="base"/><child link="arm"/>
<origin xyz="{13} 0 1" rpy="{14} 0 0"/><axis xyz="{15} 0 1"/>
<limit lower="{16}" upper="{17}" effort="{18}" velocity="{19}"/>
<dynamics damping="{20}" friction="{21}"/></joint>
<gazebo reference="base"><mu1>{22}</mu1><kp>{23}</kp></gazebo>
</robot>"""
TEXT = "0 0 1 0.1 0 0.1 0 0 1 0 0.5 0.2 1 0 0 0 -1 1 10 1 0.1 0.1 0.9 1e5"
RIGHT = TEXT.split()
COMMANDS = (
    *("lint IN --no-cache --format json", "lint IN --no-cache --unsafe-fixes --diff"),
    *("info IN --format json", "inertia robot IN --format json", "inertia robot IN"),
    *("diff IN right.urdf", "export sdf IN -o - --force", "export mjcf IN -o - --force"),
)


VALUES = ("1e308", "-1e308", "1e155", "5e-324", "nan")
STEP = 3
"""Of so many numbers one is replaced by default, another for each pair; slow tests try all."""


def list_cases():
    """List commands, values and places; an export as MJCF takes long, and others of it are slow."""
    for row, command in enumerate(COMMANDS):
        for column, value in enumerate(VALUES):
            places = range(len(RIGHT))
            if "mjcf" not in command or value in ("1e155", "nan"):
                yield pytest.param(command, value, places[(row + column) % STEP :: STEP])
            yield pytest.param(command, value, places, marks=pytest.mark.slow)


@pytest.mark.filterwarnings("error::RuntimeWarning")
@pytest.mark.parametrize(("command", "value", "places"), list(list_cases()))
def test_no_number_breaks_a_command(command, value, places, urdftool, write):
    write("right.urdf", ROBOT.format(*RIGHT))
    for place in places:
        numbers = [*RIGHT[:place], value, *RIGHT[place + 1 :]]
        path = write("r.urdf", ROBOT.format(*numbers))
        done = urdftool(*command.replace("IN", path).split())
        assert done.code in (0, 1, 2), (place, done.err)
        if "json" in command and done.out:
            json.loads(done.out, parse_constant=_none)


def _none(word):
    raise AssertionError(f"{word} is no JSON")
