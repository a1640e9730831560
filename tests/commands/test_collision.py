"""``urdftool collision`` on meshes and robots: what is written, and what is refused."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import jsonschema
import numpy as np
import pytest

from tests.collision.shapes import l_profile, noisy, stl
from tests.conftest import FIXTURES, ROOT
from urdftool import load
from urdftool.geometry.link_extent import get_shape_points

MESHES = FIXTURES / "meshes"

LINK = """  <link name="{name}">
    <visual>
      <origin xyz="0 0 1"/>
      <geometry><mesh filename="{mesh}"{more}/></geometry>
    </visual>
  </link>
"""


def robot(*links):
    joints = "".join(
        f'  <joint name="j{n}" type="fixed"><parent link="a"/><child link="{name}"/></joint>\n'
        for n, (name, *_) in enumerate(links[1:])
    )
    parts = "".join(LINK.format(name=name, mesh=mesh, more=more) for name, mesh, more in links)
    return f'<?xml version="1.0"?>\n<robot name="r">\n{parts}{joints}</robot>\n'


@pytest.fixture
def box(write):
    return write("meshes/box.stl", stl(*noisy("box", (0.3, 0.2, 0.1))))


@pytest.fixture
def bracket(write):
    return write("meshes/bracket.stl", stl(*l_profile()))


def test_a_mesh_is_measured_and_told_as_json(urdftool, box):
    done = urdftool("collision", "mesh", box, "--no-cache", "--format", "json")
    assert done.code == 0, done.err
    found = json.loads(done.out)
    schema = json.loads((ROOT / "docs/schemas/collision.json").read_text())
    jsonschema.validate(found, schema)
    (part,) = found["results"][0]["parts"]
    assert part["pieces"][0]["urdf"] == '<box size="0.3 0.2 0.1"/>'
    assert part["within"]


def test_several_pieces_get_a_file_each(urdftool, write, tmp_path):
    done = urdftool("collision", "mesh", MESHES / "two_cubes.stl", "-o", tmp_path / "out.obj",
                    "--no-cache")  # fmt: skip
    assert done.code == 0, done.err
    assert sorted(os.listdir(tmp_path)) == ["out.obj", "out_0.obj", "out_1.obj"]
    assert (tmp_path / "out.obj").read_text().count("\no piece_") == 2


@pytest.mark.parametrize(
    ("name", "word"),
    [
        ("empty.stl", "empty"),
        ("truncated.stl", "truncated"),
        ("lfs_pointer.stl", "git-LFS"),
        ("nan.stl", "NaN"),
        ("broken.dae", "cannot be read"),
        ("no_such.stl", "no such"),
    ],
)
def test_a_bad_mesh_is_one_message(urdftool, tmp_path, name, word):
    done = urdftool("collision", "mesh", MESHES / name, "-o", tmp_path / "out.stl")
    assert done.code == 2
    assert len(done.err.splitlines()) == 1
    assert word in done.err
    assert os.listdir(tmp_path) == []


@pytest.mark.parametrize("name", ["flat.stl", "inside_out.stl"])
def test_a_poor_mesh_is_used_nevertheless(urdftool, tmp_path, name):
    done = urdftool("collision", "mesh", MESHES / name, "--method", "hull", "--no-cache",
                    "-o", tmp_path / "out.stl")  # fmt: skip
    assert done.code == 0, done.err
    assert (tmp_path / "out.stl").stat().st_size > 84


def test_one_triangle_becomes_a_plate_and_a_line_is_refused(urdftool, write):
    import numpy as np

    points, face = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0.0]]), np.array([[0, 1, 2]])
    flat = write("one.stl", stl(points, face))
    assert "is flat" in urdftool("collision", "mesh", flat, "--no-cache").err
    line = write("line.stl", stl(points[[0, 1, 1]] * [[1], [1], [2]], face))
    done = urdftool("collision", "mesh", line, "--no-cache")
    assert (done.code, len(done.err.splitlines())) == (2, 1)


def test_only_the_links_change_and_shared_meshes_are_computed_once(urdftool, write, bracket, box):
    text = robot(
        ("a", "meshes/bracket.stl", ""),
        ("left hand/é", "meshes/bracket.stl", ""),
        ("c", "meshes/bracket.stl", ' scale="2 2 2"'),
        ("d", "meshes/box.stl", ' scale="1 -1 1"'),
    )
    path = write("r.urdf", text)
    words = ("collision", path, "-o", "out.urdf", "--method", "hull", "--no-cache")
    done = urdftool(*words, "--skip-link", "d")
    assert done.code == 0, done.err
    assert sorted(os.listdir("out_collision")) == ["bracket-2.stl", "bracket.stl"]
    new = Path("out.urdf").read_text("utf-8")
    assert new.count("<collision>") == 3
    assert [line for line in text.splitlines() if line not in new.splitlines()] == []
    assert new.count('filename="out_collision/bracket.stl"') == 2
    assert new.count('<origin xyz="0 0 1"/>') == 7
    first = Path("out.urdf").read_bytes(), Path("out_collision/bracket.stl").read_bytes()
    assert urdftool(*words, "--skip-link", "d", "-j", "2").code == 0
    assert first == (Path("out.urdf").read_bytes(), Path("out_collision/bracket.stl").read_bytes())


def test_from_the_cache_it_is_the_same(urdftool, write, bracket, tmp_path):
    path = write("r.urdf", robot(("a", "meshes/bracket.stl", "")))
    words = ("collision", path, "-o", "out.urdf", "--method", "hull", "--cache-dir", "kept")
    assert urdftool(*words).code == 0
    first = Path("out_collision/bracket.stl").read_bytes()
    done = urdftool(*words)
    assert "from the cache" in done.err
    assert Path("out_collision/bracket.stl").read_bytes() == first
    (entry,) = [p for p in (tmp_path / "kept").rglob("*") if p.is_file() and p.name != "trimmed"]
    entry.write_bytes(entry.read_bytes()[:-40])  # damaged: computed anew
    assert "from the cache" not in urdftool(*words).err


def test_primitives_stay_unless_they_are_not_wanted(urdftool, write, box):
    collision = "<collision><geometry><sphere radius='1'/></geometry></collision>\n  </link>"
    path = write("r.urdf", robot(("a", "meshes/box.stl", "")).replace("</link>", collision))
    assert urdftool("collision", path, "-o", "same.urdf", "--no-cache").code == 0
    assert Path("same.urdf").read_text() == Path(path).read_text()
    done = urdftool("collision", path, "-o", "new.urdf", "--replace-primitives", "--no-cache")
    assert done.code == 0, done.err
    new = Path("new.urdf").read_text()
    assert "sphere" not in new
    assert '<box size="0.3 0.2 0.1"/>' in new
    assert '<origin xyz="0 0 1" rpy="0 0 0"/>' in new


def test_names_are_seen_from_where_the_robot_goes(urdftool, write, bracket):
    path = write("r.urdf", robot(("a", "meshes/bracket.stl", "")))
    os.mkdir("there")
    done = urdftool("collision", path, "-o", "there/out.urdf", "--method", "hull", "--no-cache")
    assert done.code == 0, done.err
    new = Path("there/out.urdf").read_text()
    assert 'filename="../meshes/bracket.stl"' in new
    assert 'filename="out_collision/bracket.stl"' in new


def test_xacro_is_edited_where_it_is_literal(urdftool, write, bracket):
    link = (
        '<link name="{}"><visual><origin xyz="${{x}} 0 0"/>'
        '<geometry><mesh filename="{}"/></geometry></visual></link>'
    )
    text = (
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
        '  <xacro:property name="x" value="0.5"/><!-- kept -->'
        '<xacro:property name="name" value="bracket"/>\n'
        '  <xacro:macro name="side" params="n">\n'
        f"    {link.format('${n}', 'meshes/bracket.stl')}\n"
        "  </xacro:macro>\n"
        '  <xacro:side n="l"/><xacro:side n="r"/>\n'
        f"  {link.format('c', 'meshes/${name}.stl')}\n"
        "</robot>\n"
    )
    path = write("r.urdf.xacro", text)
    done = urdftool("collision", path, "--in-place", "--method", "hull", "--no-cache")
    assert done.code == 0, done.err
    new = Path(path).read_text()
    assert "link 'c' is left as it is" in done.err
    assert new.count("<collision>") == 1
    assert new.count('<origin xyz="${x} 0 0"/>') == 3
    assert '"r_collision/bracket.stl"' in new
    assert "<!-- kept -->" in new


def test_a_mesh_that_is_missing_stops_it_and_nothing_is_written(urdftool, write, box):
    links = (
        ("a", "meshes/box.stl", ""),
        ("b", "meshes/none.stl", ""),
        ("c", "meshes/box.stl", ' scale="0 1 1"'),
    )
    path = write("r.urdf", robot(*links))
    done = urdftool("collision", path, "-o", "out.urdf", "--no-cache")
    assert done.code == 2
    assert "no mesh file" in done.err
    assert "zero" in done.err
    assert not os.path.exists("out.urdf")
    assert not os.path.exists("out_collision")


def test_a_mesh_of_somebody_else_is_not_replaced(urdftool, write, bracket):
    path = write("r.urdf", robot(("a", "meshes/bracket.stl", "")))
    before = Path("meshes/bracket.stl").read_bytes()
    done = urdftool("collision", path, "-o", "out.urdf", "--method", "hull", "--mesh-dir", "meshes",
                    "--no-cache")  # fmt: skip
    assert done.code == 2
    assert Path("meshes/bracket.stl").read_bytes() == before
    assert not os.path.exists("out.urdf")


def test_check_says_how_good_collisions_are(urdftool, write, box):
    good = (
        '<collision><origin xyz="0 0 1"/><geometry><box size="0.3 0.2 0.1"/></geometry>'
        "</collision>\n  </link>"
    )
    path = write("r.urdf", robot(("a", "meshes/box.stl", "")).replace("</link>", good))
    done = urdftool("collision", path, "--check")
    assert done.code == 0, done.err
    write("r.urdf", Path(path).read_text().replace('size="0.3', 'size="0.4'))
    done = urdftool("collision", path, "--check", "--format", "json")
    assert done.code == 1
    found = json.loads(done.out)
    schema = json.loads((ROOT / "docs/schemas/collision-check.json").read_text())
    jsonschema.validate(found, schema)
    (link,) = found["results"][0]["links"]
    assert link["measures"]["error"] == pytest.approx(0.1336, abs=0.01)
    assert (link["within"], link["concave_meshes"], link["hull_error"]) == (False, 0, None)


def test_check_has_the_limits_of_the_configuration(urdftool, write, box):
    far = (
        '<collision><origin xyz="0 0 1"/><geometry><box size="0.4 0.2 0.1"/></geometry>'
        "</collision>\n  </link>"
    )  # 13 % too long
    links = [(name, "meshes/box.stl", "") for name in "ab"]
    path = write("r.urdf", robot(*links).replace("</link>", far))

    def check(table, *words):
        write("urdftool.toml", table)
        done = urdftool("collision", path, "--check", *words, "--format", "json")
        found = json.loads(done.out)["results"][0]["links"] if done.out else []
        return done.code, [(link["link"], link["max_error"], link["within"]) for link in found]

    assert check("[collision]\nmax-error = 0.2") == (0, [("a", 0.2, True), ("b", 0.2, True)])
    assert check("[collision]\nmax-error = 0.2", "--max-error", "0.1")[0] == 1
    own = "[collision.links.a]\nmax-error = 0.2\n"
    assert check(own) == (1, [("a", 0.2, True), ("b", 0.05, False)])
    assert check(own + "[collision.links.b]\nskip = true") == (0, [("a", 0.2, True)])
    assert check("[collision]\nmax-eror = 0.2") == (2, [])


@pytest.mark.slow
def test_check_says_what_engines_touch_of_a_concave_mesh(urdftool, write, bracket, tmp_path):
    links = [(name, "meshes/bracket.stl", "") for name in "abc"]
    both = robot(*links).replace("  </link>", "{}  </link>")
    collision = LINK.split("\n", 1)[1].rsplit("  </link>", 1)[0].replace("visual>", "collision>")
    path = write("r.urdf", both.format(*[collision.format(mesh="meshes/bracket.stl", more="")] * 3))
    words = ("collision", path, "--check", "--format", "json")
    done = urdftool(*words, "-j", "2", "--picture", tmp_path / "p.png")
    assert done.code == 0, done.err
    found = json.loads(done.out)["results"][0]["links"]
    assert [link["link"] for link in found] == ["a", "b", "c"]
    # the middle of the side that the hull has over the inner corner is farthest from the legs
    size = (0.2**2 + 0.2**2 + 0.1**2) ** 0.5
    far = 0.075 / size
    assert [link["concave_meshes"] for link in found] == [1, 1, 1]
    assert [link["hull_error"] for link in found] == pytest.approx([far] * 3, rel=0.05)
    assert found[0]["measures"]["error"] < 1e-3
    assert done.err.count("touch the hull") == 3
    assert (tmp_path / "p.png").read_bytes().startswith(b"\x89PNG")
    assert urdftool(*words, "-j", "1").out == done.out
    folder = urdftool("collision", ".", "--check", "--format", "json")
    assert json.loads(folder.out)["results"][0]["links"] == found


def test_a_check_of_nothing_is_no_pass(urdftool, write):
    path = write(
        "r.urdf",
        '<robot name="r"><link name="a"><collision><geometry><sphere radius="1"/></geometry>'
        '</collision></link><link name="b"/><joint name="j" type="fixed"><parent link="a"/>'
        '<child link="b"/></joint></robot>',
    )
    done = urdftool("collision", path, "--check", "--format", "json")
    assert done.code == 2
    assert json.loads(done.out)["results"][0]["links"] == []
    assert "r.urdf: nothing was checked" in done.err
    assert "1 link" in done.err
    write("r.urdf", Path(path).read_text().replace("collision>", "visual>"))
    done = urdftool("collision", path, "--check", "--link", "b")
    assert done.code == 2
    assert "selected links" in done.err


@pytest.mark.slow
def test_a_part_beyond_the_error_is_said_with_what_helps(urdftool, write):
    open_sphere = noisy("sphere", (0.1,), noise=0.0)
    half = open_sphere[1][(open_sphere[0][open_sphere[1]][:, :, 2] > 0).all(axis=1)]
    write("meshes/bowl.stl", stl(open_sphere[0], half))
    path = write("r.urdf", robot(("a", "meshes/bowl.stl", "")))
    words = ("collision", path, "-o", "out.urdf", "--no-cache", "--max-hulls", "2")
    done = urdftool(*words)
    assert done.code == 0
    (line,) = (line for line in done.err.splitlines() if "exceeds 5.0%" in line)
    assert line.startswith("urdftool: a bowl.stl: excess ")
    assert "--max-hulls 4 would give about" in line or "more pieces help little" in line
    assert "1 not within the error" in done.err
    found = urdftool(*words, "--overwrite", "--method", "hull")
    assert "try --method auto" in found.err


def test_check_measures_here(urdftool, write, box):
    path = write("r.urdf", robot(("a", "meshes/box.stl", "")))
    assert urdftool("collision", path, "--check", "--scheduler", "tcp://127.0.0.1:1").code == 2


def test_settings_of_a_link_come_from_the_configuration(urdftool, write, bracket):
    write("urdftool.toml", '[collision]\nmethod = "hull"\n[collision.links.b]\nskip = true\n')
    path = write("r.urdf", robot(("a", "meshes/bracket.stl", ""), ("b", "meshes/bracket.stl", "")))
    done = urdftool("collision", path, "-o", "out.urdf", "--no-cache", "--format", "json")
    (part,) = json.loads(done.out)["results"][0]["parts"]
    assert (part["link"], part["method"]) == ("a", "hull")
    write("urdftool.toml", '[collision]\nmetod = "hull"\n')
    from urdftool import configuration

    for kept in vars(configuration).values():
        if isinstance(kept, dict) and kept.keys() & {os.getcwd()}:
            kept.clear()
    assert urdftool("collision", path, "-o", "out.urdf").code == 2


def test_a_picture_is_a_png(urdftool, box, tmp_path):
    done = urdftool("collision", "mesh", box, "--method", "hull", "--no-cache",
                    "--picture", tmp_path / "p.png")  # fmt: skip
    assert done.code == 0, done.err
    assert (tmp_path / "p.png").read_bytes().startswith(b"\x89PNG")


def test_a_folder_of_robots_goes_into_a_folder(urdftool, write, bracket):
    write("urdftool.toml", "")
    for name in ("one", "two"):
        write(f"fleet/{name}/{name}.urdf", robot(("a", "../../meshes/bracket.stl", "")))
    done = urdftool("collision", "fleet", "-o", "out", "--method", "hull", "--no-cache")
    assert done.code == 0, done.err
    assert os.path.exists("out/one/one.urdf")
    assert os.path.exists("out/two/two_collision/bracket.stl")


def test_an_unknown_link_is_refused_with_the_nearest(urdftool, write, box):
    path = write("r.urdf", robot(("base_link", "meshes/box.stl", "")))
    done = urdftool("collision", path, "-o", "o.urdf", "--link", "base_lnk")
    assert (done.code, "'base_link'" in done.err) == (2, True)


@pytest.mark.slow
def test_ctrl_c_leaves_nothing_behind(write):
    path = write("meshes/rough.stl", stl(*noisy("sphere", (0.1,), noise=0.03)))
    write("r.urdf", robot(("a", path, "")))
    words = ["collision", "r.urdf", "-o", "out.urdf", "--method", "coacd", "--threshold", "0.01"]
    child = subprocess.Popen(
        [sys.executable, "-m", "urdftool", *words, "--no-cache"], stderr=subprocess.PIPE
    )
    time.sleep(4)
    child.send_signal(signal.SIGINT)
    _, err = child.communicate(timeout=20)
    assert child.returncode == 130, err
    assert not os.path.exists("out.urdf")


@pytest.mark.slow
def test_a_cluster_gives_the_same_bytes(urdftool, write, bracket, box):
    distributed = pytest.importorskip("distributed")
    path = write("r.urdf", robot(("a", "meshes/bracket.stl", ""), ("b", "meshes/box.stl", "")))
    alone = urdftool("collision", path, "-o", "alone.urdf", "--mesh-dir", "m1", "--no-cache")
    assert alone.code == 0, alone.err
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=None
    ) as cluster:
        done = urdftool("collision", path, "-o", "many.urdf", "--mesh-dir", "m2", "--no-cache",
                        "--scheduler", cluster.scheduler_address)  # fmt: skip
    assert done.code == 0, done.err
    assert Path("alone.urdf").read_text().replace("m1/", "m2/") == Path("many.urdf").read_text()
    for name in os.listdir("m1") if os.path.exists("m1") else ():
        assert Path(f"m1/{name}").read_bytes() == Path(f"m2/{name}").read_bytes()


TWO = """<robot name="r">
  <link name="a">
    <visual><geometry><sphere radius="0.01"/></geometry></visual>
    <visual><origin xyz="0 0 1"/><geometry><mesh filename="meshes/bracket.stl"/></geometry></visual>
    <visual>
      <origin xyz="0.5 0 1" rpy="0 0 1.5707963267948966"/>
      <geometry><mesh filename="meshes/box.stl"/></geometry>
    </visual>
  </link>
</robot>
"""


def _list_pieces(robot):
    return [one for one in robot.links[0].collisions if one.geometry.element.tag != "sphere"]


def test_the_meshes_of_a_link_are_decomposed_together(urdftool, write, bracket, box):
    path = write("r.urdf", TWO)
    done = urdftool("collision", path, "-o", "out.urdf", "--no-cache", "--format", "json")
    assert done.code == 0, done.err
    assert "2 meshes to" in done.err
    found = json.loads(done.out)
    jsonschema.validate(found, json.loads((ROOT / "docs/schemas/collision.json").read_text()))
    (part,) = found["results"][0]["parts"]
    assert [Path(name).name for name in (part["mesh"], *part["others"])] == [
        "bracket.stl",
        "box.stl",
    ]
    made = urdftool("collision", "out.urdf", "--check", "--format", "json")
    (measured,) = json.loads(made.out)["results"][0]["links"]
    assert measured["measures"]["error"] <= part["max_error"]
    new = load("out.urdf")
    points = np.concatenate([get_shape_points(new, one) for one in _list_pieces(new)])
    assert points.max(axis=0)[0] == pytest.approx(0.6, abs=0.02)  # the box, turned
    assert [one.geometry.element.tag for one in new.links[0].collisions].count("sphere") == 1


def test_equal_links_are_computed_once_and_named_by_the_first(urdftool, write, bracket, box):
    again = TWO.replace('name="a"', 'name="b"').split("\n", 1)[1].removesuffix("</robot>\n")
    joint = '<joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint></robot>\n'
    path = write("r.urdf", TWO.removesuffix("</robot>\n") + again + joint)
    words = ("--max-error", "0.01", "--max-hulls", "4", "--quality", "fast", "--no-cache")
    done = urdftool("collision", path, "-o", "out.urdf", "--method", "cuts", *words)
    assert done.code == 0, done.err
    assert {name.split("_")[0] for name in os.listdir("out_collision")} == {"a"}
    done = urdftool("collision", path, "-o", "each.urdf", "--per", "mesh", *words)
    assert done.code == 0, done.err
    assert "4 meshes to" in done.err
    assert all(name.startswith("bracket") for name in os.listdir("each_collision"))


def test_xacro_in_place_is_edited_for_each_mesh(urdftool, write, bracket, box):
    path = write("r.urdf.xacro", TWO)
    done = urdftool("collision", path, "--in-place", "--per", "link", "--no-cache")
    assert (done.code, "--per mesh" in done.err) == (2, True)
