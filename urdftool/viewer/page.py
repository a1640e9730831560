"""Contents and events of the page."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import ModelError, UrdftoolError
from ..finding import Finding
from ..model.elements import Robot
from ..model.files import list_sources
from ..model.gltf_axes import describe_gltf_axes
from ..model.kinematics import NOWHERE, compute_link_poses, link_poses
from ..model.pair_pose import PairPose
from . import panels
from .environment import SHEET, VIEW, add_lights, compute_viewpoint, lay_ground
from .joints import Joints
from .marks import group_by_link
from .pairs import Pairs
from .properties import link_rows, shorten_name
from .robot_scene import KINDS, RobotScene
from .sliders import explain_unmovable
from .watch import Watch

if TYPE_CHECKING:
    import viser

    from ..drawing.shapes import Shapes

PAUSE = 0.2
"""Time between two checks of the files [s]. Chosen, no source."""

PATIENCE = 2.0
"""Time after which a broken description is read again [s]; a missing file may exist by then."""

LABELS = {
    "visual": "visual",
    "collision": "collision",
    "frames": "link frames",
    "names": "names",
    "axes": "joint axes",
    "com": "centers of mass",
    "inertia": "inertia boxes",
    "errors": "errors",
    "warnings": "warnings",
}
SHOWN = ("visual", "errors")
MARKS = ("errors", "warnings")
NO_LINK = "none"

Read = Callable[[], Robot]
Load = Callable[[Robot, str], "Shapes"]
Check = Callable[[Robot], list[Finding]]
Compare = Callable[[Robot], list[PairPose]]


class Page:
    """A page with a robot and the user's settings.

    All connected browsers share one state.
    """

    def __init__(
        self,
        server: viser.ViserServer,
        robot: Robot,
        read: Read,
        load: Load,
        check: Check | None,
        *,
        start: Mapping[str, float] = NOWHERE,
        shown: tuple[str, ...] = SHOWN,
        compare: Compare | None = None,
        more: Iterable[str] = (),
    ) -> None:
        """Put a robot on the page.

        The robot is one of :func:`require_viewable`; without ``check`` or ``compare`` there is no
        tab for it.
        """
        self.server, self.robot = server, robot
        self._read, self._load, self._check = read, load, check
        self._lock = threading.RLock()
        self._findings: list[Finding] | None = None
        self._found: dict[str, list[Finding]] = {}
        self._selected: str | None = None
        self._linted = check is None
        self._compare, self._more = compare, tuple(more)
        self._compared = compare is None
        self._error: UrdftoolError | None = None
        self._tried = 0.0
        self._generation = 0
        self.moves = 0
        self.body = self._make_scene(robot)
        self._create_controls(shown, start)
        self._watch = Watch(self._list_files())
        self._fill()

    def _list_files(self) -> list[str]:
        return [*map(str, list_sources(self.robot)), *self._more]

    # Display

    @property
    def title(self) -> str:
        """Return the title of the browser window."""
        return f"{shorten_name(self.robot.name) or 'robot'} · urdftool"

    def _create_controls(self, shown: tuple[str, ...], start: Mapping[str, float]) -> None:
        """Create the controls, which do not depend on the robot."""
        gui, scene = self.server.gui, self.server.scene
        gui.configure_theme(show_share_button=False, show_logo=False, brand_color=(30, 110, 200))
        add_lights(scene)
        self._banner = gui.add_html("", visible=False)
        self._notices = gui.add_html("", visible=False)
        self._summary = gui.add_html("")
        tabs = gui.add_tab_group()
        self.joints = Joints(
            gui, tabs.add_tab("Joints"), self._handle_motion, self._run_safely, start
        )
        self._boxes: dict[str, Any] = {}
        with tabs.add_tab("Show"):
            for kind in KINDS:
                self._boxes[kind] = gui.add_checkbox(LABELS[kind], kind in shown)
                self._boxes[kind].on_update(
                    lambda _, kind=kind: self._run_safely(self.refresh, kind)
                )
            self._clear_box = gui.add_checkbox("transparent visuals", False)
            self._clear_box.on_update(lambda _: self._run_safely(self._clear))
            self._grid_box = gui.add_checkbox("ground", True)
            self._grid_box.on_update(lambda _: self._run_safely(self._update_ground))
        with tabs.add_tab("Parts"):
            self._chooser: Any = gui.add_dropdown("link", (NO_LINK,))
            self._chooser.on_update(lambda _: self._run_safely(self._handle_choice))
            self._one = gui.add_html("")
            self._all = gui.add_html("")
        with tabs.add_tab("Findings"):
            self._list = gui.add_html("")
        self._pairs = None
        if self._compare is not None:
            self._pairs = Pairs(gui, tabs.add_tab("Pairs"), self._show_pair, self._run_safely)
        self.server.on_client_connect(self._adjust_camera)

    def _make_scene(self, robot: Robot) -> RobotScene:
        self._generation += 1
        return RobotScene(
            self.server.scene,
            robot,
            lambda kind: self._load(robot, kind),
            lambda link: self._run_safely(self.select, link),
            root=f"/robot{self._generation}",
        )

    def _fill(self) -> None:
        """Fill the page with the current robot."""
        robot, body = self.robot, self.body
        shapes = [body.load(kind) for kind in ("visual", "collision") if self._boxes[kind].value]
        self._low, self._high = body.measure(compute_link_poses(robot))
        self._floor = self._low[2]
        with self.server.atomic():
            self.joints.take(robot, body.size)
            self._low, self._high = body.measure(link_poses(robot, self.joints.positions))
            for kind in KINDS:
                if kind not in MARKS:
                    body.show(kind, self._boxes[kind].value)
            self._clear()
            self._update_ground()
            self._set_camera()
            self._update_choices()
            self.select(self._selected if self._selected in body.links else None)
            self._update_texts(shapes)
        self.server.gui.set_panel_label(shorten_name(robot.name, 30) or "robot")

    def _update_texts(self, shapes: list[Shapes]) -> None:
        """Update the notices, the summary, the tables and the marks of findings."""
        robot, body = self.robot, self.body
        lost = [link.name for link in robot.links if link.name not in body.links]
        messages = [str(problem) for part in shapes for problem in part.problems]
        messages += [
            f"link '{name}' is not connected to the root and is not shown" for name in lost
        ]
        messages += explain_unmovable(robot)
        messages += filter(None, [describe_gltf_axes(robot)])
        self._set(self._notices, panels.format_notices(dict.fromkeys(messages)))
        self._set(self._summary, panels.format_summary(robot, self._findings))
        self._set(self._all, panels.format_parts(robot, self._found))
        self._set(
            self._list, panels.format_findings(self._findings if self._check else [], self._found)
        )
        body.mark(self._found, [kind for kind in MARKS if self._boxes[kind].value])

    def _set(self, handle: Any, content: str) -> None:
        if handle.content != content:
            handle.content = content
        if handle.visible != bool(content):
            handle.visible = bool(content)

    def _clear(self) -> None:
        with self.server.atomic():
            self.body.set_transparent(self._clear_box.value)

    def _update_ground(self) -> None:
        lay_ground(self.server.scene, self.body.size, self._floor, self._grid_box.value)

    def _set_camera(self) -> None:
        """Set the initial camera so that new browsers show all of the robot."""
        camera, (eye, middle) = self.server.initial_camera, compute_viewpoint(self._low, self._high)
        camera.position, camera.look_at, camera.up = eye, middle, np.array([0.0, 0.0, 1.0])
        camera.fov, camera.near, camera.far = VIEW, self.body.size / 1000, self.body.size * 200

    def _adjust_camera(self, client: viser.ClientHandle) -> None:
        """Move the camera back in a portrait window, as on a phone.

        viser may set the initial camera after this method does, so it is checked for five seconds,
        until the user moves it.
        """
        camera = client.camera
        aspect = camera.image_width / max(camera.image_height, 1)
        if aspect >= 1:
            return
        for _ in range(20):
            with self._lock:
                eye, middle = compute_viewpoint(
                    self._low, self._high, max(aspect, 0.2), covered=SHEET
                )
                if np.allclose(camera.position, self.server.initial_camera.position, rtol=1e-4):
                    with client.atomic():
                        camera.position, camera.look_at = eye, middle
            time.sleep(0.25)

    def _handle_motion(self, positions: Mapping[str, float]) -> None:
        self.moves += 1
        self.body.move(positions)
        if self._selected is not None:
            self._update_properties()

    # Links

    def _update_choices(self) -> None:
        self._links: dict[str, str] = {}
        for link in self.body.links:
            label = base = shorten_name(link) or "(no name)"
            number = 2
            while label in self._links or label == NO_LINK:
                label, number = f"{base} ({number})", number + 1
            self._links[label] = link
        options = (NO_LINK, *self._links)
        if self._chooser.options != options:
            self._chooser.options = options

    def _handle_choice(self) -> None:
        link = self._links.get(self._chooser.value)
        if link != self._selected:
            self.select(link)

    def select(self, link: str | None) -> None:
        """Highlight a link and show its properties; None for none."""
        self._selected = link
        self.body.select(*(() if link is None else (link,)))
        label = next((label for label, name in self._links.items() if name == link), NO_LINK)
        if self._chooser.value != label:
            self._chooser.value = label
        self._update_properties()

    def _update_properties(self) -> None:
        """Show the properties of the selected link at its current pose."""
        if self._selected is None:
            self._set(
                self._one, panels.wrap_html("Click a link, or choose one, to show its properties.")
            )
            return
        pose = link_poses(self.robot, self.joints.positions).get(self._selected)
        link = self.robot.link[self._selected]
        rows = link_rows(self.robot, link, pose)
        self._set(self._one, panels.format_link(self.robot, self._selected, rows))

    def _show_pair(self, pair: PairPose | None) -> None:
        """Move the robot to a pose at which two links touch, and highlight both."""
        self.select(None)
        if pair is None:
            return
        with self.server.atomic():
            self.joints.put("zero")
            self.joints.move(pair.positions)
            self._boxes["collision"].value = True
            self.refresh("collision")
            self.body.select(pair.link1, pair.link2)

    def refresh(self, kind: str) -> None:
        """Show or hide one of ``KINDS`` according to its checkbox."""
        with self.server.atomic():
            self.body.show(kind, self._boxes[kind].value)
            self._clear()
            if kind in ("visual", "collision"):
                self._update_texts(list(self.body.shapes.values()))

    # Files

    def poll(self) -> None:
        """Poll once: read the description again if files changed, and lint a new robot."""
        changed = self._watch.find_changes()
        late = self._error is not None and time.monotonic() - self._tried > PATIENCE
        if changed or late:
            self._run_safely(self.reload)
        elif not self._linted and self._check is not None:
            self._linted = True
            try:
                findings = self._check(self.robot)
            except UrdftoolError as error:
                with self._lock:
                    self._set(self._list, panels.format_error(error))
                return
            self._run_safely(self._set_findings, findings)
        elif not self._compared and self._compare is not None and self._pairs is not None:
            self._compared = True
            try:
                pairs = self._compare(self.robot)
            except UrdftoolError as error:
                self._run_safely(self._pairs.report, error)
                return
            self._run_safely(self._pairs.take, pairs)

    def run(self) -> None:
        """Poll until the process is interrupted."""
        while True:
            self.poll()
            time.sleep(PAUSE)

    def reload(self) -> None:
        """Read the description again; keep the last robot if it is broken."""
        self._tried = time.monotonic()
        self._watch.take({*self._watch.paths, *self._list_files()})
        try:
            robot = require_viewable(self._read())
            kinds = [kind for kind in ("visual", "collision") if self._boxes[kind].value]
            shapes = {kind: self._load(robot, kind) for kind in kinds}
        except UrdftoolError as error:
            if str(error) != str(self._error):
                self._error = error
                self._set(self._banner, panels.format_error(error))
            if error.path:
                self._watch.take({*self._watch.paths, error.path})
            return
        self._error = None
        with self.server.atomic():
            self.body.remove()
            self.robot, self.body = robot, self._make_scene(robot)
            self.body.shapes.update(shapes)
            self._findings, self._found, self._linted = None, {}, self._check is None
            self._compared = self._compare is None
            self._fill()
            self._set(self._banner, "")
        self._watch.take(self._list_files())

    def _set_findings(self, findings: list[Finding]) -> None:
        self._findings, self._found = findings, group_by_link(self.robot, findings)
        with self.server.atomic():
            self._update_texts(list(self.body.shapes.values()))

    def _run_safely(self, action: Callable[..., None], *arguments: Any) -> None:
        """Run an action under the lock; an exception is shown on the page, which continues."""
        with self._lock:
            try:
                action(*arguments)
            except Exception as error:
                self._banner.content, self._banner.visible = panels.format_bug(error), True


def require_viewable(robot: Robot) -> Robot:
    """Return the robot if it can be displayed.

    Raises:
        ModelError: It has no link, or no root link because joints form a loop.
    """
    if not robot.links:
        raise ModelError("the robot has no links; there is nothing to view", at=robot.place)
    if not robot.tree.roots:
        raise ModelError(
            "the robot has no root link, because its joints form a loop; remove a joint",
            at=robot.place,
        )
    return robot
