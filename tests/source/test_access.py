"""Which files a description may read: the policy, and its effect in every command."""

import os
import sys
from pathlib import Path

import pytest

from tests.assets import DAE, make_gltf, make_png, make_stl
from urdftool.errors import AccessError, UrdftoolError
from urdftool.extras import is_installed
from urdftool.file_access import AccessRefused
from urdftool.projects import TRUST
from urdftool.source.access import require_companion
from urdftool.source.packages import ConfiguredFolder, Packages
from urdftool.workspace import Workspace

CANARY = "canary-5f0c1e"


@pytest.fixture(autouse=True)
def untrusted(monkeypatch, tmp_path):
    """The home folder of the user is not above the test."""
    monkeypatch.delenv(TRUST, raising=False)
    for name in ("ROS_PACKAGE_PATH", "AMENT_PREFIX_PATH", "GZ_SIM_RESOURCE_PATH", "SDF_PATH"):
        monkeypatch.delenv(name, raising=False)
    home = tmp_path / "home" / "victim"
    home.mkdir(parents=True)
    monkeypatch.setenv("HOME", str(home))


@pytest.fixture
def home(tmp_path):
    return tmp_path / "home" / "victim"


def make(root, *names, content=""):
    """Make files, and folders for names that end in a slash."""
    for name in names:
        path = root / name
        if name.endswith("/"):
            path.mkdir(parents=True, exist_ok=True)
        else:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(content or "text")


PACKAGE = "<package><name>{}</name></package>"

# description, marks, file, whether it may be read; below the home folder of the user
LAYOUTS = {
    "next to it": ("d/r.urdf", (), "d/a.stl", True),
    "below it": ("d/r.urdf", (), "d/meshes/deep/a.stl", True),
    "beside its folder": ("d/urdf/r.urdf", (), "d/parts/a.stl", False),
    "parent": ("d/urdf/r.urdf", (), "d/a.stl", False),
    "repository": ("d/urdf/r.urdf", ("d/.git/",), "d/meshes/a.stl", True),
    "repository in a file": ("d/urdf/r.urdf", ("d/.git",), "d/meshes/a.stl", True),
    "mercurial": ("d/urdf/r.urdf", ("d/.hg/",), "d/meshes/a.stl", True),
    "outside of the repository": ("d/r/r.urdf", ("d/r/.git/",), "d/a.stl", False),
    "repository around a package": ("d/p/urdf/r.urdf", ("d/.git/", "d/p/package.xml"), "d/a", True),
    "far repository": ("d/1/2/3/4/5/6/7/8/r.urdf", ("d/.git/",), "d/a.stl", True),
    "package": ("d/urdf/r.urdf", ("d/package.xml",), "d/meshes/a.stl", True),
    "cmake": ("d/urdf/r.urdf", ("d/CMakeLists.txt",), "d/meshes/a.stl", True),
    "python": ("d/urdf/r.urdf", ("d/pyproject.toml",), "d/meshes/a.stl", True),
    "configuration": ("d/urdf/r.urdf", ("d/urdftool.toml",), "d/meshes/a.stl", True),
    "gazebo model": ("d/sdf/m.sdf", ("d/model.config",), "d/meshes/a.stl", True),
    "model beside": ("d/m/m.sdf", ("d/m/model.config", "d/n/model.config"), "d/n/a.stl", True),
    "no model beside": ("d/m/m.sdf", ("d/m/model.config",), "d/n/a.stl", False),
    "package beside": ("ws/src/p/r.urdf", ("ws/src/p/package.xml",), "ws/src/q/a.stl", False),
    "repository in home": ("d/urdf/r.urdf", (".git/",), "d/parts/a.stl", False),
    "package in home": ("d/urdf/r.urdf", ("package.xml",), "d/parts/a.stl", False),
    "in home": ("r.urdf", (), "a.stl", False),
    "in home with a mark": ("r.urdf", (".git/",), "Documents/a.stl", False),
    "meshes beside": ("d/urdf/r.urdf", (), "d/meshes/v/a.stl", True),
    "meshes beside the folder above": ("d/urdf/r/r.urdf", (), "d/mesh/a.stl", True),
    "a file beside": ("d/urdf/r.urdf", (), "d/a.stl", False),
    "a folder beside": ("d/urdf/r.urdf", (), "d/private/a.stl", False),
    "hidden in meshes beside": ("d/urdf/r.urdf", (), "d/meshes/.a/a.stl", False),
    "meshes beside in home": ("urdf/r.urdf", (), "meshes/a.stl", False),
    "meshes beside a folder of another name": ("d/x/r.urdf", (), "d/meshes/a.stl", False),
    "downloads": ("Downloads/r.urdf", (), "Documents/a.stl", False),
    "dot env": ("d/r.urdf", ("d/package.xml",), "d/.env", False),
    "git": ("d/r.urdf", ("d/.git/",), "d/.git/config", False),
    "hidden folder": ("d/r.urdf", ("d/.git/",), "d/.cache/a.stl", False),
    "hidden below": ("d/r.urdf", (), "d/meshes/.a/b/c.stl", False),
    "in a cache": (".cache/d/r.urdf", (), ".cache/d/a.stl", True),
    "out of a cache": (".cache/d/r.urdf", (".git/",), "a.stl", False),
    "beside in a cache": (".cache/d/r.urdf", (), ".cache/e/a.stl", False),
    "mark above a cache": ("w/.cache/d/r.urdf", ("w/.git/",), "w/a.stl", False),
    "repository in a cache": (".cache/d/u/r.urdf", (".cache/d/.git/",), ".cache/d/m/a.stl", True),
    "library": (
        *("w/.venv/lib/site-packages/robots/urdf/r.urdf", ("w/.git/",)),
        *("w/.venv/lib/site-packages/robots/meshes/a.stl", True),
    ),
    "other library": (
        *("w/.venv/lib/site-packages/robots/urdf/r.urdf", ()),
        *("w/.venv/lib/site-packages/other/a.stl", False),
    ),
    "out of a library": (
        *("w/.venv/lib/site-packages/robots/r.urdf", ("w/.git/", "w/.venv/package.xml")),
        *("w/a.stl", False),
    ),
    "cmeel": (
        *("v/site-packages/cmeel.prefix/share/erd/robots/r/urdf/r.urdf", ()),
        *("v/site-packages/cmeel.prefix/share/erd/robots/s/a.stl", True),
    ),
    "beside in cmeel": (
        *("v/site-packages/cmeel.prefix/share/erd/robots/r.urdf", ()),
        *("v/site-packages/cmeel.prefix/share/other/a.stl", False),
    ),
}


@pytest.mark.parametrize("case", LAYOUTS.values(), ids=LAYOUTS)
def test_the_project_of_a_file(home, case):
    description, marks, file, is_read = case
    make(home, description, file, *marks)
    packages = Packages(home / description)
    assert (packages.access.explain_refusal(home / file) == "") == is_read
    if is_read:
        assert packages.workspace.read_bytes(home / file) == b"text"
        return
    with pytest.raises(AccessError, match="--trust") as caught:
        packages.access.check(home / file)
    assert str(home / file) in caught.value.message
    with pytest.raises(AccessRefused):
        packages.workspace.read_bytes(home / file)
    with pytest.raises(AccessError):
        packages.resolve(f"file://{home / file}")
    assert packages.workspace.get_size(home / file) is None
    assert packages.workspace.restrict(None).read_bytes(home / file) == b"text"


@pytest.mark.parametrize("case", LAYOUTS.values(), ids=LAYOUTS)
def test_trusted_input_reads_everything(home, monkeypatch, case):
    monkeypatch.setenv(TRUST, "1")
    description, marks, file, _ = case
    make(home, description, file, *marks)
    assert Packages(home / description).workspace.read_bytes(home / file) == b"text"


@pytest.mark.parametrize(
    "path", ["/etc/passwd", "/proc/self/environ", "/root/.ssh/id_rsa", "/", "/tmp", "/home", "a\0b"]
)
def test_system_files_are_refused(home, path):
    make(home, "d/r.urdf")
    assert Packages(home / "d/r.urdf").access.explain_refusal(path)


def test_a_file_without_a_project_says_how_to_name_its_folder(home):
    make(home, "arm_description/urdf/r.urdf", "arm_description/parts/a.stl")
    description = home / "arm_description/urdf/r.urdf"
    for uri in ("package://arm_description/parts/a.stl", "../parts/a.stl"):
        with pytest.raises(AccessError, match=r"--package arm_description=.*arm_description, or"):
            Packages(description).resolve(uri)
        named = {"arm_description": home / "arm_description"}
        assert Packages(description, named=named).resolve(uri).is_file()
        assert Packages(description, paths=[home]).resolve(uri).is_file()


def test_meshes_beside_are_not_read_through_a_link(home):
    make(home, "d/urdf/r.urdf", "private/a.stl")
    (home / "d/meshes").symlink_to(home / "private")
    with pytest.raises(AccessError):
        Packages(home / "d/urdf/r.urdf").resolve("../meshes/a.stl")


def test_packages_of_the_workspace_are_read(home):
    make(home, "ws/src/p/r.urdf", "ws/src/q/a.stl", "ws/src/q/.b.stl", "ws/src/c.stl")
    make(home, "ws/src/p/package.xml", content=PACKAGE.format("p"))
    make(home, "ws/src/q/package.xml", content=PACKAGE.format("q"))
    packages = Packages(home / "ws/src/p/r.urdf")
    assert packages.resolve("package://q/a.stl").is_file()
    assert Packages(packages.file).workspace.read_bytes(home / "ws/src/q/a.stl")
    for file in ("q/.b.stl", "c.stl"):
        assert packages.access.explain_refusal(home / "ws/src" / file)


@pytest.mark.parametrize("variable", ["ROS_PACKAGE_PATH", "AMENT_PREFIX_PATH", "SDF_PATH"])
def test_folders_of_the_environment_are_read(home, monkeypatch, variable):
    make(home, "d/r.urdf", "opt/share/q/a.stl")
    assert Packages(home / "d/r.urdf").access.explain_refusal(home / "opt/share/q/a.stl")
    monkeypatch.setenv(variable, str(home / "opt"))
    assert not Packages(home / "d/r.urdf").access.explain_refusal(home / "opt/share/q/a.stl")


def test_a_package_elsewhere_is_not_read_for_its_manifest(home):
    make(home, "d/p/r.urdf", "other/x/q/a.stl")
    make(home, "other/x/q/package.xml", content=PACKAGE.format("q"))
    make(home, "d/p/package.xml", content=PACKAGE.format("p"))
    assert Packages(home / "d/p/r.urdf").access.explain_refusal(home / "other/x/q/a.stl")


def test_a_folder_above_is_found_but_not_read_for_its_name(home):
    make(home, "d/r.urdf", "secret.yaml")
    packages = Packages(home / "d/r.urdf")
    for name in ("victim", "home"):
        packages.find(name)
        assert packages.access.explain_refusal(home / "secret.yaml")


FOREIGN = ["..", "../../Documents", "/etc", "sub/../..", ".hidden", "link"]


@pytest.mark.parametrize("folder", FOREIGN)
def test_a_configuration_that_came_along_names_only_its_project(home, folder):
    make(home, "d/.git/", "d/r.urdf", "d/.hidden/a", "Documents/a", "d/sub/a")
    (home / "d" / "link").symlink_to(home / "Documents")
    entry = ConfiguredFolder(home / "d" / folder, str(home / "d/urdftool.toml"), 7)
    packages = Packages(home / "d/r.urdf", configured={"x": entry})
    with pytest.raises(UrdftoolError, match=r"urdftool.toml:7.* --package x="):
        packages.find("x")
    assert packages.access.explain_refusal(home / "Documents/a")
    own = ConfiguredFolder(home / "d/sub", str(home / "d/urdftool.toml"), 7)
    assert Packages(home / "d/r.urdf", configured={"x": own}).find("x") == home / "d/sub"


def test_a_configuration_that_is_named_names_any_folder(home, urdftool):
    make(home, "d/.git/")
    make(home, "Documents/part.xacro", content=XACRO.format('<link name="part"/>'))
    make(
        home, "d/r.xacro", content=XACRO.format('<xacro:include filename="$(find x)/part.xacro"/>')
    )
    make(home, "d/urdftool.toml", content='\n[packages]\nx = "../Documents"\n')
    refused = urdftool("expand", home / "d/r.xacro")
    assert (refused.code, "urdftool.toml:3" in refused.err) == (2, True)
    found = urdftool("--config", home / "d/urdftool.toml", "expand", home / "d/r.xacro")
    assert found.code == 0
    assert "part" in found.out


LINKS = {
    "to a file": lambda d, out: (d / "a.stl").symlink_to(out / "a.stl"),
    "of two": lambda d, out: (
        (d / "b.stl").symlink_to(out / "a.stl"),
        (d / "a.stl").symlink_to(d / "b.stl"),
    ),
    "relative": lambda d, out: (d / "a.stl").symlink_to(os.path.relpath(out / "a.stl", d)),
}


@pytest.mark.parametrize("link", LINKS.values(), ids=LINKS)
def test_links_do_not_lead_out(home, link):
    make(home, "d/r.urdf", "out/a.stl")
    link(home / "d", home / "out")
    with pytest.raises(AccessError, match=f"a link to {home}/out/a.stl"):
        Packages(home / "d/r.urdf").resolve("a.stl")


def test_folders_that_are_links_do_not_lead_out(home):
    make(home, "d/r.urdf", "out/a.stl")
    (home / "d" / "meshes").symlink_to(home / "out")
    with pytest.raises(AccessError, match="a link to"):
        Packages(home / "d/r.urdf").resolve("meshes/a.stl")
    (home / "d" / "loop").symlink_to(home / "d" / "loop")
    assert not Packages(home / "d/r.urdf").workspace.is_file(home / "d/loop")


def test_links_inside_of_the_project_are_followed(home):
    make(home, "d/r.urdf", "d/b.stl")
    (home / "d" / "a.stl").symlink_to("b.stl")
    (home / "e").symlink_to(home / "d")
    assert Packages(home / "e/r.urdf").workspace.read_bytes(home / "e/a.stl") == b"text"


@pytest.mark.skipif(sys.platform == "win32", reason="there are no pipes with names")
@pytest.mark.parametrize("trust", ["", "1"])
@pytest.mark.parametrize("kind", ["pipe", "device", "link to a pipe"])
def test_devices_and_pipes_are_never_opened(home, monkeypatch, kind, trust):
    monkeypatch.setenv(TRUST, trust)
    make(home, "d/r.urdf")
    path = home / "d" / "a.stl"
    if kind == "device":
        path.symlink_to("/dev/zero")
    else:
        os.mkfifo(path if kind == "pipe" else home / "d" / "pipe")
        if kind != "pipe":
            path.symlink_to("pipe")
    packages = Packages(home / "d/r.urdf")
    with pytest.raises(AccessError, match="device or a pipe"):
        packages.resolve("a.stl")
    for files in (packages.workspace, Workspace()):
        with pytest.raises(OSError, match="device or a pipe"):
            files.read_bytes(path)
        with pytest.raises(OSError, match="device or a pipe"):
            files.materialize(path)
    with pytest.raises(OSError, match="device or a pipe"):
        require_companion(home / "d/b.obj", path)


def test_equal_policies_share_a_memo_and_others_do_not(home):
    make(home, "d/.git/", "d/a.urdf", "d/b.urdf", "e/c.urdf", "d/m.stl")
    files, computed = Workspace(), []

    def read(view):
        computed.append(view)
        try:
            return view.read_bytes(home / "d/m.stl")
        except OSError:
            return None

    named = {"p": home / "e"}
    views = [Packages(home / "d/a.urdf", named=named, workspace=files).workspace for _ in "12"]
    other = Packages(home / "e/c.urdf", workspace=files).workspace
    assert [view.memoize("m", read) for view in (other, *views)] == [None, b"text", b"text"]
    assert len(computed) == 2
    assert other.get_with_overlay({str(home / "x"): b""}).memoize("m", read) is None
    assert views[0].with_record().memoize("m", read) == b"text"


def test_companions_of_a_mesh_are_in_its_project(home):
    make(home, "d/.git/", "d/meshes/a.obj", "d/tex/a.mtl", "d/.env", "out/a.mtl")
    mesh = home / "d/meshes/a.obj"
    assert require_companion(mesh, home / "d/tex/a.mtl") == home / "d/tex/a.mtl"
    for name in ("out/a.mtl", "d/.env"):
        with pytest.raises(AccessRefused, match="--trust"):
            require_companion(mesh, home / name)


# What descriptions read, in every command -------------------------------------------------------

XACRO = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="r">{}</robot>'
URDF = (
    '<robot name="r"><link name="a"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" '
    'ixy="0" ixz="0" iyz="0"/></inertial><visual><geometry>{}</geometry>{}</visual><collision>'
    "<geometry>{}</geometry></collision></link>{}</robot>"
)
BOX = '<box size="1 1 1"/>'
SDF = (
    '<sdf version="1.10"><model name="r">{}<link name="a"><visual name="v"><geometry>{}</geometry>'
    "{}</visual></link></model></sdf>"
)
MJCF = "<mujoco>{}<worldbody><body><freejoint/><geom size='1' {}/></body></worldbody></mujoco>"
USDA = '#usda 1.0\n( {} )\ndef Xform "A" ( {} ) {{ {} }}\n'


def _mesh(uri):
    return URDF.format(f'<mesh filename="{uri}"/>', "", f'<mesh filename="{uri}"/>', "")


def _texture(uri):
    return URDF.format(BOX, f'<material name="m"><texture filename="{uri}"/></material>', BOX, "")


def _load(path):
    return XACRO.format(f"<link name=\"${{xacro.load_yaml('{path}')['key']}}\"/>")


# file, its content; OUT is a folder outside with secret files, UP is a relative path to it
ATTACKS = {
    "xacro yaml": ("r.xacro", _load("OUT/s.yaml")),
    "xacro yaml up": ("r.xacro", _load("UP/s.yaml")),
    "xacro yaml home": ("r.xacro", _load("$(find home)/victim/out/s.yaml")),
    "xacro yaml env": ("r.xacro", _load("HERE/.env.yaml")),
    "xacro yaml git": ("r.xacro", _load("HERE/.git/s.yaml")),
    "xacro include": ("r.xacro", XACRO.format('<xacro:include filename="OUT/s.xacro"/>')),
    "xacro wildcard": ("r.xacro", XACRO.format('<xacro:include filename="OUT/*.xacro"/>')),
    "xacro link": ("r.xacro", XACRO.format('<xacro:include filename="link.xacro"/>')),
    "mesh": ("r.urdf", _mesh("OUT/s.stl")),
    "mesh up": ("r.urdf", _mesh("UP/s.stl")),
    "mesh file": ("r.urdf", _mesh("file://OUT/s.stl")),
    "mesh localhost": ("r.urdf", _mesh("file://localhostOUT/s.stl")),
    "mesh encoded": ("r.urdf", _mesh("UP/%73.stl")),
    "mesh case": ("r.urdf", _mesh("UP/S.STL")),
    "mesh package": ("r.urdf", _mesh("package://home/victim/out/s.stl")),
    "mesh link": ("r.urdf", _mesh("link.stl")),
    "mesh folder link": ("r.urdf", _mesh("folder/s.stl")),
    "mesh git": ("r.urdf", _mesh(".git/s.stl")),
    "mesh no suffix": ("r.urdf", _mesh("OUT/secret")),
    "mesh in obj": ("r.urdf", _mesh("OUT/s.obj")),
    "mesh shadow": ("r.urdf", _mesh("/etc/shadow")),
    "mesh environ": ("r.urdf", _mesh("/proc/self/environ")),
    "texture": ("r.urdf", _texture("OUT/s.png")),
    "texture link": ("r.urdf", _texture("link.png")),
    "texture of obj": ("r.urdf", _mesh("mine.obj")),
    "texture of dae": ("r.urdf", _mesh("mine.dae")),
    "buffer of gltf": ("r.urdf", _mesh("mine.gltf")),
    "gazebo uri": ("r.urdf", URDF.format(BOX, "", BOX, "<gazebo><a>file://OUT/s.stl</a></gazebo>")),
    "sdf mesh": ("r.sdf", SDF.format("", "<mesh><uri>file://OUT/secret</uri></mesh>", "")),
    "sdf mesh up": ("r.sdf", SDF.format("", "<mesh><uri>UP/s.stl</uri></mesh>", "")),
    "sdf texture": (
        "r.sdf",
        SDF.format(
            "",
            "<box><size>1 1 1</size></box>",
            "<material><pbr><metal><albedo_map>OUT/s.png</albedo_map></metal></pbr></material>",
        ),
    ),
    "sdf include": (
        "r.sdf",
        SDF.format("<include><uri>OUT/secret</uri></include>", BOX, ""),
    ),
    "sdf include file": (
        "r.sdf",
        SDF.format("<include><uri>file://OUT/secret</uri></include>", BOX, ""),
    ),
    "sdf include model": (
        "r.sdf",
        SDF.format("<include><uri>model://../out</uri></include>", BOX, ""),
    ),
    "mjcf include": ("r.xml", MJCF.format("<include file='OUT/secret'/>", "")),
    "mjcf include up": ("r.xml", MJCF.format("<include file='UP/secret'/>", "")),
    "mjcf mesh": (
        "r.xml",
        MJCF.format("<asset><mesh name='m' file='OUT/s.stl'/></asset>", "type='mesh' mesh='m'"),
    ),
    "mjcf meshdir": (
        "r.xml",
        MJCF.format(
            "<compiler meshdir='UP'/><asset><mesh name='m' file='s.stl'/></asset>",
            "type='mesh' mesh='m'",
        ),
    ),
    "mjcf link": (
        "r.xml",
        MJCF.format("<asset><mesh name='m' file='link.stl'/></asset>", "type='mesh' mesh='m'"),
    ),
    "mjcf texture": (
        "r.xml",
        MJCF.format(
            "<asset><texture name='t' type='2d' file='OUT/s.png'/><material name='m' texture='t'/>"
            "</asset>",
            "material='m'",
        ),
    ),
    "mjcf model": ("r.xml", MJCF.format("<asset><model name='m' file='OUT/secret'/></asset>", "")),
    "usd sublayer": ("r.usda", USDA.format("subLayers = [@OUT/s.usda@]", "", "")),
    "usd reference": ("r.usda", USDA.format("", "references = @UP/s.usda@", "")),
    "usd payload": ("r.usda", USDA.format("", "payload = @OUT/s.usda@", "")),
    "usd link": ("r.usda", USDA.format("", "references = @link.usda@", "")),
    "usd chain": ("r.usda", USDA.format("", "references = @inner.usda@", "")),
    "usd secret": ("r.usda", USDA.format("subLayers = [@OUT/secret@]", "", "")),
}
COMMANDS = {
    "expand": ("expand", "FILE"),
    "lint": ("lint", "--no-cache", "--select", "all", "FILE"),
    "lint fix": ("lint", "--no-cache", "--diff", "--unsafe-fixes", "FILE"),
    "info": ("info", "FILE"),
    "graph": ("graph", "FILE"),
    "bundle": ("bundle", "FILE", "-o", "RESULT", "--force"),
    "export urdf": ("export", "urdf", "FILE", "-o", "RESULT/r.urdf", "--force"),
    "export sdf": ("export", "sdf", "FILE", "-o", "RESULT", "--force"),
    "export sdf classic": ("export", "sdf", "FILE", "-o", "RESULT", "--force", "--for", "classic"),
    "export mjcf": ("export", "mjcf", "FILE", "-o", "RESULT", "--force"),
    "export usd": ("export", "usd", "FILE", "-o", "RESULT/r.usda", "--force"),
    "inertia": ("inertia", "robot", "FILE"),
    "collision": ("collision", "FILE", "-o", "RESULT"),
    "view": ("view", "--picture", "RESULT.svg", "FILE"),
}
LIBRARIES = {".xml": "mujoco", ".usda": "pxr"}


def plant(home):
    """Write secret files outside of a project, and return the project with links to them."""
    out, here = home / "out", home / "d" / "project"
    make(home, "d/project/.git/")
    out.mkdir()
    tiny = make_stl(head=CANARY.encode())
    obj = f"# {CANARY}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
    picture = make_png() + CANARY.encode()
    for folder in (out, here / ".git"):
        (folder / "s.stl").write_bytes(tiny)
        (folder / "s.yaml").write_text(f"key: {CANARY}\n")
    (here / ".env.yaml").write_text(f"key: {CANARY}\n")
    (out / "s.obj").write_text(obj)
    (out / "s.png").write_bytes(picture)
    (out / "s.mtl").write_text(f"newmtl m\n# {CANARY}\nKd 1 0 0\n")
    (out / "s.bin").write_bytes(CANARY.encode().ljust(36))
    (out / "s.xacro").write_text(XACRO.format(f'<link name="{CANARY}"/>'))
    (out / "s.usda").write_text(f'#usda 1.0\ndef Xform "{CANARY.replace("-", "_")}" {{}}\n')
    (out / "secret").write_text(f"root:{CANARY}:0:0\n")
    for name in ("s.stl", "s.png", "s.xacro", "s.usda"):
        (here / f"link.{name[2:]}").symlink_to(out / name)
    (here / "folder").symlink_to(out)
    (here / "mine.obj").write_text(
        f"mtllib ../../out/s.mtl mine.mtl\nmtllib mine.mtl\n{obj.partition(chr(10))[2]}"
    )
    (here / "mine.mtl").write_text("newmtl m\nmap_Kd ../../out/s.png\n")
    (here / "mine.dae").write_text(
        DAE.format(
            '<library_images><image id="i"><init_from>../../out/s.png</init_from></image>'
            "</library_images>"
        )
    )
    (here / "mine.gltf").write_bytes(
        make_gltf(
            buffers=[{"byteLength": 36, "uri": "../../out/s.bin"}],
            images=[{"uri": "../../out/s.png"}],
        )
    )
    (here / "inner.usda").write_text(USDA.format("subLayers = [@../../out/s.usda@]", "", ""))
    return here


def list_contents(folder):
    return b"".join(path.read_bytes() for path in folder.rglob("*") if path.is_file())


def attack(home, urdftool, case, command):
    """Run a command on a hostile description; fail if anything secret comes out."""
    name, text = case
    here = plant(home)
    up = os.path.relpath(home / "out", here)
    for word, path in (("OUT", home / "out"), ("UP", up), ("HERE", here)):
        text = text.replace(word, str(path))
    (here / name).write_text(text)
    result = home / "result"
    result.mkdir()
    words = {"FILE": str(here / name)}
    arguments = [words.get(w, w.replace("RESULT", str(result / "r"))) for w in command]
    done = urdftool(*arguments)
    secret = CANARY.encode(), CANARY.replace("-", "_").encode()
    assert done.code in (0, 1, 2), done.err
    assert "bug in urdftool" not in done.out + done.err
    written = list_contents(result) + (done.out + done.err).encode()
    assert not any(one in written for one in secret)
    assert not [path for path in result.rglob("*") if path.is_symlink()]
    return done


def _is_slow(number, title, name):
    """Tell whether a pair is left to the long run; each attack is in an eighth of the commands."""
    return title not in ("lint", "export urdf") and list(ATTACKS).index(name) % 8 != number % 8


PAIRS = [
    pytest.param(
        *(ATTACKS[name], command),
        id=f"{title}-{name}",
        marks=[pytest.mark.slow] * _is_slow(number, title, name),
    )
    for number, (title, command) in enumerate(COMMANDS.items())
    for name in ATTACKS
]


@pytest.mark.parametrize(("case", "command"), PAIRS)
def test_nothing_foreign_comes_out(home, urdftool, monkeypatch, case, command):
    library = LIBRARIES.get(Path(case[0]).suffix)
    if library is not None and not is_installed(library):
        pytest.skip(f"requires {library}")
    monkeypatch.chdir(home)
    attack(home, urdftool, case, command)


UNNAMED = {
    *("gazebo uri", "mesh localhost", "mesh encoded", "mesh case", "sdf include model"),
    *("texture of obj", "texture of dae", "buffer of gltf", "sdf texture"),
}
"""Attacks that name no file, or one that lint does not open."""


@pytest.mark.parametrize("name", [name for name in ATTACKS if name not in UNNAMED])
def test_the_message_says_why(home, urdftool, monkeypatch, name):
    library = LIBRARIES.get(Path(ATTACKS[name][0]).suffix)
    if library is not None and not is_installed(library):
        pytest.skip(f"requires {library}")
    monkeypatch.chdir(home)
    done = attack(home, urdftool, ATTACKS[name], COMMANDS["lint"])
    assert done.code in (1, 2) or "not checked: mesh" in done.err
    assert "--trust" in done.out + done.err
