"""Configure Sphinx for the site of these pages: ``make site``.

The pages are plain Markdown that can be read in the repository. This file adds what only the site
needs: the order of its menu, a link from each rule back to the list, and redirects of old
addresses.
"""

from __future__ import annotations

from pathlib import Path

from sphinx.application import Sphinx

from urdftool import __version__
from urdftool.rules.old_names import RENAMED_RULES

DOCS = Path(__file__).resolve().parent
REPOSITORY = "https://github.com/urdftool/urdftool"

MENU = {
    "Start": ("start", "install", "terms", "compare"),
    "Commands": (
        *(f"commands/{name}" for name in ("expand", "lint", "inertia", "collision", "graph")),
        *(f"commands/{name}" for name in ("info", "diff", "verify", "view", "simulate")),
        *(f"commands/{name}" for name in ("srdf", "fmt", "server", "schema")),
        *(f"commands/{name}" for name in ("bundle", "edit", "export", "cmake-dir")),
    ),
    "Operations": (
        *(f"edit/{name}" for name in ("attach", "prefix", "merge-fixed", "root", "mirror")),
        *(f"edit/{name}" for name in ("zero", "sign", "cut", "round")),
    ),
    "How-to": (
        *("adopting", "editors", "agents", "building"),
        *("howto/two-wheels", "howto/cad-to-simulation"),
        *("howto/collision-fleet", "howto/cluster", "howto/classic-to-gz", "howto/mujoco-scene"),
        *("howto/mujoco-to-ros", "howto/moveit-without-ros", "howto/untrusted-input"),
    ),
    "Reference": (
        *("rules/index", "configuration", "formats/commands", "formats/urdf", "formats/sdf"),
        *("formats/mjcf", "formats/mjcf_runs", "formats/mjcf_vendors", "formats/usd"),
        *("python", "completion"),
    ),
    "Measurements": (
        *(f"measurements/{name}" for name in ("index", "benchmarks", "fidelity", "verify")),
        *(f"measurements/{name}" for name in ("lint-precision", "robustness", "simulate-robots")),
        *(f"measurements/{name}" for name in ("collision", "inertia-vendors", "vendors")),
        *(f"measurements/{name}" for name in ("srdf-vendors", "srdf-numbers", "edits", "server")),
        "upstream",
    ),
    "Development": ("architecture", "contributing"),
}
"""Pages of the menu, by caption; files that do not exist are left out."""

RENAMED_PAGES = {"howto/strangers": "howto/untrusted-input", "house": "architecture"}
MOVED_PAGES = {
    **{
        name: f"measurements/{name}"
        for name in (
            *("benchmarks", "fidelity", "verify", "lint-precision", "robustness"),
            *("simulate-robots", "inertia-vendors", "vendors", "srdf-vendors", "srdf-numbers"),
        )
    },
    **{f"{name}-measurements": f"measurements/{name}" for name in ("collision", "server")},
    "edit-measurements": "measurements/edits",
}
REDIRECTS = (
    RENAMED_PAGES | MOVED_PAGES | {f"rules/{a}": f"rules/{b}" for a, b in RENAMED_RULES.items()}
)
"""Old addresses of pages, and their new ones."""

project = author = "urdftool"
project_copyright = "the authors of urdftool; Apache-2.0"
version = release = __version__

extensions = ["myst_parser", "sphinx_copybutton"]
source_suffix = {".md": "markdown"}
exclude_patterns = ["pictures/*.py"]
myst_enable_extensions = ["colon_fence", "deflist"]
myst_heading_anchors = 4
nitpicky = True
smartquotes = False  # docutils would turn --fix into an en dash and "fix"

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


def add_site_parts(app: Sphinx, name: str, source: list[str]) -> None:
    """Add to a page what only the site has: the menu, or the link from a rule to the list."""
    if name == "index":
        source[0] += "".join(write_menu(caption, pages) for caption, pages in MENU.items())
    elif name.startswith("rules/") and name != "rules/index":
        source[0] = f"---\norphan: true\n---\n\n{source[0]}\n[All rules](index.md)\n"
    elif name == "contributing":
        above = (DOCS.parent / "CONTRIBUTING.md").read_text("utf-8")
        source[0] = above.replace("](docs/", "](")


def write_menu(caption: str, pages: tuple[str, ...]) -> str:
    """Return the part of the menu with one caption, as a directive."""
    present = "\n".join(page for page in pages if (DOCS / f"{page}.md").exists())
    return f"\n```{{toctree}}\n:hidden:\n:caption: {caption}\n\n{present}\n```\n"


def write_redirects(app: Sphinx, error: Exception | None) -> None:
    """Write a page at each old address that leads to the new one."""
    if error is not None or app.builder.name != "html":
        return
    for old, new in REDIRECTS.items():
        target = "../" * old.count("/") + f"{new}.html"
        page = (
            f'<!doctype html>\n<meta charset="utf-8">\n<title>{new}</title>\n'
            f'<meta http-equiv="refresh" content="0; url={target}">\n'
            f'<p>This page has moved: <a href="{target}">{new}</a>.</p>\n'
        )
        (Path(app.outdir) / f"{old}.html").write_text(page, "utf-8")


def setup(app: Sphinx) -> dict[str, bool]:
    """Connect the functions of this file; called by Sphinx."""
    app.connect("source-read", add_site_parts)
    app.connect("build-finished", write_redirects)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
