"""Names with control characters in every place of a robot, in each command and output format."""

import io
import json
import os
import re
import shutil
import sys
from xml.sax.saxutils import quoteattr

import pytest

from tests.conftest import FIXTURES
from urdftool.terminal import SanitizingStream, escape_text

OBEYED = re.compile(
    "[\0-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069]"
)
FORGED = "forged: no findings"

IN_XML = f"\x9b31m\x9d0;title\x9c\x85\u202eevil\u2066\u2028\n{FORGED}\n"
"""What an XML file can hold: C1, text direction, line ends."""

ELSEWHERE = f"\x1b[31m\x1b]0;title\x07\x1b[8m\x08\x7f\x9b2J\u202eevil[bold][link=x]\n{FORGED}\n"
"""What an argument, a file name, YAML or an expression can hold."""


def quote(text):
    return quoteattr(text).replace("\n", "&#10;")


ROBOT = """<robot name={r}>
<!-- {comment} -->
<material name={material}><color rgba="1 0 0 1"/><texture filename={texture}/></material>
<link name={a}><inertial><mass value="1"/>
  <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial>
  <visual name={visual}><geometry><mesh filename={mesh}/></geometry>
    <material name={material}/></visual>
  <visual><geometry><mesh filename="cube.obj"/></geometry></visual>
  <collision name={collision}><geometry><box size="1 1 1"/></geometry></collision></link>
<link name={b}><inertial><mass value="1"/>
  <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial>
  <visual><geometry><sphere radius={number}/></geometry></visual></link>
<link name={c}/>
<joint name={j} type="revolute"><parent link={a}/><child link={b}/>
  <axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
<joint name={k} type={type}><parent link={parent}/><child link={c}/><mimic joint={mimic}/></joint>
<transmission name={transmission}><type>{text}</type>
  <joint name={j}><hardwareInterface>{text}</hardwareInterface></joint>
  <actuator name={actuator}/></transmission>
<gazebo reference={reference}><material>{text}</material>
  <sensor name={sensor} type={sensortype}><topic>{text}</topic></sensor>
  <plugin name={plugin} filename={filename}><x>{text}</x></plugin></gazebo>
<ros2_control name={control} type="system"><hardware><plugin>{text}</plugin></hardware>
  <joint name={j}><command_interface name={interface}/></joint></ros2_control>
<unknown odd={unknown}/>
</robot>
"""
GOOD = {
    "r": "r", "comment": "urdftool-ignore[x] y", "material": "m", "texture": "quadrants.png",
    "a": "a", "visual": "v", "mesh": "cube.obj", "collision": "c", "b": "b", "number": "1",
    "c": "c", "j": "j", "k": "k", "type": "fixed", "parent": "b", "mimic": "j",
    "transmission": "t", "text": "x", "actuator": "m", "reference": "a", "sensor": "s",
    "sensortype": "camera", "plugin": "p", "filename": "libp.so", "control": "x",
    "interface": "position", "unknown": "u",
}  # fmt: skip
PLACES = sorted(GOOD)
TEXTS = ("comment", "text")


def make_robot(*places):
    """Return the robot with a hostile value in these places."""
    values = {}
    for name, good in GOOD.items():
        value = good + IN_XML if name in places else good
        values[name] = value.replace("<", "&lt;") if name in TEXTS else quote(value)
    return ROBOT.format(**values)


NAMES = ("r", "a", "b", "c", "j", "k", "material", "visual", "collision", "sensor", "plugin")


@pytest.fixture
def folder(write, tmp_path):
    """A folder with robots whose names are all hostile, and what they use."""
    for name in ("cube.obj", "cube.mtl", "quadrants.png"):
        shutil.copyfile(FIXTURES / "meshes" / name, tmp_path / name)
    write("r.urdf", make_robot(*NAMES))
    write("other.urdf", make_robot("a", "j"))
    return tmp_path


def find_obeyed(text):
    """Return what a terminal obeys in a text, and lines that the robot has forged."""
    return [*OBEYED.findall(text), *re.findall(rf"^{FORGED}.*", text, re.MULTILINE)]


COMMANDS = [
    *(f"lint r.urdf --format {style}" for style in ("full", "concise", "json", "sarif", "github")),
    *(f"lint r.urdf --format {style}" for style in ("junit", "html")),
    *("lint r.urdf --statistics", "lint r.urdf --fix --unsafe-fixes --diff", "lint . --all"),
    *("info r.urdf", "info r.urdf --format json", "graph r.urdf -o -", "graph r.urdf -o g.svg"),
    *("graph r.urdf -o g.gv", "graph r.urdf -o g.mmd", "graph r.urdf -o g.json"),
    *(f"graph r.urdf --style detailed --lint -o g.{ending}" for ending in ("svg", "gv", "mmd")),
    *("diff r.urdf other.urdf", "diff r.urdf other.urdf --format json"),
    *("diff r.urdf other.urdf --format markdown", "verify r.urdf other.urdf"),
    *("verify r.urdf other.urdf --format json", "inertia robot r.urdf"),
    *("inertia robot r.urdf --format json", "inertia robot r.urdf --write --density 9 -o i.urdf"),
    *("collision r.urdf -o c.urdf --method hull", "collision r.urdf -o c.urdf --format json"),
    *("bundle r.urdf -o bundled", "bundle r.urdf -o b.zip --format sdf --format mjcf"),
    *("export sdf r.urdf -o s.sdf --force --verify", "export sdf r.urdf -o t.sdf --format json"),
    *("export mjcf r.urdf -o m.xml --force --verify", "export urdf r.urdf -o u.urdf --verify"),
    *("export usd r.urdf -o u.usda --force --verify", "simulate r.urdf --duration 0.1"),
    *("simulate r.urdf --duration 0.1 --format json", "view r.urdf --picture p.png --size 32x32"),
    *("expand r.urdf --check other.urdf", "expand r.urdf --list-args", "expand r.urdf --deps"),
]
DATA = ("--diff", "--check")
"""Options that print lines of files as they are; a terminal gets them escaped."""


@pytest.mark.parametrize("command", COMMANDS)
def test_results_and_messages(urdftool, folder, command):
    done = urdftool(*command.split())
    assert done.code in (0, 1, 2), done.err
    assert done.out or done.err or done.code == 0
    assert not find_obeyed(done.err)
    if not any(option in command for option in DATA):
        assert not find_obeyed(done.out)
    for path in folder.glob("g.*"):
        assert not find_obeyed(path.read_text("utf-8"))


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("style", ["full", "json", "github"])
def test_findings_of_each_place(urdftool, folder, write, place, style):
    write("r.urdf", make_robot(place))
    done = urdftool("lint", "r.urdf", "--format", style, "--all", "--no-cache")
    assert done.code in (0, 1)
    assert not find_obeyed(done.out + done.err)


NAME = ELSEWHERE.replace("/", "")


@pytest.fixture
def odd(folder, write):
    """The same with hostile names of files and folders; gives the words of command lines."""
    os.mkdir(NAME)
    write(f"{NAME}/{NAME}.urdf", make_robot(*NAMES).replace("cube.obj", "../cube.obj"))
    write(f"{NAME}/broken.urdf", "<robot name='r'>\x1b]0;owned\x07<a></robot>")
    write(f"{NAME}/{NAME}.yaml", f"{json.dumps(NAME)}: {json.dumps(NAME)}\n")
    write(
        f"{NAME}/{NAME}.xacro",
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:arg name="n" '
        'default=""/><link name="$(arg n)"/><xacro:include filename="$(arg f)"/></robot>',
    )
    write(
        f"{NAME}/said.xacro",
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><link name="a"/>'
        f'<xacro:property name="p" value="${{xacro.load_yaml({NAME + ".yaml"!r})}}"/>'
        f"${{xacro.message(list(p)[0])}}"
        + "".join(
            f"${{xacro.{kind}({NAME!r})}}" for kind in ("message", "warning", "error")
        ).replace("\n", "&#10;")
        + "</robot>",
    )
    return {
        "IN": f"{NAME}/{NAME}.urdf", "BROKEN": f"{NAME}/broken.urdf", "DIR": NAME,
        "XACRO": f"{NAME}/{NAME}.xacro", "SAID": f"{NAME}/said.xacro", "ARG": f"n:={NAME}",
        "FILE": f"f:={NAME}/absent{NAME}", "NAME": NAME, "YAML": f"{NAME}/{NAME}.yaml",
        "PACKAGE": f"{NAME}={NAME}", "EQUAL": f"{NAME}:={NAME}",
    }  # fmt: skip


ODD_COMMANDS = [
    *(f"lint IN --format {style}" for style in ("full", "concise", "json", "sarif", "github")),
    *(
        f"lint BROKEN DIR --format {style}"
        for style in ("full", "json", "sarif", "github", "junit")
    ),
    *("lint XACRO ARG FILE", "expand XACRO ARG", "expand XACRO ARG FILE", "expand SAID"),
    *("info IN", "info XACRO ARG", "info SAID", "expand BROKEN", "graph IN -o DIR/g.svg"),
    *("diff IN BROKEN", "diff IN other.urdf", "verify IN other.urdf", "inertia robot IN"),
    *("inertia robot IN --masses YAML", "collision IN -o DIR/c.urdf --method hull", "info NAME"),
    *("bundle IN -o DIR/b", "bundle --check DIR", "export sdf IN -o DIR/s.sdf --force --verify"),
    *("export mjcf IN -o DIR/m.xml --force", "export urdf IN -o DIR/u.urdf --verify", "NAME"),
    *("simulate IN --duration 0.1", "simulate IN --controllers YAML", "view IN --picture NAME.png"),
    *("lint --select NAME IN", "lint --explain NAME", "--config YAML lint IN", "lint IN --NAME"),
    *("info IN -p PACKAGE", "info IN -p NAME", "info IN EQUAL", "simulate IN --pose PACKAGE"),
    *("expand IN -o DIR", "inertia mesh YAML --mass 1", "collision mesh YAML -o DIR/x.stl"),
    *("lint IN --baseline YAML", "lint IN --target NAME", "export mjcf IN --srdf YAML"),
]


@pytest.mark.skipif(sys.platform == "win32", reason="such names are not allowed there")
@pytest.mark.parametrize("command", ODD_COMMANDS)
def test_names_of_files_and_arguments(urdftool, odd, command):
    words = []
    for word in command.split():
        start, slash, rest = word.partition("/")
        words.append(odd.get(start.lstrip("-"), start) + slash + rest)
        if start == "--NAME":
            words[-1] = f"--{NAME}"
    done = urdftool(*words)
    assert done.code in (0, 1, 2), done.err
    assert done.code != 2 or done.err
    found = find_obeyed(done.out + done.err)
    if "SAID" in command or " DIR" in command:  # a message of xacro may have several lines
        assert done.err.count("\\x1b[8m") == 4 or " DIR" in command
        found = OBEYED.findall(done.out + done.err)
    assert not found


class Terminal(io.BytesIO):
    """A terminal that keeps what it gets."""

    def isatty(self):
        return True


SENT = ["a\x1b[31mred\x1b[0m", "b\r\x1b[K12/13", "c\r\nd", "é–×\U0001f916", "\u202eevil", "\x9b2J"]
SENT += ["\x1b]0;title\x07", "\x1b[8mconcealed\x1b[1;8m", "\x1b[30;40mblack", "\x1b[2J\x1b[38;5;1m"]


@pytest.mark.parametrize("text", SENT)
def test_a_write_may_end_anywhere(text):
    data = (text + "!").encode()
    for cut in range(len(data) + 1):
        terminal = Terminal()
        stream = SanitizingStream(terminal, "stderr")
        assert stream.write(data[:cut]) + stream.write(data[cut:]) == len(data)
        assert terminal.getvalue() == escape_text(text + "!", "stderr").encode()


def test_an_unfinished_sequence_is_written_at_the_end():
    for text in ("\x1b[3", "\r", "\x1b"):
        terminal = Terminal()
        stream = SanitizingStream(terminal, "stderr")
        stream.write(b"a" + text.encode())
        written = terminal.getvalue()
        terminal.close = lambda: None
        stream.close()
        assert written == b"a"
        assert terminal.getvalue() == f"a{escape_text(text)}".encode()
