"""What is done to a file before a command gets it: as bytes, as numbers, as XML, as an attack."""

from __future__ import annotations

import re

NUMBERS = (
    *(b"nan", b"-nan", b"inf", b"-inf", b"1e308", b"-1e308", b"1e-320", b"1e999", b"-0", b"0"),
    *(
        b"",
        b" ",
        b"1 2",
        b"0x10",
        b"1,5",
        b"1_000",
        "٣".encode(),
        b"${1/0}",
        b"--1",
        b"99999999999999999999",
    ),
)
NAMES = (
    *(b"$(touch HERE/pwned)", b"`touch HERE/pwned`", b"; touch HERE/pwned;", b"| touch HERE/pwned"),
    *(b"../../../escaped", b"/escaped", b"HERE/../escaped", b"a/b", b".", b"..", b"CON", b"a\\b"),
    *(b"&lt;script>alert(1)&lt;/script>", b"&quot;>&lt;svg onload=alert(1)>", b"]]>", b"--&gt;"),
    *(
        b"::error file=x::owned",
        b"%0A::warning::owned",
        b"a&#10;::error::b",
        b"\xc3\xa9\xe2\x82\xac",
    ),
    *(
        b"world",
        b"",
        b" ",
        b"a b",
        b"{}",
        b"%s%n",
        b"[red]",
        b"\\033[31m",
        b"&#x202e;",
        b"&#x9b;31m",
        b"| a | b |",
        b"![x](javascript:alert(1))",
        b"x" * 5000,
    ),
)
FILES = (
    *(b"/etc/passwd", b"file:///etc/passwd", b"package://../../etc/passwd", b"package://a/../../b"),
    *(b"/dev/zero", b"/dev/stdin", b"/proc/self/environ", b"http://127.0.0.1:9/a.stl", b"."),
    *(b"missing.stl", b"mesh.glb", b"", b"package://", b"file://", b"\\\\host\\share\\a.stl"),
    *(b"model://a.stl", b"bomb.xml", b"loop.urdf", b"link.stl", b"a" * 3000),
)
PIECES = (
    *(
        b"<",
        b">",
        b"/>",
        b'"',
        b"&",
        b"&amp;",
        b"-->",
        b"<!--",
        b"]]>",
        b"\0",
        b"\xff",
        b"\xef\xbb\xbf",
        b"\x1b[31m",
        b"\x1b]0;owned\x07",
        b"\xc2\x9b2J",
    ),
    *(b"${", b"}", b"$(", b"$$", b"${x}", b"$(find x)", b"$(arg y)", b"$(env HOME)", b"${[].x}"),
    *(b"<link/>", b"<joint/>", b"<robot>", b"</robot>", b"<gazebo/>", b"<mimic joint='x'/>"),
    *(b"<xacro:if value='2'/>", b"<xacro:include filename='*'/>", b"<xacro:macro name='a'/>"),
    *(b"<joint name='f' type='floating'/>", b"<geometry><mesh filename='x.glb'/></geometry>"),
    *(b"<sensor/>", b"<transmission/>", b"<ros2_control/>", b"<collision/>", b"<inertial/>"),
)
BOMB = (
    b'<?xml version="1.0"?><!DOCTYPE r [<!ENTITY a "ha">'
    + b"".join(b'<!ENTITY %c "&%c;&%c;&%c;&%c;">' % (98 + n, *[97 + n] * 4) for n in range(24))
    + b']><robot name="r"><link name="&z;"/></robot>'
)
OUTSIDE = (
    b'<?xml version="1.0"?><!DOCTYPE r [<!ENTITY x SYSTEM "file:///etc/passwd">]>'
    b'<robot name="&x;"/>'
)

_NUMBER = re.compile(rb"(?<=[\"\s])-?\d+\.?\d*(?:e-?\d+)?(?=[\"\s])")
_NAME = re.compile(rb"(?:name|link|joint|reference)\s*=\s*\"([^\"]*)\"")
_FILE = re.compile(rb"filename\s*=\s*\"([^\"]*)\"")
_TAGS = b"link|joint|visual|collision|inertial|gazebo|limit|origin|geometry|axis|mimic"
_ELEMENT = re.compile(rb"<(" + _TAGS + rb")\b")


def damaged(data, dice, here):
    """A file after one to four kinds of damage.

    Args:
        data: Its bytes.
        dice: A ``random.Random``.
        here: The folder it stands in, which some names try to leave.
    """
    if dice.random() < 0.004:
        return dice.choice((BOMB, OUTSIDE, b"", b"\0" * 100, b"<robot" + b" a='1'" * 20000 + b"/>"))
    for _ in range(dice.choice((1, 1, 1, 2, 2, 3, 4))):
        data = dice.choices(_KINDS, _WEIGHTS)[0](data, dice)
    return data.replace(b"HERE", str(here).encode())


def _cut(data, dice):
    start = dice.randrange(len(data) + 1)
    return data[:start] + data[start + dice.choice((1, 2, 5, 20, 200, 2000)) :]


def _truncate(data, dice):
    return data[: dice.randrange(len(data) + 1)]


def _move(data, dice):
    a, b = sorted(dice.randrange(len(data) + 1) for _ in range(2))
    to = dice.randrange(len(data) + 1)
    return data[:to] + data[a : min(b, a + 500)] + data[to:]


def _insert(data, dice):
    at = dice.randrange(len(data) + 1)
    return data[:at] + dice.choice(PIECES) + data[at:]


def _flip(data, dice):
    if not data:
        return data
    changed = bytearray(data)
    for _ in range(dice.choice((1, 3, 10))):
        changed[dice.randrange(len(changed))] = dice.randrange(256)
    return bytes(changed)


def _swapped(pattern, values, group=0):
    def swap(data, dice):
        found = list(pattern.finditer(data))
        if not found:
            return data
        match = dice.choice(found)
        start, end = match.span(group)
        other = dice.choice(found)[group] if dice.random() < 0.25 else dice.choice(values)
        return data[:start] + other + data[end:]

    return swap


def _scaled(data, dice):
    found = list(_NUMBER.finditer(data))
    if not found:
        return data
    match = dice.choice(found)
    factor = dice.choice((-1, 0, 1e-9, 1e-3, 10, 1e3, 1e9))
    return data[: match.start()] + b"%g" % (float(match[0]) * factor) + data[match.end() :]


def _element(data, dice):
    """An element away, twice, or within itself."""
    found = list(_ELEMENT.finditer(data))
    if not found:
        return data
    match = dice.choice(found)
    tag = match[1]
    closing = re.compile(rb"</" + tag + rb"\s*>|/>").search(data, match.end())
    if closing is None:
        return data
    whole = data[match.start() : closing.end()]
    middle = dice.choice((b"", whole + whole, whole + b"\n" + dice.choice(PIECES)))
    if dice.random() < 0.1:
        middle = (b"<" + tag + b">") * 300 + whole + (b"</" + tag + b">") * 300
    return data[: match.start()] + middle + data[closing.end() :]


_KINDS = (
    *(_cut, _truncate, _move, _insert, _flip, _scaled, _element),
    _swapped(_NUMBER, NUMBERS),
    _swapped(_NAME, NAMES, 1),
    _swapped(_FILE, FILES, 1),
)
_WEIGHTS = (1, 0.5, 1, 2, 0.5, 6, 5, 7, 5, 5)

CONTROLLERS = b"""controller_manager:
  ros__parameters:
    update_rate: 100
    arm: {type: joint_trajectory_controller/JointTrajectoryController}
arm:
  type: effort_controllers/JointTrajectoryController
  joints: [a, b, elbow, joint1]
  gains:
    a: {p: 100, i: 0.01, d: 10, i_clamp: 1}
    elbow: {p: 1.0e+3, d: 1}
  ros__parameters:
    joints: [a]
    gains: {a: {p: 10.0, d: 1.0}}
"""
ALIASES = b"a0: &a0 [x, x]\n" + b"".join(
    b"a%d: &a%d [*a%d, *a%d, *a%d]\n" % (n + 1, n + 1, n, n, n) for n in range(24)
)
_YAML_WORDS = (b"&a", b"*a", b"!!python/object/apply:os.system ['id']", b"!degrees 9", b"- ", b": ")
_YAML_WORDS += (
    b"[" * 3000,
    b"{",
    b"\x1b[31m",
    b"~",
    b"nan",
    b"1e999",
    b"<<: *a",
    b"\n---\n",
    b"\t",
)


def damaged_yaml(dice):
    """Gains of controllers with damage, or a bomb of aliases."""
    if dice.random() < 0.05:
        return ALIASES + b"arm: {gains: *a24}\n"
    data = CONTROLLERS
    for _ in range(dice.choice((1, 1, 2, 3))):
        kind = dice.choice((_cut, _truncate, _move, _flip, None, None))
        if kind is not None:
            data = kind(data, dice)
            continue
        words = list(re.finditer(rb"[\w./]+", data)) or [re.match(b"", data)]
        word = dice.choice(words)
        data = data[: word.start()] + dice.choice(_YAML_WORDS + NUMBERS) + data[word.end() :]
    return data
