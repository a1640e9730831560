"""The page without a browser: a real server that nobody looks at."""

import os

import pytest

from urdftool.api.lint import check
from urdftool.drawing.shapes import read_robot_shapes
from urdftool.errors import ModelError
from urdftool.model.kinematics import add_mimic_positions, link_poses
from urdftool.model.load import load
from urdftool.model.pair_pose import PairPose
from urdftool.model.pose import Pose, rotation_from_quaternion
from urdftool.viewer import server

from .robots import ARM, chain, joint, limit, link, read, urdf
from .serving import free_port

pytest.importorskip("viser")


@pytest.fixture(scope="module")
def running():
    running = server.start("127.0.0.1", free_port(), server.make_token(), lambda: "t")
    yield running
    running.stop()


@pytest.fixture
def show(running, tmp_path):
    """Put the text of a robot on a page; gives the page and its file."""
    from urdftool.viewer.page import Page, require_viewable

    def put(text, **options):
        path = tmp_path / "r.urdf"
        path.write_text(text, "utf-8")
        running.gui.reset()
        running.scene.reset()
        page = Page(
            running,
            require_viewable(load(path)),
            lambda: load(path),
            lambda robot, kind: read_robot_shapes(robot, show=kind),
            options.pop("check", None),
            **options,
        )
        return page, path

    return put


def seen_poses(page):
    """Where the scene has each link, from its nodes alone."""
    found = {}
    for name, path in page.body._paths.items():
        parts = path.split("/")[1:]
        pose = Pose()
        for depth in range(1, len(parts) + 1):
            node = page.server.scene.get_handle_by_name("/" + "/".join(parts[:depth]))
            turn = rotation_from_quaternion(tuple(node.wxyz))
            pose = pose @ Pose(turn, tuple(node.position))
        found[name] = pose
    return found


def same(one, other):
    flat = [[*p.translation, *(v for row in p.rotation for v in row)] for p in (one, other)]
    return flat[0] == pytest.approx(flat[1], abs=1e-6)


def rewrite(path, text):
    """Write a file so that a watch sees it, and give the watch its two looks."""
    path.write_text(text, "utf-8")
    state = os.stat(path)
    os.utime(path, ns=(state.st_atime_ns, state.st_mtime_ns + 5_000_000))


def tend(page):
    for _ in range(3):
        page.poll()


def test_links_are_where_the_joints_put_them(show):
    page, _ = show(ARM)
    for wanted in ({}, {"shoulder": 0.7, "elbow": -2.0}, {"grip": 0.03}, {"shoulder": 0.0}):
        page.joints.move(wanted)
        positions = add_mimic_positions(page.robot, {**page.joints.positions})
        wanted_poses = link_poses(page.robot, positions)
        assert all(same(pose, wanted_poses[name]) for name, pose in seen_poses(page).items())
    assert page.joints.positions["grip_mirror"] == -0.03


def test_only_what_moves_is_sent(show):
    page, _ = show(chain(20))
    assert page.body.move({**page.joints.positions, "j3": 0.5}) == 1
    assert page.body.move({**page.joints.positions, "j3": 0.5}) == 0


def test_a_slider_moves_its_joint_within_the_limits(show):
    page, _ = show(ARM)
    handle = page.joints._handles["shoulder"]
    handle.value = 99.0
    page.joints._handle_slider(page.joints.sliders[0])
    assert page.joints.positions["shoulder"] == 1.25
    assert (handle.min, handle.max) == (-1.5, 1.25)
    assert handle.label == "shoulder 72°"


@pytest.mark.parametrize(("where", "shoulder"), [("zero", 0), ("lower", -1.5), ("upper", 1.25)])
def test_buttons(show, where, shoulder):
    page, _ = show(ARM)
    page.joints.move({"shoulder": 0.3, "grip": 0.01})
    page.joints.put(where)
    positions = page.joints.positions
    assert positions["shoulder"] == shoulder
    assert positions["grip_mirror"] == -positions["grip"]


def test_random_stays_within_the_limits(show):
    page, _ = show(ARM)
    for _ in range(20):
        page.joints.put("random")
        assert -1.5 <= page.joints.positions["shoulder"] <= 1.25
        assert 0 <= page.joints.positions["grip"] <= 0.04


def test_the_pose_to_begin_with(show):
    page, _ = show(ARM, start={"shoulder": 1.4, "elbow": 1.0})
    assert page.joints.positions["shoulder"] == 1.4
    assert page.joints._handles["shoulder"].value == 1.4


def test_what_is_shown_is_made_once_and_hidden(show):
    page, _ = show(ARM)
    assert "collision" not in page.body.shapes
    for kind in ("collision", "frames", "names", "axes", "com", "inertia"):
        page._boxes[kind].value = True
        page.refresh(kind)
        first = page.body._nodes[kind]
        assert all(node.visible for _, node in first)
        page._boxes[kind].value = False
        page.refresh(kind)
        assert page.body._nodes[kind] is first
        assert not any(node.visible for _, node in first)
    assert len(page.body._nodes["frames"]) == 5
    assert len(page.body._nodes["axes"]) == 4


def test_visuals_are_seen_through_also_after_a_reload(show):
    page, path = show(ARM)
    opacities = lambda: {node.opacity for _, node in page.body._nodes["visual"]}  # noqa: E731
    assert opacities() == {None}
    page._clear_box.value = True
    page._clear()
    assert opacities() == {0.35}
    rewrite(path, ARM.replace('name="arm"', 'name="b"'))
    tend(page)
    assert opacities() == {0.35}
    page._clear_box.value = False
    page._clear()
    assert opacities() == {None}
    assert not page._banner.visible


def test_a_link_is_chosen(show):
    page, _ = show(ARM)
    page.select("upper")
    (_name, mesh) = next(pair for pair in page.body._nodes["visual"] if pair[0] == "upper")
    assert tuple(mesh.color) == (255, 196, 0)
    assert page._chooser.value == "upper"
    assert "shoulder" in page._one.content
    assert "−85.9°" in page._one.content
    page._chooser.value = "none"
    page._handle_choice()
    assert tuple(mesh.color) != (255, 196, 0)
    assert "Click a link" in page._one.content


def test_a_change_is_read_and_the_pose_kept(show):
    page, path = show(ARM)
    page.joints.move({"shoulder": 0.5, "elbow": 2.0})
    page.select("upper")
    rewrite(path, ARM.replace('name="arm"', 'name="better"').replace("1.25", "0.25"))
    tend(page)
    assert page.title.startswith("better")
    assert page.joints.positions["elbow"] == 2.0
    assert page.joints.positions["shoulder"] == 0.25  # the limit is narrower now
    assert page._selected == "upper"
    assert all(
        same(pose, link_poses(page.robot, page.joints.positions)[name])
        for name, pose in seen_poses(page).items()
    )


def test_a_broken_file_is_said_and_the_robot_stays(show):
    page, path = show(ARM)
    page.joints.move({"shoulder": 0.5})
    robot = page.robot
    rewrite(path, ARM.replace("</robot>", ""))
    tend(page)
    assert page.robot is robot
    assert page._banner.visible
    assert "r.urdf" in page._banner.content
    rewrite(path, "")
    tend(page)
    assert page._banner.visible
    path.unlink()
    tend(page)
    assert "no such file" in page._banner.content
    rewrite(path, urdf(name="empty"))
    tend(page)
    assert "the robot has no links" in page._banner.content
    rewrite(path, ARM)
    tend(page)
    assert not page._banner.visible
    assert page.robot is not robot
    assert page.joints.positions["shoulder"] == 0.5


def test_a_mesh_that_comes_is_seen(show, tmp_path):
    from tests.conftest import FIXTURES

    mesh = '<visual><geometry><mesh filename="cube.stl"/></geometry></visual>'
    page, _ = show(urdf(link("a", mesh)))
    assert "there is no such mesh file" in page._notices.content
    assert page._notices.visible
    (tmp_path / "cube.stl").write_bytes((FIXTURES / "meshes" / "cube.stl").read_bytes())
    tend(page)
    assert not page._notices.visible
    assert len(page.body._nodes["visual"]) == 1


def test_findings_are_listed_and_marked(show):
    text = ARM.replace('<link name="upper">', '<link name="upper"><inertial/>')
    page, _ = show(text, check=check, shown=("visual", "errors"))
    assert "linting" in page._list.content
    tend(page)
    assert "incomplete-inertial" in page._list.content
    assert "upper" in {name for name, _ in page.body._nodes["errors"]}
    assert not page._banner.visible


def test_joints_that_come_and_go(show):
    page, path = show(ARM)
    rewrite(path, urdf(link("only")))
    tend(page)
    assert page.joints.sliders == ()
    assert page.joints._none.visible
    rewrite(path, chain(3))
    tend(page)
    assert [slider.name for slider in page.joints.sliders] == ["j0", "j1", "j2"]
    assert not page.joints._none.visible


def test_three_hundred_joints(show):
    page, _ = show(chain(300))
    assert len(page.joints.sliders) == 300
    page.joints.put("upper")
    poses = link_poses(page.robot, page.joints.positions)
    assert same(seen_poses(page)["l300"], poses["l300"])


@pytest.mark.parametrize(
    "name", ["/", "a/b", "", " ", "<b>x</b>", "{1+1}", "x" * 5000, "ünï\u202e"]
)
def test_any_name(show, name):
    from xml.sax.saxutils import quoteattr

    quoted = quoteattr(name)
    text = (
        f"<robot name={quoted}><link name={quoted}/><link name='tip'/>"
        f"<joint name={quoted} type='continuous'><parent link={quoted}/><child link='tip'/></joint>"
        "</robot>"
    )
    page, _ = show(text)
    page.joints.put("upper")
    page.select(name)
    assert not page._banner.visible


def test_broken_trees(show):
    twins = urdf(link("a"), link("a"), link("b"), joint("j", "fixed", "a", "b"),
                 joint("j", "revolute", "a", "b", limit(0, 1)), joint("k", "fixed", "x", "y"),
                 link("c"), link("d"), joint("p", "fixed", "c", "d"),
                 joint("q", "fixed", "d", "c"))  # fmt: skip
    page, _ = show(twins)
    assert "is not connected to the root" in page._notices.content
    assert set(page.body.links) == {"a", "b"}


def test_numbers_that_are_none(show):
    text = urdf(
        link("a"), link("b", '<visual><geometry><box size="nan 1 inf"/></geometry></visual>'),
        joint("j", "revolute", "a", "b", '<axis xyz="nan 0 0"/>' + limit(-1, 1), xyz="inf 0 nan"),
    )  # fmt: skip
    page, _ = show(text)
    page.joints.put("upper")
    for kind in ("collision", "frames", "names", "axes", "com", "inertia"):
        page._boxes[kind].value = True
        page.refresh(kind)
    assert not page._banner.visible


def test_a_loop_is_refused(tmp_path):
    from urdftool.viewer.page import require_viewable

    loop = urdf(link("a"), link("b"), joint("j", "fixed", "a", "b"), joint("k", "fixed", "b", "a"))
    with pytest.raises(ModelError, match="no root link"):
        require_viewable(read(tmp_path / "r.urdf", loop))


def test_what_fails_is_said_and_the_page_goes_on(show):
    page, _ = show(ARM)

    def fail():
        raise ZeroDivisionError("oh")

    page._run_safely(fail)
    assert "Bug in urdftool" in page._banner.content
    page.joints.put("upper")
    assert page.joints.positions["shoulder"] == 1.25


def test_a_chosen_pair_moves_the_robot_to_its_contact(show):
    pair = PairPose("base", "lower", {"shoulder": 0.7, "elbow": -2.0}, "Never")
    page, path = show(ARM, compare=lambda robot: [pair])
    page.joints.move({"grip": 0.03})
    tend(page)
    (label,) = page._pairs.labels
    assert page._chooser.value == "none"
    page._pairs.choose(label)
    assert page.joints.positions["shoulder"] == pytest.approx(0.7)
    assert page.joints.positions["elbow"] == pytest.approx(-2.0)
    assert page.joints.positions["grip"] == 0  # joints that do not move the pair are at zero
    rewrite(path, ARM.replace("thumb", "second"))
    page._compare = lambda robot: []
    tend(page)
    tend(page)
    assert page._pairs.labels == ()


def test_an_srdf_that_cannot_be_read_is_reported_on_the_page(show):
    def compare(robot):
        raise ModelError("the SRDF is of another robot")

    page, _ = show(ARM, compare=compare)
    tend(page)
    assert "of another robot" in page._pairs._text.content
