"""Links that came with a project: no output and no message follows them out of it."""

import os
import sys

import pytest

from tests.hostile.writers import ROBOT, WRITERS, contents, is_slow, robot, words

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="needs symbolic links")

SECRET = "qX7outside = qX7secret"
NAMES = [pytest.param(n, marks=[pytest.mark.slow] if is_slow(n) else []) for n in WRITERS]


@pytest.fixture
def place(tmp_path, monkeypatch):
    """A project, and a folder beside it that its links lead to."""
    monkeypatch.delenv("URDFTOOL_TRUST", raising=False)
    home = tmp_path / "home" / "user"
    for name in ("outside", "folder"):
        (home / name).mkdir(parents=True)
    monkeypatch.setenv("HOME", str(home))
    (home / "outside" / "a").write_text(SECRET)
    robot(home / "project")
    monkeypatch.chdir(home / "project")
    return home / "project"


def look(place):
    return contents(place.parent / "outside")


@pytest.mark.parametrize("kind", ["file", "folder"])
@pytest.mark.parametrize("name", NAMES)
def test_an_output_that_is_a_link_out(name, kind, place, urdftool):
    target = WRITERS[name][1]
    if kind == "file":
        (place / target).symlink_to("../outside" + ("/a" if "." in target else ""))
    else:
        (place / "out").symlink_to("../outside")
        target = f"out/{target}"
    before = look(place)
    done = urdftool(*words(name, target))
    assert done.code == 2
    assert "outside of its project" in done.err
    assert str(place.parent / "outside") in done.err
    assert look(place) == before


def test_an_output_that_is_a_link_within_the_project(place, urdftool):
    (place / "deep").mkdir()
    (place / "a.urdf").symlink_to("deep/b.urdf")
    assert urdftool("expand", "r.xacro", "-o", "a.urdf").code == 0
    assert (place / "deep" / "b.urdf").is_file()


@pytest.mark.parametrize("target", [".git/hooks/pre-commit", ".git", ".hidden/a"])
def test_a_link_to_what_is_hidden_in_the_project(target, place, urdftool):
    hook = place / ".git" / "hooks" / "pre-commit"
    hook.parent.mkdir(parents=True)
    hook.write_text("true\n")
    (place / ".hidden").mkdir()
    (place / "out").symlink_to(target)
    name = "out/config" if target == ".git" else "out"
    done = urdftool("inertia", "robot", "r.urdf", "-o", name)
    assert done.code == 2
    assert "hidden" in done.err
    assert hook.read_text() == "true\n"
    assert not (place / ".git" / "config").exists()


def test_the_manifest_of_a_bundle_that_is_a_link_is_not_read(place, urdftool):
    (place / "b").mkdir()
    (place / "b" / "bundle.json").symlink_to("/dev/zero")
    assert urdftool("bundle", "r.urdf", "-o", "b").code == 2


@pytest.mark.parametrize("is_repository", [True, False])
def test_the_package_beside_a_repository_is_not_read(is_repository, place, urdftool):
    for name in ("project", "outside"):
        package = f"<package><name>{name}</name></package>"
        (place.parent / name / "package.xml").write_text(package)
    if is_repository:
        (place / ".git").mkdir()
    work = place.parent / "work"
    work.mkdir()
    for name in ("project", "outside"):
        (place.parent / name).rename(work / name)
    link = "<link name=\"${xacro.load_yaml('$(find outside)/a')}\"/>"
    xacro = f'<robot name="r" xmlns:xacro="x">{link}</robot>'
    file = work / "project" / "y.xacro"
    file.write_text(xacro.replace('"x"', '"http://www.ros.org/wiki/xacro"'))
    done = urdftool("expand", str(file))
    assert ("qX7" in done.out) is not is_repository
    assert done.code == (2 if is_repository else 0)


def test_a_link_of_the_user_in_the_home_folder(place, urdftool):
    (place.parent / "link").symlink_to("outside")
    target = place.parent / "link" / "r.urdf"
    assert urdftool("expand", "r.xacro", "-o", str(target)).code == 0
    assert (place.parent / "outside" / "r.urdf").is_file()


@pytest.mark.parametrize(
    "words",
    [
        ("collision", "r.urdf", "--in-place", "--method", "hull", "--no-cache", "-j", "1"),
        ("export", "mjcf", "r.urdf", "-o", "x.xml", "--force", "--mesh-dir", "collision"),
        ("export", "sdf", "r.urdf", "-o", "x.sdf", "--force"),
        ("bundle", "r.urdf", "-o", "b", "--overwrite"),
    ],
)
def test_companions_are_not_written_through_a_folder(words, place, urdftool):
    for name in ("collision", "meshes", "assets"):
        (place / name).symlink_to("../outside")
    (place / "b").mkdir()
    (place / "b" / "meshes").symlink_to("../../outside")
    before = look(place)
    urdftool(*words)
    assert look(place) == before


def test_a_fix_through_a_link(place, urdftool):
    bad = ROBOT.replace('xyz="0 1 0"/>', 'xyz="0 2 0"/>')
    (place.parent / "outside" / "r.urdf").write_text(bad)
    (place / "r.urdf").unlink()
    (place / "r.urdf").symlink_to("../outside/r.urdf")
    before = look(place)
    done = urdftool("lint", "r.urdf", "--fix", "--unsafe-fixes")
    assert look(place) == before
    assert done.code == 2


@pytest.mark.parametrize("name", ["urdftool.toml", ".urdftool.toml", "pyproject.toml"])
@pytest.mark.parametrize("command", ["lint", "info", "expand"])
def test_a_configuration_that_is_a_link_out_is_not_quoted(name, command, place, urdftool):
    (place / name).symlink_to("../outside/a")
    done = urdftool(command, "r.xacro")
    assert "qX7" not in done.out + done.err
    assert done.code == 2
    assert "--config" in done.err


def test_a_folder_that_is_a_link_out_has_no_configuration(place, urdftool):
    """A folder of robots in a workspace is often a link; what is not there is not refused."""
    robots = place.parent / "outside" / "robots"
    robots.mkdir()
    (place / "r.urdf").rename(robots / "r.urdf")
    (place / "robots").symlink_to("../outside/robots")
    assert urdftool("info", "robots/r.urdf").code == 0
    (robots / "urdftool.toml").write_text("[lint]\n")
    done = urdftool("info", "robots/r.urdf")
    assert done.code == 2
    assert "--config" in done.err


@pytest.mark.parametrize("suffix", [".urdf", ".xacro", ".sdf", ".xml", ".usda"])
@pytest.mark.parametrize("command", ["lint", "info", "verify", "expand"])
def test_a_description_that_is_a_link_out_of_the_repository(suffix, command, place, urdftool):
    (place / ".git").mkdir()
    (place / f"link{suffix}").symlink_to("../outside/a")
    given = [f"link{suffix}", "r.urdf"] if command == "verify" else [f"link{suffix}"]
    done = urdftool(command, *given)
    assert "qX7" not in done.out + done.err
    assert done.code in (1, 2)
    assert "outside" in done.out + done.err


def test_an_installed_link_to_the_sources_is_read(place, urdftool):
    """As `colcon build --symlink-install` makes them."""
    share = place.parent / "install" / "share" / "p"
    share.mkdir(parents=True)
    (share / "package.xml").write_text("<package><name>p</name></package>")
    (share / "r.urdf").symlink_to(place / "r.urdf")
    assert urdftool("info", str(share / "r.urdf")).code == 0


def test_licenses_around_the_project_are_not_copied(place, urdftool):
    home = place.parent
    (home / ".git").mkdir()
    (home / "package.xml").write_text("<package><name>p</name><license>qX7</license></package>")
    (home / "LICENSE").write_text("qX7secret")
    done = urdftool("bundle", "r.urdf", "-o", "b")
    assert done.code == 0, done.err
    written = contents(place / "b")
    assert not any(b"qX7" in data for data in written.values())
    assert not any("LICENSE" in os.path.basename(name) for name in written)
