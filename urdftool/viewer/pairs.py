"""Tab of the page with pairs of links, and the poses at which they touch."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from ..errors import UrdftoolError
from ..model.pair_pose import PairPose
from . import panels
from .properties import shorten_name

if TYPE_CHECKING:
    import viser

NO_PAIR = "none"

_LONGEST = 24
"""Most letters of a link in the list of pairs. Chosen, no source."""


class Pairs:
    """Choice of a pair of links, whose pose is then shown."""

    def __init__(
        self,
        gui: viser.GuiApi,
        tab: Any,
        chosen: Callable[[PairPose | None], None],
        safely: Callable[..., None],
    ) -> None:
        """Create the tab, which reports that the pairs are compared."""
        self._chosen, self._safely = chosen, safely
        self._pairs: dict[str, PairPose] = {}
        with tab:
            self._chooser: Any = gui.add_dropdown("pair", (NO_PAIR,), visible=False)
            self._chooser.on_update(lambda _: safely(self._handle_choice))
            self._text = gui.add_html(panels.wrap_html("comparing the disabled pairs …"))

    @property
    def labels(self) -> tuple[str, ...]:
        """Return the labels of the pairs, in their order."""
        return tuple(self._pairs)

    def take(self, pairs: Sequence[PairPose]) -> None:
        """Offer pairs; none is chosen."""
        self._pairs = {
            f"{number}. {_shorten(pair.link1)} – {_shorten(pair.link2)}": pair
            for number, pair in enumerate(pairs, 1)
        }
        self._chooser.options = (NO_PAIR, *self._pairs)
        self._chooser.value = NO_PAIR
        self._chooser.visible = bool(pairs)
        self._text.content = panels.format_pairs(pairs)

    def choose(self, label: str) -> None:
        """Choose a pair by its label."""
        self._chooser.value = label

    def report(self, error: UrdftoolError) -> None:
        """Show why the pairs are not known."""
        self._pairs = {}
        self._chooser.visible = False
        self._text.content = panels.format_error(error)

    def _handle_choice(self) -> None:
        self._chosen(self._pairs.get(self._chooser.value))


def _shorten(link: str) -> str:
    return shorten_name(link, _LONGEST)
