"""Poses and inertia of a URDF by Pinocchio, and their differences between two files."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterable, Mapping
from typing import Any, NamedTuple

import numpy as np

CONFIGURATIONS = 4


class State(NamedTuple):
    """A robot at one configuration, in the frame of a link.

    Attributes:
        poses: 4 x 4 matrix of each link.
        inertia: Mass [kg], center of mass [m] and tensor of the whole robot about it.
        columns: Joint of each row of the mass matrix.
        matrix: Mass matrix.
    """

    poses: dict[str, Any]
    inertia: tuple[float, Any, Any]
    columns: list[str]
    matrix: Any


class Engine:
    """A URDF in Pinocchio."""

    def __init__(self, text: str) -> None:
        """Read a URDF; meshes are not read."""
        import pinocchio

        self.pin = pinocchio
        self.model = pinocchio.buildModelFromXML(text)
        self.data = self.model.createData()

    def compute(self, positions: Mapping[str, float], reference: str) -> State:
        """Compute a state in the frame of a link."""
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
        total = pin.Inertia.Zero()
        for joint in range(model.njoints):
            total = total + data.oMi[joint].act(model.inertias[joint])
        base = frames[reference].inverse()
        local = base.act(total)
        names = [model.names[j] for j in range(1, model.njoints) for _ in range(model.joints[j].nv)]
        poses = {name: (base * pose).homogeneous for name, pose in frames.items()}
        inertia = local.mass, local.lever, local.inertia
        return State(poses, inertia, names, np.triu(matrix) + np.triu(matrix, 1).T)


class Case(NamedTuple):
    """What is expected of a result.

    Attributes:
        links: Links to compare, each with its name in the result; the first is the reference.
        moving: Joints with a position.
        move: Returns the positions of the result.
        flip: Reflection of the result, 4 x 4.
        signs: Sign of each moving joint in the mass matrix.
        start: Text before the names of joints in the result.
        has_inertia: Whether the whole robot has the same mass and inertia.
        has_matrix: Whether the mass matrix is the same.
    """

    links: Mapping[str, str]
    moving: Iterable[str]
    move: Callable[[Mapping[str, float]], Mapping[str, float]]
    flip: Any
    sign: float = 1.0
    start: str = ""
    has_inertia: bool = True
    has_matrix: bool = True


class Differences(NamedTuple):
    """Largest differences: of poses, inertia (relative), mass matrix (relative), per link."""

    pose: float
    inertia: float
    matrix: float
    links: dict[str, float]


def measure(before: str, after: str, case: Case) -> Differences:
    """Return the largest differences of two URDFs at random configurations."""
    one, two = Engine(before), Engine(after)
    generator = random.Random(0)
    reference = next(iter(case.links))
    links: dict[str, float] = dict.fromkeys(case.links, 0.0)
    inertia = matrix = 0.0
    for _ in range(CONFIGURATIONS):
        positions = {joint: generator.uniform(-1, 1) for joint in case.moving}
        x = one.compute(positions, reference)
        y = two.compute(case.move(positions), case.links[reference])
        for link, name in case.links.items():
            if link in x.poses and name in y.poses:
                offset = np.abs(case.flip @ x.poses[link] @ case.flip - y.poses[name]).max()
                links[link] = max(links[link], offset)
        if case.has_inertia and x.inertia[0] > 0:
            inertia = max(inertia, compare_inertia(x, y, case.flip[:3, :3]))
        if case.has_matrix and x.columns:
            matrix = max(matrix, compare_matrices(x, y, case))
    return Differences(max(links.values()), inertia, matrix, links)


def compare_inertia(x: State, y: State, flip: Any) -> float:
    """Return the largest relative difference of mass, center of mass (above 1 m) and tensor."""
    (mass, center, tensor), (mass2, center2, tensor2) = x.inertia, y.inertia
    away = np.abs(flip @ center - center2).max() / max(1.0, np.abs(center).max())
    turned = np.abs(flip @ tensor @ flip - tensor2).max() / max(np.trace(tensor), 1e-12)
    return max(away, turned, abs(mass - mass2) / mass)


def compare_matrices(x: State, y: State, case: Case) -> float:
    """Return the largest difference of the mass matrices, relative to the largest element."""
    columns = [y.columns.index(case.start + name) for name in x.columns]
    signs = np.array([case.sign if name in case.moving else 1.0 for name in x.columns])
    there = y.matrix[np.ix_(columns, columns)] * np.outer(signs, signs)
    return np.abs(x.matrix - there).max() / max(np.abs(x.matrix).max(), 1e-12)
