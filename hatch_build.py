"""Parts of wheel and sdist that are not files of the package.

The links and pictures of the README lead to the site, not into a checkout. A wheel has the JSON
schemas; an editable installation reads those of the checkout.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface
from hatchling.metadata.plugin.interface import MetadataHookInterface

LINK = re.compile(r"\]\((?!https?:)([^)\s]+)\)")


def on_the_site(text: str, site: str) -> str:
    """A README whose relative links are absolute; ``/page`` leads to the newest version."""

    def absolute(match: re.Match[str]) -> str:
        path, mark, anchor = match[1].partition("#")
        path = path.removeprefix("docs/")
        if path.endswith(".png"):
            return f"]({site}/page/_images/{Path(path).name})"
        page = path.lower() if "/" not in path else path
        return f"]({site}/page/{page.removesuffix('.md')}.html{mark}{anchor})"

    return LINK.sub(absolute, text)


class ReadmeHook(MetadataHookInterface):
    """Called by hatchling."""

    def update(self, metadata: dict[str, Any]) -> None:
        """Put in the README."""
        text = (Path(self.root) / "README.md").read_text("utf-8")
        site = metadata["urls"]["Documentation"]
        metadata["readme"] = {"content-type": "text/markdown", "text": on_the_site(text, site)}


class SchemaHook(BuildHookInterface[Any]):
    """Called by hatchling."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Add the schemas."""
        if version != "editable":
            build_data["force_include"]["docs/schemas"] = "urdftool/schemas"
