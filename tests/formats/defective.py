"""Small SDF and MJCF files with one defect each, and files that other programs read.

``CASES`` maps a name to the files of a folder; the first of them is the one that is read.
"""

from __future__ import annotations

from pathlib import Path

INERTIAL = (
    "<inertial><mass>1</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia>"
    "</inertial>"
)
SHAPE = "<geometry><box><size>0.1 0.1 0.1</size></box></geometry>"


def link(name: str, body: str = INERTIAL) -> str:
    """Return a link of SDF with a box."""
    shapes = f'<visual name="v">{SHAPE}</visual><collision name="c">{SHAPE}</collision>'
    return f'<link name="{name}">\n{body}\n{shapes}</link>\n'


def joint(parent: str, child: str, axis: str = "", name: str = "j", kind: str = "revolute") -> str:
    """Return a joint of SDF, with the contents of its axis."""
    inside = axis or "<xyz>0 0 1</xyz>"
    return (
        f'<joint name="{name}" type="{kind}">\n<parent>{parent}</parent>\n<child>{child}</child>\n'
        f"<axis>\n{inside}\n</axis></joint>\n"
    )


def sdf(body: str, version: str = "1.9") -> str:
    """Return an SDF file with a model."""
    return f'<sdf version="{version}">\n<model name="m">\n{body}</model>\n</sdf>\n'


def mjcf(body: str, rest: str = "") -> str:
    """Return an MJCF file."""
    return f'<mujoco model="m">\n{rest}\n<worldbody>\n{body}\n</worldbody>\n</mujoco>\n'


GEOM = '<geom type="box" size=".1 .1 .1"/>'
ARM = (
    f'<body name="a">\n{GEOM}\n<body name="b" pos="0 0 .3">\n<joint name="j" axis="0 0 1"/>'
    f"\n{GEOM}</body></body>"
)
TWO = link("a") + link("b")
POSITIVE = "<inertia><ixx>{}</ixx><iyy>{}</iyy><izz>{}</izz></inertia>"


def _with_inertia(mass: str, *moments: str) -> str:
    tensor = POSITIVE.format(*moments)
    body = f"<inertial>\n<mass>{mass}</mass>\n{tensor}</inertial>"
    return sdf(link("a") + link("b", body) + joint("a", "b"))


def _limits(lower: str, upper: str) -> str:
    text = f"<xyz>0 0 1</xyz><limit><lower>{lower}</lower><upper>{upper}</upper></limit>"
    return sdf(TWO + joint("a", "b", text))


SDF = {
    "two links of one name": sdf(link("a") + link("a")),
    "two joints of one name": sdf(TWO + link("c") + joint("a", "b") + joint("b", "c")),
    "a model without links": sdf(""),
    "no model": '<sdf version="1.9"/>',
    "an empty world": '<sdf version="1.9"><world name="w"/></sdf>',
    "an unknown child": sdf(TWO + joint("a", "absent")),
    "an unknown parent": sdf(TWO + joint("absent", "b")),
    "a joint to itself": sdf(TWO + joint("a", "a")),
    "a joint without ends": sdf(TWO + '<joint name="j" type="revolute"/>'),
    "an axis of zeros": sdf(TWO + joint("a", "b", "<xyz>0 0 0</xyz>")),
    "a negative mass": _with_inertia("-1", "1", "1", "1"),
    "a mass of zero": _with_inertia("0", "1", "1", "1"),
    "an impossible inertia": _with_inertia("1", "1", "1", "9"),
    "a negative inertia": _with_inertia("1", "-1", "1", "1"),
    "an inertia of zeros": _with_inertia("1", "0", "0", "0"),
    "a loop": sdf(
        TWO + link("c") + joint("a", "b") + joint("b", "c", name="k") + joint("a", "c", name="l")
    ),
    "a cycle": sdf(TWO + joint("a", "b") + joint("b", "a", name="k")),
    "two roots": sdf(TWO),
    "a missing mesh": sdf(
        '<link name="a"><visual name="v"><geometry><mesh>\n<uri>nothing.stl</uri></mesh></geometry>'
        "</visual></link>"
    ),
    "a mesh without a file": sdf(
        '<link name="a"><visual name="v"><geometry><mesh/></geometry></visual></link>'
    ),
    "a geometry without a shape": sdf('<link name="a"><collision name="c"/></link>'),
    "an immense mass": _with_inertia("1e300", "1e300", "1e300", "1e300"),
    "an immense position": sdf(
        '<link name="a"><pose>1e300 0 0 0 0 0</pose></link>' + link("b") + joint("a", "b")
    ),
    "a mass of nan": _with_inertia("nan", "1", "1", "1"),
    "a mass of inf": _with_inertia("inf", "inf", "1", "1"),
    "a position of inf": sdf('<link name="a"><pose>inf 0 0 0 0 0</pose></link>'),
    "limits of inf": _limits("-inf", "inf"),
    "limits swapped": _limits("1", "-1"),
    "a limit of letters": _limits("low", "high"),
    "a size of zero": sdf(link("a").replace("0.1 0.1 0.1", "0 0 0")),
    "a negative size": sdf(link("a").replace("0.1 0.1 0.1", "-1 1 1")),
    "a size of two numbers": sdf(link("a").replace("0.1 0.1 0.1", "1 1")),
    "a mimic of nothing": sdf(TWO + joint("a", "b", '<xyz>0 0 1</xyz><mimic joint="absent"/>')),
    "a mimic of itself": sdf(TWO + joint("a", "b", '<xyz>0 0 1</xyz><mimic joint="j"/>')),
    "a link without a name": sdf("<link/>" + link("a")),
    "a joint without a name": sdf(TWO + joint("a", "b").replace(' name="j"', "")),
    "a model without a name": sdf(link("a")).replace(' name="m"', ""),
    "a visual without a name": sdf(link("a").replace(' name="v"', "")),
    "an unknown type of joint": sdf(TWO + joint("a", "b", kind="elbow")),
    "a joint without a type": sdf(TWO + joint("a", "b").replace(' type="revolute"', "")),
    "a ball joint": sdf(TWO + joint("a", "b", kind="ball")),
    "a screw joint": sdf(TWO + joint("a", "b", kind="screw")),
    "a universal joint": sdf(TWO + joint("a", "b", kind="universal")),
    "two worlds": (
        f'<sdf version="1.9"><world name="a"><model name="m">{link("a")}</model></world>\n'
        '<world name="b"/></sdf>'
    ),
    "a cycle of frames": sdf(
        '<frame name="f" attached_to="g"/><frame name="g" attached_to="f"/>' + link("a")
    ),
    "a pose of an unknown frame": sdf('<link name="a"><pose relative_to="absent"/></link>'),
    "a pose of five numbers": sdf('<link name="a"><pose>1 2 3 4 5</pose></link>'),
    "no version": "<sdf><model name='m'/></sdf>",
    "a version of letters": sdf(link("a"), "new"),
    "a version of tomorrow": sdf(link("a"), "2.0"),
    "a missing model": sdf("<include><uri>model://nothing</uri></include>"),
    "a model of the network": sdf("<include><uri>https://example.org/m</uri></include>"),
    "unknown elements": sdf(link("a") + "<wheels/><link2 name='b'/>"),
    "an immense depth": sdf("<model name='n'>" * 400 + link("a") + "</model>" * 400),
    "cut short": sdf(TWO + joint("a", "b"))[:-80],
    "an odd name": sdf(TWO.replace('"b"', '"b c&#10;d/&lt;é"') + joint("a", "b c&#10;d/&lt;é")),
    "a name of ROS": sdf(link("a") + link("base::b") + joint("a", "base::b")),
}

MJCF = {
    "two bodies of one name": mjcf(f'<body name="a">{GEOM}</body><body name="a">{GEOM}</body>'),
    "two joints of one name": mjcf(ARM.replace("<joint", '<joint name="j" axis="1 0 0"/>\n<joint')),
    "an empty world": mjcf(""),
    "no world": "<mujoco/>",
    "a floor only": mjcf('<geom type="plane" size="1 1 1"/>'),
    "an axis of zeros": mjcf(ARM.replace("0 0 1", "0 0 0")),
    "a negative mass": mjcf(ARM.replace('"box"', '"box" mass="-1"', 1)),
    "a mass of zero": mjcf(ARM.replace('"box"', '"box" mass="0"')),
    "an impossible inertia": mjcf(
        ARM.replace(GEOM, '<inertial pos="0 0 0" mass="1" diaginertia="1 1 9"/>')
    ),
    "an unbalanced inertia": mjcf(
        ARM.replace(GEOM, '<inertial pos="0 0 0" mass="1" diaginertia="1 1 9"/>'),
        '<compiler balanceinertia="true"/>',
    ),
    "a body that moves without mass": mjcf('<body name="a"><joint name="j"/></body>'),
    "a loop": mjcf(
        ARM + f'<body name="c">{GEOM}</body>',
        '<equality><connect body1="b" body2="c" anchor="0 0 0"/></equality>',
    ),
    "a weld to the world": mjcf(ARM, '<equality><weld body1="b"/></equality>'),
    "two roots": mjcf(f'<body name="a">{GEOM}</body><body name="b">{GEOM}</body>'),
    "two free bodies": mjcf(
        f'<body name="a"><freejoint/>{GEOM}</body><body name="b"><freejoint/>{GEOM}</body>'
    ),
    "a missing mesh": mjcf(
        '<body><geom type="mesh" mesh="nothing"/></body>',
        '<asset>\n<mesh name="nothing" file="nothing.stl"/></asset>',
    ),
    "a mesh of nothing": mjcf('<body><geom type="mesh" mesh="absent"/></body>'),
    "an immense mass": mjcf(ARM.replace('"box"', '"box" mass="1e300"')),
    "an immense size": mjcf(ARM.replace(".1 .1 .1", "1e300 1 1")),
    "an immense position": mjcf(ARM.replace("0 0 .3", "1e300 0 0")),
    "a position of nan": mjcf(ARM.replace("0 0 .3", "nan 0 0")),
    "a position of inf": mjcf(ARM.replace("0 0 .3", "inf 0 0")),
    "a position of letters": mjcf(ARM.replace("0 0 .3", "x y z")),
    "a position of two numbers": mjcf(ARM.replace("0 0 .3", "0 0")),
    "limits swapped": mjcf(ARM.replace('name="j"', 'name="j" range="1 -1" limited="true"')),
    "a size of zero": mjcf(ARM.replace(".1 .1 .1", "0 0 0")),
    "a coupling of nothing": mjcf(ARM, '<equality><joint joint1="j" joint2="absent"/></equality>'),
    "parts without names": mjcf(ARM.replace(' name="a"', "").replace(' name="j"', "")),
    "an unknown type of joint": mjcf(ARM.replace('name="j"', 'name="j" type="elbow"')),
    "a ball joint": mjcf(ARM.replace('name="j"', 'name="j" type="ball"')),
    "an actuator of nothing": mjcf(ARM, '<actuator><motor joint="absent"/></actuator>'),
    "unknown elements": mjcf("<wheels/>" + ARM),
    "unknown attributes": mjcf(ARM.replace("<geom", '<geom color="red"')),
    "a flag of letters": mjcf(ARM, '<compiler angle="turns"/>'),
    "an unknown class": mjcf(ARM.replace("<geom", '<geom class="absent"')),
    "an unknown include": mjcf('<include file="nothing.xml"/>'),
    "an include of itself": mjcf('<include file="model.xml"/>'),
    "an immense depth": mjcf("<body>" * 600 + GEOM + "</body>" * 600),
    "a muscle": mjcf(
        ARM.replace("</body></body>", '<site name="s"/></body><site name="t"/></body>'),
        '<tendon><spatial name="t"><site site="s"/><site site="t"/></spatial></tendon>'
        '<actuator><muscle tendon="t"/></actuator>',
    ),
    "a replicate": mjcf(f'<replicate count="3"><body name="a">{GEOM}</body></replicate>'),
    "an immense replicate": mjcf(f'<replicate count="100000000"><body>{GEOM}</body></replicate>'),
    "a flexible body": mjcf(
        '<flexcomp name="f" type="grid" count="3 3 1" spacing=".1 .1 .1" radius=".01" dim="2"'
        ' mass="1"/>'
    ),
    "a height field": mjcf(
        '<body><geom type="hfield" hfield="h"/></body>',
        '<asset><hfield name="h" nrow="2" ncol="2" size="1 1 1 1"/></asset>',
    ),
    "cut short": mjcf(ARM)[:-60],
    "an odd name": mjcf(ARM.replace('"b"', '"b c&#10;d/&lt;é"')),
    "a library that is not here": mjcf(ARM, '<extension><plugin plugin="absent"/></extension>'),
}

OTHER = {
    "srdf.srdf": '<robot name="r"><group name="g"><link name="a"/></group></robot>',
    "file.launch": '<launch><node pkg="a" type="b" name="c"/></launch>',
    "package.xml": "<package format='3'><name>p</name></package>",
    "plain.xml": "<shapes><box/></shapes>",
    "page.html": "<!DOCTYPE html><html><body>Hello</body></html>",
    "values.json": '{"sdf": 1}',
    "values.yaml": "sdf:\n  - 1\n",
    "text.sdf": "a text without a tag",
    "empty.sdf": "",
    "spaces.xml": " \n ",
    "zeros.sdf": "\0\0\0",
    "binary.xml": "\x7fELF\x02\x01\x01\0\x80\xff",
    "picture.png": "\x89PNG\r\n\x1a\n\0\0\0\rIHDR",
    "utf16.sdf": "\ufeff<sdf version='1.9'/>",
    "included.xml": "<mujocoinclude><worldbody/></mujocoinclude>",
    "namespace.sdf": '<s:sdf xmlns:s="urn:sdf" version="1.9"/>',
    "entities.sdf": (
        '<!DOCTYPE s [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;">]>'
        '<sdf version="1.9"><model name="&b;"/></sdf>'
    ),
}

INCLUDED = {
    "an include of itself": {
        "model.sdf": sdf("<include><uri>model.sdf</uri></include>"),
    },
    "includes in a circle": {
        "model.sdf": sdf("<include><uri>b.sdf</uri></include>"),
        "b.sdf": sdf("<include><uri>model.sdf</uri></include>"),
    },
    "an included file of two models": {
        "model.sdf": sdf("<include><uri>b.sdf</uri></include>"),
        "b.sdf": '<sdf version="1.9"><model name="a"/><model name="b"/></sdf>',
    },
    "an included file of another tool": {
        "model.sdf": sdf("<include><uri>b.urdf</uri></include>"),
        "b.urdf": '<robot name="r"><link name="a"/></robot>',
    },
    "an included file cut short": {
        "model.sdf": sdf("<include><uri>b.sdf</uri></include>"),
        "b.sdf": sdf(TWO)[:-40],
    },
    "mjcf includes in a circle": {
        "model.xml": mjcf('<include file="b.xml"/>'),
        "b.xml": '<mujocoinclude><include file="model.xml"/></mujocoinclude>',
    },
    "an mjcf include cut short": {
        "model.xml": mjcf('<include file="b.xml"/>'),
        "b.xml": "<mujocoinclude><body>",
    },
    "an attached model of nothing": {
        "model.xml": mjcf(
            '<body><attach model="c" body="x" prefix="p"/></body>',
            '<asset><model name="c" file="c.xml"/></asset>',
        ),
    },
    "an attached model cut short": {
        "model.xml": mjcf(
            '<body><attach model="c" body="x" prefix="p"/></body>',
            '<asset><model name="c" file="c.xml"/></asset>',
        ),
        "c.xml": "<mujoco><worldbody>",
    },
    "an attached model of itself": {
        "model.xml": mjcf(
            '<body><attach model="c" body="x" prefix="p"/></body>',
            '<asset><model name="c" file="model.xml"/></asset>',
        ),
    },
    "a mesh of letters": {
        "model.xml": mjcf(
            '<body><geom type="mesh" mesh="m"/></body>',
            '<asset><mesh name="m" file="m.stl"/></asset>',
        ),
        "m.stl": "this is not a mesh, although it is longer than the head of a binary file " * 3,
    },
    "an sdf mesh of letters": {
        "model.sdf": sdf(
            '<link name="a"><visual name="v"><geometry><mesh>\n<uri>m.stl</uri></mesh></geometry>'
            "</visual></link>"
        ),
        "m.stl": "this is not a mesh, although it is longer than the head of a binary file " * 3,
    },
}

CASES: dict[str, dict[str, str]] = {
    **{f"sdf: {name}": {"model.sdf": text} for name, text in SDF.items()},
    **{f"mjcf: {name}": {"model.xml": text} for name, text in MJCF.items()},
    **{f"other: {name}": {name: text} for name, text in OTHER.items()},
    **{f"files: {name}": files for name, files in INCLUDED.items()},
}


def write_case(name: str, folder: Path) -> Path:
    """Write the files of a case and return the path of the first."""
    files = CASES[name]
    for file, text in files.items():
        if file.startswith("utf16"):
            data = text.encode("utf-16-le")
        elif file.endswith((".png", "binary.xml")):
            data = text.encode("latin-1")
        else:
            data = text.encode("utf-8")
        (folder / file).write_bytes(data)
    return folder / next(iter(files))
