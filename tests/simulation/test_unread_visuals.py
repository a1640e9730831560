"""Visuals whose mesh was not read are reported in every output of ``simulate``."""

import json

import pytest

from tests.simulation.robots import body, simulated

BOX = body('<box size="0.4 0.3 0.2"/>', 4, (0.04, 0.06, 0.08))
TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"


def with_visual(filename):
    """A box that stands, with a visual mesh of 1 mm."""
    shape = f'<geometry><mesh filename="{filename}" scale="1e-3 1e-3 1e-3"/></geometry>'
    return BOX.replace("<collision>", f"<visual>{shape}</visual><collision>")


@pytest.mark.parametrize(
    ("filename", "reason"),
    [
        ("part.obj", None),
        ("gone.obj", "there is no such mesh file"),
        ("broken.obj", "mesh"),
        ("../outside.obj", "outside"),
    ],
)
def test_a_visual_that_is_not_read_is_a_remark(write, tmp_path, filename, reason):
    write("part.obj", TETRAHEDRON)
    write("broken.obj", "no mesh")
    (tmp_path.parent / "outside.obj").write_text(TETRAHEDRON)
    verdict = simulated(write("r.urdf", with_visual(filename)))
    assert verdict.stands
    assert [fault.code for fault in verdict.gaps] == ["visual-not-read"] * (reason is not None)
    for fault in verdict.gaps:
        assert (fault.name, fault.location.line, fault.fails) == ("a", 1, False)
        assert f"'{filename}' was not read: " in fault.message
        assert reason in fault.message


def test_every_output_counts_it(urdftool, write):
    path = write("r.urdf", with_visual("gone.obj"))
    done = urdftool("simulate", path)
    assert (done.code, done.out.splitlines()[0]) == (0, "r: stands; visuals of 1 link not read")
    assert "note: link 'a': visual mesh 'gone.obj' was not read: there is no such mesh" in done.out
    done = urdftool("simulate", "--fleet", path, "-j", "1")
    assert "visual-not-read (a)" in done.out
    assert done.out.endswith("1 robot: 1 stand; 1 of them with visuals that were not read\n")
    done = urdftool("simulate", path, "--format", "json")
    (fault,) = json.loads(done.out)["trials"][0]["faults"]
    assert (fault["kind"], fault["name"], fault["line"]) == ("visual-not-read", "a", 1)
