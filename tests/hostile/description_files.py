"""Hostile URDF, SDF, MJCF, USD and files around them, as data: names, and what is in them.

In a text, ``@BESIDE@`` and its kind are replaced as in ``escapes``. The first file is the one that a
command is given.
"""
# ruff: noqa: E501

from __future__ import annotations

import io
import zipfile
from collections.abc import Callable

Files = dict[str, bytes | str]

INERTIAL = '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
BOX = "<geometry><box size='1 1 1'/></geometry>"
SOLID_LINK = (
    f'<link name="{{}}">{INERTIAL}<visual>{BOX}</visual><collision>{BOX}</collision></link>'
)
JOINT = '<joint name="{0}" type="{3}"><parent link="{1}"/><child link="{2}"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>'


def robot(body: str) -> str:
    """Return a URDF."""
    return f'<robot name="r">{body}</robot>'


def mesh(path: str, texture: str = "") -> str:
    """Return a URDF with a mesh, and a texture if one is named."""
    shape = f'<geometry><mesh filename="{path}"/></geometry>' if path else BOX
    material = f'<material name="m"><texture filename="{texture}"/></material>' if texture else ""
    return robot(
        f'<link name="a">{INERTIAL}<visual>{shape}{material}</visual>'
        f"<collision>{shape}</collision></link>"
    )


def links(count: int, parent: Callable[[int], int], *, kind: str = "fixed", at: str = "") -> str:
    """Return a URDF of many links with boxes."""
    body = "".join(SOLID_LINK.format(f"l{n}") for n in range(count))
    joints = (
        JOINT.format(f"j{n}", f"l{parent(n)}", f"l{n}", kind).replace(
            "<axis", f'<origin xyz="{at.format(n)}"/><axis' if at else "<axis"
        )
        for n in range(1, count)
    )
    return robot(body + "".join(joints))


def laughs(root: str, levels: int = 12) -> str:
    """Return XML with entities that hold each other ten times."""
    lines = [f'<!ENTITY a{n} "{f"&a{n - 1};" * 10}">' for n in range(1, levels)]
    return f'<!DOCTYPE {root} [<!ENTITY a0 "aaaaaaaaaa">{"".join(lines)}]><{root} name="&a{levels - 1};"/>'


def external(root: str) -> str:
    """Return XML with an entity of a file."""
    return f'<!DOCTYPE {root} [<!ENTITY a SYSTEM "file://@BESIDE@">]><{root} name="r">&a;</{root}>'


def xml_cases(root: str, extension: str) -> dict[str, Files]:
    """Return what is hostile in XML of any kind."""
    inside = f'<{root} name="r">{{}}</{root}>'

    def text(body: str) -> Files:
        return {f"r{extension}": inside.format(body)}

    def whole(data: str | bytes) -> Files:
        return {f"r{extension}": data}

    return {
        "entities": whole(laughs(root)),
        "external entity": whole(external(root)),
        "external definition": whole(f'<!DOCTYPE {root} SYSTEM "@BESIDE@">' + inside.format("")),
        "parameter entity": whole(
            f'<!DOCTYPE {root} [<!ENTITY % a SYSTEM "@BESIDE@"> %a;]>' + inside.format("")
        ),
        "XInclude": text(
            '<xi:include xmlns:xi="http://www.w3.org/2001/XInclude" href="@BESIDE@" parse="text"/>'
        ),
        **{
            f"encoding {name}": whole(
                f'<?xml version="1.0" encoding="{name}"?>' + inside.format("")
            )
            for name in (
                "zlib",
                "hex",
                "rot13",
                "base64",
                "idna",
                "utf-7",
                "unicode_escape",
                "x" * 9999,
                "mbcs",
                "undefined",
            )
        },
        "UTF-16": whole(inside.format("").encode("utf-16")),
        "UTF-16 without a mark": whole(inside.format("").encode("utf-16-le")),
        "UTF-32": whole(inside.format("").encode("utf-32")),
        "invalid UTF-8": whole(inside.format("<a b='\xff\xfe'/>").encode("latin-1")),
        "surrogates": whole(inside.format("<a b='\ud800'/>").encode("utf-8", "surrogatepass")),
        "null bytes": whole(bytes(100_000)),
        "program": whole(b"\x7fELF\x02\x01\x01" + bytes(range(256)) * 9),
        "nothing": whole(b""),
        "deep": text("<a>" * 50_000 + "</a>" * 50_000),
        "not closed": whole(f"<{root}>" * 200_000),
        "attributes": text("<a " + " ".join(f'a{n}="1"' for n in range(100_000)) + "/>"),
        "long attribute": text(f'<a b="{"x" * 5_000_000}"/>'),
        "long name": text(f"<{'a' * 1_000_000}/>"),
        "many elements": text("<a/>" * 500_000),
        "namespaces": text("".join(f'<a xmlns:n{n}="u{n}"/>' for n in range(20_000))),
        "comments": text("<!--" + "-" * 3 + ">" + "<!-- a -->" * 100_000),
        "CDATA": text("<![CDATA[" + "]" * 500_000 + "]]>"),
        "instructions": text("<?a b?>" * 100_000),
        "characters": text("&#x41;" * 200_000),
        "control characters": text("<a b='&#27;[31m'/>"),
        "a control character in a name": whole(
            inside.replace('name="r"', 'name="r\x1b]0;x\x07"').format("")
        ),
    }


URDF: dict[str, Files] = {
    **xml_cases("robot", ".urdf"),
    "links at one place": {"r.urdf": links(10_000, lambda n: 0)},
    "links in a chain": {"r.urdf": links(3000, lambda n: n - 1, at="0 0 1")},
    "links that turn in a chain": {
        "r.urdf": links(1000, lambda n: n - 1, kind="revolute", at="0 0 1")
    },
    "links in a star": {"r.urdf": links(10_000, lambda n: 0, kind="revolute", at="{0} 0 0")},
    "links that overlap": {"r.urdf": links(2000, lambda n: 0, kind="continuous", at="0.00{0} 0 0")},
    "links in a tree": {"r.urdf": links(8000, lambda n: n // 2, at="1 0 0")},
    "links of one name": {"r.urdf": robot('<link name="a"/>' * 20_000)},
    "links without joints": {
        "r.urdf": robot("".join(f'<link name="a{n}"/>' for n in range(20_000)))
    },
    "joints of one name": {
        "r.urdf": robot(
            '<link name="a"/><link name="b"/>' + JOINT.format("j", "a", "b", "fixed") * 5000
        )
    },
    "joints in a circle": {
        "r.urdf": robot(
            '<link name="a"/><link name="b"/>'
            + JOINT.format("j", "a", "b", "fixed")
            + JOINT.format("k", "b", "a", "fixed")
        )
    },
    "joint to itself": {"r.urdf": robot('<link name="a"/>' + JOINT.format("j", "a", "a", "fixed"))},
    "mimics in a circle": {
        "r.urdf": robot(
            "".join(f'<link name="l{n}"/>' for n in range(1001))
            + "".join(
                JOINT.format(f"j{n}", "l0", f"l{n}", "revolute").replace(
                    "<axis", f'<mimic joint="j{n % 1000 + 1}"/><axis'
                )
                for n in range(1, 1001)
            )
        )
    },
    "materials": {
        "r.urdf": robot(
            "".join(
                f'<material name="m{n}"><color rgba="1 0 0 1"/></material>' for n in range(20_000)
            )
            + '<link name="a"/>'
        )
    },
    "shapes of one link": {
        "r.urdf": robot(
            f'<link name="a">{INERTIAL}'
            + f"<visual>{BOX}</visual><collision>{BOX}</collision>" * 5000
            + "</link>"
        )
    },
    "numbers of many digits": {"r.urdf": mesh("").replace("1 1 1", "9" * 100_000 + " 1 1")},
    "many numbers": {"r.urdf": mesh("").replace("1 1 1", "1 " * 500_000)},
    "extreme numbers": {"r.urdf": mesh("").replace("1 1 1", "1e308 1e308 1e308")},
    "numbers that are none": {"r.urdf": mesh("").replace("1 1 1", "nan inf 1e999")},
    "gazebo blocks": {
        "r.urdf": robot('<link name="a"/>' + '<gazebo reference="a"><mu1>1</mu1></gazebo>' * 20_000)
    },
    "deep gazebo block": {
        "r.urdf": robot('<link name="a"/><gazebo>' + "<a>" * 190 + "</a>" * 190 + "</gazebo>")
    },
    "plugin of the system": {
        "r.urdf": robot(
            '<link name="a"/><gazebo><plugin name="p" filename="/bin/sh"><a>@BESIDE@</a></plugin></gazebo>'
        )
    },
    "plugin with parameters": {
        "r.urdf": robot(
            '<link name="a"/><gazebo><plugin name="p" filename="libgazebo_ros2_control.so"><parameters>@BESIDE@</parameters></plugin></gazebo>'
        )
    },
    "plugin with parameters of a device": {
        "r.urdf": robot(
            '<link name="a"/><gazebo><plugin name="p" filename="libgazebo_ros2_control.so"><parameters>/dev/zero</parameters></plugin></gazebo>'
        )
    },
    "markup in names": {
        "r.urdf": robot(SOLID_LINK.format("&lt;script&gt;alert(1)&lt;/script&gt;&quot;&apos;&amp;"))
    },
    "commands in names": {
        "r.urdf": robot(SOLID_LINK.format("$(touch @MARK@);`touch @MARK@`|touch @MARK@"))
    },
    "paths in names": {
        "r.urdf": robot(
            SOLID_LINK.format("../../../beside/x").replace("'1 1 1'", "'1 1 1'")
        ).replace('name="r"', 'name="../../beside/r"')
    },
    "formats in names": {"r.urdf": robot(SOLID_LINK.format("%s%n{0.__class__}{}"))},
    "styles in names": {"r.urdf": robot(SOLID_LINK.format("[bold red]a[/] [link=file:///]b"))},
    "long names": {"r.urdf": robot(SOLID_LINK.format("a" * 1_000_000))},
    "direction of names": {"r.urdf": robot(SOLID_LINK.format("a\u202egnp\u2066"))},
    "spreadsheet in names": {"r.urdf": robot(SOLID_LINK.format("=cmd|' /C calc'!A0"))},
}


def reach(name: str) -> dict[str, Files]:
    """Return meshes and textures of other folders, in each form of a path."""
    paths = {
        "relative": f"../beside/{name}",
        "absolute": f"@BESIDEDIR@/{name}",
        "file URL": f"file://@BESIDEDIR@/{name}",
        "file URL with a host": f"file://localhost@BESIDEDIR@/{name}",
        "short file URL": f"file:@BESIDEDIR@/{name}",
        "percent signs": f"%2e%2e/beside/{name}",
        "package": f"package://beside/{name}",
        "package of the project": f"package://project/../beside/{name}",
        "package of a parent": f"package://../beside/{name}",
        "package above": f"package://work/beside/{name}",
        "model": f"model://beside/{name}",
        "model of a parent": f"model://../beside/{name}",
        "backslashes": f"..\\beside\\{name}",
        "through proc": f"/proc/self/cwd/../beside/{name}",
        "through a link of the project": f"linked/{name}",
    }
    return {form: {"path": path} for form, path in paths.items()}


REACH: dict[str, Files] = {
    f"{what} {form}": {"r.urdf": mesh(path) if name.endswith("stl") else mesh("", path)}
    for what, name in (("mesh", "secret.stl"), ("texture", "secret.png"))
    for form, paths in reach(name).items()
    for path in [str(paths["path"])]
} | {
    f"{what} {path}": {"r.urdf": mesh(path) if what == "mesh" else mesh("", path)}
    for what in ("mesh", "texture")
    for path in (
        *("@BESIDE@", "@HOME@", "@TMP@", "~/Documents/secret.yaml", ".env", ".git/config"),
        *("/etc/passwd", "/proc/self/environ", "/dev/zero", "/dev/stdin", "/dev/fd/0", "."),
        *("http://127.0.0.1:9/a.stl", "data:,a", "a" * 5000, "a/" * 5000, "//127.0.0.1/a.stl"),
        *("fifo.stl", "zero.stl", "loop.stl", "folder.stl", "link.stl", "cookies.stl", "link.png"),
        *("linked_obj.obj", "linked_gltf.gltf", "linked.dae", ".hidden/secret.yaml"),
    )
}
"""Robots with a mesh or texture that they must not read."""


def sdf(body: str, version: str = "1.10") -> str:
    """Return an SDF."""
    return f'<sdf version="{version}">{body}</sdf>'


def sdf_model(body: str) -> str:
    """Return an SDF with a model."""
    return sdf(f'<model name="r"><link name="a">{body}</link></model>')


def sdf_visual(geometry: str, material: str = "") -> str:
    """Return an SDF with a visual."""
    return sdf_model(f'<visual name="v"><geometry>{geometry}</geometry>{material}</visual>')


def doubled(count: int, form: str, end: str, name: str) -> Files:
    """Return files of which each includes the next one twice."""
    files: Files = {name.format(0): form.format(name.format(1))}
    for n in range(1, count):
        files[name.format(n)] = form.format(name.format(n + 1))
    files[name.format(count)] = end
    return files


SDF: dict[str, Files] = {
    **{name: files for name, files in xml_cases("sdf", ".sdf").items() if "encoding x" not in name},
    **{
        f"include {uri}": {
            "r.sdf": sdf(f'<world name="w"><include><uri>{uri}</uri></include></world>')
        }
        for uri in (
            *("@BESIDE@", "../beside/secret.sdf", "file://@BESIDE@", "/etc/passwd", "/dev/zero"),
            *("model://beside", "model://../../beside", "r.sdf", ".", "http://127.0.0.1:9/a"),
            *("file:///proc/self/environ", ".git/config", "fifo.stl", "linked"),
        )
    },
    **{
        f"mesh {uri}": {"r.sdf": sdf_visual(f"<mesh><uri>{uri}</uri></mesh>")}
        for uri in (
            *("@BESIDEDIR@/secret.stl", "file://@BESIDEDIR@/secret.stl", "../beside/secret.stl"),
            *("model://../beside/secret.stl", "file:///etc/passwd", "/dev/zero", "fifo.stl"),
            *("link.stl", "cookies.stl", "package://beside/secret.stl", "@HOME@", ".env"),
        )
    },
    **{
        f"texture {tag}": {
            "r.sdf": sdf_visual(
                "<box><size>1 1 1</size></box>",
                f"<material><pbr><metal><{tag}>{path}</{tag}></metal></pbr></material>",
            )
        }
        for tag, path in (
            *(("albedo_map", "/etc/passwd"), ("albedo_map", "../beside/secret.png")),
            *(("normal_map", "file://@BESIDEDIR@/secret.png"), ("metalness_map", "link.png")),
            ("environment_map", "/dev/zero"),
        )
    },
    "script": {
        "r.sdf": sdf_visual(
            "<box><size>1 1 1</size></box>",
            "<material><script><uri>file://@BESIDE@</uri><name>a</name></script></material>",
        )
    },
    "height map": {
        "r.sdf": sdf_visual(
            "<heightmap><uri>../beside/secret.png</uri><size>1 1 1</size></heightmap>"
        )
    },
    "image": {"r.sdf": sdf_visual("<image><uri>../beside/secret.png</uri></image>")},
    "plugin": {
        "r.sdf": sdf(
            '<model name="r"><plugin name="p" filename="@BESIDE@"/><link name="a"/></model>'
        )
    },
    "actor": {
        "r.sdf": sdf(
            '<world name="w"><actor name="a"><skin><filename>@BESIDE@</filename></skin></actor></world>'
        )
    },
    "includes that double": doubled(
        25,
        '<sdf version="1.10"><model name="m"><include><uri>{0}</uri></include><include><name>b</name><uri>{0}</uri></include><link name="a"/></model></sdf>',
        sdf('<model name="m"><link name="a"/></model>'),
        "r{}.sdf",
    ),
    "models in models": {"r.sdf": sdf('<model name="m"><link name="a"/>' * 150 + "</model>" * 150)},
    "frames in a circle": {
        "r.sdf": sdf(
            '<model name="m"><link name="a"/><frame name="f" attached_to="g"/><frame name="g" attached_to="f"/></model>'
        )
    },
    "frames in a chain": {
        "r.sdf": sdf(
            '<model name="m"><link name="a"/>'
            + "".join(f'<frame name="f{n}" attached_to="f{n + 1}"/>' for n in range(5000))
            + "</model>"
        )
    },
    "many links": {
        "r.sdf": sdf(
            '<model name="m">'
            + "".join(
                f'<link name="l{n}"><collision name="c"><geometry><box><size>1 1 1</size></box></geometry></collision></link>'
                for n in range(5000)
            )
            + "</model>"
        )
    },
    "parameters": {
        "r.sdf": sdf(
            '<model name="m"><include><uri>r.sdf</uri><experimental:params><link element_id="a" action="remove"/></experimental:params></include></model>'
        )
    },
    "large numbers": {
        "r.sdf": sdf_model(
            "<pose>1e999 nan inf 0 0 0</pose><inertial><mass>1e999</mass></inertial>"
        )
    },
    "ruby": {"r.sdf": "<%= `touch @MARK@` %>" + sdf_model("")},
}


def mjcf(body: str, head: str = "") -> str:
    """Return an MJCF."""
    return f'<mujoco model="r">{head}<worldbody>{body}</worldbody></mujoco>'


GEOM = '<geom size="1"/>'

MJCF: dict[str, Files] = {
    **{
        name: files
        for name, files in xml_cases("mujoco", ".xml").items()
        if "encoding x" not in name
    },
    **{
        f"include {path}": {"r.xml": f'<mujoco><include file="{path}"/></mujoco>'}
        for path in (
            *("@BESIDE@", "../beside/secret.xml", "/etc/passwd", "/dev/zero", "r.xml", "."),
            *("/proc/self/environ", ".git/config", "fifo.stl", "linked/secret.xml", "@HOME@"),
        )
    },
    **{
        f"mesh {path}": {
            "r.xml": mjcf(
                '<geom type="mesh" mesh="m"/>', f'<asset><mesh name="m" file="{path}"/></asset>'
            )
        }
        for path in (
            *(
                "@BESIDEDIR@/secret.stl",
                "../beside/secret.stl",
                "/dev/zero",
                "fifo.stl",
                "link.stl",
            ),
            *("cookies.stl", "linked/secret.stl", "/etc/passwd", "a" * 5000, "."),
        )
    },
    "folder of meshes": {
        "r.xml": mjcf(
            '<geom type="mesh" mesh="m"/>',
            '<compiler meshdir="@BESIDEDIR@"/><asset><mesh name="m" file="secret.stl"/></asset>',
        )
    },
    "relative folder of meshes": {
        "r.xml": mjcf(
            '<geom type="mesh" mesh="m"/>',
            '<compiler meshdir="../beside"/><asset><mesh name="m" file="secret.stl"/></asset>',
        )
    },
    "folder of assets": {
        "r.xml": mjcf(
            '<geom type="mesh" mesh="m"/>',
            '<compiler assetdir="/"/><asset><mesh name="m" file="dev/zero" content_type="model/stl"/></asset>',
        )
    },
    "texture": {
        "r.xml": mjcf(
            GEOM, '<asset><texture name="t" type="2d" file="../beside/secret.png"/></asset>'
        )
    },
    "texture of six files": {
        "r.xml": mjcf(
            GEOM,
            '<asset><texture name="t" type="cube" fileright="../beside/secret.png" fileleft="/dev/zero" fileup="@BESIDE@" filedown="a" filefront="a" fileback="a"/></asset>',
        )
    },
    "texture of a device": {
        "r.xml": mjcf(GEOM, '<asset><texture name="t" type="2d" file="/dev/zero"/></asset>')
    },
    "height field of a file": {
        "r.xml": mjcf(
            GEOM, '<asset><hfield name="h" file="../beside/secret.png" size="1 1 1 1"/></asset>'
        )
    },
    "height field": {
        "r.xml": mjcf(
            GEOM, '<asset><hfield name="h" nrow="100000" ncol="100000" size="1 1 1 1"/></asset>'
        )
    },
    "texture of many pixels": {
        "r.xml": mjcf(
            GEOM,
            '<asset><texture name="t" type="2d" builtin="checker" width="100000" height="100000"/></asset>',
        )
    },
    "skin": {"r.xml": mjcf(GEOM, '<deformable><skin name="s" file="@BESIDE@"/></deformable>')},
    "flexcomp": {
        "r.xml": mjcf(
            '<flexcomp name="f" type="grid" count="1000 1000 1000" spacing="1 1 1" mass="1"/>'
        )
    },
    "flexcomp of a file": {
        "r.xml": mjcf('<flexcomp name="f" type="mesh" file="../beside/secret.obj" mass="1"/>')
    },
    "flexcomp in two dimensions": {
        "r.xml": mjcf(
            '<flexcomp name="f" type="grid" dim="2" count="30000 30000 1" spacing="1 1 1" mass="1"/>'
        )
    },
    "composite": {
        "r.xml": mjcf(
            '<composite type="cable" curve="l" count="1000000 1 1" size="1"><geom size="1"/></composite>'
        )
    },
    "replicate": {
        "r.xml": mjcf(
            f'<replicate count="1000000000" offset="1 0 0"><body>{GEOM}</body></replicate>'
        )
    },
    "replicates": {
        "r.xml": mjcf(
            '<replicate count="1000" offset="1 0 0">' * 3
            + f"<body>{GEOM}</body>"
            + "</replicate>" * 3
        )
    },
    "memory": {"r.xml": mjcf(GEOM, '<size memory="1000G"/>')},
    "sizes": {
        "r.xml": mjcf(GEOM, '<size njmax="2000000000" nconmax="2000000000" nstack="2000000000"/>')
    },
    "user data": {"r.xml": mjcf(GEOM, '<size nuserdata="2000000000"/>')},
    "custom numbers": {
        "r.xml": mjcf(GEOM, '<custom><numeric name="n" size="2000000000"/></custom>')
    },
    "sensor history": {
        "r.xml": mjcf(
            '<body><joint name="j"/><geom size="1"/></body>',
            '<sensor><user name="s" dim="2000000000"/></sensor>',
        )
    },
    "bodies in bodies": {"r.xml": mjcf(f"<body>{GEOM}" * 190 + "</body>" * 190)},
    "many bodies": {"r.xml": mjcf(f"<body><joint/>{GEOM}</body>" * 5000)},
    "many geoms": {"r.xml": mjcf(GEOM * 50_000)},
    "many joints": {"r.xml": mjcf("<body>" + "<joint/>" * 5000 + GEOM + "</body>")},
    "defaults in defaults": {"r.xml": f"<mujoco>{'<default>' * 150}{'</default>' * 150}</mujoco>"},
    "key frames": {
        "r.xml": mjcf("<body><joint/>" + GEOM + "</body>").replace(
            "</mujoco>", "<keyframe>" + '<key qpos="0"/>' * 100_000 + "</keyframe></mujoco>"
        )
    },
    "plugin": {
        "r.xml": mjcf(GEOM, '<extension><plugin plugin="mujoco.elasticity.cable"/></extension>')
    },
    "plugin of a file": {
        "r.xml": mjcf(GEOM, '<extension><plugin plugin="@BESIDEDIR@/secret.so"/></extension>')
    },
    "model of a file": {
        "r.xml": mjcf(
            '<attach model="m" prefix="a"/>', '<asset><model name="m" file="@BESIDE@"/></asset>'
        )
    },
    "model of itself": {
        "r.xml": mjcf(
            '<attach model="m" prefix="a"/>', '<asset><model name="m" file="r.xml"/></asset>'
        )
    },
    "includes that double": doubled(
        25, '<mujoco><include file="{0}"/><include file="{0}"/></mujoco>', "<mujoco/>", "r{}.xml"
    ),
    "models that double": doubled(
        20,
        '<mujoco><asset><model name="m" file="{0}"/></asset><worldbody><frame><attach model="m" body="b" prefix="a"/></frame><frame><attach model="m" body="b" prefix="c"/></frame><body name="b"/></worldbody></mujoco>',
        mjcf(f'<body name="b">{GEOM}</body>'),
        "r{}.xml",
    ),
    "vertices": {
        "r.xml": mjcf(
            GEOM, f'<asset><mesh name="m" vertex="{"0 0 0 1 0 0 0 1 0 0 0 1 " * 100_000}"/></asset>'
        )
    },
    "points that are none": {
        "r.xml": mjcf('<geom size="nan"/><geom pos="1e999 0 0" size="1"/><geom size="-1"/>')
    },
    "tendon": {
        "r.xml": mjcf('<site name="s"/>').replace(
            "</mujoco>",
            "<tendon><spatial>" + '<site site="s"/>' * 50_000 + "</spatial></tendon></mujoco>",
        )
    },
    "contact pairs": {
        "r.xml": mjcf(f'<body name="a">{GEOM}</body>').replace(
            "</mujoco>",
            "<contact>" + '<exclude body1="a" body2="world"/>' * 50_000 + "</contact></mujoco>",
        )
    },
    "octree": {
        "r.xml": mjcf(
            '<geom type="sdf" mesh="m"/>',
            '<asset><mesh name="m" file="a.obj" octree_maxdepth="30"/></asset>',
        ),
        "a.obj": "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n",
    },
    "built-in meshes": {
        "r.xml": mjcf(
            GEOM, '<asset><mesh name="m" builtin="supersphere" params="30000 30000 1 1"/></asset>'
        )
    },
}


def usda(body: str, head: str = "") -> str:
    """Return a USD layer."""
    return f"#usda 1.0\n({head}\n)\n{body}\n"


def references(levels: int, width: int, form: str = "references") -> str:
    """Return prims of which each refers to the one below it several times."""
    text = ['def Xform "p0" {}']
    for n in range(1, levels + 1):
        inside = "".join(f'def "c{k}" ({form} = </p{n - 1}>) {{}}\n' for k in range(width))
        text.append(f'def Xform "p{n}" {{\n{inside}}}')
    return usda("\n".join(text))


def usdz(name: str, data: bytes) -> bytes:
    """Return a package with a layer."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        archive.writestr(name, data)
    return stream.getvalue()


USD: dict[str, Files] = {
    "references": {"r.usda": references(10, 10)},
    "payloads": {"r.usda": references(10, 10, "payload")},
    "inherits": {"r.usda": references(10, 10, "inherits")},
    "specializes": {"r.usda": references(10, 10, "specializes")},
    "instances": {"r.usda": references(10, 10, "instanceable = true\nreferences")},
    "two references each": {"r.usda": references(40, 2)},
    "references in a circle": {
        "r.usda": usda('def "a" (references = </b>) {}\ndef "b" (references = </a>) {}')
    },
    "reference to its parent": {"r.usda": usda('def "a" { def "b" (references = </a>) {} }')},
    "variants": {
        "r.usda": usda(
            'def "a" (variantSets = ['
            + ", ".join(f'"v{n}"' for n in range(500))
            + "]) {\n"
            + "".join(f'variantSet "v{n}" = {{ "x" {{}} "y" {{}} }}\n' for n in range(500))
            + "}"
        )
    },
    "variants in variants": {
        "r.usda": usda(
            'def "a" {'
            + "".join(f'variantSet "v{n}" = {{ "x" {{' for n in range(150))
            + "}}" * 150
            + "}"
        )
    },
    "deep": {"r.usda": usda("".join(f'def "p{n}" {{' for n in range(20_000)) + "}" * 20_000)},
    "many": {"r.usda": usda("\n".join(f'def Xform "p{n}" {{}}' for n in range(50_000)))},
    "instancer": {
        "r.usda": usda(
            'def PointInstancer "i" {\nrel prototypes = </i/a>\nint[] protoIndices = ['
            + "0, " * 500_000
            + "0]\npoint3f[] positions = ["
            + "(0, 0, 0), " * 200_000
            + "(0, 0, 0)]\n"
            'def Cube "a" {}\n}'
        )
    },
    "long array": {
        "r.usda": usda('def Mesh "m" { point3f[] points = [' + "(0,0,0)," * 500_000 + "] }")
    },
    "long text": {"r.usda": usda(f'def "a" {{ string s = "{"x" * 5_000_000}" }}')},
    "mesh of large counts": {
        "r.usda": usda(
            'def Mesh "m" { int[] faceVertexCounts = [2000000000, -1]\nint[] faceVertexIndices = [0, 1, 2]\npoint3f[] points = [(0,0,0), (1,0,0), (0,1,0)] }'
        )
    },
    "time samples": {
        "r.usda": usda(
            'def Xform "a" { double x.timeSamples = {'
            + ",".join(f"{n}: 1" for n in range(200_000))
            + "} }"
        )
    },
    "layers of itself": {"r.usda": usda("", "subLayers = [@r.usda@]")},
    "layers in a circle": {
        "r.usda": usda("", "subLayers = [@b.usda@]"),
        "b.usda": usda("", "subLayers = [@r.usda@]"),
    },
    **{
        f"layer {path}": {"r.usda": usda("", f"subLayers = [@{path}@]")}
        for path in (
            *("../beside/secret.usda", "@BESIDEDIR@/secret.usda", "/etc/passwd", "/dev/zero"),
            *("fifo.stl", "linked/secret.usda", ".git/config", "http://127.0.0.1:9/a.usda"),
            *("file://@BESIDEDIR@/secret.usda", "a.usdz[b.usda]", "."),
        )
    },
    **{
        f"{kind} {path}": {"r.usda": usda(f'def "a" ({kind} = @{path}@</secret>) {{}}')}
        for kind in ("references", "payload")
        for path in ("../beside/secret.usda", "/etc/passwd", "/dev/zero", "@BESIDEDIR@/secret.usda")
    },
    "texture": {
        "r.usda": usda(
            'def Shader "s" { asset inputs:file = @../beside/secret.png@\nuniform token info:id = "UsdUVTexture" }'
        )
    },
    "asset of a device": {"r.usda": usda('def Shader "s" { asset inputs:file = @/dev/zero@ }')},
    "expression variables": {
        "r.usda": usda(
            "",
            'expressionVariables = { string A = "../beside/secret.usda" }\nsubLayers = [@`"${A}"`@]',
        )
    },
    "clips": {
        "r.usda": usda(
            'def "a" (clips = { dictionary default = { asset[] assetPaths = [@../beside/secret.usda@]\nstring primPath = "/secret"\ndouble2[] active = [(0,0)]\ndouble2[] times = [(0,0)]\nasset manifestAssetPath = @/dev/zero@ } }) {}'
        )
    },
    "names": {"r.usda": usda('def "a\x1b" {}')},
    "brackets": {"r.usda": '#usda 1.0\ndef "a" { int a = ' + "[" * 100_000},
    "not a layer": {"r.usda": "root:x:0:0:root:/root:/bin/sh\n"},
    "nothing": {"r.usda": b""},
    "binary claim": {"r.usdc": b"PXR-USDC" + b"\xff" * 500},
    "binary zeros": {"r.usdc": b"PXR-USDC" + bytes(100_000)},
    "package": {
        "r.usdz": usdz("a.usda", usda("", "subLayers = [@../beside/secret.usda@]").encode())
    },
    "package of a parent": {"r.usdz": usdz("../a.usda", usda("").encode())},
    "package of nothing": {"r.usdz": b"PK\x05\x06" + bytes(18)},
    "package of a package": {"r.usdz": usdz("a.usdz", usdz("a.usda", usda("").encode()))},
}


def packed(
    entries: list[tuple[str, bytes]], *, attributes: int = 0, method: int = zipfile.ZIP_DEFLATED
) -> bytes:
    """Return a zip file."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", method) as archive:
        for name, data in entries:
            information = zipfile.ZipInfo(name)
            information.compress_type = method
            information.external_attr = attributes << 16
            archive.writestr(information, data)
    return stream.getvalue()


def zeros(gigabytes: int) -> bytes:
    """Return a zip file with much more in it than it is long."""
    stream = io.BytesIO()
    with (
        zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive,
        archive.open("r/bundle.json", "w", force_zip64=True) as out,
    ):
        for _ in range(gigabytes * 256):
            out.write(bytes(4 << 20))
    return stream.getvalue()


def lying() -> bytes:
    """Return a zip file that announces a smaller size than it has."""
    data = bytearray(packed([("r/bundle.json", bytes(50 << 20))]))
    for mark, offset in ((b"PK\x03\x04", 22), (b"PK\x01\x02", 24)):
        at = data.find(mark) + offset
        data[at : at + 4] = (10).to_bytes(4, "little")
    return bytes(data)


ZIP: dict[str, Callable[[], bytes]] = {
    "zeros.zip": lambda: zeros(1),
    "many.zip": lambda: packed([(f"r/{n}", b"") for n in range(60_000)]),
    "parent.zip": lambda: packed([("../../beside/written", b"x"), ("r/bundle.json", b"{}")]),
    "absolute.zip": lambda: packed([("/tmp/urdftool-written", b"x"), ("r/bundle.json", b"{}")]),
    "backslash.zip": lambda: packed([("r\\..\\..\\written", b"x"), ("r/bundle.json", b"{}")]),
    "drive.zip": lambda: packed([("C:/written", b"x"), ("r/bundle.json", b"{}")]),
    "link.zip": lambda: packed(
        [("r/bundle.json", b"../../home/work/beside/secret.json")], attributes=0o120777
    ),
    "device.zip": lambda: packed([("r/bundle.json", b"")], attributes=0o020666),
    "same.zip": lambda: packed(
        [("r/bundle.json", b"{}"), ("r/BUNDLE.JSON", b"{}"), ("r/./bundle.json", b"[]")]
    ),
    "lying.zip": lying,
    "nested.zip": lambda: packed(
        [("r/a.zip", packed([("b.zip", packed([("c", bytes(9999))]))])), ("r/bundle.json", b"{}")]
    ),
    "names.zip": lambda: packed(
        [("r/\x1b]0;x\x07.urdf", b""), ("r/a\u202eb", b""), ("r/bundle.json", b"{}")]
    ),
    "long.zip": lambda: packed([("r/" + "a" * 60_000, b""), ("r/bundle.json", b"{}")]),
    "deep.zip": lambda: packed([("a/" * 20_000 + "b", b""), ("r/bundle.json", b"{}")]),
    "manifest.zip": lambda: packed([("r/bundle.json", b"[" * 500_000)]),
    "manifest_paths.zip": lambda: packed(
        [
            (
                "r/bundle.json",
                b'{"files":[{"path":"../../beside/secret.json","sha256":"a"}],"robot":"../../beside/secret.urdf"}',
            )
        ]
    ),
    "lzma.zip": lambda: packed([("r/bundle.json", bytes(50 << 20))], method=zipfile.ZIP_LZMA),
    "short.zip": lambda: packed([("r/bundle.json", b"{}")])[:40],
    "empty.zip": lambda: b"PK\x05\x06" + bytes(18),
    "text.zip": lambda: b"root:x:0:0:root:/root:/bin/sh\n",
}
"""Hostile archives."""

ALIASES = "a0: &a0 [1, 1]\n" + "".join(
    f"a{n}: &a{n} [{','.join([f'*a{n - 1}'] * 9)}]\n" for n in range(1, 12)
)

YAML: dict[str, bytes | str] = {
    "aliases": ALIASES,
    "merges": "a0: &a0 {k: 1}\n"
    + "".join(f"a{n}: &a{n} {{<<: [{','.join([f'*a{n - 1}'] * 9)}]}}\n" for n in range(1, 12)),
    "deep": "a: " + "[" * 100_000,
    "deep blocks": "".join(" " * n + "a:\n" for n in range(2000)),
    "itself": "a: &a [*a]",
    "long": "a: " + "x" * 20_000_000,
    "many": "- 1\n" * 900_000,
    "keys": "".join(f"k{n}: 1\n" for n in range(200_000)),
    "equal keys": "k: 1\n" * 200_000,
    "object": "!!python/object/apply:os.system ['touch @MARK@']",
    "documents": "---\na: 1\n" * 100_000,
    "number": "a: " + "9" * 500_000,
    "sexagesimal": "a: " + "1:" * 200_000 + "1",
    "date": "a: 9999-99-99",
    "codec": b"# coding: utf-7\na: +AGE-",
    "UTF-16": "a: 1".encode("utf-16"),
    "null bytes": bytes(50_000),
    "control characters": b"a: \x1b]0;x\x07",
    "invalid UTF-8": b"a: \xff\xfe",
    "tabs": "a:\n\t- b",
    "flow": "{" * 50_000,
    "quotes": 'a: "' + "\\x41" * 500_000,
    "comment": "#" * 5_000_000,
    "tags": "!" * 200_000 + " a",
    "nothing": "",
}
"""Hostile YAML."""

TOML: dict[str, bytes | str] = {
    "deep": "a = " + "[" * 100_000,
    "deep tables": "[" + "a." * 20_000 + "a]\n",
    "tables": "".join(f"[a{n}]\n" for n in range(100_000)),
    "number": "a = " + "9" * 500_000,
    "long": 'a = "' + "x" * 5_000_000 + '"',
    "invalid UTF-8": b"a = '\xff\xfe'",
    "control characters": b"a = '\x1b]0;x\x07'",
    "unknown keys": '[tool]\na = 1\n[lint]\n"\x7f" = 1\n',
    "packages beside": '[packages]\nbeside = "../beside"\n',
    "packages of the system": '[packages]\nbeside = "/etc"\n',
    "packages of a device": '[packages]\nbeside = "/dev/zero"\n',
    "packages of many": "[packages]\n" + "".join(f'p{n} = "."\n' for n in range(20_000)),
    "packages of another type": "[packages]\nbeside = 1\n",
    "package paths": '[packages]\npaths = ["/"]\n',
    "lint of another type": "[lint]\nselect = 1\nignore = [[]]\n",
    "patterns": '[lint]\nexclude = ["' + "*" * 5000 + 'b"]\n',
    "patterns of many": '[lint]\nexclude = ["' + "/".join(["**"] * 500) + '/b"]\n',
    "per-file": '[lint.per-file-ignores]\n"' + "[a-z]*" * 2000 + '" = ["ALL"]\n',
}
"""Hostile urdftool.toml."""

PACKAGE_XML: dict[str, bytes | str] = {
    "entities": laughs("package"),
    "external entity": external("package").replace("&a;", "<name>&a;</name>"),
    "name of a path": "<package><name>../../beside</name></package>",
    "name with control characters": "<package><name>a&#x9b;b\u202e</name></package>",
    "long name": f"<package><name>{'a' * 1_000_000}</name></package>",
    "deep": "<package>" + "<a>" * 50_000,
    "many names": "<package>" + "<name>project</name>" * 100_000 + "</package>",
    "codec": '<?xml version="1.0" encoding="zlib"?><package><name>a</name></package>',
    "null bytes": bytes(10_000),
    "nothing": b"",
}
"""Hostile package.xml."""

SRDF: dict[str, Files] = {
    **{
        name: files
        for name, files in xml_cases("robot", ".srdf").items()
        if not name.startswith("encoding x")
    },
    "groups in a circle": {
        "r.srdf": robot(
            '<group name="a"><group name="b"/></group><group name="b"><group name="a"/></group>'
        )
    },
    "groups that double": {
        "r.srdf": robot(
            "".join(
                f'<group name="g{n}"><group name="g{n + 1}"/><group name="g{n + 1}"/></group>'
                for n in range(60)
            )
        )
    },
    "many pairs": {
        "r.srdf": robot('<disable_collisions link1="a" link2="b" reason="Never"/>' * 100_000)
    },
    "chains": {
        "r.srdf": robot(
            '<group name="g">' + '<chain base_link="a" tip_link="a"/>' * 20_000 + "</group>"
        )
    },
    "expression": {
        "r.srdf": robot("${().__class__}").replace(
            "<robot", '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"'
        )
    },
}
