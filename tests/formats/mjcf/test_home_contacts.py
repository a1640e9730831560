"""Links that overlap at home: found, told from those of hulls, excluded."""

from pathlib import Path

import numpy as np
import pytest

from urdftool.api.export import export_mjcf, measure_overlap
from urdftool.formats.mjcf.write import find_srdf_files
from urdftool.model.load import load

from .robots import INERTIAL, export, joint, link, robot, rules, tree

pytestmark = pytest.mark.library("mujoco")


def ball(radius, x=0.0):
    return (
        f'{INERTIAL}<collision><origin xyz="{x} 0 0"/>'
        f'<geometry><sphere radius="{radius}"/></geometry></collision>'
    )


def chain(last):
    """Three links in a row, of which the last is a grandchild of the first."""
    at = '<origin xyz="0.5 0 0"/><limit lower="-1" upper="1"/>'
    return robot(
        link("a", ball(0.2)), link("b", INERTIAL), link("c", last),
        joint("j", "a", "b", inside=at), joint("k", "b", "c", inside=at),
    )  # fmt: skip


def excluded(written):
    section = tree(written).find("contact")
    return [] if section is None else [frozenset(e.attrib.values()) for e in section]


@pytest.mark.parametrize(("radius", "touches"), [(0.79, False), (0.81, True)])
def test_an_overlap_is_excluded_and_reported(write, radius, touches):
    written = export(write("r.urdf", chain(ball(radius))), exclude="touching")
    assert (frozenset(("a", "c")) in excluded(written)) == touches
    assert ("lossy-overlap" in rules(written)) == touches
    if touches:
        (loss,) = (loss for loss in written.losses if loss.code == "lossy-overlap")
        assert "'a' and 'c' 10 mm" in loss.message


def test_an_overlap_that_stays_is_reported_too(write):
    path = write("r.urdf", chain(ball(0.9)))
    written = export_mjcf(load(path), exclude="adjacent")
    assert excluded(written) == []
    (loss,) = (loss for loss in written.losses if loss.code == "lossy-overlap")
    assert "--exclude touching excludes them" in loss.message


def test_none_excludes_nothing(write):
    text = robot(link("a", ball(0.2)), link("b", ball(0.2)), joint("j", "a", "b"))
    assert excluded(export(write("r.urdf", text), exclude="adjacent")) == [frozenset("ab")]
    assert excluded(export(write("r.urdf", text), exclude="none")) == []


def test_an_overlap_of_hulls_is_told_from_one_of_the_geometry(write):
    def bowl(path: Path):
        """Four walls without a floor, which only their hull fills."""
        faces = []
        for x, y, dx, dy in ((-1, 0, 0.1, 1), (1, 0, 0.1, 1), (0, -1, 1, 0.1), (0, 1, 1, 0.1)):
            low = np.array([x - dx, y - dy, -1])
            high = np.array([x + dx, y + dy, 1])
            c = np.array([low, high])
            p = [c[[i, j, k], [0, 1, 2]] for k in (0, 1) for j in (0, 1) for i in (0, 1)]
            for a, b, d, e in ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2),
                               (1, 3, 7, 5)):  # fmt: skip
                faces += [(p[a], p[b], p[d]), (p[a], p[d], p[e])]
        lines, count = [], 0
        for face in faces:
            lines += [f"v {v[0]} {v[1]} {v[2]}" for v in face]
            lines.append(f"f {count + 1} {count + 2} {count + 3}")
            count += 3
        path.write_text("\n".join(lines) + "\n")

    mesh = '<collision><geometry><mesh filename="bowl.obj"/></geometry></collision>'
    text = chain(ball(0.2, x=-1.0)).replace(link("a", ball(0.2)), link("a", INERTIAL + mesh))
    path = write("r.urdf", text)
    bowl(Path(path).parent / "bowl.obj")
    found = load(path)
    assert measure_overlap(found, {}, "a", "c") == pytest.approx(0, abs=1e-9)
    written = export_mjcf(found)
    (loss,) = (loss for loss in written.losses if loss.code == "lossy-overlap")
    assert "only by the convex hulls" in loss.message
    assert "--decompose" in loss.hint


def test_an_srdf_of_the_moveit_package_is_offered(tmp_path):
    package = tmp_path / "arm_description"
    config = tmp_path / "arm_moveit_config" / "config"
    for folder in (package / "urdf", config):
        folder.mkdir(parents=True)
    for folder in (package, config.parent):
        name = f"<package><name>{folder.name}</name></package>"
        (folder / "package.xml").write_text(name)
    path = package / "urdf" / "arm.urdf"
    path.write_text(robot(link("a"), name="arm"))
    (config / "arm.srdf").write_text('<robot name="arm"/>')
    (config / "other.srdf").write_text('<robot name="other"/>')
    assert [file.name for file in find_srdf_files(load(path))] == ["arm.srdf"]
    written = export(path)
    assert "lossy-srdf-not-used" in rules(written)
    used = export(path, srdf=config / "arm.srdf")
    assert "lossy-srdf-not-used" not in rules(used)
