"""A robot looked over: the table, its JSON, masses and lumps."""

import json
import math
import re
from pathlib import Path

import jsonschema
import numpy as np
import pytest

from tests.conftest import FIXTURES, ROOT
from urdftool.api.lint import check

ROBOTS = FIXTURES / "robots"
SCHEMAS = ROOT / "docs" / "schemas"


def schema(name):
    return json.loads((SCHEMAS / f"{name}.json").read_text())


def review(urdftool, *words):
    done = urdftool("inertia", "robot", *words, "--format", "json")
    assert done.code in (0, 1), done.err
    found = json.loads(done.out)
    jsonschema.validate(found, schema("inertia-robot"))
    return done.code, {link["name"]: link for link in found["links"]}


def robot(*links, joints=""):
    return f'<robot name="r">\n{"".join(links)}{joints}</robot>\n'


def link(name, inertial="", geometry='<box size="1 1 0.5"/>', kind="collision", origin=""):
    shape = f"<{kind}>{origin}<geometry>{geometry}</geometry></{kind}>" if geometry else ""
    return f'  <link name="{name}">\n    {inertial}\n    {shape}\n  </link>\n'


def inertial(mass, *six, origin=""):
    names = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
    numbers = " ".join(f'{n}="{v}"' for n, v in zip(names, six, strict=True))
    return f'<inertial>{origin}<mass value="{mass}"/><inertia {numbers}/></inertial>'


def joint(name, kind, parent, child, xyz="0 0 0", axis="0 0 1"):
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="{xyz}"/><axis xyz="{axis}"/></joint>'
    )


def test_the_arm_with_a_moment_copied_to_all_axes(urdftool):
    path = ROBOTS / "ros2_arm" / "urdf" / "robot2_base_inertia.urdf.xacro"
    done = urdftool("inertia", "robot", path)
    assert done.code == 1
    base = next(line for line in done.out.splitlines() if line.startswith("base_link"))
    assert "IMPOSSIBLE" in base
    assert 'ixx="106.667"' in done.out
    code, links = review(urdftool, path)
    assert code == 1
    assert [name for name, found in links.items() if found["status"] == "wrong"] == ["base_link"]
    proposed = links["base_link"]["proposal"]["inertia"]
    moments = [proposed[name] for name in ("ixx", "iyy", "izz")]
    assert moments == pytest.approx([106.667, 106.667, 170.667], abs=1e-3)
    assert links["base_link"]["faults"][0]["line"] == 20


def test_a_sound_arm(urdftool):
    code, links = review(urdftool, ROBOTS / "ros2_arm" / "urdf" / "robot2_sound.urdf.xacro")
    assert code == 0
    for name, found in links.items():
        if found["written"]:
            assert found["comparison"]["moment_ratio"] == pytest.approx([1, 1, 1], rel=1e-3), name


@pytest.mark.parametrize(
    ("six", "mass", "kind"),
    [
        ((1, 0, 0, 1, 0, 3), 12, "triangle"),
        ((-1, 0, 0, 1, 0, 1), 12, "positivity"),
        ((0, 0, 0, 0, 0, 0), 12, "positivity"),
        ((1, 5, 0, 1, 0, 1), 12, "positivity"),
        ((900, 0, 0, 900, 0, 900), 12, "box"),
        ((1.25, 0, 0, 1.25, 0, 2), -12, "mass"),
        (("{ixx}", 0, 0, 1.25, 0, 2), 12, "unreadable"),
        (("nan", 0, 0, 1.25, 0, 2), 12, "unreadable"),
    ],
)
def test_what_cannot_be(urdftool, write, six, mass, kind):
    path = write("r.urdf", robot(link("a", inertial(mass, *six))))
    code, links = review(urdftool, path)
    assert code == 1
    assert links["a"]["faults"][0]["kind"] == kind
    assert urdftool("inertia", "robot", path).code == 1


@pytest.mark.parametrize(
    ("kind", "six", "wrong"),
    [
        ("continuous", (0, 0, 0, 0, 0, 0), True),
        ("continuous", (1, 0, 0, 1, 0, 1), True),
        ("fixed", (1, 0, 0, 1, 0, 1), True),
        ("fixed", (0, 0, 0, 0, 0, 0), False),
    ],
)
def test_a_mass_of_zero_is_right_for_a_part_of_a_body(urdftool, write, kind, six, wrong):
    base = link("base", inertial(12, 1.25, 0, 0, 1.25, 0, 2))
    text = robot(base, link("a", inertial(0, *six)), joints=joint("j", kind, "base", "a"))
    code, links = review(urdftool, write("r.urdf", text))
    assert code == int(wrong)
    assert [fault["kind"] for fault in links["a"]["faults"]] == ["mass"] * wrong


def test_a_root_of_mass_zero_is_static(urdftool, write):
    code, links = review(urdftool, write("r.urdf", robot(link("a", inertial(0, *[0] * 6)))))
    assert code == 0
    assert "PyBullet fixes it to the world" in links["a"]["notes"][0]


def test_a_frame_of_a_gram_is_no_fault(urdftool, write):
    """Its small tensor is larger than its shape allows, as is that of many a sensor's frame."""
    base = link("base", inertial(12, 1.25, 0, 0, 1.25, 0, 2))
    frame = link(
        "frame", inertial(0.001, 1e-6, 0, 0, 1e-6, 0, 1e-6), '<box size="0.01 0.01 0.01"/>'
    )
    text = robot(base, frame, joints=joint("j", "fixed", "base", "frame"))
    code, links = review(urdftool, write("r.urdf", text))
    assert (code, links["frame"]["faults"]) == (0, [])
    assert links["frame"]["notes"] == []


@pytest.mark.parametrize(
    ("mass", "six", "origin", "rule"),
    [
        (12, (9, 0, 0, 9, 0, 12), "0 0 0", "inertia-exceeds-geometry"),
        (12, (900, 0, 0, 901, 0, 902), "0.1 0.2 0", "inertia-exceeds-geometry"),
        (12, (1.25, 0, 0, 1.25, 0, 2), "0 0 0.4", "com-outside-geometry"),
        (12, (0, 0, 0, 0, 0, 0), "0 0 0", "zero-inertia"),
        (12, (1, 0, 0, 1, 0, 3), "0 0 0", "inertia-triangle-inequality"),
        (3, (1, 0, 0, 1, 0, 1), "0 0 0", "placeholder-inertia"),
        (12, (1.25, 0, 0, 1.25, 0, 2), "0 0 0", ""),
        (12, (1.25, 0, 0, 1.25, 0, 2), "0 0 0.255", ""),
        (12, (1.25, 0, 0, 1.25, 0, 2), "0 0 0.24", ""),
        (12, (0.01, 0, 0, 0.01, 0, 0.01), "0 0 0", ""),
    ],
)
def test_one_verdict_and_one_number_with_lint(urdftool, write, mass, six, origin, rule):
    tensor = inertial(mass, *six, origin=f'<origin xyz="{origin}"/>')
    path = write("r.urdf", robot(link("a", tensor)))
    found = check(path, select=["inertia", "pedantic"])  # a single link is an object
    found = [f for f in found if f.severity.label != "info"]
    code, links = review(urdftool, path)
    assert code == bool(rule)
    assert [finding.code for finding in found] == [rule] * bool(rule)
    fault = links["a"]["faults"][0] if rule else {"kind": ""}
    if fault["kind"] == "box":
        what = "center of mass" if "outside" in fault["message"] else "inertia"
        said = re.split(r" (?=is |would be )", fault["message"], maxsplit=1)[1]
        assert found[0].message.startswith(f"{what} of link 'a' {said}")


def test_a_centre_of_mass_outside_the_geometry(urdftool, write):
    tensor = inertial(12, 1.25, 0, 0, 1.25, 0, 2, origin='<origin xyz="0 0 3"/>')
    code, links = review(urdftool, write("r.urdf", robot(link("a", tensor))))
    assert code == 1
    assert "outside" in links["a"]["faults"][0]["message"]


def test_geometry_of_the_other_kind_counts_for_the_box(urdftool, write):
    shapes = (
        '<link name="a"><visual><geometry><box size="4 4 4"/></geometry></visual>'
        '<collision><geometry><box size="1 1 1"/></geometry></collision>'
        f"{inertial(1, 2, 0, 0, 2, 0, 2)}</link>"
    )
    code, links = review(urdftool, write("r.urdf", robot(shapes)))
    assert (code, links["a"]["source"]) == (0, "collision")
    assert review(urdftool, "r.urdf", "--from", "visual")[1]["a"]["source"] == "visual"


def test_pieces_are_put_together(urdftool, write):
    shapes = (
        '<link name="a">'
        '<visual><origin xyz="1 0 0"/><geometry><box size="1 1 1"/></geometry></visual>'
        '<visual><origin xyz="-1 0 0"/><geometry><sphere radius="0.5"/></geometry></visual></link>'
    )
    code, links = review(urdftool, write("r.urdf", robot(shapes)), "--density", "1000")
    found = links["a"]["implied"]
    box, ball = 1000.0, 1000 * math.pi / 6
    com = (box - ball) / (box + ball)
    assert code == 0
    assert found["mass"] == pytest.approx(box + ball, rel=5e-6)
    assert found["com"] == pytest.approx([com, 0, 0], abs=1e-6)
    own = box / 6 + 0.4 * ball * 0.25
    assert found["inertia"]["ixx"] == pytest.approx(own, rel=1e-5)
    assert found["inertia"]["iyy"] == pytest.approx(
        own + box * (1 - com) ** 2 + ball * (1 + com) ** 2, rel=1e-5
    )


def test_comparison_of_axes_and_centres(urdftool, write):
    tilt = '<origin xyz="0 0 0" rpy="0 0 0.5"/>'
    tensor = inertial(1, 1, 0, 0, 2, 0, 2.5, origin='<origin xyz="0.1 0 0"/>')
    size = '<box size="4 2 1"/>'
    _, links = review(urdftool, write("r.urdf", robot(link("a", tensor, size, origin=tilt))))
    found = links["a"]["comparison"]
    assert found["axis_angle"] == pytest.approx(0.5)
    assert found["com_distance"] == pytest.approx(0.1)
    assert found["density"] == pytest.approx(1 / 8)
    assert found["moment_ratio"] == pytest.approx([12 / 5, 24 / 17, 30 / 20])


def test_missing_meshes_leave_the_rest_of_the_table(urdftool, write):
    mesh = '<mesh filename="package://nowhere/a.stl"/>'
    gone = '<mesh filename="gone.stl"/>'
    path = write("r.urdf", robot(link("a", geometry=mesh), link("b", geometry=gone), link("c")))
    done = urdftool("inertia", "robot", path)
    assert done.code == 0
    assert "nowhere" in done.out
    assert "gone.stl: there is no such mesh file" in done.out
    assert [line.split()[0] for line in done.out.splitlines()[2:5]] == ["a", "b", "c"]
    _, links = review(urdftool, path)
    assert [bool(links[name]["lacks"]) for name in "abc"] == [True, True, False]


def test_a_mesh_is_read_once_and_mirrored_where_it_is(urdftool, write, monkeypatch):
    from urdftool.inertia import bodies

    write("cube.stl", (FIXTURES / "meshes" / "cube.stl").read_bytes())
    reads = []
    original = bodies.integrate_mesh_body
    monkeypatch.setattr(
        bodies, "integrate_mesh_body", lambda p, **up: reads.append(p) or original(p, **up)
    )
    meshes = [f'<mesh filename="cube.stl" scale="{s}"/>' for s in ("1 1 1", "1 -1 1", "0.1 1 2")]
    path = write(
        "r.urdf", robot(*(link(n, geometry=m) for n, m in zip("abc", meshes, strict=True)))
    )
    _, links = review(urdftool, path, "--density", "10")
    assert len(reads) == 1
    assert [links[name]["implied"]["mass"] for name in "abc"] == pytest.approx([10, 10, 2])
    assert links["c"]["implied"]["inertia"]["ixx"] == pytest.approx(2 * (1 + 4) / 12)


def test_meshes_in_several_processes(urdftool, write):
    for name in "abcd":
        write(f"{name}.stl", (FIXTURES / "meshes" / "cube.stl").read_bytes())
    parts = [link(name, geometry=f'<mesh filename="{name}.stl"/>') for name in "abcd"]
    parts.append(link("e", geometry='<mesh filename="none.stl"/>'))
    path = write("r.urdf", robot(*parts))
    _, links = review(urdftool, path, "--density", "3", "-j", "2")
    assert [links[name]["mass"] for name in "abcd"] == pytest.approx([3] * 4)
    assert "no such mesh file" in links["e"]["lacks"][0]["reason"]


def test_masses_from_files_and_options(urdftool, write):
    path = write("r.urdf", robot(link("a"), link("b"), link("c"), link("d", inertial(7, *[1] * 6))))
    csv = write("m.csv", "link,mass\n# a comment\na,1.5\n\nb,2\n")
    _, links = review(urdftool, path, "--masses", csv, "--mass", "b=3", "--density", "10")
    assert [links[name]["mass"] for name in "abcd"] == [1.5, 3, 5, 7]
    yaml = write("m.yaml", "masses:\n  a: 1.5\n  b: 2\n")
    _, links = review(urdftool, path, "--masses", yaml)
    assert [links[name]["mass"] for name in "abcd"] == [1.5, 2, None, 7]


def test_a_total_mass_is_shared_by_volume(urdftool, write):
    parts = [link("a"), link("b", geometry='<box size="1 1 1"/>'), link("c", inertial(4, *[1] * 6))]
    path = write("r.urdf", robot(*parts))
    _, links = review(urdftool, path, "--total-mass", "10")
    assert [links[name]["mass"] for name in "abc"] == pytest.approx([2, 4, 4])
    _, links = review(urdftool, path, "--total-mass", "10", "--all")
    assert [links[name]["mass"] for name in "abc"] == pytest.approx([2.5, 5, 2.5])
    _, links = review(urdftool, path, "--total-mass", "10", "--all", "--mass", "b=8")
    assert [links[name]["mass"] for name in "abc"] == pytest.approx([1, 8, 1])


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--mass", "bas=1"], "did you mean 'base'"),
        (["--mass", "base=0"], "mass of link 'base' is 0 kg"),
        (["--mass", "base=nan"], "mass of link 'base' is nan kg"),
        (["--mass", "base"], "LINK=KG"),
        (["--mass", "base=heavy"], "base=heavy"),
        (["--density", "-1"], "density is -1"),
        (["--density", "1", "--total-mass", "1"], "exclude each other"),
        (["--total-mass", "3", "--mass", "base=4", "--mass", "arm=1"], "cannot be distributed"),
        (["--total-mass", "3", "--mass", "base=4"], "leaves nothing for arm"),
        (["--link", "amr"], "did you mean 'arm'"),
        (["--pose", "j=1"], "--lump"),
        (["--lump", "--write"], "--lump excludes --write"),
        (["--lump", "--pose", "elbo=1"], "did you mean 'elbow'"),
        (["--lump", "--pose", "elbow=inf"], "not a finite number"),
        (["--masses", "none.csv"], "none.csv: cannot be read"),
        (["--masses", "bad.csv"], "bad.csv:2: 'arm,heavy'"),
        (["--masses", "bad.yaml"], "bad.yaml:2"),
        (["--masses", "twice.csv"], "listed twice"),
        (["--from", "mesh"], "--from"),
        (["--format", "xml"], "--format"),
        (["-o", "out.urdf"], "--write"),
    ],
)
def test_bad_input_is_one_message(urdftool, write, words, said):
    joints = joint("elbow", "revolute", "base", "arm")
    path = write("r.urdf", robot(link("base"), link("arm"), joints=joints))
    write("bad.csv", "base,1\narm,heavy\n")
    write("twice.csv", "base,1\nbase,2\n")
    write("bad.yaml", "base: 1\narm: heavy\n")
    done = urdftool("inertia", "robot", path, *words)
    assert done.code == 2
    assert done.out == ""
    assert said in done.err
    assert "bug" not in done.err


def test_a_total_mass_wants_every_volume(urdftool, write):
    gone = '<mesh filename="gone.stl"/>'
    path = write("r.urdf", robot(link("a"), link("b", geometry=gone)))
    done = urdftool("inertia", "robot", path, "--total-mass", "3")
    assert done.code == 2
    assert "--mass b=KG" in done.err
    assert urdftool("inertia", "robot", path, "--total-mass", "3", "--mass", "b=1").code == 0


def lumps(urdftool, *words):
    done = urdftool("inertia", "robot", *words, "--lump", "--format", "json")
    assert done.code == 0, done.err
    found = json.loads(done.out)
    jsonschema.validate(found, schema("inertia-lump"))
    return found


def test_links_on_fixed_joints_are_one_body(urdftool, write):
    ball = inertial(2, 0.2, 0, 0, 0.2, 0, 0.2)
    parts = [link(name, ball, '<sphere radius="0.5"/>') for name in "abc"]
    joints = joint("f", "fixed", "a", "b", "1 0 0") + joint("j", "revolute", "b", "c", "1 0 0")
    path = write("r.urdf", robot(*parts, joints=joints))
    found = lumps(urdftool, path)
    first, second = found["bodies"]
    assert (first["links"], second["links"]) == (["a", "b"], ["c"])
    assert first["properties"]["com"] == [0.5, 0, 0]
    # two balls of 2 kg, half a metre either side
    assert first["properties"]["inertia"]["izz"] == pytest.approx(0.4 + 4 * 0.25)
    assert first["properties"]["inertia"]["ixx"] == pytest.approx(0.4)
    assert found["whole"]["properties"]["com"] == [1, 0, 0]


def test_the_whole_at_a_pose(urdftool, write):
    ball = inertial(2, 0.2, 0, 0, 0.2, 0, 0.2)
    parts = [link(name, ball, '<sphere radius="0.5"/>') for name in "abc"]
    joints = joint("j", "continuous", "a", "b", "1 0 0") + joint(
        "s", "prismatic", "b", "c", "1 0 0"
    )
    path = write("r.urdf", robot(*parts, joints=joints))
    pose = ("--pose", f"j={math.pi / 2}", "--pose", "s=3")
    found = lumps(urdftool, path, *pose)["whole"]["properties"]
    points = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 3]], float)
    center = points.mean(axis=0)
    assert found["com"] == pytest.approx(center.tolist(), rel=1e-5)
    d = points - center
    tensor = sum(0.2 * np.eye(3) + 2 * (v @ v * np.eye(3) - np.outer(v, v)) for v in d)
    six = found["inertia"]
    assert six["ixx"] == pytest.approx(tensor[0, 0], rel=1e-5)
    assert six["ixz"] == pytest.approx(tensor[0, 2], rel=1e-5)
    assert six["iyz"] == pytest.approx(tensor[1, 2], rel=1e-5)


def test_a_mimic_follows_and_limits_are_said(urdftool, write):
    text = (ROBOTS / "mira_description" / "urdf" / "mira.urdf").read_text()
    done = urdftool("inertia", "robot", write("m.urdf", text), "--lump", "--pose", "pitch_joint=1")
    assert done.code == 0
    assert "beyond its limits" in done.err
    balls = [link(name, inertial(1, 1, 0, 0, 1, 0, 1.5), "") for name in "abc"]
    follow = joint("k", "revolute", "b", "c").replace(
        "</joint>", '<mimic joint="j" multiplier="-2" offset="0.5"/></joint>'
    )
    joints = joint("j", "revolute", "a", "b") + follow
    found = lumps(urdftool, write("r.urdf", robot(*balls, joints=joints)), "--pose", "j=0.25")
    assert found["positions"] == {"j": 0.25, "k": 0.0}


def test_the_whole_of_the_small_head(urdftool):
    found = lumps(urdftool, ROBOTS / "mira_description" / "urdf" / "mira.urdf")
    assert found["whole"]["properties"]["mass"] == pytest.approx(0.206)


def test_two_roots_have_no_whole(urdftool, write):
    done = urdftool("inertia", "robot", write("r.urdf", robot(link("a"), link("b"))), "--lump")
    assert done.code == 2
    assert "link 'b' and root 'a' have no parent joint" in done.err


def test_standard_input_and_a_file_for_the_table(urdftool, write, monkeypatch):
    import io

    class Stdin:
        buffer = io.BytesIO(robot(link("a")).encode())

        def isatty(self):
            return False

    write("x", "")
    monkeypatch.setattr("sys.stdin", Stdin())
    done = urdftool("inertia", "robot", "-", "-o", "table.txt")
    assert (done.code, done.out) == (0, "")
    assert "no inertial" in Path("table.txt").read_text()


MACROS = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:macro name="wheel" params="name"><link name="${name}"/></xacro:macro>
</robot>
"""


@pytest.mark.parametrize(
    ("name", "text", "right"),
    [
        ("macros.xacro", MACROS, "use a file that calls its macros"),
        ("empty.urdf", "<robot name='r'/>", 'add a <link name="…"/>'),
    ],
)
@pytest.mark.parametrize("command", ["inertia robot", "collision"])
def test_a_robot_without_links_is_refused(urdftool, write, tmp_path, command, name, text, right):
    path, out = write(name, text), tmp_path / "out.urdf"
    options = ("--write", "--density", "1000") if command == "inertia robot" else ()
    done = urdftool(*command.split(), path, *options, "-o", out)
    assert (done.code, done.out) == (2, "")
    assert done.err.startswith(f"{path}:1:1: ")
    assert done.err.endswith(f" has no link; {right}\n")
    assert not out.exists()


def test_a_diff_shows_what_would_be_written_and_writes_nothing(urdftool, write):
    path = write("r.urdf", robot(link("a"), link("b", inertial(1, 0.104, 0, 0, 0.104, 0, 0.167))))
    before = Path(path).read_bytes()
    shown = urdftool("inertia", "robot", path, "--diff", "--mass", "a=2")
    assert shown.code == 1
    assert Path(path).read_bytes() == before
    added = [line[1:] for line in shown.out.splitlines() if line.startswith("+ ")]
    assert any('<mass value="2"/>' in line for line in added)
    assert not [line for line in shown.out.splitlines() if line.startswith("- ")]
    urdftool("inertia", "robot", path, "--write", "--mass", "a=2")
    after = Path(path).read_text()
    assert all(line in after for line in added)
    again = urdftool("inertia", "robot", path, "--diff", "--mass", "a=2")
    assert (again.code, again.out) == (0, "")


def test_a_diff_has_no_output_file(urdftool, write):
    path = write("r.urdf", robot(link("a")))
    done = urdftool("inertia", "robot", path, "--diff", "-o", "x.urdf", "--mass", "a=2")
    assert done.code == 2
    assert "--diff" in done.err
