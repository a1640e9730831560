"""Access to a compiled MJCF model. The only module that imports mujoco."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from ...errors import OutputError
from ...extras import is_installed, make_missing_error
from ...isolated import ProcessDied
from ...limited import Limits, call_with_limits
from ...mechanics.reference import GRAVITY, Array
from ...mujoco_library import import_mujoco
from ..common.directory import write_directory
from ..registry import format_named
from ..written import Written

_LIMITS = Limits(time=300.0)
"""Limits of compiling an export, whose size that of the robot limits."""

_PLAIN = (
    "<mujoco><asset><material name='plain'/></asset>"
    "<worldbody><body><joint/><geom size='1'/></body></worldbody></mujoco>"
)


def _check_name(path: Path) -> str:
    """Return a path as text; raise :class:`UnicodeEncodeError` if it is not UTF-8."""
    return str(path).encode("utf-8").decode("utf-8")


def compile_file(path: Path) -> tuple[Any, list[str]]:
    """Compile a file.

    Returns:
        MuJoCo's model, and the warnings of the compiler.

    Raises:
        MissingDependency: MuJoCo is not installed.
        OutputError: The file does not compile.
    """
    import warnings

    mujoco = import_mujoco("--verify")
    texts: list[str] = []
    mujoco.set_mju_user_warning(texts.append)  # else MuJoCo writes a log file
    try:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            model = mujoco.MjModel.from_xml_path(_check_name(path))
    except UnicodeEncodeError:
        raise OutputError(
            "MuJoCo reads only files whose name is UTF-8; use another name", path=path.name
        ) from None
    except (ValueError, mujoco.FatalError) as error:
        reason = " ".join(str(error).replace(f"{path.parent}{os.sep}", "").split())
        raise OutputError(
            f"MuJoCo does not compile the export, so nothing is written: {reason}", path=path.name
        ) from None
    texts += [str(warning.message) for warning in caught]
    return model, list(dict.fromkeys(" ".join(text.split()) for text in texts))


def compile_copy(written: Written) -> None:
    """Compile a temporary copy of an export; skip this if MuJoCo is not installed.

    Raises:
        OutputError: The model, or the scene around it, does not compile.
    """
    if not is_installed("mujoco"):
        return
    with copy_export(written) as folder:
        compile_all(written, folder)


def compile_all(written: Written, folder: Path) -> None:
    """Compile the model and the scene of an export that was written to a folder.

    Raises:
        MissingDependency: MuJoCo is not installed.
        OutputError: One of them does not compile.
    """
    if not is_installed("mujoco"):
        raise make_missing_error("mujoco", "--verify")
    paths = [
        folder / name
        for name, content in written.files.items()
        if isinstance(content, bytes) and format_named("mjcf").has_suffix(name)
    ]
    try:
        call_with_limits(_compile_files, paths, limits=_LIMITS)
    except ProcessDied as error:
        raise OutputError(
            f"MuJoCo crashes on the export, so nothing is written: {error.message}",
            path=written.main,
            notes=error.output,
        ) from None


def _compile_files(paths: Iterable[Path]) -> None:
    for path in paths:
        compile_file(path)


@contextmanager
def copy_export(written: Written) -> Iterator[Path]:
    """Write a copy of an export to a temporary folder, and yield the folder."""
    with tempfile.TemporaryDirectory(prefix="urdftool-") as place:
        folder = Path(os.path.realpath(place)) / "model"
        write_directory(folder, written.files, main=written.main)
        yield folder


class Compiled:
    """A compiled MuJoCo model, posed joint by joint.

    Attributes:
        model: MuJoCo's model.
        root: Body of the robot's root link; 0 is the world.
        renamed: New names by kind and old name.
        warnings: Warnings of the compiler; none are expected.
        written_options: Physics options of the file by name; gravity of ``model`` itself is
            replaced by that of the reference mechanics.
    """

    def __init__(
        self, path: Path, root: str, renamed: Mapping[tuple[str, str], str] | None = None
    ) -> None:
        """Compile a file.

        Raises:
            MissingDependency: MuJoCo is not installed.
            OutputError: The file does not compile.
        """
        self.mujoco = import_mujoco("--verify")
        self._reference: Any = None
        self.renamed = dict(renamed or {})
        self.model, self.warnings = compile_file(path)
        self.mujoco.set_mju_user_warning(self._warn)
        self.written_options = self._collect_options(self.model)
        self.model.opt.gravity = GRAVITY
        self.model.opt.disableflags &= ~int(self.mujoco.mjtDisableBit.mjDSBL_GRAVITY)
        self.data = self.mujoco.MjData(self.model)
        self.root = max(self.get_body(root), 0)

    @property
    def tensor_rounding(self) -> float:
        """Return the relative error of a full tensor; diagonalization stops early before 4.0."""
        major = str(self.mujoco.__version__).partition(".")[0]
        return 1e-8 if major.isdigit() and int(major) >= 4 else 2e-6

    def _collect_options(self, model: Any) -> dict[str, Any]:
        names = [name for name in dir(model.opt) if not name.startswith("_")]
        return {name: np.array(getattr(model.opt, name)).tolist() for name in names}

    def get_reference(self) -> Any:
        """Return a model of one body, joint and geom with MuJoCo's defaults."""
        if self._reference is None:
            self._reference = self.mujoco.MjModel.from_xml_string(_PLAIN)
        return self._reference

    def _warn(self, text: str) -> None:
        line = " ".join(text.split())
        if line not in self.warnings:
            self.warnings.append(line)

    def get_id(self, kind: str, name: str) -> int:
        """Return the index of an object by kind (``BODY``, ``JOINT`` …) and name; -1 for none."""
        number = self.mujoco.mj_name2id(
            self.model, getattr(self.mujoco.mjtObj, f"mjOBJ_{kind}"), name
        )
        return int(number)

    def get_body(self, link: str) -> int:
        """Return the index of a link's body; -1 if not found, 0 for the world."""
        return self.get_id("BODY", self.renamed.get(("link", link), link))

    def name(self, kind: str, number: int) -> str:
        """Return the name of an object; empty if it has none."""
        found = self.mujoco.mj_id2name(
            self.model, getattr(self.mujoco.mjtObj, f"mjOBJ_{kind}"), number
        )
        return found or ""

    def set_pose(self, positions: Mapping[str, float]) -> None:
        """Set joint positions by name [rad or m]; the other joints get their initial positions."""
        self.mujoco.mj_resetData(self.model, self.data)
        for name, value in positions.items():
            joint = self.get_id("JOINT", name)
            if joint >= 0:
                self.data.qpos[self.model.jnt_qposadr[joint]] = value
        self._compute_state()
        self.mujoco.mj_camlight(self.model, self.data)

    def set_pose_at_key(self, key: int) -> None:
        """Set the state to a keyframe."""
        self.mujoco.mj_resetDataKeyframe(self.model, self.data, key)
        self._compute_state()

    def _compute_state(self) -> None:
        """Compute what depends on the positions.

        Raises:
            OutputError: MuJoCo stops, as it has not enough memory for the contacts.
        """
        try:
            self.mujoco.mj_fwdPosition(self.model, self.data)
            self.mujoco.mj_fwdVelocity(self.model, self.data)
        except self.mujoco.FatalError as error:
            reason = " ".join(str(error).split())
            raise OutputError(
                f"MuJoCo stops at the model, which is not verified: {reason}"
            ) from None

    def get_positions_of_key(self, key: int) -> dict[str, float]:
        """Return the position [rad or m] of each hinge and slide in a keyframe, by name."""
        model, found = self.model, {}
        for joint in range(model.njnt):
            if int(model.jnt_type[joint]) in (2, 3):
                value = model.key_qpos[key][model.jnt_qposadr[joint]]
                found[self.name("JOINT", joint)] = float(value)
        return found

    def get_frame(self, link: str) -> Array | None:
        """Return the pose of a link in the root's frame, 4 × 4; None if it is not a body."""
        body = self.get_body(link)
        return (
            None if body < 0 else self._compute_in_root(self.data.xpos[body], self.data.xmat[body])
        )

    def get_geoms(self, body: int) -> range:
        """Return the indices of the geoms of a body, in file order."""
        if body < 0:
            return range(0)
        first = int(self.model.body_geomadr[body])
        return range(first, first + int(self.model.body_geomnum[body])) if first >= 0 else range(0)

    def get_geom_frame(self, geom: int) -> Array:
        """Return the pose of a geom in the root's frame, 4 × 4."""
        return self._compute_in_root(self.data.geom_xpos[geom], self.data.geom_xmat[geom])

    def get_site_frame(self, site: int) -> Array:
        """Return the pose of a site in the root's frame, 4 × 4."""
        return self._compute_in_root(self.data.site_xpos[site], self.data.site_xmat[site])

    def get_camera_frame(self, camera: int) -> Array:
        """Return the pose of a camera in the root's frame, 4 × 4; it looks along -z."""
        return self._compute_in_root(self.data.cam_xpos[camera], self.data.cam_xmat[camera])

    def _compute_in_root(self, position: Array, rotation: Array) -> Array:
        turn = self.data.xmat[self.root].reshape(3, 3)
        pose = np.eye(4)
        pose[:3, :3] = turn.T @ rotation.reshape(3, 3)
        pose[:3, 3] = turn.T @ (position - self.data.xpos[self.root])
        return pose

    def get_dofs(self, joints: list[str]) -> list[int]:
        """Return the degree of freedom of each hinge or slide; -1 for joints that do not exist."""
        numbers = [self.get_id("JOINT", name) for name in joints]
        return [int(self.model.jnt_dofadr[n]) if n >= 0 else -1 for n in numbers]

    def compute_mass_matrix(self, dofs: list[int]) -> Array:
        """Compute the mass matrix of some degrees of freedom, without armature."""
        count, tendons = self.model.nv, getattr(self.model, "tendon_armature", np.zeros(0))
        if tendons.any():
            armature = tendons.copy()
            tendons[:] = 0.0
            self.mujoco.mj_fwdPosition(self.model, self.data)
            matrix = self.compute_mass_matrix(dofs)
            tendons[:] = armature
            self.mujoco.mj_fwdPosition(self.model, self.data)
            return matrix
        full = np.zeros((count, count))
        for dof in range(count):  # the call for the whole matrix changed its form
            unit, column = np.zeros(count), np.zeros(count)
            unit[dof] = 1.0
            self.mujoco.mj_mulM(self.model, self.data, column, unit)
            full[:, dof] = column
        full -= np.diag(self.model.dof_armature)
        return full[np.ix_(dofs, dofs)]

    def get_gravity(self, dofs: list[int]) -> Array:
        """Return the force [N·m or N] that each degree of freedom needs to hold still."""
        return np.array(self.data.qfrc_bias)[dofs]

    def compute_centroid(self) -> tuple[float, Array, Array]:
        """Compute mass [kg], center of mass [m] and inertia about it [kg·m²], in the root frame."""
        masses = np.array(self.model.body_mass)
        mass = float(masses.sum())
        if mass == 0:
            return 0.0, np.zeros(3), np.zeros((3, 3))
        com = masses @ self.data.xipos / mass
        tensor = np.zeros((3, 3))
        for body in range(self.model.nbody):
            axes = self.data.ximat[body].reshape(3, 3)
            arm = self.data.xipos[body] - com
            tensor += axes @ np.diag(self.model.body_inertia[body]) @ axes.T
            tensor += masses[body] * (arm @ arm * np.eye(3) - np.outer(arm, arm))
        turn = self.data.xmat[self.root].reshape(3, 3)
        return mass, turn.T @ (com - self.data.xpos[self.root]), turn.T @ tensor @ turn
