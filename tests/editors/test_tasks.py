"""Ten tasks of an author of xacro, which docs/editors.md shows."""

import re
import shutil
from importlib.util import find_spec

import pytest

from tests.conftest import FIXTURES, ROOT
from tests.editors.tasks import Author, do_tasks
from tests.server.client import Client

PAGE = ROOT / "docs" / "editors.md"


@pytest.mark.slow
@pytest.mark.skipif(find_spec("pygls") is None, reason="it needs the extra 'server'")
def test_ten_tasks_appear_as_on_the_page(tmp_path, monkeypatch):
    folder = tmp_path.resolve() / "demo_arm"
    shutil.copytree(FIXTURES / "robots" / "demo_arm", folder)
    monkeypatch.chdir(tmp_path)
    with Client(folder) as client:
        appeared = do_tasks(Author(client, folder / "urdf"))
    page = PAGE.read_text("utf-8")
    shown = re.search(r"<!-- recording: tasks -->\n\n```text\n(.*?)```", page, re.DOTALL)
    assert appeared == shown[1]
