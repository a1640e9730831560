"""How Sphinx makes the site of these pages: ``make site``.

The pages are plain Markdown that reads well where it lies; what only the site needs is here: the
order of its menu, and a way back from each of the rules, which the menu does not list.
"""

from __future__ import annotations

from pathlib import Path

from sphinx.application import Sphinx

from urdftool import __version__

DOCS = Path(__file__).resolve().parent
REPOSITORY = "https://github.com/urdftool/urdftool"

MENU = {
    "First": ("start", "install", "compare"),
    "Commands": (
        *(f"commands/{name}" for name in ("expand", "lint", "inertia", "collision", "graph")),
        *(f"commands/{name}" for name in ("info", "diff", "view", "simulate", "export")),
    ),
    "How to": (
        *("adopting", "building", "howto/cad-to-simulation", "howto/collision-fleet"),
        *("howto/classic-to-gz", "howto/mujoco-scene", "howto/strangers", "howto/two-wheels"),
    ),
    "To look up": (
        *("rules/index", "configuration", "formats/sdf", "formats/mjcf", "formats/mjcf_runs"),
        *("python", "completion"),
        *(
            "benchmarks",
            "fidelity",
            "robustness",
            "simulate-robots",
            "inertia-vendors",
            "lint-precision",
        ),
    ),
    "For contributors": ("architecture", "contributing"),
}
"""The pages of the menu, by caption; one that is not there yet is left out."""

project = author = "urdftool"
project_copyright = "the authors of urdftool; Apache-2.0"
version = release = __version__

extensions = ["myst_parser", "sphinx_copybutton"]
source_suffix = {".md": "markdown"}
exclude_patterns = ["pictures/*.py"]
myst_enable_extensions = ["colon_fence"]
myst_heading_anchors = 4
nitpicky = True
smartquotes = False  # "--fix" stays what is typed

html_theme = "furo"
html_title = "urdftool"
html_static_path = ["static"]
html_css_files = ["site.css"]
html_copy_source = False
html_show_sphinx = False
html_theme_options = {"source_repository": f"{REPOSITORY}/", "source_branch": "main"}
html_theme_options |= {"source_directory": "docs/", "top_of_page_buttons": ["view"]}
pygments_style = "friendly"
pygments_dark_style = "github-dark"

copybutton_prompt_text = "$ "
copybutton_only_copy_prompt_lines = True


def for_the_site(app: Sphinx, name: str, source: list[str]) -> None:
    """A page as the site wants it: the first with the menu, a rule with a way back."""
    if name == "index":
        source[0] += "".join(_menu(caption, pages) for caption, pages in MENU.items())
    elif name.startswith("rules/") and name != "rules/index":
        source[0] = f"---\norphan: true\n---\n\n{source[0]}\n[All rules](index.md)\n"
    elif name == "contributing":
        above = (DOCS.parent / "CONTRIBUTING.md").read_text("utf-8")
        source[0] = above.replace("](docs/", "](")


def _menu(caption: str, pages: tuple[str, ...]) -> str:
    there = "\n".join(page for page in pages if (DOCS / f"{page}.md").exists())
    return f"\n```{{toctree}}\n:hidden:\n:caption: {caption}\n\n{there}\n```\n"


def setup(app: Sphinx) -> dict[str, bool]:
    """Called by Sphinx."""
    app.connect("source-read", for_the_site)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
