"""The page from end to end, in a headless Chromium."""

import shutil
import time
from urllib.parse import urlsplit

import pytest

from tests.conftest import FIXTURES

from . import chromium
from .serving import served

pytest.importorskip("viser")

pytestmark = [
    pytest.mark.slow,
    pytest.mark.program(*chromium.NAMES),
]

READY = "document.querySelectorAll('[role=slider]').length > 0"
SAYS = "document.body.innerText.includes({!r})"


def tab_named(name):
    return f"[...document.querySelectorAll('[role=tab]')].find(e => e.innerText.includes({name!r}))"


def labelled(name):
    return f"[...document.querySelectorAll('label')].find(e => e.innerText === {name!r}).control"


def label_starting(name):
    return (
        f"[...document.querySelectorAll('label')].map(e => e.innerText)"
        f".find(t => t.startsWith({name!r}))"
    )


@pytest.fixture
def arm(tmp_path):
    folder = tmp_path / "demo_arm"
    shutil.copytree(FIXTURES / "robots" / "demo_arm", folder)
    return folder / "urdf" / "arm_sound.urdf.xacro"


def settled(tab, moments=3):
    """The picture once it does not change any more."""
    last = tab.picture()
    same = 0
    end = time.monotonic() + 40
    while same < moments and time.monotonic() < end:
        time.sleep(0.3)
        now = tab.picture()
        same = same + 1 if now == last else 0
        last = now
    return last


def test_a_slider_a_toggle_a_click_and_a_reload(arm):
    with served(arm) as url, chromium.chromium() as new_tab:
        tab = new_tab()
        tab.open(url)
        tab.until(READY)
        assert tab.until("document.title").startswith("demo_arm")
        before = settled(tab)

        # a slider is dragged
        slider = "[...document.querySelectorAll('[role=slider]')][1]"
        x, y = tab.place(slider)
        poses = tab.run("seen.poses")
        tab.mouse("mouseMoved", x, y)
        tab.mouse("mousePressed", x, y)
        for step in range(1, 11):
            tab.mouse("mouseMoved", x + 4 * step, y)
        tab.mouse("mouseReleased", x + 40, y)
        tab.until(f"seen.poses > {poses}")
        value = float(tab.run(f"{slider}.getAttribute('aria-valuenow')"))
        assert value != 0
        assert settled(tab) != before
        meshes = tab.run("seen.types.MeshMessage")

        # collision is shown
        tab.click(*tab.place(tab_named("Show")))
        tab.until(f"{labelled('collision')} !== null")
        unlike = settled(tab)
        tab.click(*tab.place(labelled("collision")))
        tab.until(f"seen.types.MeshMessage > {meshes}")
        assert settled(tab) != unlike

        # the description is broken, and mended with another name for a joint's limit
        text = arm.read_text("utf-8")
        arm.write_text(text.replace("</robot>", ""), "utf-8")
        tab.until(SAYS.format("the file ends before all elements are closed"))
        assert tab.run(SAYS.format("The page shows the last valid version."))
        renamed = text.replace('name="$(arg prefix)demo_arm"', 'name="other_arm"')
        renamed = renamed.replace('<robot name="demo_arm"', '<robot name="other_arm"')
        assert renamed != text
        arm.write_text(renamed, "utf-8")
        tab.until(SAYS.format("other_arm"))
        assert not tab.run(SAYS.format("the file ends before all elements are closed"))

        # the pose is kept
        tab.click(*tab.place(tab_named("Joints")))
        tab.until(READY)
        assert float(tab.run(f"{slider}.getAttribute('aria-valuenow')")) == value

        # an included file counts too
        macro = arm.parent / "link_sound.macro.xacro"
        macro.write_text(macro.read_text("utf-8").replace("</robot>", ""), "utf-8")
        tab.until(SAYS.format(macro.name))

        hosts = {urlsplit(asked).hostname for asked in tab.asked if ":" in asked
                 and urlsplit(asked).scheme in ("http", "https", "ws", "wss")}  # fmt: skip
        assert hosts == {"127.0.0.1"}
        assert any(asked.startswith("ws://127.0.0.1") for asked in tab.asked)


def test_a_link_is_clicked(write):
    path = write(
        "block.urdf",
        '<robot name="block"><link name="&lt;b&gt;lump"><visual><geometry><box size="2 2 2"/>'
        "</geometry></visual></link></robot>",
    )
    with served(path) as url, chromium.chromium() as new_tab:
        tab = new_tab()
        tab.open(url)
        tab.until("seen.types.MeshMessage > 0")
        tab.until(SAYS.format("The robot has no movable joints."))
        settled(tab)
        tab.click(*tab.place(tab_named("Parts")))
        tab.until(SAYS.format("Click a link"))
        tab.click(600, 420)
        tab.until(SAYS.format("none (root link)"))
        assert tab.run("[...document.querySelectorAll('b')].some(e => e.innerText === '<b>lump')")


def test_names_are_no_markup(write):
    name = "<img src=x onerror=document.title='owned'>{{1+1}}**bold**"
    from xml.sax.saxutils import quoteattr

    path = write(
        "hostile.urdf",
        f"<robot name={quoteattr(name)}><link name={quoteattr(name)}/>"
        f"<link name='tip'/><joint name={quoteattr(name + 'j')} type='continuous'>"
        f"<parent link={quoteattr(name)}/><child link='tip'/><axis xyz='0 0 2'/></joint></robot>",
    )
    with served(path) as url, chromium.chromium() as new_tab:
        tab = new_tab(400, 800)
        tab.open(url)
        tab.until(READY)
        tab.click(*tab.place(tab_named("Parts")))
        tab.until(SAYS.format("{1+1}"))
        tab.click(*tab.place(tab_named("Findings")))
        tab.until(SAYS.format("axis-not-unit"))
        assert tab.run("document.querySelectorAll('img[src=x]').length") == 0

        # neither would run if a name became markup
        tab.run(
            "document.body.insertAdjacentHTML('beforeend', "
            '\'<img src=x onerror="window.owned = 1"><a id=way href="javascript:owned = 2">a</a>'
            '<iframe srcdoc="<script>parent.owned = 3</script>"></iframe>\')'
        )
        tab.run("document.getElementById('way').click()")
        time.sleep(1)
        assert tab.run("String(window.owned)") == "undefined"
        assert "onerror" in tab.run("document.title")
