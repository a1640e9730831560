"""Joint sliders of the page and the current joint positions."""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from ..model.elements import Robot
from ..model.kinematics import add_mimic_positions
from . import panels
from .properties import shorten_name
from .sliders import Slider, create_sliders

if TYPE_CHECKING:
    import viser

WHERE = ("zero", "lower", "upper", "random")
_LONGEST = 40
"""Characters of the name of a joint. Chosen, no source."""


class Joints:
    """Joint positions of a robot, with a slider for each joint."""

    def __init__(
        self,
        gui: viser.GuiApi,
        tab: Any,
        moved: Callable[[Mapping[str, float]], None],
        safely: Callable[..., None],
        start: Mapping[str, float],
    ) -> None:
        """Create the buttons; sliders are created with a robot."""
        self._gui, self._tab, self._moved, self._safely = gui, tab, moved, safely
        self._start = dict(start)
        self._positions: dict[str, float] = dict(start)
        self._robot: Robot | None = None
        self._sliders: list[Slider] = []
        self._handles: dict[str, Any] = {}
        with tab:
            self._buttons = gui.add_button_group("all joints", WHERE)
            self._buttons.on_click(lambda event: safely(self.put, event.target.value))
            self._none = gui.add_html(
                panels.wrap_html("The robot has no movable joints."), visible=False
            )

    @property
    def positions(self) -> dict[str, float]:
        """Return the position of each joint [rad or m]."""
        return dict(self._positions)

    @property
    def sliders(self) -> tuple[Slider, ...]:
        """Return the sliders, in the order of the file."""
        return tuple(self._sliders)

    def take(self, robot: Robot, reach: float) -> None:
        """Create the sliders of a robot; joints with a known position keep it.

        Args:
            robot: The robot.
            reach: Travel to either side of a prismatic joint without limits [m].
        """
        self._robot = robot
        sliders = create_sliders(robot, self._start, reach)
        if sliders != self._sliders:
            for handle in self._handles.values():
                handle.remove()
            self._sliders = sliders
            with self._tab:
                self._handles = {slider.name: self._make_slider(slider) for slider in sliders}
        self._buttons.visible, self._none.visible = bool(sliders), not sliders
        zero = {slider.name: slider.zero for slider in self._list_free()}
        same = {
            slider.name: slider for slider in self._list_free() if slider.name in self._positions
        }
        stay = {name: slider.clamp_position(self._positions[name]) for name, slider in same.items()}
        self._positions = {}
        self.move({**zero, **stay})

    def _make_slider(self, slider: Slider) -> Any:
        low, high = slider.shown_bounds
        if high <= low:
            low, high = low - slider.step, high + slider.step
        unit = "rad" if slider.turns else "m"
        handle = self._gui.add_slider(
            shorten_name(slider.name, _LONGEST),
            min=low,
            max=high,
            step=slider.step,
            initial_value=min(max(slider.round_position(slider.zero), low), high),
            marks=(
                (low, slider.format_position(slider.lower)),
                (high, slider.format_position(slider.upper)),
            ),
            disabled=slider.locked,
            hint=f"{shorten_name(slider.name)} [{unit}]{': ' * bool(slider.note)}{slider.note}",
        )

        def slid(_: object) -> None:
            self._safely(self._handle_slider, slider)

        handle.on_update(slid)
        return handle

    def _handle_slider(self, slider: Slider) -> None:
        """Handle a slider update, by the user or by this page."""
        handle = self._handles.get(slider.name)
        if handle is None or slider.locked or slider not in self._sliders:
            return
        if handle.value != slider.round_position(self._positions.get(slider.name, 0.0)):
            self.move({slider.name: slider.clamp_position(handle.value)}, leader=slider.name)

    def move(self, requested: Mapping[str, float], leader: str = "") -> None:
        """Move joints [rad or m] and the joints that mimic them; the others stay."""
        if self._robot is None:
            return
        free = {slider.name for slider in self._list_free()}
        given = {name: at for name, at in {**self._positions, **requested}.items() if name in free}
        positions = add_mimic_positions(self._robot, given)
        self._positions = {slider.name: positions[slider.name] for slider in self._sliders}
        self._moved(positions)
        for slider in self._sliders:
            value, handle = positions[slider.name], self._handles[slider.name]
            words = f"{shorten_name(slider.name, _LONGEST)} {slider.format_short(value)}"
            if handle.label != words:
                handle.label = words
            if slider.name != leader and handle.value != slider.round_position(value):
                handle.value = slider.round_position(value)

    def put(self, where: str) -> None:
        """Move every joint that does not mimic another to one of ``WHERE``."""
        free = self._list_free()
        if where == "random":
            self.move({slider.name: random.uniform(slider.lower, slider.upper) for slider in free})
        else:
            self.move({slider.name: getattr(slider, where) for slider in free})

    def _list_free(self) -> list[Slider]:
        return [slider for slider in self._sliders if not slider.follows]
