"""Measure operations on real robots by Pinocchio: ``python -m tests.edits [--mistakes] FILE...``.

Every operation is made on every robot. Pinocchio reads its result and its source, compared at
random configurations: poses of all links; mass, center of mass and inertia of the whole robot in
the frame of one link with the joints locked; the joint-space mass matrix. With ``--mistakes``, one
number of each result is changed, and ``urdftool verify --map`` has to find it.
"""

from __future__ import annotations

import random
import re
import sys
import tempfile
from collections import defaultdict
from pathlib import Path

import numpy as np

import urdftool
from urdftool.compare.correspondence import parse_correspondence
from urdftool.compare.declared import compare_declared
from urdftool.compare.rows import ROWS, limit_tolerances

CONFIGURATIONS = 4
MOVING = ("revolute", "continuous", "prismatic")


def list_operations(robot):
    """Return the operations that a robot allows, as functions."""
    moving = [joint.name for joint in robot.joints if joint.type in MOVING]
    order = robot.tree.order
    leaves = [name for name in order if not robot.tree.get_child_joints(name)]
    heavy = [name for name in leaves if robot.link[name].mass] or leaves
    values = {name: round(0.1 * (number % 7 + 1), 3) for number, name in enumerate(moving)}
    found = {
        "prefix": lambda: robot.prefix("p_"),
        "merge-fixed": lambda: robot.merge_fixed(),
        "mirror": lambda: robot.mirror("xz", meshes="scale"),
        "round": lambda: robot.round_numbers(1e-12),
        "attach": lambda: robot.attach(robot, to=order[-1], prefix="g_", xyz=(0.1, 0.2, 0.3)),
    }
    if moving:
        found["zero"] = lambda: robot.change_zero(values)
        found["sign"] = lambda: robot.reverse_sign(moving)
    if len(order) > 1:
        found["root"] = lambda: robot.change_root(heavy[-1])
        found["root --move-frames"] = lambda: robot.change_root(heavy[-1], move_frames=True)
        found["cut"] = lambda: robot.cut(leaves[-1])
    return found, values, moving


class Engine:
    """A URDF in Pinocchio."""

    def __init__(self, text):
        import pinocchio

        self.pin = pinocchio
        # links without mass get their inertia from Pinocchio; names of meshes are not read
        self.model = pinocchio.buildModelFromXML(text)
        self.data = self.model.createData()

    def compute(self, positions, reference):
        """Return poses of links, and mass, center and inertia of all in the frame of a link."""
        pin, model, data = self.pin, self.model, self.data
        q = pin.neutral(model)
        for joint in range(1, model.njoints):
            value, at = positions.get(model.names[joint], 0.0), model.joints[joint].idx_q
            if model.joints[joint].nq == 1:
                q[at] = value
            elif model.joints[joint].nq == 2:
                q[at : at + 2] = np.cos(value), np.sin(value)
        pin.framesForwardKinematics(model, data, q)
        frames = {f.name: data.oMf[i] for i, f in enumerate(model.frames) if f.type == pin.BODY}
        matrix = pin.crba(model, data, q)
        matrix = np.triu(matrix) + np.triu(matrix, 1).T
        total = pin.Inertia.Zero()
        for joint in range(model.njoints):
            total = total + data.oMi[joint].act(model.inertias[joint])
        base = frames[reference].inverse()
        local = base.act(total)
        names = [model.names[j] for j in range(1, model.njoints) for _ in range(model.joints[j].nv)]
        poses = {name: (base * pose).homogeneous for name, pose in frames.items()}
        return poses, (local.mass, local.lever, local.inertia), names, matrix


def map_positions(name, values, moving, positions):
    """Return the positions of the edited robot."""
    if name == "zero":
        return {j: p - values.get(j, 0.0) for j, p in positions.items()}
    if name == "sign":
        return {j: -p if j in moving else p for j, p in positions.items()}
    if name == "prefix":
        return {f"p_{j}": p for j, p in positions.items()}
    return positions


def measure(robot, text, name, edited, values, moving):
    """Return the largest differences: pose [m, rotation], inertia and mass matrix (relative)."""
    one, two = Engine(text), Engine(edited.data.decode())
    generator = random.Random(0)
    start = "p_" if name == "prefix" else ""
    flip = np.diag([1.0, -1.0, 1.0, 1.0]) if name == "mirror" else np.eye(4)
    worst = np.zeros(3)
    kept = [link for link in robot.link if start + link in edited.robot.link]
    reference = kept[0]
    if name == "root --move-frames":
        moved = {words[1] for words in edited.proofs[0].lines if words[0] == "frame"}
        kept = [link for link in kept if link not in moved]
        reference = kept[0]
    for _ in range(CONFIGURATIONS):
        positions = {j: generator.uniform(-1, 1) for j in moving}
        poses, total, names, matrix = one.compute(positions, reference)
        other = map_positions(name, values, moving, positions)
        poses2, total2, names2, matrix2 = two.compute(other, start + reference)
        for link in kept:
            if link in poses and start + link in poses2:
                offset = flip @ poses[link] @ flip - poses2[start + link]
                worst[0] = max(worst[0], np.abs(offset).max())
        if name in ("attach", "cut"):
            continue
        if total[0] > 0:
            s = flip[:3, :3]
            center = np.abs(s @ total[1] - total2[1]).max() / max(1.0, np.abs(total[1]).max())
            inertia = np.abs(s @ total[2] @ s - total2[2]).max() / max(np.trace(total[2]), 1e-12)
            mass = abs(total[0] - total2[0]) / total[0]
            worst[1] = max(worst[1], center, inertia, mass)
        if name.startswith("root") or not len(names):
            continue  # another base is fixed: the matrix is another one
        columns = [names2.index(start + n) for n in names]
        sign = -1.0 if name == "sign" else 1.0
        signs = np.array([sign if n in moving else 1.0 for n in names])
        there = matrix2[np.ix_(columns, columns)] * np.outer(signs, signs)
        worst[2] = max(worst[2], np.abs(matrix - there).max() / max(np.abs(matrix).max(), 1e-12))
    return worst


NUMBERS = re.compile(
    r"(<(?:origin|axis|limit|mimic|inertia|mass)\b[^<>]*?\b"
    r'(xyz|rpy|lower|upper|multiplier|offset|ixx|ixy|ixz|iyz|value)=")([^"]*)(")'
)


def plant(data, generator):
    """Change one number or name of a URDF as a mistake would; return the text and what it is."""
    text = data.decode()
    places = [match for match in NUMBERS.finditer(text) if not _is_in_visual(text, match.start())]
    generator.shuffle(places)
    for match in places:
        words = match[3].split()
        index = generator.randrange(len(words))
        value = float(words[index])
        key, tag = match[2], re.match(r"<(\w+)", match[1])[1]
        if key in ("ixy", "ixz", "iyz", "offset", "multiplier") or tag == "axis":
            if abs(value) < 1e-7:
                continue
            new, what = -value, f"sign of {key}"
        elif key in ("xyz", "rpy", "lower", "upper"):
            new, what = value + generator.choice((1e-3, -1e-3)), f"0.001 in {key}"
        else:
            if not value:
                continue
            new, what = value * 1.001, f"0.1 % of {key}"
        words[index] = repr(new)
        changed = text[: match.start(3)] + " ".join(words) + text[match.end(3) :]
        line = text.count("\n", 0, match.start()) + 1
        context = " ".join(text[max(0, match.start() - 60) : match.end() + 90].split())
        return changed, f"{tag}: {what} in line {line}: {context}"
    return None, ""


def _is_in_visual(text, at):
    """Tell whether a place is in something that has no effect on motion: a comment, or a block."""
    before = text[:at]
    if text[at:].startswith("<origin") and before.rfind("<joint ") < before.rfind("<link "):
        return True  # it may be of a shape or body that has no direction
    return any(
        before.rfind(start) > before.rfind(end)
        for start, end in (("<!--", "-->"), ("<gazebo", "</gazebo"), ("<ros2_control", "</ros2_c"))
    )


def has_effect(robot, what, changed, original):
    """Tell whether a change is one of the mechanism, by the model of both texts."""
    return _describe(changed) != _describe(original)


def _describe(robot):
    found = []
    for joint in robot.joints:
        limit = joint.limit if joint.type in ("revolute", "prismatic") else None
        axis = joint.axis.xyz if joint.axis and joint.has_axis else None
        mimic = joint.mimic and (joint.mimic.joint, joint.mimic.multiplier, joint.mimic.offset)
        ends = limit and (limit.lower, limit.upper)
        found.append(
            (joint.name, joint.origin and (joint.origin.xyz, joint.origin.rpy), axis, ends, mimic)
        )
    for link in robot.links:
        body = link.inertial
        if body and (body.mass or (body.inertia and any(body.inertia.six))):
            six = body.inertia.six if body.inertia else ()
            turned = len(set(six[::3])) > 1 or any((six[1], six[2], six[4])) if six else False
            at = body.origin and (body.origin.xyz, turned and body.origin.rpy)
            found.append((link.name, body.mass, at, six))
        for shape in (*link.visuals, *link.collisions):
            at = shape.origin and (shape.origin.xyz, shape.origin.rpy)
            found.append((link.name, at))
    return found


def find_mistakes(robot, name, edited, generator, folder, counts):
    """Plant a mistake into a result, and look whether it is found by one of its proofs."""
    text, what = plant(edited.data, generator)
    if text is None:
        return
    path = Path(folder) / "planted.urdf"
    path.write_text(text)
    changed = urdftool.load(path)
    if not has_effect(robot, what, changed, edited.robot):
        return
    changed.source.packages = edited.robot.source.packages
    equal = []
    for proof in edited.proofs:
        declared = parse_correspondence(list(enumerate(proof.lines, 1)), 2)
        rows = limit_tolerances(ROWS, declared.tolerance)
        equal.append(compare_declared(robot, changed, declared, rows=rows).is_equal)
    counts["planted"] += 1
    counts["found"] += not all(equal)
    if all(equal):
        print(f"  NOT FOUND {name}: {what}", flush=True)


def main(paths, mistakes):
    """Measure all operations on robots."""
    worst, counts = defaultdict(lambda: np.zeros(3)), defaultdict(lambda: defaultdict(int))
    generator = random.Random(1)
    with tempfile.TemporaryDirectory() as folder:
        for path in paths:
            try:
                robot = urdftool.load(path)
                operations, values, moving = list_operations(robot)
                text = Path(path).read_text()
                Engine(text)
            except Exception as error:
                counts["not read"][type(error).__name__] += 1
                continue
            for name, operation in operations.items():
                try:
                    edited = operation()
                except urdftool.UrdftoolError as error:
                    counts[name]["refused"] += 1
                    print(f"{Path(path).name}: {name}: refused: {error.message[:120]}", flush=True)
                    continue
                counts[name]["made"] += 1
                counts[name]["proved"] += edited.is_proved
                if not edited.is_proved:
                    first = edited.proofs[0].comparison.differences[:1]
                    print(
                        f"{Path(path).name}: {name}: differs: {[d.title for d in first]}",
                        flush=True,
                    )
                if mistakes:
                    find_mistakes(robot, name, edited, generator, folder, counts["mistakes"])
                    continue
                try:
                    numbers = measure(robot, text, name, edited, values, moving)
                except Exception as error:
                    counts[name]["not measured"] += 1
                    print(f"{Path(path).name}: {name}: not measured: {error!r:.150}", flush=True)
                    continue
                counts[name]["measured"] += 1
                if (numbers > (1e-9, 1e-9, 1e-8)).any():
                    print(f"{Path(path).name}: {name}: {numbers}", flush=True)
                worst[name] = np.maximum(worst[name], numbers)
    for name, row in counts.items():
        print(
            f"{name:20} {dict(row)} pose {worst[name][0]:.1e} inertia {worst[name][1]:.1e} "
            f"matrix {worst[name][2]:.1e}"
        )


if __name__ == "__main__":
    arguments = sys.argv[1:]
    main([a for a in arguments if a != "--mistakes"], "--mistakes" in arguments)
