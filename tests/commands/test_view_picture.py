"""``urdftool view --picture`` and ``--contact-sheet``."""

import os
from io import BytesIO

import numpy as np
import pytest

from urdftool.drawing.contact_sheet import choose_layout

LINK = (
    '<link name="{0}"><visual><geometry>{1}</geometry></visual>'
    '<collision><geometry><sphere radius="0.4"/></geometry></collision></link>'
)
BOX = '<box size="0.2 0.2 0.6"/>'
JOINT = (
    '<joint name="{0}" type="{1}"><parent link="a"/><child link="{2}"/><origin xyz="0 0.5 0.2"/>'
    '<axis xyz="1 0 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>'
)
ROBOT = '<robot name="r">\n' + LINK.format("a", BOX) + "\n{}</robot>\n"
ARM = ROBOT.format(LINK.format("b", BOX) + JOINT.format("j", "revolute", "b"))


def pixels(path):
    from PIL import Image

    with open(path, "rb") as file:
        return np.asarray(Image.open(BytesIO(file.read())).convert("RGB"))


def test_a_picture_is_written(urdftool, write):
    path = write("r.urdf", ARM)
    done = urdftool("view", path, "--picture", "p.png", "--size", "160x120")
    assert (done.code, done.out) == (0, "")
    assert "p.png" in done.err
    assert pixels("p.png").shape == (120, 160, 3)
    assert urdftool("-q", "view", path, "--picture", "p.png").err == ""
    assert pixels("p.png").shape == (960, 1280, 3)


def test_a_picture_is_the_same_each_time(urdftool, write):
    path = write("r.urdf", ARM)
    for name in ("p.png", "q.png"):
        urdftool("view", path, "--picture", name, "--size", "80x60")
    with open("p.png", "rb") as one, open("q.png", "rb") as other:
        assert one.read() == other.read()


def test_pose_camera_and_show_change_it(urdftool, write):
    path = write("r.urdf", ARM)
    choices = ((), ("--pose", "j=0.9"), ("--camera", "90,10"), ("--camera", "0,0,9"),
               ("--show", "collision"), ("--show", "both"))  # fmt: skip
    seen = set()
    for choice in choices:
        done = urdftool("view", path, "--picture", "p.png", "--size", "80x60", *choice)
        assert done.code == 0, done.err
        seen.add(pixels("p.png").tobytes())
    assert len(seen) == len(choices)


def test_a_contact_sheet_and_a_picture_at_once(urdftool, write):
    path = write("r.urdf", ARM)
    done = urdftool("view", path, "--picture", "p.png", "--contact-sheet", "s.png",
                    "--size", "64x48")  # fmt: skip
    assert done.code == 0, done.err
    layout = choose_layout(1, (64, 48))
    assert pixels("s.png").shape == (layout.height, layout.width, 3)


def test_a_pose_beyond_a_limit_is_said(urdftool, write):
    path = write("r.urdf", ARM)
    for value, count in (("0.5", 0), ("50", 1)):
        done = urdftool(
            "view", path, "--picture", "p.png", "--size", "80x60", "--pose", f"j={value}"
        )
        assert done.code == 0, done.err
        assert done.err.count(f"joint 'j' at {value} is beyond its limits, ") == count


def test_no_joint_moves(urdftool, write):
    path = write("r.urdf", ROBOT.format(""))
    done = urdftool("view", path, "--contact-sheet", "s.png")
    assert done.code == 2
    assert "r.urdf:1:1: no joint" in done.err
    assert not os.path.exists("s.png")


def test_a_missing_mesh_is_said_and_the_rest_drawn(urdftool, write):
    mesh = '<mesh filename="gone.stl"/>'
    path = write("r.urdf", ROBOT.format(LINK.format("b", mesh) + JOINT.format("j", "fixed", "b")))
    done = urdftool("view", path, "--picture", "p.png", "--size", "80x60")
    assert done.code == 1
    assert "r.urdf:3:" in done.err
    assert "gone.stl" in done.err
    assert pixels("p.png").shape == (60, 80, 3)


def test_nothing_to_draw(urdftool, write):
    path = write("r.urdf", '<robot name="r"><link name="a"/></robot>')
    done = urdftool("view", path, "--picture", "p.png")
    assert done.code == 2
    assert "r.urdf:1:1: the robot has no visual" in done.err
    assert not os.path.exists("p.png")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--size", "12"), "WIDTHxHEIGHT"),
        (("--size", "0x5"), "WIDTHxHEIGHT"),
        (("--size", "99999x99999"), "WIDTHxHEIGHT"),
        (("--camera", "1"), "AZIMUTH,ELEVATION"),
        (("--camera", "1,nan"), "AZIMUTH,ELEVATION"),
        (("--camera", "1,91"), "91"),
        (("--camera", "1,2,0"), "0 m"),
        (("--pose", "j"), "JOINT=VALUE"),
        (("--pose", "j=x"), "JOINT=VALUE"),
        (("--pose", "j=1", "--pose", "j=2"), "given twice"),
        (("--pose", "jj=1"), "did you mean 'j'"),
        (("--show", "inertia"), "inertia"),
    ],
)
def test_wrong_words_are_refused(urdftool, write, words, said):
    path = write("r.urdf", ARM)
    done = urdftool("view", path, "--picture", "p.png", *words)
    assert done.code == 2
    assert said in done.err
    assert not os.path.exists("p.png")


@pytest.mark.parametrize("name", ["p.jpg", "r.urdf/p.png"])
def test_files_that_cannot_be_written_are_refused_first(urdftool, write, name):
    path = write("r.urdf", ARM)
    for option in ("--picture", "--contact-sheet"):
        assert urdftool("view", path, option, name).code == 2


def test_an_input_is_not_harmed(urdftool, write):
    path = write("r.png", ARM)
    done = urdftool("view", path, "--picture", "r.png")
    assert done.code == 2
    with open("r.png", encoding="utf-8") as file:
        assert file.read() == ARM


def test_a_sheet_beyond_all_measure_is_refused(urdftool, write):
    joints = "".join(
        LINK.format(f"b{n}", BOX) + JOINT.format(f"j{n}", "revolute", f"b{n}") for n in range(5)
    )
    path = write("r.urdf", ROBOT.format(joints))
    done = urdftool("view", path, "--contact-sheet", "s.png", "--size", "4096x4096")
    assert done.code == 2
    assert "smaller --size" in done.err


def test_links_in_a_loop_are_said_and_the_rest_drawn(urdftool, write):
    loop = "".join(
        JOINT.format(name, "fixed", child).replace('link="a"', f'link="{parent}"')
        for name, parent, child in (("p", "b", "c"), ("q", "c", "b"))
    )
    path = write("r.urdf", ROBOT.format(LINK.format("b", BOX) + LINK.format("c", BOX) + loop))
    done = urdftool("view", path, "--picture", "p.png", "--size", "80x60")
    assert done.code == 1
    assert "link 'b' is not connected" in done.err
    assert pixels("p.png").shape == (60, 80, 3)


FAULTY = ARM.replace('lower="-1" upper="1"', 'lower="1" upper="-1"')


@pytest.mark.library("PIL")
def test_findings_color_their_links_and_have_labels(urdftool, write, tmp_path):
    path = write("r.urdf", FAULTY)
    for name, more in (("plain", ()), ("findings", ("--findings",))):
        target = tmp_path / f"{name}.png"
        assert urdftool("view", path, "--picture", target, "--size", "400x300", *more).code == 0
    plain, drawn = pixels(tmp_path / "plain.png"), pixels(tmp_path / "findings.png")
    assert plain.shape == drawn.shape

    def count_red(image):
        red, green, blue = (image[..., k].astype(int) for k in range(3))
        return int(np.count_nonzero((red > green + 60) & (red > blue + 60)))

    assert count_red(plain) == 0
    assert count_red(drawn) > 300, "the link of the joint, its label and the line between them"


@pytest.mark.parametrize("more", [(), ("--contact-sheet", "s.png")])
def test_findings_require_a_picture(urdftool, write, more):
    result = urdftool("view", write("r.urdf", ARM), "--findings", *more)
    assert result.code == 2
    assert "--findings requires --picture" in result.err
