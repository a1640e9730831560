"""What is seen, against closed forms."""

import math
import subprocess
import sys

import numpy as np
import pytest

from urdftool.drawing.camera import Camera
from urdftool.drawing.picture import draw
from urdftool.drawing.png_file import encode_png
from urdftool.drawing.shapes import make_bare_shapes, read_robot_shapes
from urdftool.geometry.tessellate import tessellate
from urdftool.model.kinematics import link_poses
from urdftool.model.pose import IDENTITY, Pose

from .robots import BOX, MAGENTA, front_view, joint, link, mask, middle, read, seen, visual

RED = (0.9, 0.1, 0.1, 1.0)


def one(kind, size, rgba=RED):
    return make_bare_shapes([(*tessellate(kind, size), rgba)])


def picture(shapes, view=None, pose=IDENTITY, **more):
    more = {"ground": False, "background": MAGENTA, **more}
    return draw(shapes, {"": pose}, camera=view or front_view(), **more)


def coverage(shapes, view):
    """Area that is seen, in pixels, with parts of pixels: from a white shape before black."""
    image = draw(
        shapes.with_colors(np.tile([1.0, 0.0, 0.0, 1.0], (len(shapes), 1))), {"": IDENTITY},
        camera=view, ground=False, background=(0.0, 0.0, 1.0),
    )  # fmt: skip
    blue = (image[..., 2] / 255.0) ** 2.2
    return (1 - blue / blue.max()).sum()


@pytest.mark.parametrize(
    ("kind", "size", "area"),
    [
        ("box", (1.0, 1.2, 0.8), 1.2 * 0.8),
        ("sphere", (0.7,), math.pi * 0.49),
        ("cylinder", (0.4, 1.0), 0.8),
        ("capsule", (0.3, 0.8), 0.6 * 0.8 + math.pi * 0.09),
    ],
)
def test_a_silhouette_has_its_area(kind, size, area):
    # the plane of the picture is at the origin, 100 pixels a metre, seen from a kilometre
    found = coverage(one(kind, size), front_view()) / 100**2
    assert found == pytest.approx(area, rel=0.012)


def test_a_box_covers_exactly_its_pixels():
    there = mask(picture(one("box", (0.2, 1.0, 0.5)), front_view(distance=1e6)))
    rows, columns = np.nonzero(there)
    assert (rows.min(), rows.max(), columns.min(), columns.max()) == (75, 124, 50, 149)
    assert there[75:125, 50:150].all()


def test_perspective_is_the_pinhole_s():
    cube = one("box", (1.0, 1.0, 1.0))
    camera = Camera(0.0, 0.0, distance=3.0, target=(0, 0, 0), field_of_view=2 * math.atan(0.5))
    there = mask(picture(cube, camera, size=(300, 300)))
    # the near face is 2.5 m away, where 2.5 m are 300 pixels
    rows, columns = np.nonzero(there)
    assert columns.max() - columns.min() + 1 == pytest.approx(120, abs=1)
    assert rows.max() - rows.min() + 1 == pytest.approx(120, abs=1)


def test_the_colour_is_that_of_the_material(tmp_path):
    for rgba, strongest in (("1 0 0 1", 0), ("0 1 0 1", 1), ("0 0 1 1", 2)):
        pixel = seen(read(tmp_path, link("a", visual(rgba=rgba))))[100, 100].astype(int)
        assert np.argmax(pixel) == strongest
        assert pixel[strongest] > 150
        assert np.delete(pixel, strongest).max() < 90


def test_brighter_towards_the_light():
    view = Camera(math.radians(-40), math.radians(30))
    image = picture(one("sphere", (1.0,), (0.6, 0.6, 0.6, 1)), view, size=(200, 200)).astype(int)
    there = mask(image)
    left = image[..., 0] * there
    assert left[60, 80] > left[150, 130] + 20
    assert left[there].max() <= 255


@pytest.mark.parametrize("x", [0.6, -0.6])
def test_what_is_nearer_is_in_front(tmp_path, x):
    robot = read(
        tmp_path, link("a", visual(rgba="1 0 0 1"), visual(rgba="0 0 1 1", xyz=f"{x} 0 0"))
    )
    red, _, blue = seen(robot)[100, 100].astype(int)
    assert (blue > red) == (x > 0)


def test_surfaces_that_cross_are_cut_at_their_line(tmp_path):
    robot = read(
        tmp_path,
        link(
            "a",
            visual(BOX.format("1 1 0.2"), "1 0 0 1", xyz="0 0 0"),
            '<visual><origin rpy="0 0 0.5"/><geometry><box size="1 1 0.1"/></geometry>'
            '<material name=""><color rgba="0 0 1 1"/></material></visual>',
        ),
    )
    image = seen(robot, front_view(side="z"))
    assert image[100, 100, 0] > image[100, 100, 2]  # the red one is higher
    assert (image[..., 2] > image[..., 0]).sum() > 100  # corners of the blue one


def test_both_sides_of_a_face_are_seen_and_lit():
    vertices = np.array([[0, -0.5, -0.5], [0, 0.5, -0.5], [0, 0, 0.5]])
    pixels = []
    for faces in ([[0, 1, 2]], [[0, 2, 1]]):
        shapes = make_bare_shapes([(vertices, np.array(faces), RED)])
        pixels.append(picture(shapes)[100, 100])
    assert (pixels[0] == pixels[1]).all()


def test_up_is_up_and_left_is_left(tmp_path):
    robot = read(
        tmp_path,
        link(
            "a",
            visual(BOX.format("0.2 0.2 0.2"), "0 0 1 1", xyz="0 0 0.7"),
            visual(BOX.format("0.2 0.2 0.2"), "0 1 0 1", xyz="0 0.7 0"),
        ),
    )
    image = seen(robot).astype(int)  # from the front: y to the right
    blue = middle((image[..., 2] > image[..., 0] + 60) & (image[..., 2] > image[..., 1] + 60))
    green = middle((image[..., 1] > image[..., 0] + 60) & (image[..., 1] > image[..., 2] + 60))
    assert blue == pytest.approx((100, 30), abs=1)
    assert green == pytest.approx((170, 100), abs=1)


def test_a_pose_moves_the_pixels(tmp_path):
    robot = read(
        tmp_path,
        link("a"),
        link("b", visual(BOX.format("0.1 0.1 0.1"), xyz="0 0.6 0")),
        joint("j", "a", "b", axis="1 0 0"),
    )
    for angle in (0.0, 0.5, -1.2, 2.0):
        x, y = middle(mask(seen(robot, positions={"j": angle})))
        assert x == pytest.approx(100 + 60 * math.cos(angle), abs=0.7)
        assert y == pytest.approx(100 - 60 * math.sin(angle), abs=0.7)


def test_a_mirrored_mesh_is_seen_from_outside(tmp_path):
    obj = "v 0 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n"
    (tmp_path / "t.obj").write_text(obj)
    mesh = '<geometry><mesh filename="t.obj" scale="1 {} 1"/></geometry>'
    straight, mirrored = (
        seen(read(tmp_path, link("a", visual(mesh.format(s), "1 0 0 1")))) for s in ("1", "-1")
    )
    assert (mask(straight)[:, ::-1] == mask(mirrored)).mean() > 0.999
    assert middle(mask(straight))[0] > 100 > middle(mask(mirrored))[0]


def test_the_floor_is_under_the_robot_and_has_its_shadow():
    shapes = one("box", (1.0, 1.0, 1.0), (0.5, 0.5, 0.5, 1))
    bare = draw(shapes, {"": IDENTITY}, size=(200, 160), ground=False).astype(int)
    floor = draw(shapes, {"": IDENTITY}, size=(200, 160)).astype(int)
    assert (bare != floor).any(axis=-1).mean() > 0.3
    assert (floor.sum(axis=-1) < bare.sum(axis=-1) - 150).sum() > 200  # the shadow


def test_what_is_below_the_floor_is_hidden():
    shapes = one("box", (1.0, 1.0, 1.0))
    camera = Camera(0.0, math.radians(10), distance=5.0, target=(0, 0, 0))
    whole = mask_of_red(draw(shapes, {"": IDENTITY}, camera=camera, size=(200, 200), ground=-0.5))
    half = mask_of_red(draw(shapes, {"": IDENTITY}, camera=camera, size=(200, 200), ground=0.0))
    assert 0.35 < half.sum() / whole.sum() < 0.7
    assert half[:90].sum() > 0
    assert np.nonzero(half)[0].max() < np.nonzero(whole)[0].max() - 10


def mask_of_red(image):
    image = image.astype(int)
    return image[..., 0] > image[..., 1] + 60


def test_see_through_shows_what_is_behind(tmp_path):
    def pixel(alpha):
        robot = read(
            tmp_path,
            link(
                "a",
                visual(BOX.format("0.1 1 1"), f"1 0 0 {alpha}", xyz="0.5 0 0"),
                visual(BOX.format("0.1 1 1"), "0 0 1 1"),
            ),
        )
        return seen(robot)[100, 100].astype(int)

    red, both, blue = pixel(1), pixel(0.5), pixel(0)
    assert red[2] < both[2] < blue[2]
    assert red[0] > both[0] > blue[0]


def test_collisions_over_visuals_let_them_through(tmp_path):
    robot = read(
        tmp_path,
        link(
            "a",
            visual(BOX.format("0.5 0.5 0.5"), "0 0 1 1"),
            "<collision><geometry><box size='1 1 1'/></geometry></collision>",
        ),
    )
    visuals, collisions, both = (
        seen(robot, show=show).astype(int) for show in ("visual", "collision", "both")
    )
    assert mask(collisions).sum() == pytest.approx(100**2, rel=0.02)
    assert (mask(both) == mask(collisions)).all()
    assert visuals[100, 100, 2] > both[100, 100, 2] > collisions[100, 100, 2]
    with pytest.raises(ValueError, match="show must be one of"):
        read_robot_shapes(robot, show="inertia")


def test_a_camera_within_the_robot_cuts_it():
    room = one("box", (2.0, 2.0, 2.0))
    for turn in (0.3, 1.0, 2.5):
        camera = Camera(turn, 0.2, distance=0.4, target=(0, 0, 0))
        assert mask(picture(room, camera, size=(64, 48))).all()


def test_nothing_to_draw_is_a_backdrop(tmp_path):
    robot = read(tmp_path, link("a"))
    shapes = read_robot_shapes(robot)
    assert len(shapes) == 0
    image = draw(shapes, link_poses(robot), size=(60, 40))
    assert image.shape == (40, 60, 3)
    assert len(np.unique(image[0])) <= 3
    cube = one("box", (1, 1, 1))
    assert not mask(draw(cube, {}, background=MAGENTA, size=(60, 40))).any()


def test_a_pose_that_is_no_number_is_left_out():
    gone = Pose(translation=(math.nan, 0.0, 0.0))
    assert not mask(picture(one("box", (1, 1, 1)), pose=gone)).any()


@pytest.mark.parametrize("scale", [1e-9, 1e-4, 1.0, 1e6, 1e15])
def test_size_does_not_matter(scale):
    image = draw(one("box", (scale, scale, scale)), {"": IDENTITY}, size=(80, 60), ground=False)
    same = draw(one("box", (1.0, 1.0, 1.0)), {"": IDENTITY}, size=(80, 60), ground=False)
    assert (np.abs(image.astype(int) - same.astype(int)) > 8).any(axis=-1).mean() < 0.01


def test_far_from_the_origin_is_as_near_it():
    near = one("box", (1.0, 1.0, 1.0))
    far = Pose(translation=(1e6, -2e6, 5e5))
    here = draw(near, {"": IDENTITY}, size=(80, 60)).astype(int)
    there = draw(near, {"": far}, size=(80, 60)).astype(int)
    robot = mask_of_red(here)
    assert (np.abs(here - there)[robot] < 12).mean() > 0.98


def test_the_same_bytes_in_another_process(tmp_path):
    robot = read(tmp_path, link("a", visual(rgba="0.2 0.5 0.9 1"), visual(xyz="0 0.3 0.6")))
    program = (
        "import sys, hashlib\n"
        "from urdftool.drawing.picture import draw\n"
        "from urdftool.drawing.png_file import encode_png\n"
        "from urdftool.drawing.shapes import read_robot_shapes\n"
        "from urdftool.model.kinematics import link_poses\n"
        "from urdftool.model.load import load\n"
        "r = load(sys.argv[1])\n"
        "data = encode_png(draw(read_robot_shapes(r), link_poses(r), size=(160, 120)))\n"
        "print(hashlib.sha256(data).hexdigest())\n"
    )
    path = str(tmp_path / "r.urdf")
    sums = {
        subprocess.run(
            [sys.executable, "-c", program, path], capture_output=True, text=True, check=True
        ).stdout
        for _ in range(2)
    }
    assert len(sums) == 1
    image = draw(read_robot_shapes(robot), link_poses(robot), size=(160, 120))
    assert encode_png(image) == encode_png(
        draw(read_robot_shapes(robot), link_poses(robot), size=(160, 120))
    )


def test_a_png_is_read_as_it_was(tmp_path):
    from io import BytesIO

    from PIL import Image

    pixels = np.random.default_rng(1).integers(0, 256, (17, 23, 3), dtype=np.uint8)
    assert (np.asarray(Image.open(BytesIO(encode_png(pixels)))) == pixels).all()


@pytest.mark.slow
def test_two_million_triangles():
    import resource
    import time

    vertices, faces = tessellate("sphere", (1.0,), around=2000)
    shapes = make_bare_shapes([(vertices, faces, RED)])
    assert len(shapes) > 1_900_000
    begin = time.process_time()
    image = picture(shapes)
    assert time.process_time() - begin < 60
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss < 6e6  # kilobytes
    assert mask(image).sum() == pytest.approx(math.pi * 100**2, rel=0.03)
